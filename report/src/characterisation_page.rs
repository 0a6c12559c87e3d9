//! A page with the results of the procedures of \[B\].

use excavator_identification::characterisation::{
    ChamberLeakage, Characterisation, ClosedValve, DeadZone, DirectionalGain, Edge, Estimate, FrictionCurve,
    Polynomial, Refusal,
};
use excavator_model::Model;
use excavator_model::display::PressureUnit;
use maud::{Markup, html};

use super::characterisation_plots::{edge_plots, friction_plot, gain_plots, transient_plots};
use super::drive_rows::drive_rows;
use super::numbers::{SIDES_95, percent, significant, with_margin};
use super::page::{Section, page, tile};

/// A page with gains, dead zones, leakage and friction of every cylinder, with 95 % bands, and the reasons for missing
/// results.
///
/// ```
/// use excavator_identification::characterisation::characterise;
/// use excavator_model::Model;
/// use excavator_model::recording::Recording;
/// use excavator_report::characterisation_page;
///
/// fn page(model: &Model, recording: &Recording) -> String {
///     characterisation_page(model, &[recording.source.clone()], &characterise(model, &[recording]))
/// }
/// ```
pub fn characterisation_page(model: &Model, sources: &[String], found: &[Characterisation]) -> String {
    let lead = html! {
        p.about { (model.machine.description) " · " (sources.join(", ")) }
        div.tiles {
            (tile(&found.iter().map(Characterisation::results).sum::<usize>().to_string(), "results"))
            (tile(&sources.len().to_string(), if sources.len() == 1 { "recording" } else { "recordings" }))
        }
    };
    let each = |of: &dyn Fn(&Characterisation) -> Markup| {
        html! { @for one in found {
            @if found.len() > 1 { h3 { (one.cylinder) } }
            (of(one))
        } }
    };
    let section = |anchor, title: &str, of: &dyn Fn(&Characterisation) -> Markup| Section {
        anchor,
        title: title.to_string(),
        body: each(of),
    };
    let sections = [
        section("drive", "Drive and stops, from steady stretches", &drive),
        section("gains", "Gains of the metering edges", &gains),
        section("dead-zone", "Dead zone and hysteresis", &dead_zones),
        section("leakage", "Leakage of the closed valve", &leakage),
        section("friction", "Friction against speed", &friction),
    ];
    page("Characterisation", &model.machine.name, &lead, &sections)
}

fn refused(what: &str, refusal: &Refusal) -> Markup {
    html! { p.empty { (what) ": not from these recordings, because " (refusal) "." } }
}

/// Null, dead zones, gains and leakage of a valve, or the losses of a pump; and the stops.
fn drive(one: &Characterisation) -> Markup {
    let rows = drive_rows(one);
    html! {
        @if !rows.is_empty() {
            div.wide { table.data {
                thead { tr { th { "Quantity" } th.n { "Value" } th { "Unit" } } }
                tbody { @for row in &rows { tr {
                    td { (row.what) }
                    td.n { (with_margin(row.estimate.value, SIDES_95 * row.estimate.error)) }
                    td.unit { (row.unit) }
                } } }
            } }
            p.note {
                "The flow follows from the speed, where input and speed are constant. The null is the middle of the closed valve, and dead zones count from it. Both "
                "chambers are closed by one spool, which tells the leakage past the piston. A stop is where the piston stands although it is driven on. ± 95 %."
            }
        }
        @if let Err(refusal) = &one.drive { (refused("The curve of the drive", refusal)) }
    }
}

fn gains(one: &Characterisation) -> Markup {
    let found: Vec<(Edge, &DirectionalGain)> =
        one.gains.iter().filter_map(|(edge, gain)| Some((*edge, gain.as_ref().ok()?))).collect();
    html! {
        @if !found.is_empty() {
            (gain_plots(&found, one.unit))
            div.wide { table.data {
                thead { tr {
                    th { "Edge" } th.n { "Stretches" } th { "Opening" } th.n { "Degree" } th { "Polynomial in x = |u|/umax, " (one.unit.flow_gain()) } th { "Why this degree" }
                } }
                tbody { @for (edge, gain) in &found {
                    (gain_row(edge.name(), gain.points.len(), "from closed", &gain.polynomial))
                    @if let Some(curve) = &gain.past_edge { (gain_row("", gain.points.len(), "from the edge", curve)) }
                } }
            } }
            p.note {
                "Gain: flow divided by opening and by the root of the pressure drop, in steady stretches ([B] Eq. 11, with the opening as area law). If the opening "
                "is measured from closed, the dead zone bends the gain. Measured from the edge of the dead zone, it shows the area law alone. Bands are 95 %."
            }
        }
        @for (edge, gain) in &one.gains { @if let Err(refusal) = gain { (refused(edge.name(), refusal)) } }
    }
}

fn gain_row(name: &str, count: usize, from: &str, curve: &Polynomial) -> Markup {
    html! { tr.first[!name.is_empty()] {
        td { (name) }
        td.n { @if !name.is_empty() { (count) } }
        td { (from) }
        td.n { (curve.degree()) }
        td { (polynomial_text(curve)) }
        td.meaning { (curve.reason) }
    } }
}

/// `c0 + c1 x + ...` with standard errors.
fn polynomial_text(curve: &Polynomial) -> String {
    let terms = curve.coefficients.iter().enumerate().map(|(power, &coefficient)| {
        let number = with_margin(coefficient, SIDES_95 * curve.covariance[(power, power)].sqrt());
        match power {
            0 => number,
            1 => format!("({number}) x"),
            2 => format!("({number}) x²"),
            3 => format!("({number}) x³"),
            _ => format!("({number}) x⁴"),
        }
    });
    terms.collect::<Vec<_>>().join(" + ")
}

fn dead_zones(one: &Characterisation) -> Markup {
    let found: Vec<(Edge, &DeadZone)> =
        one.dead_zones.iter().filter_map(|(edge, zone)| Some((*edge, zone.as_ref().ok()?))).collect();
    let (factor, unit) = one.unit.for_people();
    let area = |estimate: Estimate| with_margin(estimate.value * factor, SIDES_95 * estimate.error * factor);
    html! {
        @if !found.is_empty() {
            (edge_plots(&found, one.unit))
            div.wide { table.data {
                thead { tr {
                    th { "Edge" } th.n { "Flow begins, " (unit) } th.n { "Flow ends, " (unit) } th.n { "Dead zone, " (unit) } th.n { "Share of umax" }
                    th.n { "Hysteresis, " (unit) } th.n { "Runs" } th.n { "Equal lag" }
                } }
                tbody { @for (edge, zone) in &found { tr {
                    td.unit { (edge.name()) }
                    td.n { (area(zone.opening)) } td.n { (area(zone.closing)) } td.n { (area(zone.dead_zone)) }
                    td.n { (percent(zone.dead_zone.value / one.maximum_orifice_area)) }
                    td.n { (area(zone.hysteresis)) }
                    td.n { (zone.runs.0) " + " (zone.runs.1) }
                    td.n { (significant(1e3 * zone.lag_that_looks_the_same(), 2)) " ms" }
                } } }
            } }
            p.note {
                "The edges are the openings at which the normalised flow leaves zero while the valve opens and reaches zero while it closes; ± 95 %. If the opening is "
                "a command, a lag of the valve (column “equal lag”) looks like hysteresis. Repeat the test at another speed to separate the two."
            }
        }
        @for (edge, zone) in &one.dead_zones { @if let Err(refusal) = zone { (refused(edge.name(), refusal)) } }
    }
}

/// Unit for leakage coefficients, per pressure in this process's unit: displayed value of 1 m³/(s Pa), and the unit.
pub fn leakage_unit() -> (f64, String) {
    let pressure = PressureUnit::shown();
    (60e6 / pressure.factor(), format!("ml/(min {})", pressure.symbol()))
}

fn leakage(one: &Characterisation) -> Markup {
    let (_, unit) = leakage_unit();
    match &one.leakage {
        Err(refusal) => refused("Leakage", refusal),
        Ok(found) => html! {
            (transient_plots(found))
            div.wide { table.data {
                thead { tr {
                    th { "Chamber" } th.n { "From the pump, " (unit) } th.n { "To tank, " (unit) } th.n { "Time constant, s" } th.n { "Static gain" }
                } }
                tbody {
                    @if let Ok(side) = &found.cap { (leakage_row("cap side: C1, C2", side)) }
                    @if let Ok(side) = &found.rod { (leakage_row("rod side: C3, C4", side)) }
                }
            } }
            p.note {
                (found.holds.len()) " times with closed valve; the piston creeps " (significant(1e3 * creep(found), 2)) " mm at most, which the balance takes into account. "
                "Time constants and static gains apply to a piston held at mid-stroke. If the load moves the piston, it settles where flows and load balance. "
                "All values depend on the bulk modulus of the model, " (significant(found.bulk_modulus * 1e-9, 3)) " GPa. ± 95 %."
            }
            @if let Err(refusal) = &found.cap { (refused("Cap side", refusal)) }
            @if let Err(refusal) = &found.rod { (refused("Rod side", refusal)) }
        },
    }
}

fn creep(found: &ClosedValve) -> f64 {
    found.holds.iter().map(|hold| hold.creep.abs()).filter(|creep| creep.is_finite()).fold(0.0, f64::max)
}

fn leakage_row(name: &str, side: &ChamberLeakage) -> Markup {
    let text = |estimate: Estimate| with_margin(estimate.value, SIDES_95 * estimate.error);
    let (factor, _) = leakage_unit();
    let leak = |estimate: Estimate| with_margin(factor * estimate.value, SIDES_95 * factor * estimate.error);
    html! { tr {
        td { (name) }
        td.n { (leak(side.from_pump)) } td.n { (leak(side.to_tank)) } td.n { (text(side.time_constant)) } td.n { (text(side.static_gain)) }
    } }
}

fn friction(one: &Characterisation) -> Markup {
    match &one.friction {
        Err(refusal) => refused("Friction", refusal),
        Ok(curve) => html! { (friction_plot(curve)) (friction_table(curve)) },
    }
}

fn friction_table(curve: &FrictionCurve) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr { th { "Term" } th { "Times" } th.n { "Coefficient" } th { "Unit" } } }
            tbody {
                @for term in &curve.terms { tr {
                    td { (super::words::spoken(term.effect)) }
                    td { (term.shape) }
                    td.n { (with_margin(term.coefficient.value, SIDES_95 * term.coefficient.error)) }
                    td.unit { (term.unit) }
                } }
                @if let Some(faded) = curve.stribeck_speed { tr { td { "fades by vs" } td {} td.n { (with_margin(1e3 * faded.value, SIDES_95 * 1e3 * faded.error)) } td.unit { "mm/s" } } }
                @if let Some(share) = curve.load_share { tr { td { "load over the model's" } td {} td.n { (with_margin(share.value, SIDES_95 * share.error)) } td.unit {} } }
            }
        } }
        p.note {
            (curve.points.len()) " steady stretches, load " @if curve.from_load_cell { "from the load cell" } @else { "from the model, scaled by a fitted factor" }
            ". " (curve.reason) ". Points lie " (significant(curve.scatter, 2)) " N from the curve (root mean square); the band is 95 %."
        }
    }
}
