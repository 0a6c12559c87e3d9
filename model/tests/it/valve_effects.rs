//! What effects of the valve and of the bypass do to the flow.

use crate::common;
use crate::common::Random;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{ActsOn, Card, Catalogue, Family, Number, Site};
use excavator_model::equations::{Inputs, Rows, Situation, System, Warmth};
use excavator_model::machine::Size;
use excavator_model::simulation::{InputSignals, Integrator, Tolerances};

const CYLINDER: Site = Site::Cylinder(0);

fn arm_with(effect: &str, site: Site, values: &[f64]) -> Model {
    let mut model =
        built_in("zx30u-arm").unwrap().with_effect(&Catalogue::built_in().find(effect).unwrap(), site).unwrap();
    for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
        parameter.value = *value;
    }
    model
}

/// The arm with one parameter of its own scaled.
fn arm_with_scaled(name: &str, factor: f64) -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    let index = model.parameter_names().iter().position(|candidate| candidate == name).unwrap();
    model.parameters_mut().nth(index).unwrap().value *= factor;
    model
}

fn rows(model: &Model, state: &[f64], inputs: &Inputs<f64>) -> Rows<f64> {
    let system = System::new(model);
    let mut workspace = system.workspace();
    system.rates(&mut workspace, &model.parameter_values(), state, inputs, &mut vec![0.0; system.layout().len]);
    workspace.rows
}

fn assert_same_flows(found: &Rows<f64>, wanted: &Rows<f64>) {
    let flows = |rows: &Rows<f64>| [rows.cap_flow[0], rows.rod_flow[0], rows.pump_flow];
    for (found, wanted) in flows(found).into_iter().zip(flows(wanted)) {
        assert!((found - wanted).abs() <= 1e-12 * (found.abs() + wanted.abs()), "{found} is not {wanted}");
    }
}

/// Random states and inputs of the arm, one after the other.
fn situations(seed: u64) -> impl Iterator<Item = (Vec<f64>, Inputs<f64>)> {
    let mut random = Random(seed);
    (0..50).map(move |_| {
        let model = built_in("zx30u-arm").unwrap();
        let state = common::random_state(&System::new(&model), &mut random);
        (state, common::random_inputs(&model.machine, &mut random))
    })
}

/// A change of the gain for u < 0 is a valve of other gains there, and the nominal valve for u > 0.
#[test]
fn directional_gains_are_other_gains_for_retraction() {
    let nominal = built_in("zx30u-arm").unwrap();
    let gain = |name: &str| nominal.value_of(name).unwrap();
    let (cap, rod) = (0.3 * gain("arm.flow_gain_cap"), 0.3 * gain("arm.flow_gain_rod"));
    for (state, mut inputs) in situations(21) {
        inputs.orifice_area[0] = inputs.orifice_area[0].abs();
        let changed = arm_with("valve_directional_gain", CYLINDER, &[cap, rod]);
        assert_same_flows(&rows(&changed, &state, &inputs), &rows(&nominal, &state, &inputs));
        inputs.orifice_area[0] *= -1.0;
        let changed = rows(&arm_with("valve_directional_gain", CYLINDER, &[cap, 0.0]), &state, &inputs);
        assert_same_flows(&changed, &rows(&arm_with_scaled("arm.flow_gain_cap", 1.3), &state, &inputs));
        let changed = rows(&arm_with("valve_directional_gain", CYLINDER, &[0.0, rod]), &state, &inputs);
        assert_same_flows(&changed, &rows(&arm_with_scaled("arm.flow_gain_rod", 1.3), &state, &inputs));
    }
}

/// Over a small drop x the edges pass `x / (x² + d²)^(1/4)`, d what is told.
#[test]
fn edges_turn_turbulent_where_they_are_told() {
    let nominal = built_in("zx30u-arm").unwrap();
    let later = arm_with("orifice_transition", CYLINDER, &[5e4]);
    let gain = nominal.value_of("arm.flow_gain_rod").unwrap();
    for (mut state, mut inputs) in situations(23) {
        inputs.orifice_area[0] = inputs.orifice_area[0].abs();
        for drop in [-1e5, -3e3, 0.0, 500.0, 2e4, 1e6_f64] {
            state[3] = inputs.tank_pressure + drop;
            let [before, after] = [&nominal, &later].map(|model| rows(model, &state, &inputs).rod_flow[0]);
            let root = |transition: f64| drop / drop.hypot(transition).sqrt();
            let wanted = -gain * inputs.orifice_area[0] * (root(5e4) - root(2e3));
            assert!((after - before - wanted).abs() < 1e-9 * (gain * inputs.orifice_area[0] * 1e3), "{drop} Pa");
        }
    }
}

/// Of the pressure drop the hose takes R q² and the edge what it takes for this flow alone.
#[test]
fn hose_and_edge_share_the_pressure_drop() {
    const RESISTANCE: f64 = 1.5e12;
    let nominal = built_in("zx30u-arm").unwrap();
    let hose = arm_with("hose_pressure_loss", CYLINDER, &[RESISTANCE]);
    let pump = System::new(&nominal).layout().pump.unwrap();
    for (mut state, mut inputs) in situations(22) {
        // Drops above what is smoothed about zero.
        (state[2], state[3], state[pump], inputs.tank_pressure) = (4e6, 3e6, 7e6, 1e5);
        let area = inputs.orifice_area[0];
        let mut through = |model: &Model, area: f64| {
            inputs.orifice_area[0] = area;
            let all = rows(model, &state, &inputs);
            inputs.orifice_area[0] = 0.0;
            let leaks = rows(model, &state, &inputs);
            [all.cap_flow[0] - leaks.cap_flow[0], all.rod_flow[0] - leaks.rod_flow[0]]
        };
        let (edges, with_hose) = (through(&nominal, area), through(&hose, area));
        let drops = if area > 0.0 { [7e6 - 4e6, 3e6 - 1e5] } else { [4e6 - 1e5, 7e6 - 3e6] };
        for ((edge, both), drop) in edges.into_iter().zip(with_hose).zip(drops) {
            let taken = RESISTANCE * both * both + drop * (both / edge).powi(2);
            assert!((taken / drop - 1.0).abs() < 1e-6 && both * edge > 0.0, "{taken} of {drop} Pa at {area} m2");
        }
    }
}

/// At half opening the area is 1 + c1/2 + c2/4 times as large; the bypass does not know of it.
#[test]
fn a_gain_curve_bends_the_opening_but_not_the_bypass() {
    let model = arm_with("valve_gain_curve", CYLINDER, &[0.4, -0.2]);
    let maximum = model.machine.cylinders[0].chambers.unwrap().full_command();
    let system = System::new(&model);
    let mut workspace = system.workspace();
    for (state, mut inputs) in situations(22).take(3) {
        for side in [0.5, -0.5] {
            inputs.orifice_area[0] = side * maximum;
            system.observe(&mut workspace, &model.parameter_values(), &state, &inputs, &mut [0.0; 5]);
            let piston = &workspace.situation.pistons[0];
            assert!((piston.opening - side * maximum * 1.15).abs() < 1e-18, "{}", piston.opening);
            assert_eq!(piston.bypass_closing, 0.5 * maximum);
        }
    }
}

/// \[B\] Eq. 9 with its travel ending at 0.9: at half opening a quarter of sqrt((1 - 0.9^4)/(1 - 0.45^4)), at full opening as before.
#[test]
fn an_area_law_is_quadratic_and_leaves_the_full_opening() {
    let model = arm_with("valve_area_law", CYLINDER, &[1.0]);
    let maximum = model.machine.cylinders[0].chambers.unwrap().full_command();
    let system = System::new(&model);
    let mut workspace = system.workspace();
    let half = 0.25 * ((1.0 - 0.9_f64.powi(4)) / (1.0 - 0.45_f64.powi(4))).sqrt();
    for (state, mut inputs) in situations(22).take(3) {
        for (travel, area) in [(0.5, half), (-0.5, -half), (1.0, 1.0), (-1.0, -1.0)] {
            inputs.orifice_area[0] = travel * maximum;
            system.observe(&mut workspace, &model.parameter_values(), &state, &inputs, &mut [0.0; 5]);
            let opening = workspace.situation.pistons[0].opening / maximum;
            assert!((opening - area).abs() < 1e-12, "{travel}: {opening} for {area}");
        }
    }
}

/// At half opening an edge with a curve passes what it passes with a gain that is a/2 + b/4 larger.
#[test]
fn every_edge_has_a_curve_of_its_own() {
    let nominal = built_in("zx30u-arm").unwrap();
    let maximum = nominal.machine.cylinders[0].chambers.unwrap().full_command();
    let edges = [("flow_gain_cap", 0.5), ("flow_gain_rod", 0.5), ("flow_gain_cap", -0.5), ("flow_gain_rod", -0.5)];
    for (edge, (gain, side)) in edges.into_iter().enumerate() {
        let mut values = [0.0; 8];
        values[2 * edge..2 * edge + 2].copy_from_slice(&[1e-3, -4e-4]);
        let curved = arm_with("valve_edge_curves", CYLINDER, &values);
        let name = format!("arm.{gain}");
        let wider = arm_with_scaled(&name, 1.0 + 4e-4 / nominal.value_of(&name).unwrap());
        for (state, mut inputs) in situations(22) {
            inputs.orifice_area[0] = side * maximum;
            assert_same_flows(&rows(&curved, &state, &inputs), &rows(&wider, &state, &inputs));
            inputs.orifice_area[0] = -side * maximum;
            assert_same_flows(&rows(&curved, &state, &inputs), &rows(&nominal, &state, &inputs));
        }
    }
}

/// Within the overlap the bypass is fully open; beyond it loses what a nominal one loses that much earlier.
#[test]
fn an_overlapped_bypass_closes_later() {
    let nominal = built_in("zx30u-arm").unwrap();
    let overlapped = arm_with("bypass_overlap", Site::PumpLine, &[2e-5]);
    let through_bypass = |model: &Model, state: &[f64], area: f64| {
        let mut model = model.clone();
        model.effects.retain(|effect| effect.name() != "orifice_flow");
        let mut inputs = Inputs::zero(1);
        inputs.orifice_area[0] = area;
        rows(&model, state, &inputs).pump_flow
    };
    for (state, _) in situations(23) {
        let open = through_bypass(&nominal, &state, 0.0);
        for area in [0.0, 1e-5, -2e-5] {
            assert_eq!(through_bypass(&overlapped, &state, area), open);
        }
        for area in [3e-5, 9e-5] {
            let (found, wanted) =
                (through_bypass(&overlapped, &state, -area), through_bypass(&nominal, &state, area - 2e-5));
            assert!((found - wanted).abs() <= 1e-12 * wanted.abs(), "{found} {wanted}");
        }
    }
}

fn has_a_say(card: &Card) -> bool {
    matches!(card.acts_on, ActsOn::Valve | ActsOn::PumpLine) || card.family == Family::Rounding
}

/// Spools, openings and what else is adjusted are asked of effects of valves and of the pump line alone, and of those that round a
/// corner: no other effect may have something to say there that nobody hears. What the temperature does is asked of all.
#[test]
fn only_valves_and_pump_line_have_a_say_in_the_way_of_oil() {
    for model in common::machines() {
        for effect in Catalogue::built_in().iter().filter(|effect| !has_a_say(effect.card())) {
            let name = &effect.card().name;
            let places = (0..model.machine.cylinders.len()).map(Site::Cylinder);
            for site in places.chain([Site::PumpLine, Site::Machine]) {
                let typical: Vec<f64> =
                    effect.parameters(&model.machine, site).iter().map(|parameter| parameter.typical).collect();
                assert_eq!(effect.states(), 0, "{name}");
                let hooks = <f64 as Number>::hooks(&**effect);
                assert_eq!(hooks.spool(&Size::REFERENCE, &typical, &[], &mut [], 3e-5), [3e-5, 3e-5], "{name}");
                let mut situation = Situation::<f64>::empty(&model.machine);
                assert_eq!(hooks.opening(site, &typical, 3e-5, &situation), 3e-5, "{name}");
                hooks.adjust(site, &typical, &mut situation);
                situation.pistons.iter_mut().for_each(|piston| piston.warmth = Warmth::USUAL);
                assert_eq!(situation.pistons, Situation::<f64>::empty(&model.machine).pistons, "{name}");
            }
        }
    }
}

/// At an edge the opening is exactly the ideal play's, inside it what it was at the last reversal.
#[test]
fn play_is_the_ideal_one() {
    let width = 8e-6;
    let model = arm_with("valve_hysteresis", CYLINDER, &[width, 1.0]);
    let system = System::new(&model);
    let parameters = model.parameter_values();
    let (amplitude, frequency) = (6e-5, 0.5);
    let spool = |t: f64| amplitude * (std::f64::consts::TAU * frequency * t).sin();
    let recording = common::driven(&model, 4.0, 1e-3, |_, t| spool(t), |_| 0.0);
    let signals = InputSignals::from_recording(&model, &recording).unwrap();
    let mut integrator = Integrator::new(&system, &parameters, &[], Tolerances::default());
    let mut state = common::at_rest(&system);
    let mut workspace = system.workspace();
    let mut inputs = Inputs::zero(1);
    let (mut ideal, mut worst, mut held) = (0.0_f64, 0.0_f64, 0);
    for index in 0..signals.len() - 1 {
        let now = spool(recording.time[index]);
        let before = ideal;
        ideal = ideal.clamp(now - width / 2.0, now + width / 2.0);
        held += usize::from(index > 0 && ideal == before);
        signals.between(index, 0.0, &mut inputs);
        system.observe(&mut workspace, &parameters, &state, &inputs, &mut vec![0.0; system.layout().len]);
        worst = worst.max((workspace.situation.pistons[0].opening - ideal).abs());
        integrator.advance(&signals, index, &mut state, None).unwrap();
    }
    // The spool turns round with 6e-4 m2/s2: a memory that is late by 1 ms stands that much times (1 ms)^2 too low.
    let allowed = amplitude * (std::f64::consts::TAU * frequency * 1e-3).powi(2) + 1e-9;
    println!("play: {worst:.1e} m2 from the ideal, {allowed:.1e} allowed; held for {held} samples");
    assert!(held > 100, "the play is never inside its width");
    assert!(worst < allowed, "{worst:e}");
}

/// The bypass has the whole play, none of it, or a share: the metering edges have it in any case.
#[test]
fn the_bypass_has_its_share_of_the_play() {
    let (width, area) = (8e-6, 5e-5);
    for share in [0.0, 0.3, 1.0] {
        let model = arm_with("valve_hysteresis", CYLINDER, &[width, share]);
        let system = System::new(&model);
        let mut inputs = Inputs::zero(1);
        inputs.orifice_area[0] = area;
        let mut workspace = system.workspace();
        let state = common::at_rest(&system);
        let mut rates = vec![0.0; system.layout().len];
        system.observe(&mut workspace, &model.parameter_values(), &state, &inputs, &mut rates);
        let piston = &workspace.situation.pistons[0];
        assert!((piston.opening - (area - width / 2.0)).abs() < 1e-18, "{}", piston.opening);
        let wanted = area - share * width / 2.0;
        assert!((piston.bypass_closing - wanted).abs() < 1e-18, "{share}: {} {wanted}", piston.bypass_closing);
    }
}

/// A compensated section holds its flow whatever the load, as long as the pump is the margin above it; below it is an
/// orifice, and the flow never falls as the pressure drop grows. Edges to tank are no other for it.
#[test]
fn a_compensated_valve_holds_flow_until_the_margin_is_gone() {
    let margin = 8e5;
    let nominal = built_in("zx30u-arm").unwrap();
    let mut model =
        nominal.with_effect(&Catalogue::built_in().find("pressure_compensation").unwrap(), Site::Cylinder(0)).unwrap();
    model.effects.last_mut().unwrap().parameters[0].value = margin;
    let system = System::new(&model);
    let gain = |name: &str| nominal.value_of(name).unwrap();
    let (cap_gain, rod_gain) = (gain("arm.flow_gain_cap"), gain("arm.flow_gain_rod"));
    let mut state = common::at_rest(&system);
    let (pump, cap, rod) = (
        system.layout().pump.unwrap(),
        system.layout().cap_pressure(0).unwrap(),
        system.layout().rod_pressure(0).unwrap(),
    );
    let only_valve = |model: &Model| {
        let mut model = model.clone();
        let keep = ["orifice_flow", "pressure_compensation", "inertia", "oil_compressibility"];
        model.effects.retain(|effect| keep.contains(&effect.name()));
        model
    };
    let (compensated, plain) = (only_valve(&model), only_valve(&nominal));
    for (area, gain, load, other) in [(4e-5, cap_gain, cap, rod), (-4e-5, rod_gain, rod, cap)] {
        let mut inputs = Inputs::zero(1);
        inputs.orifice_area[0] = area;
        (state[pump], state[other]) = (1.5e7, 2e6);
        let mut flow = |drop: f64| {
            state[load] = state[pump] - drop;
            let into = |model: &Model| {
                let rows = rows(model, &state, &inputs);
                if area > 0.0 { (rows.cap_flow[0], rows.rod_flow[0]) } else { (rows.rod_flow[0], rows.cap_flow[0]) }
            };
            let (own, orifice) = (into(&compensated), into(&plain));
            assert_eq!(own.1, orifice.1, "the edge to tank");
            (own.0, orifice.0)
        };
        let held = gain * area.abs() * margin.sqrt();
        for drop in [2.0 * margin, 4.0 * margin, 1.3e7] {
            let (own, _) = flow(drop);
            assert!((own / held - 1.0).abs() < 5e-4, "{own} at {drop} Pa, {held} held");
        }
        for drop in [0.0, 1e3, 1e5, 0.5 * margin, -1e5, -2e6] {
            let (own, orifice) = flow(drop);
            assert!((own - orifice).abs() <= 5e-4 * orifice.abs(), "{own} at {drop} Pa, orifice {orifice}");
        }
        let flows: Vec<f64> = (0..4000).map(|step| flow(f64::from(step) * 1e3).0).collect();
        assert!(flows.windows(2).all(|pair| pair[1] >= pair[0]), "flow falls as the drop grows");
        // Slopes change by no more than an orifice's own slope within a tenth of the margin: no corner.
        let slopes: Vec<f64> = flows.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let corner = slopes[300..].windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(corner < 0.02 * slopes[300], "{corner} of {}", slopes[300]);
    }
}

/// A check valve that is tight lets nothing back; one that is not there lets all back.
#[test]
fn a_tight_check_valve_lets_nothing_back() {
    let base = built_in("zx30u-arm").unwrap();
    let model = base.with_effect(&Catalogue::built_in().find("load_check_valve").unwrap(), Site::Cylinder(0)).unwrap();
    let system = System::new(&model);
    let mut inputs = Inputs::zero(1);
    let mut state = common::at_rest(&system);
    let pump = system.layout().pump.unwrap();
    let valve = model.effects.iter().position(|effect| effect.name() == "orifice_flow").unwrap();
    for (opening, low) in [(5e-5, true), (-5e-5, true), (5e-5, false), (-5e-5, false)] {
        inputs.orifice_area[0] = opening;
        state[pump] = if low { 1e5 } else { 2e7 };
        let drawn = |tightness: f64| {
            let mut parameters = model.parameter_values();
            *parameters.last_mut().unwrap() = tightness;
            let book = excavator_model::energy::ledger(&system, &parameters, &state, &inputs);
            book.effects[valve].pump_line
        };
        if low {
            assert!(drawn(0.0) > 0.0 && drawn(1.0) == 0.0, "{opening}: {} {}", drawn(0.0), drawn(1.0));
        } else {
            assert!(drawn(0.0) < 0.0 && drawn(1.0) == drawn(0.0), "{opening}");
        }
    }
}
