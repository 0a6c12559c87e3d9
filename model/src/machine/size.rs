//! Size of a machine, for scaling limits and tolerances.

use super::{Drive, Machine, Supply};
use crate::effects::Site;

/// Size of a part of a machine relative to the arm of a 3 t excavator (`zx30u-arm`), for which limits, starts, windows of time
/// and tolerances are specified.
///
/// Machines of every size work with the same pressures. Lengths, areas, openings and speeds determine how everything else scales.
/// Each ratio is a power of two, so machines of nearly the same size are treated alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Ratio of strokes.
    pub stroke: f64,
    /// Ratio of piston areas, which is also the ratio of forces.
    pub area: f64,
    /// Ratio of largest orifice areas, in whatever unit a model file gives them: mm², volts, or a share.
    pub opening: f64,
    /// Ratio of the speeds of pistons.
    pub speed: f64,
    /// Ratio of the levers between piston and joint: equal to that of strokes, except for a gear.
    pub lever: f64,
    /// Ratio of the sliding speeds of seals and gaps: one, except for a motor, whose shaft rotates.
    pub sliding: f64,
}

/// Exponents of the ratios of a [`Size`] with which a quantity scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Growth {
    stroke: i32,
    area: i32,
    opening: i32,
    speed: i32,
    lever: i32,
    sliding: i32,
}

impl Growth {
    /// Pressures, pure numbers, and quantities of a recording.
    pub const NONE: Growth = Growth::of(0, 0, 0, 0);
    /// Speeds at which seals start to slide, m/s.
    pub const SEAL_SPEED: Growth = Growth { sliding: 1, ..Growth::NONE };
    /// Distances between joints and on links, m.
    pub const LEVER: Growth = Growth::of(0, 0, 0, 0).with_levers(1);
    /// Positions of pistons and lengths along a stroke, m.
    pub const LENGTH: Growth = Growth::of(1, 0, 0, 0);
    /// Times of a machine's motion, s.
    pub const TIME: Growth = Growth::of(1, 0, 0, -1);
    /// Volumes of oil, m³.
    pub const VOLUME: Growth = Growth::of(1, 1, 0, 0);
    /// Orifice areas, m², or their commands.
    pub const OPENING: Growth = Growth::of(0, 0, 1, 0);
    /// Forces, N, and forces per pressure, m².
    pub const FORCE: Growth = Growth::of(0, 1, 0, 0);
    /// Forces per speed, N s/m.
    pub const DAMPING: Growth = Growth::of(0, 1, 0, -1);
    /// Forces per square of speed, N s²/m².
    pub const DRAG: Growth = Growth::of(0, 1, 0, -2);
    /// Flows, m³/s, and flows per pressure, m³/(s Pa).
    pub const FLOW: Growth = Growth::of(0, 1, 0, 1);
    /// Flow per opening and root of pressure, m/(s sqrt(Pa)).
    pub const FLOW_GAIN: Growth = Growth::of(0, 1, -1, 1);
    /// Pressure per square of flow, Pa s²/m⁶.
    pub const FLOW_RESISTANCE: Growth = Growth::of(0, -2, 0, -2);
    /// One over a speed of pistons, s/m.
    pub const PER_SPEED: Growth = Growth::of(0, 0, 0, -1);
    /// Force per length, N/m.
    pub const STIFFNESS: Growth = Growth::of(-1, 1, 0, 0);
    /// Torque, N m, and torque per angle, N m/rad.
    pub const TORQUE: Growth = Growth::of(0, 1, 0, 0).with_levers(1);
    /// Force per acceleration, kg.
    pub const MASS: Growth = Growth::of(1, 1, 0, -2);
    /// Mass times length, kg m.
    pub const MASS_MOMENT: Growth = Growth::of(1, 1, 0, -2).with_levers(1);
    /// Mass times square of length, kg m².
    pub const INERTIA: Growth = Growth::of(1, 1, 0, -2).with_levers(2);

    const fn of(stroke: i32, area: i32, opening: i32, speed: i32) -> Self {
        Growth { stroke, area, opening, speed, lever: 0, sliding: 0 }
    }

    const fn with_levers(self, lever: i32) -> Self {
        Growth { lever, ..self }
    }
}

impl Size {
    /// The size of the reference machine.
    pub const REFERENCE: Size = Size { stroke: 1.0, area: 1.0, opening: 1.0, speed: 1.0, lever: 1.0, sliding: 1.0 };

    /// The ratio of a quantity to its value on the reference machine.
    pub fn factor(&self, growth: Growth) -> f64 {
        self.stroke.powi(growth.stroke)
            * self.area.powi(growth.area)
            * self.opening.powi(growth.opening)
            * self.speed.powi(growth.speed)
            * self.lever.powi(growth.lever)
            * self.sliding.powi(growth.sliding)
    }

    /// The factor for times, a pure number.
    pub fn time(&self) -> f64 {
        self.factor(Growth::TIME)
    }
}

/// The nearest power of two; one if the ratio has none.
fn rounded(ratio: f64) -> f64 {
    if ratio.is_finite() && ratio > 0.0 { ratio.log2().round().exp2() } else { 1.0 }
}

/// Stroke of the arm cylinder, m, \[A\] Table 1.
const REFERENCE_STROKE: f64 = 0.6;
/// Its piston area on the cap side, m², \[A\] Table 1.
const REFERENCE_AREA: f64 = 3.8e-3;
/// Largest orifice area of its valve section, m².
const REFERENCE_OPENING: f64 = 1.15e-4;
/// Speed at the full flow of its pump, m/s, \[A\] Table 1.
const REFERENCE_SPEED: f64 = 0.1;
/// Lever of the arm's cylinder, m: about the distance of the rod's pin from the joint, \[A\] Table 1.
const REFERENCE_LEVER: f64 = 0.33;
/// Speed of a motor's shaft if no pump flow determines it, rad/s: 500 revolutions per minute.
const MOTOR_SPEED: f64 = 50.0;
/// Distance of a motor's gaps from its axis, m: a few centimetres on motors of all sizes.
const MOTOR_RADIUS: f64 = 0.03;

impl Machine {
    /// Size of the whole machine: that of its cylinder with the longest stroke, or of its first motor if it has no cylinder.
    pub fn size(&self) -> Size {
        let stroke = |cylinder: &usize| self.cylinders[*cylinder].stroke;
        let cylinders = (0..self.cylinders.len()).filter(|&cylinder| !self.cylinders[cylinder].is_motor());
        let longest = cylinders.max_by(|a, b| stroke(a).total_cmp(&stroke(b))).unwrap_or(0);
        self.cylinder_size(longest)
    }

    /// Size of the part of the machine at `site`.
    pub fn size_at(&self, site: Site) -> Size {
        match site {
            Site::Cylinder(cylinder) => self.cylinder_size(cylinder),
            Site::PumpLine | Site::Machine => self.size(),
        }
    }

    /// Speeds are those at the pump's flow, otherwise those of the reference. An imposed motion has the time scale of the
    /// reference, because no drive of the machine sets it. A drive with a measured force has no known area, so its forces are
    /// those of the reference.
    fn cylinder_size(&self, index: usize) -> Size {
        let Some(cylinder) = self.cylinders.get(index) else { return Size::REFERENCE };
        let stroke = rounded(cylinder.stroke / REFERENCE_STROKE);
        let Some(chambers) = &cylinder.chambers else {
            return match &cylinder.imposed_motion {
                Some(motion) => {
                    let area = rounded(motion.cap_area.max(motion.rod_area) / REFERENCE_AREA);
                    Size { stroke, area, speed: stroke, lever: stroke, ..Size::REFERENCE }
                }
                None => Size { stroke, lever: stroke, ..Size::REFERENCE },
            };
        };
        let area = chambers.cap_area.max(chambers.rod_area);
        let pump_flow = match (self.supply, chambers.drive) {
            (_, Drive::Pump { full_flow }) => Some(full_flow),
            (Supply::PumpLine(line), _) => Some(line.flow),
            (Supply::PressureSource(_) | Supply::None, _) => None,
        };
        let usual_speed = if cylinder.is_motor() { MOTOR_SPEED } else { REFERENCE_SPEED };
        let speed = rounded(pump_flow.map_or(usual_speed, |flow| flow / area) / REFERENCE_SPEED);
        let size = Size {
            stroke,
            area: rounded(area / REFERENCE_AREA),
            opening: rounded(chambers.full_command() / REFERENCE_OPENING),
            speed,
            lever: stroke,
            sliding: 1.0,
        };
        if !cylinder.is_motor() {
            return size;
        }
        // A motor has no stroke: its travel is the angle at its usual speed in the reference's time.
        let lever = rounded(cylinder.linkage.lever(0.0_f64).abs() / REFERENCE_LEVER);
        Size { stroke: speed, lever, sliding: rounded(1.0 / MOTOR_RADIUS), ..size }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::document::built_in;
    use crate::machine::CommandUnit;

    #[test]
    fn machines_of_one_class_have_one_size() {
        for name in ["zx30u-arm", "zx30u"] {
            let machine = built_in(name).unwrap().machine;
            for site in [Site::Cylinder(0), Site::PumpLine, Site::Machine] {
                assert_eq!(machine.size_at(site), Size::REFERENCE, "{name} {site:?}");
            }
        }
    }

    #[test]
    fn a_machine_ten_times_smaller_is_eight_or_sixteen_times_smaller_here() {
        let mut machine = built_in("zx30u-arm").unwrap().machine;
        let cylinder = &mut machine.cylinders[0];
        cylinder.stroke *= 0.1;
        let chambers = cylinder.chambers.as_mut().unwrap();
        chambers.cap_area *= 0.01;
        chambers.rod_area *= 0.01;
        chambers.drive = Drive::Valve { full_command: 5.0, unit: CommandUnit::Volt };
        let Supply::PumpLine(line) = &mut machine.supply else { unreachable!() };
        line.flow *= 0.01;
        let size = machine.size();
        assert_eq!(size, Size { stroke: 0.125, area: 1.0 / 128.0, opening: 32768.0, lever: 0.125, ..Size::REFERENCE });
        assert_eq!(size.factor(Growth::FLOW_GAIN), 1.0 / 128.0 / 32768.0);
    }
}
