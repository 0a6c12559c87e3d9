//! How large a machine is: what is large for one is nothing for another.

use super::{Machine, Supply};
use crate::effects::Site;

/// How large a part of a machine is beside the arm of a 3 t excavator (`zx30u-arm`), for which limits, starts, windows of time and
/// tolerances are written down.
///
/// Machines of every size work with the same pressures and pistons of about the same speed. Lengths, areas and openings then say how
/// everything else grows. Each ratio is a power of two: machines of nearly one size are treated alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Ratio of strokes; also that of times, at the same speed.
    pub stroke: f64,
    /// Ratio of piston areas; also that of forces and flows.
    pub area: f64,
    /// Ratio of largest orifice areas, in whatever unit a model file gives them: mm², volts, or a share.
    pub opening: f64,
}

/// Powers of the three ratios of a [`Size`] with which a quantity grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Growth {
    stroke: i32,
    area: i32,
    opening: i32,
}

impl Growth {
    /// Pressures, speeds, pure numbers, and what belongs to a recording.
    pub const NONE: Growth = Growth::of(0, 0, 0);
    /// Positions and lengths, m.
    pub const LENGTH: Growth = Growth::of(1, 0, 0);
    /// Times in which a machine moves, s.
    pub const TIME: Growth = Growth::of(1, 0, 0);
    /// Orifice areas, m².
    pub const OPENING: Growth = Growth::of(0, 0, 1);
    /// Forces, N, and what is a force per speed, per square of speed, or per pressure.
    pub const FORCE: Growth = Growth::of(0, 1, 0);
    /// Flows, m³/s, and what is a flow per pressure.
    pub const FLOW: Growth = Growth::of(0, 1, 0);
    /// Flow per opening and root of pressure, m/(s sqrt(Pa)).
    pub const FLOW_GAIN: Growth = Growth::of(0, 1, -1);
    /// Pressure per square of flow, Pa s²/m⁶.
    pub const FLOW_RESISTANCE: Growth = Growth::of(0, -2, 0);
    /// Force per length, N/m.
    pub const STIFFNESS: Growth = Growth::of(-1, 1, 0);
    /// Torque per angle, N m/rad.
    pub const TORQUE: Growth = Growth::of(1, 1, 0);
    /// Force per acceleration, kg.
    pub const MASS: Growth = Growth::of(1, 1, 0);
    /// Mass times length, kg m.
    pub const MASS_MOMENT: Growth = Growth::of(2, 1, 0);
    /// Mass times square of length, kg m².
    pub const INERTIA: Growth = Growth::of(3, 1, 0);

    const fn of(stroke: i32, area: i32, opening: i32) -> Self {
        Growth { stroke, area, opening }
    }
}

impl Size {
    /// The size of the machine for which numbers are written down.
    pub const REFERENCE: Size = Size { stroke: 1.0, area: 1.0, opening: 1.0 };

    /// Of a part with this stroke (m), piston area (m²) and largest orifice area (m²).
    fn of(stroke: f64, area: f64, opening: f64) -> Self {
        let ratio = |value: f64, reference: f64| {
            let ratio = value / reference;
            if ratio.is_finite() && ratio > 0.0 { ratio.log2().round().exp2() } else { 1.0 }
        };
        Size {
            stroke: ratio(stroke, REFERENCE_STROKE),
            area: ratio(area, REFERENCE_AREA),
            opening: ratio(opening, REFERENCE_OPENING),
        }
    }

    /// The factor by which a quantity is larger than at the reference.
    pub fn factor(&self, growth: Growth) -> f64 {
        self.stroke.powi(growth.stroke) * self.area.powi(growth.area) * self.opening.powi(growth.opening)
    }

    /// The factor of times, a pure number.
    pub fn time(&self) -> f64 {
        self.factor(Growth::TIME)
    }
}

/// Stroke of the arm cylinder, m, \[A\] Table 1.
const REFERENCE_STROKE: f64 = 0.6;
/// Its piston area on the cap side, m², \[A\] Table 1.
const REFERENCE_AREA: f64 = 3.8e-3;
/// Largest orifice area of its valve section, m².
const REFERENCE_OPENING: f64 = 1.15e-4;
/// Flow of its pump, m³/s, \[A\] Table 1.
const REFERENCE_FLOW: f64 = 3.8e-4;

impl Machine {
    /// Size of the whole machine: that of its cylinder with the longest stroke.
    pub fn size(&self) -> Size {
        let longest =
            (0..self.cylinders.len()).max_by(|&a, &b| self.cylinders[a].stroke.total_cmp(&self.cylinders[b].stroke));
        longest.map_or(Size::REFERENCE, |cylinder| self.cylinder_size(cylinder))
    }

    /// Size of the part of the machine at `site`. Flows at a pump line are those of the pump.
    pub fn size_at(&self, site: Site) -> Size {
        match site {
            Site::Cylinder(cylinder) => self.cylinder_size(cylinder),
            Site::PumpLine => {
                let Supply::PumpLine(line) = self.supply else { return self.size() };
                Size { area: Size::of(1.0, line.flow / REFERENCE_FLOW * REFERENCE_AREA, 1.0).area, ..self.size() }
            }
            Site::Machine => self.size(),
        }
    }

    /// A drive whose force is measured shows no area: its forces are taken for those of the reference.
    fn cylinder_size(&self, index: usize) -> Size {
        let Some(cylinder) = self.cylinders.get(index) else { return Size::REFERENCE };
        let (area, opening) = match (&cylinder.chambers, &cylinder.imposed_motion) {
            (Some(chambers), _) => (chambers.cap_area.max(chambers.rod_area), chambers.maximum_orifice_area),
            (None, Some(motion)) => (motion.cap_area.max(motion.rod_area), REFERENCE_OPENING),
            (None, None) => (REFERENCE_AREA, REFERENCE_OPENING),
        };
        Size::of(cylinder.stroke, area, opening)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::document::built_in;

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
        chambers.maximum_orifice_area = 5.0;
        let size = machine.size();
        assert_eq!((size.stroke, size.area, size.opening), (0.125, 1.0 / 128.0, 32768.0));
        assert_eq!(size.factor(Growth::FLOW_GAIN), 1.0 / 128.0 / 32768.0);
    }
}
