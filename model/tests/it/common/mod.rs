//! What several tests need: machines, random states that a machine could be in, and drives.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

pub mod references;
pub mod scaled;

use excavator_model::Model;
use excavator_model::document::{built_in, parse_catalogue};
use excavator_model::effects::{AnyEffect, Catalogue, Site};
use excavator_model::equations::{Channel, Inputs, System};
use excavator_model::machine::{Machine, Mechanism, PressureSource, Supply};
use excavator_model::recording::Recording;
use excavator_model::template::examples;

/// Uniform random numbers that are the same on every machine (SplitMix64, Steele et al. 2014).
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Standard normal, as a sum of twelve uniforms.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

/// The arm alone with a supply pressure set from outside: the special case of a closed centre, \[B\].
pub fn closed_centre() -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    model.effects.retain(|effect| effect.site != Site::PumpLine);
    model.machine.supply = Supply::PressureSource(PressureSource { pressure: 12e6, tank_pressure: 0.0 });
    model.machine.name = "closed-centre".into();
    model
}

pub fn machines() -> Vec<Model> {
    let mut models: Vec<Model> = ["zx30u-arm", "zx30u", "zx30u-bucket", "zx30u-excavator", "servo-bench", "emps"]
        .iter()
        .map(|name| built_in(name).unwrap())
        .collect();
    models.push(closed_centre());
    models.extend(from_templates());
    models
}

/// Machines from data sheets, those whose valves take an orifice area: inputs of tests are areas.
pub fn from_templates() -> Vec<Model> {
    let wanted = ["pump-driven", "pump-driven-double-rod", "motor", "load-sensing", "single-acting"];
    let models = examples().into_iter().filter(|model| wanted.contains(&&*model.machine.name)).collect::<Vec<_>>();
    assert_eq!(models.len(), wanted.len());
    models
}

/// The built-in effects, and formula effects: built-in ones written as formulas, and laws that no catalogue has.
pub fn catalogue() -> Catalogue {
    parse_catalogue("own-effects.toml", include_str!("../../data/own-effects.toml"), &Catalogue::built_in()).unwrap()
}

/// One model for each effect of the catalogue at each place of each machine where it can act, with the index of that
/// effect in the model: effects that a machine has as they are there, the others added.
pub fn every_effect_everywhere() -> Vec<(Model, usize)> {
    let mut cases = Vec::new();
    for machine in machines() {
        for physics in &catalogue() {
            for (index, _) in machine.effects.iter().enumerate().filter(|(_, e)| e.name() == physics.card().name) {
                cases.push((machine.clone(), index));
            }
            for site in machine.free_sites(physics) {
                let model = with_typical(&machine, physics, site);
                let added = model.effects.len() - 1;
                cases.push((model, added));
            }
        }
    }
    cases
}

/// Random numbers of one case, the same whatever other cases there are: another effect in the catalogue must not decide
/// whether a test of this one visits what it needs.
pub fn random_for(seed: u64, model: &Model, effect: usize) -> Random {
    let letters =
        label(model, effect).bytes().fold(seed, |sum, letter| sum.wrapping_mul(31).wrapping_add(letter.into()));
    Random(letters)
}

/// The model with one more effect, as strong as is typical, so that no test is about an effect of size zero.
pub fn with_typical(model: &Model, physics: &AnyEffect, site: Site) -> Model {
    let mut model = model.with_effect(physics, site).unwrap();
    for parameter in &mut model.effects.last_mut().unwrap().parameters {
        parameter.value = match &*parameter.card.name {
            // Within the second or less that tests simulate.
            "contact_start" | "payload_start" => 0.1,
            "contact_duration" | "payload_duration" => 0.3,
            _ => parameter.card.typical,
        };
    }
    model
}

pub fn label(model: &Model, effect: usize) -> String {
    let site = model.effects[effect].site;
    format!("{} {}@{site:?}", model.machine.name, model.effects[effect].name())
}

/// Parameter values within 30 % of the model's; none zero.
pub fn random_parameters(model: &Model, random: &mut Random) -> Vec<f64> {
    let chain =
        matches!(&model.machine.mechanism, Mechanism::PlanarChain { link_lengths, .. } if link_lengths.len() > 1);
    model
        .parameters()
        .map(|(_, parameter)| {
            let value = if parameter.value == 0.0 { parameter.card.typical } else { parameter.value };
            // Moments of three links in wild proportions are those of no masses at all: the mass matrix turns singular.
            let bound = chain && ["inertia", "coupling_moment"].contains(&&*parameter.card.name);
            let varied = value * if bound { random.between(0.97, 1.03) } else { random.between(0.7, 1.3) };
            // No check valve is tighter than tight.
            varied.min(parameter.card.maximum)
        })
        .collect()
}

/// A state inside and slightly beyond everything the machine can do: end stops and vapour pressure are touched.
pub fn random_state(system: &System<'_>, random: &mut Random) -> Vec<f64> {
    let layout = system.layout();
    let mut state = vec![0.0; layout.len];
    for (index, cylinder) in system.model().machine.cylinders.iter().enumerate() {
        let reach = cylinder.usual_travel() / 2.0 + 1e-3;
        let sides = [-reach, -reach + 2e-3, reach - 2e-3, reach];
        let displacement = match random.between(0.0, 4.0) as usize {
            0 => random.between(sides[0], sides[1]),
            1 => random.between(sides[2], sides[3]),
            _ => random.between(sides[1], sides[2]),
        };
        state[layout.joint(index)] = cylinder.linkage.joint(displacement);
        let speed = if random.unit() < 0.3 { 2e-3 } else { 0.5 };
        state[layout.rate(index)] = random.between(-speed, speed);
        if let (Some(cap), Some(rod)) = (layout.cap_pressure(index), layout.rod_pressure(index)) {
            state[cap] = random_pressure(random);
            state[rod] = random_pressure(random);
        }
    }
    if let Some(pump) = layout.pump {
        state[pump] = random_pressure(random);
    }
    for (index, scale) in system.state_scales() {
        state[index] = random.between(-scale, scale);
    }
    state
}

fn random_pressure(random: &mut Random) -> f64 {
    match random.between(0.0, 4.0) as usize {
        0 => random.between(-9.8e4, 1e4),
        1 => random.between(5e6, 2e7),
        _ => random.between(0.0, 5e6),
    }
}

pub fn random_inputs(machine: &Machine, random: &mut Random) -> Inputs<f64> {
    let mut inputs = Inputs::zero(machine.cylinders.len());
    for area in &mut inputs.orifice_area {
        *area = random.between(-1.14e-4, 1.14e-4);
    }
    for (rates, area) in inputs.orifice_rates.iter_mut().zip(&inputs.orifice_area) {
        // As of an opening that turns about where it is.
        *rates = [100.0 * area, -60.0 * area];
    }
    for force in &mut inputs.rod_force {
        *force = random.between(-100.0, 100.0);
    }
    inputs.time = random.between(0.0, 0.5);
    inputs.supply_pressure = random.between(0.0, 7e6);
    inputs.tank_pressure = random.between(0.0, 2e5);
    inputs.pump_flow = random.between(1e-4, 5e-4);
    // From what has been drawn, so that states of machines without a temperature stay the same.
    inputs.oil_temperature = Random(inputs.supply_pressure.to_bits()).between(-10.0, 90.0);
    inputs
}

/// A recording with nothing but inputs: `area` gives the opening of a cylinder's valve (m²) at a time (s), `force` the
/// force on its rod (N); the closed-centre supply is at 5 MPa.
pub fn driven(
    model: &Model,
    duration: f64,
    interval: f64,
    area: impl Fn(usize, f64) -> f64,
    force: impl Fn(f64) -> f64,
) -> Recording {
    let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    let samples = (duration / interval).round() as usize;
    let time: Vec<f64> = (0..=samples).map(|index| index as f64 * interval).collect();
    let mut recording = Recording::unmeasured("drive", time.clone(), &names);
    for (number, cylinder) in recording.cylinders.iter_mut().enumerate() {
        cylinder.orifice_area = time.iter().map(|&t| area(number, t)).collect();
        cylinder.rod_force = time.iter().map(|&t| force(t)).collect();
    }
    recording.pump_pressure = vec![5e6; time.len()];
    recording.oil_temperature = vec![55.0; time.len()];
    recording
}

/// At rest at mid-stroke with chamber pressures that carry the load: 1 MPa on the rod side, the cap side to match.
pub fn at_rest(system: &System<'_>) -> Vec<f64> {
    let model = system.model();
    let layout = system.layout();
    let mut state = vec![0.0; layout.len];
    for (index, cylinder) in model.machine.cylinders.iter().enumerate() {
        state[layout.joint(index)] = cylinder.linkage.joint(0.0);
    }
    let mut workspace = system.workspace();
    let mut rates = vec![0.0; layout.len];
    let inputs = Inputs::zero(layout.joints);
    system.rates(&mut workspace, &model.parameter_values(), &state, &inputs, &mut rates);
    for (index, cylinder) in model.machine.cylinders.iter().enumerate() {
        let (Some(cap), Some(rod)) = (layout.cap_pressure(index), layout.rod_pressure(index)) else { continue };
        let chambers = cylinder.chambers.unwrap();
        let force = -workspace.rows.torque[index] / workspace.situation.pistons[index].lever;
        // Cap and rod pressure raised together until both are at least 1 MPa.
        let at_one = (1e6 * chambers.rod_area + force) / chambers.cap_area;
        let raised = (1e6 - at_one).max(0.0);
        state[cap] = at_one + raised;
        state[rod] = 1e6 + raised * chambers.cap_area / chambers.rod_area;
    }
    if let Some(pump) = layout.pump {
        state[pump] = 1e6;
    }
    state
}

/// A page of the contract, or `None` with a line that says so where it is not at hand.
pub fn contract(page: &str) -> Option<String> {
    let shared = std::env::var_os("EXCAVATOR_SHARED").map_or_else(
        || std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        std::path::PathBuf::from,
    );
    let path = shared.join("contract").join(page);
    let text = std::fs::read_to_string(&path).ok();
    if text.is_none() {
        eprintln!("skipped: {} cannot be read (set EXCAVATOR_SHARED to the folder of shared files)", path.display());
    }
    text
}

/// A manoeuvre that visits what effects need to show: both ends of the stroke, reversals, holds, low pump pressure.
pub fn tour(model: &Model) -> Recording {
    let area = |number: usize, t: f64| match t {
        t if t < 8.0 => 9e-5 * (std::f64::consts::TAU * 0.5 * t + 0.4 * number as f64).sin(),
        t if t < 12.0 => 1.1e-4,
        t if t < 13.0 => 0.0,
        t if t < 19.0 => -1.1e-4,
        _ => 4e-5,
    };
    let force = |t: f64| match t {
        // Slow reversals, for what shows near standstill only.
        t if t < 8.0 => 25.0 * (std::f64::consts::TAU * 0.5 * t).sin(),
        t if t < 13.0 => 60.0,
        _ => -60.0,
    };
    driven(model, 20.0, 2e-3, area, force)
}

/// Noise of a good instrument of a channel, in its unit.
pub fn good_noise(channel: Channel) -> f64 {
    match channel {
        Channel::JointAngle(_) | Channel::Displacement(_) => 5e-5,
        Channel::Velocity(_) => 1e-3,
        Channel::CapPressure(_) | Channel::RodPressure(_) | Channel::PumpPressure => 2e3,
        Channel::RodForce(_) => 1.0,
    }
}

/// Does something to each item, on every core.
pub fn each<Item: Send>(items: impl IntoIterator<Item = Item>, work: impl Fn(Item) + Sync) {
    let items: Vec<Item> = items.into_iter().collect();
    let waiting = std::sync::Mutex::new(items.into_iter());
    // Not in the condition of the loop, which would hold the lock while the item is worked on.
    let next = || waiting.lock().unwrap().next();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(item) = next() {
                    work(item);
                }
            });
        }
    });
}
