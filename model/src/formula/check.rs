//! Evaluates a law over the range of a machine before a fit, to find errors such as a wrong sign early.

use super::law::Law;
use super::variable::{Variable, VariableCard};
use crate::Model;
use crate::effects::{Effect, Number, Site};
use crate::equations::{Inputs, Rows, Situation, System};
use crate::machine::{Cylinder, Supply};
use crate::scalar::{Dual, constant, derivative, variable};

/// Result of the check of a law at one place of a machine.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Checked {
    /// Least and largest value over the range of the machine, in the unit of its row.
    pub range: [f64; 2],
    /// Problems found.
    pub problems: Vec<CheckProblem>,
    /// Fraction of the states in which the law takes energy, and in which it adds energy; none for openings, readings and laws
    /// with memory.
    pub power: Option<[f64; 2]>,
    /// Its value over each of its variables, with the others at usual values.
    pub curves: Vec<Curve>,
}

/// A problem with a law.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckProblem {
    /// Its value is not finite somewhere.
    #[error("its value is not finite where {0}")]
    NotFinite(String),
    /// Its slope is not finite somewhere.
    #[error("its slope is not finite where {0}; root(x) has a finite slope at zero, sqrt(x) has none")]
    SlopeNotFinite(String),
    /// It jumps.
    #[error("it jumps from {from:.3e} to {to:.3e} where {at}; sign, step and if are rounded, an own quotient is not")]
    Jump {
        /// Where.
        at: String,
        /// Value before.
        from: f64,
        /// Value after.
        to: f64,
    },
    /// It is zero everywhere.
    #[error("it is zero over the whole range of the machine")]
    Nothing,
}

/// A law over one of its variables.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Curve {
    /// The variable.
    pub variable: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Variable and value, from the least to the largest.
    pub points: Vec<[f64; 2]>,
}

/// Number of states evaluated.
const STATES: usize = 4000;

/// Points per curve.
const POINTS: usize = 41;

/// Lines through the range on which the check searches for jumps.
const LINES: usize = 60;

/// Points per line.
const LINE_POINTS: usize = 200;

/// Bisections between two neighbouring points of a line: 2⁻³⁰ of the range is far less than the width of any corner.
const HALVINGS: usize = 30;

/// Remaining change, as a fraction of a law's range, that counts as a jump.
const JUMP: f64 = 0.01;

/// Coordinates of a state: s, v, p_cap, p_rod, p_pump, p_tank, u, rod_force, t, each as a fraction of its range from 0 to 1, then
/// states.
const COORDINATES: usize = 10;

/// Oil temperatures of machines at work, °C.
const COLD_TO_HOT: [f64; 2] = [0.0, 80.0];

/// Checks a law as the effect `number` of `model`, with its parameter values there. `None` if that effect is not a formula.
pub fn check(model: &Model, number: usize) -> Option<Checked> {
    let effect = model.effects.get(number)?;
    let law = &Law::read(effect.physics.formula()?).ok()?;
    let parameters: Vec<f64> = effect.parameters.iter().map(|parameter| parameter.value).collect();
    let system = System::new(model);
    let (site, parameters) = (effect.site, &parameters[..]);
    let bench = Bench { law, system: &system, site, parameters };
    let mut checked =
        Checked { range: [f64::INFINITY, f64::NEG_INFINITY], problems: Vec::new(), power: None, curves: Vec::new() };
    let points: Vec<Vec<f64>> = bench.corners().chain((0..STATES).map(|number| bench.random(number))).collect();
    bench.look_at_values(&points, &mut checked);
    if checked.problems.is_empty() {
        bench.look_for_jumps(&mut checked);
    }
    if checked.range == [0.0, 0.0] {
        checked.problems.push(CheckProblem::Nothing);
    }
    if Effect::has_power(law) && !law.has_memory() {
        checked.power = Some(bench.power(&points));
    }
    checked.curves = bench.curves();
    Some(checked)
}

struct Bench<'a, 'm> {
    law: &'a Law,
    system: &'a System<'m>,
    site: Site,
    parameters: &'a [f64],
}

impl Bench<'_, '_> {
    /// Least and largest value of each coordinate.
    fn ranges(&self) -> Vec<[f64; 2]> {
        let machine = &self.system.model().machine;
        let cylinder = match self.site {
            Site::Cylinder(cylinder) => machine.cylinders.get(cylinder),
            Site::PumpLine | Site::Machine => machine.cylinders.first(),
        };
        let stroke = cylinder.map_or(1.0, Cylinder::usual_travel);
        let ends =
            cylinder.filter(|cylinder| !cylinder.is_motor()).map_or([-stroke / 2.0, stroke / 2.0], |one| one.ends);
        let chambers = cylinder.and_then(|cylinder| cylinder.chambers);
        let pressure = match machine.supply {
            Supply::PressureSource(source) => source.pressure,
            Supply::PumpLine(_) | Supply::None => USUAL_PRESSURE,
        };
        let flow = machine.supply.pump_flow();
        let speed = match chambers {
            Some(chambers) if flow > 0.0 => flow / chambers.cap_area.min(chambers.rod_area),
            _ => 2.0 * stroke,
        };
        let force = chambers.map_or(1e4, |chambers| chambers.cap_area * pressure);
        let opening = chambers.map_or(0.0, |chambers| chambers.full_command());
        let mut ranges = vec![
            ends,
            [-speed, speed],
            [0.0, pressure],
            [0.0, pressure],
            [0.0, pressure],
            [0.0, 0.05 * pressure],
            [-opening, opening],
            [-force, force],
            [0.0, 60.0],
            COLD_TO_HOT,
        ];
        ranges.extend((0..self.law.states()).map(|state| [-self.law.state_scale(state), self.law.state_scale(state)]));
        ranges
    }

    /// A point given by fractions of the ranges.
    fn point(&self, share: impl Fn(usize) -> f64) -> Vec<f64> {
        let ranges = self.ranges().into_iter().enumerate();
        ranges.map(|(number, [low, high])| low + (high - low) * share(number)).collect()
    }

    /// Points that fill the range evenly (the additive recurrence with square roots of primes).
    fn random(&self, number: usize) -> Vec<f64> {
        const PRIMES: [f64; 12] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0];
        self.point(|coordinate| ((number + 1) as f64 * PRIMES[coordinate % PRIMES.len()].sqrt()).fract())
    }

    /// The middle, where many quantities are zero, and the ends.
    fn corners(&self) -> impl Iterator<Item = Vec<f64>> {
        let (rest, low, high) = (self.rest(), self.point(|_| 0.0), self.point(|_| 1.0));
        let each = (0..rest.len()).flat_map(move |number| {
            [low[number], high[number]].map(|value| {
                let mut point = rest.clone();
                point[number] = value;
                point
            })
        });
        std::iter::once(self.rest()).chain(each)
    }

    /// Mid-stroke, at rest, without pressure.
    fn rest(&self) -> Vec<f64> {
        self.ranges().iter().map(|&[low, _]| if low < 0.0 { 0.0 } else { low }).collect()
    }

    fn situation<T: Number>(&self, point: &[T]) -> Situation<'_, T> {
        let machine = &self.system.model().machine;
        let mut state = vec![T::from(0.0); self.system.layout().len];
        let mut inputs = Inputs::zero(machine.cylinders.len());
        for number in 0..machine.cylinders.len() {
            let linkage = &machine.cylinders[number].linkage;
            // The value of the joint coordinate comes from the kinematics, its derivative from the lever.
            let joint = linkage.joint(point[0].value());
            let lever = linkage.lever(joint);
            let layout = self.system.layout();
            state[layout.joint(number)] = (point[0] - point[0].value()) / lever + joint;
            state[layout.rate(number)] = point[1] / lever;
            if let (Some(cap), Some(rod)) = (layout.cap_pressure(number), layout.rod_pressure(number)) {
                state[cap] = point[2];
                state[rod] = point[3];
            }
            inputs.orifice_area[number] = point[6];
            inputs.rod_force[number] = point[7];
            inputs.imposed[number].cap_pressure = point[2];
            inputs.imposed[number].rod_pressure = point[3];
        }
        if let Some(pump) = self.system.layout().pump {
            state[pump] = point[4];
        }
        inputs.supply_pressure = point[4];
        inputs.tank_pressure = point[5];
        inputs.time = point[8];
        inputs.oil_temperature = point[9];
        let mut workspace = self.system.workspace();
        let mut rates = state.clone();
        let parameters: Vec<T> = self.system.model().parameter_values().into_iter().map(T::from).collect();
        // Evaluates all rows, so that metering flows are known if the law needs them.
        self.system.rates(&mut workspace, &parameters, &state, &inputs, &mut rates);
        workspace.situation
    }

    fn value<T: Number>(&self, point: &[T]) -> T {
        let parameters: Vec<T> = self.parameters.iter().map(|&value| T::from(value)).collect();
        self.law.value(self.site, &parameters, &point[COORDINATES..], &self.situation(point))
    }

    fn look_at_values(&self, points: &[Vec<f64>], checked: &mut Checked) {
        let widths: Vec<f64> = self.ranges().iter().map(|[low, high]| high - low).collect();
        for point in points {
            // One derivative direction through all coordinates reveals every infinite slope.
            let moved: Vec<Dual> =
                point.iter().zip(&widths).map(|(&value, &width)| constant(value) + variable(0.0, 0) * width).collect();
            let found = self.value(&moved);
            let slope = derivative(&found, 0);
            let problem = if !found.re.is_finite() {
                Some(CheckProblem::NotFinite(self.place(point)))
            } else if !slope.is_finite() {
                Some(CheckProblem::SlopeNotFinite(self.place(point)))
            } else {
                checked.range = [checked.range[0].min(found.re), checked.range[1].max(found.re)];
                None
            };
            if let Some(problem) = problem {
                checked.problems.push(problem);
                return;
            }
        }
    }

    fn look_for_jumps(&self, checked: &mut Checked) {
        let jump = JUMP * (checked.range[1] - checked.range[0]);
        for line in 0..LINES {
            let (from, to) = (self.random(7 * line), self.random(7 * line + 3));
            let at = |share: f64| -> Vec<f64> { from.iter().zip(&to).map(|(a, b)| a + share * (b - a)).collect() };
            for step in 0..LINE_POINTS {
                let (mut low, mut high) = (step as f64, (step + 1) as f64);
                let value = |share: f64| self.value(&at(share / LINE_POINTS as f64));
                let (mut below, mut above) = (value(low), value(high));
                let mut halvings = 0;
                while (above - below).abs() > jump && halvings < HALVINGS {
                    let middle = 0.5 * (low + high);
                    let between = value(middle);
                    if (between - below).abs() > (above - between).abs() {
                        (high, above) = (middle, between);
                    } else {
                        (low, below) = (middle, between);
                    }
                    halvings += 1;
                }
                if halvings == HALVINGS {
                    let at = self.place(&at(low / LINE_POINTS as f64));
                    checked.problems.push(CheckProblem::Jump { at, from: below, to: above });
                    return;
                }
            }
        }
    }

    /// Fractions of the states in which the law takes energy, and in which it adds energy.
    fn power(&self, points: &[Vec<f64>]) -> [f64; 2] {
        let powers: Vec<f64> = points.iter().map(|point| self.power_at(point)).collect();
        let share = |wanted: fn(f64) -> bool| {
            powers.iter().filter(|&&power| wanted(power)).count() as f64 / powers.len().max(1) as f64
        };
        [share(|power| power < 0.0), share(|power| power > 0.0)]
    }

    /// Power that the law adds to pistons, joints and oil, W; flows count at their pressures.
    fn power_at(&self, point: &[f64]) -> f64 {
        let situation = self.situation(point);
        let mut rows = Rows::zero(situation.pistons.len());
        let hooks = f64::hooks(self.law);
        hooks.contribute(self.site, self.parameters, &situation, &mut rows);
        let of_pistons: f64 = situation
            .pistons
            .iter()
            .enumerate()
            .map(|(number, piston)| {
                rows.piston_force[number] * piston.velocity
                    + rows.torque[number] * piston.rate
                    + rows.cap_flow[number] * piston.cap_pressure
                    + rows.rod_flow[number] * piston.rod_pressure
            })
            .sum();
        of_pistons + rows.pump_flow * situation.pump_pressure
    }

    fn curves(&self) -> Vec<Curve> {
        let usual = self.point(|coordinate| USUAL[coordinate.min(USUAL.len() - 1)]);
        let ranges = self.ranges();
        let curve = |card: &'static VariableCard| {
            let coordinate = coordinate(card.variable)?;
            let [low, high] = ranges[coordinate];
            let points = (0..POINTS)
                .map(|step| {
                    let mut point = usual.clone();
                    point[coordinate] = low + (high - low) * step as f64 / (POINTS - 1) as f64;
                    [point[coordinate], self.value(&point)]
                })
                .collect();
            let [name, unit] = NAMES[coordinate];
            Some(Curve { variable: name, unit, points })
        };
        let mut curves: Vec<Curve> = self.law.variables().filter_map(|variable| curve(variable.card())).collect();
        curves.dedup_by(|one, other| one.variable == other.variable);
        curves
    }

    /// Formats the values of the law's variables.
    fn place(&self, point: &[f64]) -> String {
        let mut used: Vec<usize> = self.law.variables().filter_map(coordinate).collect();
        used.sort_unstable();
        used.dedup();
        let each: Vec<String> = used
            .iter()
            .map(|&number| format!("{} = {:.3e} {}", NAMES[number][0], point[number], NAMES[number][1]))
            .collect();
        if each.is_empty() { "its parameters are as given".to_string() } else { each.join(", ") }
    }
}

/// Pressure if that of the supply is unknown, usual for mobile machines, Pa.
const USUAL_PRESSURE: f64 = 2e7;

/// Values of the coordinates that a curve keeps constant, as fractions of their ranges: a piston that extends under load.
const USUAL: [f64; COORDINATES] = [0.7, 0.75, 0.4, 0.15, 0.6, 0.1, 0.75, 0.7, 0.5, 0.5];

/// Names and units of the coordinates.
const NAMES: [[&str; 2]; COORDINATES] = [
    ["s", "m"],
    ["v", "m/s"],
    ["p_cap", "Pa"],
    ["p_rod", "Pa"],
    ["p_pump", "Pa"],
    ["p_tank", "Pa"],
    ["u", "m2"],
    ["rod_force", "N"],
    ["t", "s"],
    ["temperature", "degC"],
];

/// The coordinate that sets a variable.
fn coordinate(variable: Variable) -> Option<usize> {
    match variable {
        Variable::Displacement | Variable::Joint | Variable::Lever => Some(0),
        Variable::Velocity | Variable::Rate => Some(1),
        Variable::CapPressure => Some(2),
        Variable::RodPressure => Some(3),
        Variable::PumpPressure => Some(4),
        Variable::TankPressure => Some(5),
        Variable::Opening | Variable::Command | Variable::CapFlow | Variable::RodFlow => Some(6),
        Variable::RodForce => Some(7),
        Variable::Time => Some(8),
        Variable::Temperature => Some(9),
        _ => None,
    }
}
