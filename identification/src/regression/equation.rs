//! Samples the terms of each equation of motion, with derivatives by the parameters.

use excavator_model::Model;
use excavator_model::equations::{Inputs, Rows, System, Workspace};
use excavator_model::machine::Supply;
use excavator_model::scalar::{DIRECTIONS, Dual, constant, derivative, variable};
use rayon::prelude::*;

use super::Observation;

/// Which equation of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum EquationKind {
    /// Torque balance of a joint.
    Motion(usize),
    /// Continuity of a cap side chamber.
    CapContinuity(usize),
    /// Continuity of a rod side chamber.
    RodContinuity(usize),
    /// Continuity of the pump line.
    PumpContinuity,
}

impl EquationKind {
    /// Name for people and JSON: `arm.motion`, `arm.cap_continuity`, `pump.continuity`.
    pub fn name(&self, model: &Model) -> String {
        let cylinder = |index: usize| model.machine.cylinders.get(index).map_or("?", |c| c.name.as_str());
        match *self {
            EquationKind::Motion(index) => format!("{}.motion", cylinder(index)),
            EquationKind::CapContinuity(index) => format!("{}.cap_continuity", cylinder(index)),
            EquationKind::RodContinuity(index) => format!("{}.rod_continuity", cylinder(index)),
            EquationKind::PumpContinuity => "pump.continuity".to_string(),
        }
    }
}

/// Storage times a derivative of a measured quantity.
#[derive(Debug, Clone)]
pub struct Term {
    /// Order of the derivative, 1 or 2.
    pub order: usize,
    /// The sensor whose noise the quantity carries; [`Sensor::Velocity`] for the position of a joint or a piston.
    pub sensor: Sensor,
    /// The quantity at each sample, as measured.
    pub quantity: Vec<f64>,
    /// Storage c at each sample.
    pub storage: Vec<f64>,
    /// Its derivative by each fitted parameter; empty if it is zero throughout.
    pub by_parameter: Vec<Vec<f64>>,
}

/// One equation: `sum of terms = rest`.
#[derive(Debug, Clone)]
pub struct Equation {
    /// Which one.
    pub kind: EquationKind,
    /// Storage terms.
    pub terms: Vec<Term>,
    /// Forces (torques) or flows at each sample.
    pub rest: Vec<f64>,
    /// Their derivative by each fitted parameter; empty if it is zero throughout.
    pub rest_by_parameter: Vec<Vec<f64>>,
    /// Their derivative by each sensor's reading, in the order of [`Sensor::all`]. Noise enters through it.
    pub rest_by_sensor: Vec<Vec<f64>>,
}

/// A sensor whose reading enters an equation's forces or flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    /// Velocity of a cylinder's piston, from its displacement sensor.
    Velocity(usize),
    /// Cap side pressure.
    CapPressure(usize),
    /// Rod side pressure.
    RodPressure(usize),
    /// Spool opening.
    Spool(usize),
    /// Pump pressure.
    PumpPressure,
}

impl Sensor {
    /// All sensors of a machine with `cylinders` cylinders, in a fixed order.
    pub fn all(cylinders: usize) -> Vec<Sensor> {
        let of_cylinder = |c| [Sensor::Velocity(c), Sensor::CapPressure(c), Sensor::RodPressure(c), Sensor::Spool(c)];
        (0..cylinders).flat_map(of_cylinder).chain([Sensor::PumpPressure]).collect()
    }
}

/// A quantity of [`Rows`] at all samples, with its derivatives in the directions of one or more passes.
struct Track {
    value: Vec<f64>,
    /// Empty if the derivative is zero throughout.
    slopes: Vec<Vec<f64>>,
}

impl Track {
    fn new(samples: usize, directions: usize) -> Self {
        Track { value: vec![f64::NAN; samples], slopes: vec![Vec::new(); directions] }
    }

    fn set(&mut self, sample: usize, number: &Dual) {
        self.value[sample] = number.re;
        for (direction, column) in self.slopes.iter_mut().enumerate() {
            let slope = derivative(number, direction);
            if column.is_empty() {
                if slope == 0.0 {
                    continue;
                }
                column.resize(self.value.len(), 0.0);
            }
            column[sample] = slope;
        }
    }
}

/// All quantities of [`Rows`].
struct Tracks {
    mass: Vec<Track>,
    torque: Vec<Track>,
    flows: Vec<[Track; 2]>,
    compliances: Vec<[Track; 2]>,
    pump_flow: Track,
    pump_compliance: Track,
}

impl Tracks {
    fn new(joints: usize, samples: usize, directions: usize) -> Self {
        let track = || Track::new(samples, directions);
        Tracks {
            mass: (0..joints * joints).map(|_| track()).collect(),
            torque: (0..joints).map(|_| track()).collect(),
            flows: (0..joints).map(|_| [track(), track()]).collect(),
            compliances: (0..joints).map(|_| [track(), track()]).collect(),
            pump_flow: track(),
            pump_compliance: track(),
        }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut Track> {
        let sides = self.flows.iter_mut().chain(&mut self.compliances).flatten();
        let lines = [&mut self.pump_flow, &mut self.pump_compliance];
        self.mass.iter_mut().chain(&mut self.torque).chain(sides).chain(lines)
    }

    /// Appends the derivatives of a later pass.
    fn merged(mut self, mut later: Tracks) -> Self {
        for (own, other) in self.each().zip(later.each()) {
            own.slopes.append(&mut other.slopes);
        }
        self
    }

    /// The quantities along an observation, with the derivatives in the directions from `first` up to `last`: by the
    /// parameters with indices `fitted`, then by each sensor's reading.
    fn along(
        system: &System<'_>,
        observation: &Observation,
        effect_states: &[Vec<f64>],
        fitted: &[usize],
        sensors: &[Sensor],
        (first, last): (usize, usize),
    ) -> Self {
        let (model, layout) = (system.model(), system.layout());
        let (joints, samples) = (layout.joints, observation.time.len());
        let mut tracks = Tracks::new(joints, samples, last - first);
        let values = model.parameter_values();
        let mut parameters: Vec<Dual> = values.iter().map(|&value| constant(value)).collect();
        for number in first..last.min(fitted.len()) {
            parameters[fitted[number]] = variable(values[fitted[number]], number - first);
        }
        let mut workspace = system.workspace::<Dual>();
        let (mut plain_inputs, mut inputs) = (Inputs::<f64>::zero(joints), Inputs::<Dual>::zero(joints));
        let mut state = vec![constant(0.0); layout.len];
        let mut rates = vec![constant(0.0); layout.len];
        for sample in 0..samples {
            observation.inputs.between(sample, 0.0, &mut plain_inputs);
            inputs.lift_from(&plain_inputs);
            observation.set_state(system, sample, effect_states.get(sample), &mut state);
            for number in first.max(fitted.len())..last {
                let direction = number - first;
                let vary = |number: &mut Dual| *number = variable(number.re, direction);
                match sensors[number - fitted.len()] {
                    Sensor::Velocity(c) => vary(&mut state[layout.rate(c)]),
                    Sensor::CapPressure(c) => layout.cap_pressure(c).into_iter().for_each(|i| vary(&mut state[i])),
                    Sensor::RodPressure(c) => layout.rod_pressure(c).into_iter().for_each(|i| vary(&mut state[i])),
                    Sensor::Spool(c) => vary(&mut inputs.orifice_area[c]),
                    Sensor::PumpPressure => layout.pump.into_iter().for_each(|i| vary(&mut state[i])),
                }
            }
            system.rates(&mut workspace, &parameters, &state, &inputs, &mut rates);
            tracks.set(sample, &workspace, layout.chambers);
        }
        tracks
    }

    fn set(&mut self, sample: usize, workspace: &Workspace<'_, Dual>, chambers: bool) {
        let rows: &Rows<Dual> = &workspace.rows;
        for (slot, number) in self.mass.iter_mut().zip(&rows.mass) {
            slot.set(sample, number);
        }
        for index in 0..self.torque.len() {
            self.torque[index].set(sample, &rows.driven_torque(index, &workspace.situation));
            if chambers {
                self.flows[index][0].set(sample, &rows.cap_flow[index]);
                self.flows[index][1].set(sample, &rows.rod_flow[index]);
                self.compliances[index][0].set(sample, &rows.cap_compliance[index]);
                self.compliances[index][1].set(sample, &rows.rod_compliance[index]);
            }
        }
        self.pump_flow.set(sample, &rows.pump_flow);
        self.pump_compliance.set(sample, &rows.pump_line_compliance());
    }
}

/// All equations of a model along an observation, with derivatives by the parameters with indices `fitted`. States of
/// effects (a lagging spool) are taken from `effect_states`, sample by sample. Equations are `NaN` at samples where a
/// signal that they need is not measured.
pub fn equations(
    system: &System<'_>,
    observation: &Observation,
    effect_states: &[Vec<f64>],
    fitted: &[usize],
) -> Vec<Equation> {
    let sensors = Sensor::all(system.layout().joints);
    equations_by(system, observation, effect_states, fitted, &sensors)
}

/// Like [`equations`], with derivatives by the readings of these sensors only.
pub(super) fn equations_by(
    system: &System<'_>,
    observation: &Observation,
    effect_states: &[Vec<f64>],
    fitted: &[usize],
    sensors: &[Sensor],
) -> Vec<Equation> {
    let model = system.model();
    let layout = system.layout();
    let (joints, samples) = (layout.joints, observation.time.len());
    let directions = fitted.len() + sensors.len();
    // The values need a pass even without directions.
    let passes: Vec<(usize, usize)> =
        (0..directions.max(1)).step_by(DIRECTIONS).map(|first| (first, (first + DIRECTIONS).min(directions))).collect();
    let tracks = passes
        .into_par_iter()
        .map(|pass| Tracks::along(system, observation, effect_states, fitted, sensors, pass))
        .reduce_with(Tracks::merged)
        .unwrap_or_else(|| Tracks::new(joints, samples, 0));
    let Tracks { mass, torque, flows, compliances, pump_flow, pump_compliance } = tracks;
    let parts = Parts { model, observation, fitted: fitted.len(), sensors };
    let mut equations = parts.motion(mass, torque);
    equations.extend(parts.chambers(flows, compliances));
    if matches!(model.machine.supply, Supply::PumpLine(_)) {
        equations.push(parts.pump_line(pump_flow, pump_compliance));
    }
    equations
}

/// What turns tracks into equations.
struct Parts<'p> {
    model: &'p Model,
    observation: &'p Observation,
    /// Number of fitted parameters, whose derivatives come first in a track.
    fitted: usize,
    sensors: &'p [Sensor],
}

impl Parts<'_> {
    /// Torque balance of each joint: row of the mass matrix times accelerations = torque.
    fn motion(&self, mass: Vec<Track>, torque: Vec<Track>) -> Vec<Equation> {
        let (joints, mut mass) = (torque.len(), mass.into_iter());
        let equation = |(index, torque): (usize, Track)| {
            let row = mass.by_ref().take(joints).enumerate();
            let term = |(other, track): (usize, Track)| Term {
                order: 2,
                sensor: Sensor::Velocity(other),
                quantity: self.observation.cylinders[other].joint.clone(),
                by_parameter: self.by_parameter(&track),
                storage: track.value,
            };
            let terms = row.map(term).collect();
            self.equation(EquationKind::Motion(index), terms, torque)
        };
        torque.into_iter().enumerate().map(equation).collect()
    }

    /// Continuity of both chambers of each cylinder: area times velocity + compliance times pressure rate = flow.
    fn chambers(&self, flows: Vec<[Track; 2]>, compliances: Vec<[Track; 2]>) -> Vec<Equation> {
        let mut equations = Vec::new();
        for (index, (flows, compliances)) in flows.into_iter().zip(compliances).enumerate() {
            let Some(constants) = self.model.machine.cylinders[index].chambers else { continue };
            let cylinder = &self.observation.cylinders[index];
            let sides = [
                (EquationKind::CapContinuity(index), constants.cap_area, Sensor::CapPressure(index)),
                (EquationKind::RodContinuity(index), -constants.rod_area, Sensor::RodPressure(index)),
            ];
            let tracks = flows.into_iter().zip(compliances).zip(&cylinder.pressures);
            for ((kind, area, sensor), ((flow, compliance), pressure)) in sides.into_iter().zip(tracks) {
                let displaced = Term {
                    order: 1,
                    sensor: Sensor::Velocity(index),
                    quantity: cylinder.displacement.clone(),
                    storage: vec![area; self.observation.time.len()],
                    by_parameter: vec![Vec::new(); self.fitted],
                };
                equations.push(self.equation(
                    kind,
                    vec![displaced, self.compressed(sensor, pressure, compliance)],
                    flow,
                ));
            }
        }
        equations
    }

    /// Continuity of the pump line: compliance times pressure rate = flow.
    fn pump_line(&self, flow: Track, compliance: Track) -> Equation {
        let term = self.compressed(Sensor::PumpPressure, &self.observation.pump_pressure, compliance);
        self.equation(EquationKind::PumpContinuity, vec![term], flow)
    }

    fn compressed(&self, sensor: Sensor, pressure: &[f64], compliance: Track) -> Term {
        let by_parameter = self.by_parameter(&compliance);
        Term { order: 1, sensor, quantity: pressure.to_vec(), storage: compliance.value, by_parameter }
    }

    fn by_parameter(&self, track: &Track) -> Vec<Vec<f64>> {
        track.slopes[..self.fitted].to_vec()
    }

    /// An equation whose forces or flows are `rest`.
    fn equation(&self, kind: EquationKind, terms: Vec<Term>, mut rest: Track) -> Equation {
        let mut rest_by_sensor = rest.slopes.split_off(self.fitted);
        for (sensor, column) in self.sensors.iter().zip(&mut rest_by_sensor) {
            if let Sensor::Velocity(c) = *sensor
                && !column.is_empty()
            {
                // From joint rate to piston velocity.
                let linkage = &self.model.machine.cylinders[c].linkage;
                for (slope, &s) in column.iter_mut().zip(&self.observation.cylinders[c].smooth_displacement) {
                    *slope /= linkage.lever(linkage.joint(s));
                }
            }
        }
        Equation { kind, terms, rest: rest.value, rest_by_parameter: rest.slopes, rest_by_sensor }
    }
}
