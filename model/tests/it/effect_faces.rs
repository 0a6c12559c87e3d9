//! Every effect of the catalogue, at every place of every machine: its faces agree.

use crate::common;
use std::collections::BTreeMap;

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::energy::ledger;
use excavator_model::equations::{Inputs, Rows, System};
use excavator_model::scalar::{DIRECTIONS, Dual, constant, derivative, variable};
use excavator_model::simulation::Linearisation;

const STATES_PER_CASE: usize = 50;

/// How much shorter a step is that does not reach a corner nearby.
const SHORTER: f64 = 10.0;

/// All sums of the rows, in one list.
fn flat<T: Copy>(rows: &Rows<T>) -> Vec<T> {
    let mut all = Vec::new();
    for sums in [
        &rows.mass,
        &rows.torque,
        &rows.piston_force,
        &rows.cap_flow,
        &rows.rod_flow,
        &rows.cap_compliance,
        &rows.rod_compliance,
    ] {
        all.extend_from_slice(sums);
    }
    all.extend([rows.pump_flow, rows.pump_compliance, rows.accumulator_compliance]);
    all
}

fn rows_at(system: &System<'_>, parameters: &[f64], state: &[f64], inputs: &Inputs<f64>) -> Vec<f64> {
    let mut workspace = system.workspace();
    system.rates(&mut workspace, parameters, state, inputs, &mut vec![0.0; state.len()]);
    flat(&workspace.rows)
}

fn lift(inputs: &Inputs<f64>) -> Inputs<Dual> {
    Inputs {
        time: constant(inputs.time),
        orifice_area: inputs.orifice_area.iter().map(|&value| constant(value)).collect(),
        orifice_rates: inputs.orifice_rates.iter().map(|rates| rates.map(constant)).collect(),
        rod_force: inputs.rod_force.iter().map(|&value| constant(value)).collect(),
        imposed: inputs.imposed.iter().map(|state| state.each(|&value| constant(value))).collect(),
        supply_pressure: constant(inputs.supply_pressure),
        tank_pressure: constant(inputs.tank_pressure),
        pump_flow: constant(inputs.pump_flow),
        oil_temperature: constant(inputs.oil_temperature),
    }
}

/// Derivative of each row with respect to parameter `index`.
fn regressor(system: &System<'_>, parameters: &[f64], state: &[f64], inputs: &Inputs<f64>, index: usize) -> Vec<f64> {
    let mut lifted: Vec<Dual> = parameters.iter().map(|&value| constant(value)).collect();
    lifted[index] = variable(parameters[index], 0);
    let state: Vec<Dual> = state.iter().map(|&value| constant(value)).collect();
    let mut workspace = system.workspace::<Dual>();
    system.rates(&mut workspace, &lifted, &state, &lift(inputs), &mut vec![constant(0.0); state.len()]);
    flat(&workspace.rows).iter().map(|row| derivative(row, 0)).collect()
}

/// The model without effect `index`, and the parameters that remain.
fn without(model: &Model, parameters: &[f64], index: usize) -> (Model, Vec<f64>) {
    let (first, last) = System::new(model).parameter_ranges()[index];
    let mut rest = model.clone();
    rest.effects.remove(index);
    let mut values = parameters.to_vec();
    values.drain(first..last);
    (rest, values)
}

/// Regressor times coefficient is what the simulation adds: for parameters that rows are linear in (or in one over
/// them), the sum of derivative times value is the difference that the effect makes, at any size of the coefficients.
#[test]
fn regressor_times_coefficient_is_the_contribution() {
    let mut compared = 0;
    let mut worst = 0.0_f64;
    for (model, index) in common::every_effect_everywhere() {
        let mut random = common::random_for(1, &model, index);
        let effect = &model.effects[index];
        if effect.parameters.iter().all(|parameter| parameter.card.kind == Kind::Shape) {
            continue;
        }
        let system = System::new(&model);
        let (first, last) = system.parameter_ranges()[index];
        let mut seen = false;
        for _ in 0..STATES_PER_CASE {
            let mut parameters = common::random_parameters(&model, &mut random);
            let state = common::random_state(&system, &mut random);
            let inputs = common::random_inputs(&model.machine, &mut random);
            let (rest, rest_parameters) = without(&model, &parameters, index);
            let rest_system = System::new(&rest);
            assert_eq!(rest_system.layout().len, state.len(), "effects with states have shapes only");
            let absent = rows_at(&rest_system, &rest_parameters, &state, &inputs);
            for size in [1.0, 2.5] {
                let kinds = effect.parameters.iter().map(|parameter| parameter.card.kind);
                for (parameter, kind) in parameters[first..last].iter_mut().zip(kinds.clone()) {
                    match kind {
                        Kind::Linear => *parameter *= size,
                        Kind::Reciprocal => *parameter /= size,
                        Kind::Shape => {}
                    }
                }
                let present = rows_at(&system, &parameters, &state, &inputs);
                let mut predicted = vec![0.0; present.len()];
                for (number, kind) in (first..last).zip(kinds) {
                    let sign = match kind {
                        Kind::Linear => 1.0,
                        // p d/dp = -(1/p) d/d(1/p)
                        Kind::Reciprocal => -1.0,
                        Kind::Shape => continue,
                    };
                    let slopes = regressor(&system, &parameters, &state, &inputs, number);
                    for (slot, slope) in predicted.iter_mut().zip(slopes) {
                        *slot += sign * slope * parameters[number];
                    }
                }
                for (row, ((present, absent), predicted)) in present.iter().zip(&absent).zip(&predicted).enumerate() {
                    let scale = present.abs() + absent.abs() + predicted.abs();
                    let difference = (present - absent - predicted).abs();
                    if scale > 0.0 {
                        worst = worst.max(difference / scale);
                    }
                    assert!(
                        difference <= 1e-12 * scale,
                        "{} row {row}: {present} - {absent} is not {predicted}",
                        common::label(&model, index)
                    );
                    seen |= predicted.abs() > 0.0;
                    compared += 1;
                }
            }
        }
        assert!(seen, "{} added nothing in {STATES_PER_CASE} states", common::label(&model, index));
    }
    assert!(compared > 10_000, "{compared}");
    println!("largest relative difference of regressor times coefficient: {worst:.1e}");
}

/// The energy balance closes in the vector field: dH/dt, by dual numbers along the rates, is the sum of the powers; and
/// the same for cylinders and pump line alone.
#[test]
fn powers_add_up_to_the_rate_of_the_storage() {
    let mut worst = 0.0_f64;
    let mut shows_power: BTreeMap<String, bool> = BTreeMap::new();
    for (model, index) in common::every_effect_everywhere() {
        let mut random = common::random_for(2, &model, index);
        let system = System::new(&model);
        let (mut has_power, mut most_power) = (false, 0.0_f64);
        for _ in 0..STATES_PER_CASE {
            let parameters = common::random_parameters(&model, &mut random);
            let state = common::random_state(&system, &mut random);
            let inputs = common::random_inputs(&model.machine, &mut random);
            let mut rates = vec![0.0; state.len()];
            system.rates(&mut system.workspace(), &parameters, &state, &inputs, &mut rates);
            let along: Vec<Dual> =
                state.iter().zip(&rates).map(|(&value, &rate)| constant(value) + variable(0.0, 0) * rate).collect();
            let parameters: Vec<Dual> = parameters.iter().map(|&value| constant(value)).collect();
            let mut now = lift(&inputs);
            now.time += variable(0.0, 0);
            let book = ledger(&system, &parameters, &along, &now);
            let own = &book.effects[index];
            has_power |= own.has_power;
            most_power = [own.mechanical, own.cap, own.rod, own.pump_line]
                .iter()
                .fold(most_power, |most, power| most.max(power.re.abs()));

            let size: f64 = book.pump_power.re.abs()
                + book.rod_force_power.re.abs()
                + book
                    .effects
                    .iter()
                    .map(|e| e.mechanical.re.abs() + e.cap.re.abs() + e.rod.re.abs() + e.pump_line.re.abs())
                    .sum::<f64>()
                + book
                    .cylinders
                    .iter()
                    .flat_map(|c| [c.kinetic, c.potential, c.cap_internal, c.rod_internal])
                    .map(|part| derivative(&part, 0).abs())
                    .sum::<f64>();
            let rate = |stored: Dual| derivative(&stored, 0);
            let into_line =
                book.pump_power - book.bypass_loss() - book.metering_loss() - book.supply() + book.rod_force_power;
            let pairs = [
                ("all", rate(book.stored()), book.balance().re),
                ("cylinders", rate(book.stored_in_cylinders()), (book.supply() + book.dissipation()).re),
                ("pump line", rate(book.pump_line), into_line.re),
            ];
            for (what, rate, powers) in pairs {
                let error = (rate - powers).abs() / size;
                worst = worst.max(error);
                assert!(
                    error <= 1e-9,
                    "{}, {what}: dH/dt {rate} W, powers {powers} W, size {size} W",
                    common::label(&model, index)
                );
            }
        }
        assert!(has_power || most_power == 0.0, "{}: up to {most_power} W", common::label(&model, index));
        // Not at every place: fifty states of some cylinders do not cavitate.
        let shown = shows_power.entry(model.effects[index].name().to_string()).or_insert(!has_power);
        *shown |= most_power > 0.0;
    }
    for (name, shown) in shows_power {
        assert!(shown, "{name} had no power anywhere");
    }
    println!("largest relative error of the energy balance in the vector field: {worst:.1e}");
}

/// Duals against central differences of the rates, by all states and by all parameters.
fn check_jacobians(states_per_case: usize) {
    let mut worst = 0.0_f64;
    let (mut corners, mut compared) = (0, 0);
    for (model, index) in common::every_effect_everywhere() {
        let mut random = common::random_for(3, &model, index);
        let system = System::new(&model);
        let layout = system.layout().clone();
        let wanted: Vec<usize> = (0..model.parameters().count()).collect();
        let mut linearisation = Linearisation::new(&system, &wanted);
        let mut state_steps = vec![2.0; layout.len];
        state_steps[..2 * layout.joints].fill(1e-6);
        for &(first, states) in &layout.effect_states {
            state_steps[first..first + states].fill(1e-10);
        }
        for _ in 0..states_per_case {
            let parameters = common::random_parameters(&model, &mut random);
            let state = common::random_state(&system, &mut random);
            let inputs = common::random_inputs(&model.machine, &mut random);
            linearisation.evaluate(&system, &parameters, &state, &inputs);
            let rates_at = |parameters: &[f64], state: &[f64]| {
                let mut rates = vec![0.0; state.len()];
                system.rates(&mut system.workspace(), parameters, state, &inputs, &mut rates);
                rates
            };
            let rates = rates_at(&parameters, &state);
            for (row, (rate, plain)) in linearisation.rates.iter().zip(&rates).enumerate() {
                // A rate near zero is a sum of terms that cancel; their rounding stays.
                let rounding = 1e-16 * rates_scale(&layout, row);
                assert!((rate - plain).abs() <= 1e-12 * plain.abs() + rounding, "{}", common::label(&model, index));
            }
            let mut compare = |what: &str, step: f64, moved_by: &dyn Fn(f64) -> Vec<f64>, slopes: Vec<f64>| {
                let (upper, lower) = (moved_by(step), moved_by(-step));
                for row in 0..layout.len {
                    let difference = (upper[row] - lower[row]) / (2.0 * step);
                    // What rounding of the rates leaves of a difference.
                    let rounding = 1e-13 * (upper[row].abs() + 1e-3 * rates_scale(&layout, row)) / step;
                    let error = (difference - slopes[row]).abs();
                    let sides = [(upper[row] - rates[row]) / step, (rates[row] - lower[row]) / step];
                    let sizes = sides[0].abs() + sides[1].abs();
                    if (sides[0] - sides[1]).abs() > 1e-2 * sizes + 4.0 * rounding {
                        // A corner between the two points: the slope is that of one of its sides, and the corner is
                        // nowhere more than a corner. Or a bend that is narrow for the step: the slope is the mean.
                        let error = sides.iter().map(|side| (side - slopes[row]).abs()).fold(error, f64::min);
                        assert!(
                            error <= 1e-2 * sizes + 4.0 * rounding,
                            "{} {what} row {row}: {} by duals at a corner between {sides:?}",
                            common::label(&model, index),
                            slopes[row]
                        );
                        corners += 1;
                        continue;
                    }
                    let allowed = 1e-5 * (difference.abs() + slopes[row].abs()) + rounding;
                    if error > allowed {
                        // A corner whose slopes differ by less than 1 % lies farther away than a shorter step reaches.
                        let near = step / SHORTER;
                        let difference = (moved_by(near)[row] - moved_by(-near)[row]) / (2.0 * near);
                        let error = (difference - slopes[row]).abs();
                        assert!(
                            error <= allowed - rounding + SHORTER * rounding,
                            "{} {what} row {row}: {} by duals, {difference} by differences over {near}",
                            common::label(&model, index),
                            slopes[row]
                        );
                        corners += 1;
                        continue;
                    }
                    compared += 1;
                    worst = worst.max((error - rounding).max(0.0) / (difference.abs() + slopes[row].abs() + 1e-300));
                }
            };
            let with = |values: &[f64], column: usize, step: f64| {
                let mut moved = values.to_vec();
                moved[column] += step;
                moved
            };
            for (column, &step) in state_steps.iter().enumerate() {
                let slopes = linearisation.by_state.column(column).iter().copied().collect();
                let moved_by = |step: f64| rates_at(&parameters, &with(&state, column, step));
                compare(&format!("state {column}"), step, &moved_by, slopes);
            }
            for (column, &value) in parameters.iter().enumerate() {
                let slopes = linearisation.by_parameter.column(column).iter().copied().collect();
                let moved_by = |step: f64| rates_at(&with(&parameters, column, step), &state);
                compare(&format!("parameter {column}"), value.abs() * 1e-6, &moved_by, slopes);
            }
        }
    }
    println!("largest relative difference of Jacobians beyond rounding: {worst:.1e}; {corners} corners of {compared}");
    assert!(corners * 1000 < compared, "{corners} corners in {compared} comparisons: more than chance puts there");
}

#[test]
fn jacobians_are_central_differences() {
    check_jacobians(STATES_PER_CASE / 5);
}

/// Size of the terms that a rate is the sum of, to judge rounding: velocities, accelerations, pressure rates.
fn rates_scale(layout: &excavator_model::equations::Layout, row: usize) -> f64 {
    if row < layout.joints {
        1.0
    } else if row < 2 * layout.joints {
        1e3
    } else {
        1e11
    }
}

/// More directions than one dual number carries take several passes; both Jacobians must come out whole.
#[test]
fn the_two_joint_machine_needs_several_passes() {
    let model = excavator_model::document::built_in("zx30u").unwrap();
    let system = System::new(&model);
    assert!(system.layout().len > DIRECTIONS);
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn jacobians_are_central_differences_in_many_states() {
        check_jacobians(STATES_PER_CASE);
    }
}
