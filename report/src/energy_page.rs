//! A page with the energy flow of a recording.

use excavator_identification::energy::{CylinderTraces, EnergyAnalysis, missing_power};
use excavator_model::Model;
use maud::{Markup, html};

use super::energy_flow::energy_flow;
use super::energy_tables::{by_opening, energies, evidence, ledger, pump_line};
use super::energy_text::budget_sentence;
use super::numbers::{decimal, percent, significant};
use super::page::{Section, page, tile};
use super::power_plots::{PowerLine, PowerPlot};
use super::time_plots::hint;
use super::units;
use super::words;

const EXPERIMENTAL: &str = "var(--ink)";
const NUMERICAL: &str = "var(--orange)";
const ANALYTICAL: &str = "var(--green)";
const PARTS: [&str; 5] = ["var(--ink)", "var(--blue)", "var(--green)", "var(--orange)", "var(--pink)"];

/// Points of all lines of the page.
const POINTS_OF_A_PAGE: usize = 50_000;

/// A page with the energy of one recording under one model: its flow, the rates of the stored energy as in \[A\] Figures
/// 10 to 12, and the ledger with its noise bands.
///
/// ```no_run
/// use excavator_identification::energy::{EnergySettings, analyse};
/// use excavator_model::Model;
/// use excavator_model::recording::Recording;
/// use excavator_report::energy_page;
///
/// fn write(model: &Model, recording: &Recording) -> Result<(), Box<dyn std::error::Error>> {
///     let analysis = analyse(model, recording, EnergySettings::default())?;
///     Ok(std::fs::write("energy.html", energy_page(model, &analysis))?)
/// }
/// ```
pub fn energy_page(model: &Model, analysis: &EnergyAnalysis) -> String {
    let missing = missing_power(model, analysis);
    let totals = &analysis.totals;
    let budget = analysis.budget(model);
    let whole = budget.delivered;
    let supplied: f64 = totals.cylinders.iter().map(|own| own.supplied).sum();
    let metering: f64 = totals.cylinders.iter().map(|own| own.metering_loss).sum();
    let lead = html! {
        p.about { (model.machine.description) " · " (analysis.source) }
        p class={ "verdict " (if missing.is_empty() { "adequate" } else { "unexplained" }) } {
            @match missing.first() {
                None => { "The ledger closes: at every equation noise explains the energy that is left over." }
                Some(first) => { "The ledger does not close. " (first.sentence) }
            }
            " " (budget_sentence(model, analysis))
        }
        div.tiles {
            (tile(&format!("{} kJ", significant(whole / 1e3, 3)), "delivered"))
            @if totals.pump != 0.0 { (tile(&percent(totals.bypass_loss() / whole), "lost between pump and tank")) }
            @if metering != 0.0 { (tile(&percent(metering / whole), "lost in the valve sections")) }
            (tile(&percent(supplied / whole), "into the cylinders"))
            (tile(&percent(budget.share_of(budget.unexplained())), "not explained"))
            (tile(&format!("{} s", significant(analysis.duration, 3)), "recording"))
        }
    };
    let lines: usize = analysis.traces.cylinders.iter().map(|trace| 14 + 2 * trace.terms.len()).sum();
    let budget = (POINTS_OF_A_PAGE / lines.max(1)).clamp(300, 1500);
    let each = |of: &dyn Fn(&CylinderTraces, usize) -> Markup| {
        html! { @for (number, trace) in analysis.traces.cylinders.iter().enumerate() {
            @if analysis.traces.cylinders.len() > 1 { h3 { (words::capitalised(&trace.name)) } }
            (of(trace, number))
        } }
    };
    let sections = [
        Section {
            anchor: "flow",
            title: "Where the energy went".into(),
            body: html! { (energy_flow(model, totals)) (energies(model, analysis)) h3 { "By the sign of the opening" } (by_opening(model, analysis)) h3 { "The pump line" } (pump_line(model, analysis)) },
        },
        Section {
            anchor: "ledger",
            title: "Does the ledger close?".into(),
            body: html! {
                (evidence(&missing))
                (hint())
                (residual_plots(model, analysis))
                (ledger(model, analysis))
                p.note {
                    "The residual of each equation is the rate of the stored energy minus the modelled power inflow, averaged over windows of 0.4 s. "
                    "A negative residual means that power is missing. The limit has four parts: sensor noise (from repeats with added noise), standard errors of the parameters, "
                    "smoothing by parabolas, and 1 % of the power that passes through."
                    @if !analysis.parameters_have_errors { " The parameters of this model have no standard errors, so they are treated as exact. Identify the model first." }
                }
            },
        },
        Section {
            anchor: "rates",
            title: "Rate of the stored energy".into(),
            body: html! {
                @if let Some(criterion) = analysis.phase_criterion() { p { (criterion.sentence) } }
                (each(&|trace, number| rates(model, trace, number, budget)))
                @if let Some(reason) = &analysis.simulation_failed { p.note { "No numerical results: " (reason) } }
            },
        },
        Section {
            anchor: "supply",
            title: "Supply and dissipation".into(),
            body: each(&|trace, number| supply(trace, number, budget)),
        },
        Section {
            anchor: "dissipation",
            title: "Dissipation by effect".into(),
            body: each(&|trace, number| terms(trace, number, budget)),
        },
        Section {
            anchor: "stored",
            title: "Stored energy and its parts".into(),
            body: each(&|trace, number| stored(trace, number, budget)),
        },
    ];
    page("Energy", &model.machine.name, &lead, &sections)
}

fn group(number: usize) -> String {
    format!("energy-{number}")
}

fn line<'a>(label: &'a str, colour: &'a str, dashed: bool, values: &'a [f64]) -> PowerLine<'a> {
    PowerLine { label, colour, width: 1.4, dashed, values, errors: None }
}

/// \[A\] Figure 10.
fn rates(model: &Model, trace: &CylinderTraces, number: usize, budget: usize) -> Markup {
    let group = group(number);
    let plot = PowerPlot { group: &group, label: "dH/dt", unit: "W", height: 260, last: false, budget };
    let cylinder = trace.members.first().and_then(|&member| model.machine.cylinders.get(member));
    let unit = units::of_opening(cylinder);
    let opening: Vec<f64> = trace.opening.iter().map(|input| input * unit.factor).collect();
    let lower = PowerPlot { label: "opening", unit: unit.symbol, height: 120, last: true, ..plot };
    html! {
        (plot.markup(&trace.time, &[
            PowerLine { errors: Some(&trace.experimental.error), ..line("experimental", EXPERIMENTAL, false, &trace.experimental.value) },
            line("numerical", NUMERICAL, true, &trace.numerical),
            line("analytical", ANALYTICAL, false, &trace.analytical.value),
        ]))
        (lower.markup(&trace.time, &[line("valve opening", PARTS[1], false, &opening)]))
        @if let Some(phase) = &trace.phase {
            p.note {
                "At " (significant(phase.frequency, 3)) " Hz, the analytical rate " (against(phase.analytical))
                " the experimental rate, and the numerical rate " (against(phase.numerical)) " it. The band is the 95 % interval from sensor noise. "
                "Experimental: slope of the energy stored in the measured state. Analytical: supply and dissipation at the measured state. Numerical: the same at the simulated state."
            }
        }
    }
}

/// Phase of a rate against another: its lag or lead in degrees.
fn against(lag: Option<f64>) -> String {
    match lag {
        None => "has no measured phase against".to_string(),
        Some(lag) => format!("{} by {}°", if lag < 0.0 { "leads" } else { "lags" }, decimal(lag.abs())),
    }
}

/// \[A\] Figure 11.
fn supply(trace: &CylinderTraces, number: usize, budget: usize) -> Markup {
    let group = group(number);
    let plot = PowerPlot { group: &group, label: "supply", unit: "W", height: 200, last: false, budget };
    let lower = PowerPlot { label: "dissipation", last: true, ..plot };
    html! {
        (plot.markup(&trace.time, &[
            line("numerical supply", NUMERICAL, true, &trace.numerical_supply),
            PowerLine { errors: Some(&trace.supply.error), ..line("analytical supply", ANALYTICAL, false, &trace.supply.value) },
        ]))
        (lower.markup(&trace.time, &[
            line("numerical dissipation", NUMERICAL, true, &trace.numerical_dissipation),
            PowerLine { errors: Some(&trace.dissipation.error), ..line("analytical dissipation", ANALYTICAL, false, &trace.dissipation.value) },
        ]))
    }
}

/// \[A\] Figure 12.
fn terms(trace: &CylinderTraces, number: usize, budget: usize) -> Markup {
    let group = group(number);
    let drawn: Vec<_> =
        trace.terms.iter().filter(|term| term.analytical.iter().any(|power| power.abs() > 1e-9)).collect();
    html! { @for (index, term) in drawn.iter().enumerate() {
        @let label = words::spoken(&term.effect);
        @let plot = PowerPlot { group: &group, label: &label, unit: "W", height: 150, last: index + 1 == drawn.len(), budget };
        (plot.markup(&trace.time, &[
            line("numerical", NUMERICAL, true, &term.numerical),
            line("analytical", ANALYTICAL, false, &term.analytical),
        ]))
    } }
}

fn stored(trace: &CylinderTraces, number: usize, budget: usize) -> Markup {
    let group = group(number);
    let plot = PowerPlot { group: &group, label: "H", unit: "J", height: 200, last: false, budget };
    let parts = PowerPlot { label: "parts of H", last: true, ..plot };
    html! {
        (plot.markup(&trace.time, &[
            PowerLine { errors: Some(&trace.hamiltonian.error), ..line("H", PARTS[0], false, &trace.hamiltonian.value) },
            line("potential", PARTS[1], true, &trace.potential),
        ]))
        (parts.markup(&trace.time, &[
            line("kinetic", PARTS[2], false, &trace.kinetic),
            line("oil, cap side", PARTS[3], false, &trace.cap_internal),
            line("oil, rod side", PARTS[4], false, &trace.rod_internal),
        ]))
    }
}

/// Missing power over time, with its band, equation by equation.
fn residual_plots(model: &Model, analysis: &EnergyAnalysis) -> Markup {
    let time: Vec<f64> = analysis.windows.iter().map(|window| window.time).collect();
    html! { @for (index, place) in analysis.places.iter().enumerate() {
        @let column = |of: &dyn Fn(&excavator_identification::energy::WindowPoint) -> f64| -> Vec<f64> { analysis.windows.iter().map(of).collect() };
        @let residual = column(&|window| window.residuals[index]);
        @let (zero, half) = (vec![0.0; time.len()], column(&|window| 0.5 * window.bands[index]));
        @let label = place.place.equation(model);
        @let plot = PowerPlot { group: "ledger", label: "missing", unit: "W", height: 140, last: index + 1 == analysis.places.len(), budget: 1200 };
        h3 { (words::capitalised(&words::equation(&label))) }
        (plot.markup(&time, &[
            PowerLine { label: "explained by noise", colour: "var(--blue)", width: 1.0, dashed: false, values: &zero, errors: Some(&half) },
            line("stored without explanation", EXPERIMENTAL, false, &residual),
        ]))
    } }
}
