//! Result of `energy`.

use std::collections::BTreeMap;

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ByOpening, Energies, EnergyBudget, EnergyTrace, MissingPower, finite};
use crate::energy::{self, EnergyAnalysis, PhaseCriterion, PhaseDelays, Regime, missing_power};

/// Where the energy of a recording went, and whether the model's ledger closes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Energy {
    /// The recording.
    pub source: String,
    /// Samples that were read.
    pub samples: usize,
    /// Time from the first to the last of them, s.
    pub duration: Option<f64>,
    /// Gaps that were left out.
    pub gaps: usize,
    /// Where the delivered energy went, in one sum.
    pub budget: EnergyBudget,
    /// Energies over the recording.
    pub energy: Energies,
    /// Energies per cycle of the work; `null` where the command does not repeat.
    pub cycle: Option<Cycle>,
    /// By cylinder: mean powers by the sign of the valve's opening.
    pub by_opening: BTreeMap<String, ByOpening>,
    /// Balance of the pump line; `null` for a machine whose supply is not part of the model.
    pub pump_line: Option<PumpLine>,
    /// By cylinder, or by machine for all cylinders together: how far one rate of the stored energy lags behind another one.
    pub phase_delays_degrees: BTreeMap<String, PhaseDelays>,
    /// Whether these lags are small enough; `null` where no frequency of the excitation stands out.
    pub phase_criterion: Option<PhaseCriterion>,
    /// By cylinder, or by machine for all cylinders together: energy and powers over time.
    pub traces: BTreeMap<String, EnergyTrace>,
    /// The ledger, place by place.
    pub ledger: Vec<LedgerPlace>,
    /// Whether the ledger closes at every place.
    pub ledger_closes: bool,
    /// Power that is missing, most significant first; empty where the ledger closes.
    pub missing_power: Vec<MissingPower>,
    /// Why there are no numerical results; `null` where there are.
    pub simulation_failed: Option<String>,
    /// Whether parameters of the model carry standard errors; without, their part of the bands is zero.
    pub parameters_have_errors: bool,
}

/// Energies per cycle of the work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Cycle {
    /// Length of a cycle, s.
    pub period: Option<f64>,
    /// Whole cycles.
    pub count: usize,
    /// Means over the cycles.
    pub mean: Energies,
    /// Standard deviations from cycle to cycle.
    pub standard_deviation: Energies,
}

/// Balance of the pump line: `pump = bypass_loss + sum(metering_loss + into_cylinder) + stored - residual`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct PumpLine {
    /// Delivered by the pump, J.
    pub pump: Option<f64>,
    /// Lost through bypass, relief valve and leakage of the pump, J.
    pub bypass_loss: Option<f64>,
    /// The valve sections by cylinder.
    pub sections: BTreeMap<String, ValveSection>,
    /// Gain of the line's own energy, J.
    pub stored: Option<f64>,
    /// Gained without the model saying from where, J; negative: it went missing.
    pub residual: Option<f64>,
}

/// Share of one valve section in the balance of the pump line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ValveSection {
    /// Lost in the section, J.
    pub metering_loss: Option<f64>,
    /// Passed on to the cylinder, J.
    pub into_cylinder: Option<f64>,
}

/// The ledger at one place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct LedgerPlace {
    /// Name of the equation: `arm.motion`, `arm.cap_continuity`, `pump.continuity`.
    pub equation: String,
    /// Whether the ledger closes at this place, under every condition.
    pub closes: bool,
    /// Share of the windows that are outside their own band, 0 to 1.
    pub windows_outside: Option<f64>,
    /// By condition, where it was met: `always`, `extending`, `retracting`, `valve_closed`, `opening_stroke`, `closing_stroke`.
    pub conditions: BTreeMap<String, LedgerCondition>,
}

/// What is missing at a place under one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct LedgerCondition {
    /// Windows in which the condition was met.
    pub windows: usize,
    /// Mean power that is stored without the model saying from where, W; negative: it goes missing.
    pub mean: Option<f64>,
    /// Largest of the windows' powers by size, with its sign, W.
    pub peak: Option<f64>,
    /// Root mean square of the windows' powers, W.
    pub size: Option<f64>,
    /// Standard deviation of a window's power from sensor noise, W.
    pub noise: Option<f64>,
    /// Standard deviation from the parameters' standard errors, W.
    pub parameters: Option<f64>,
    /// Mean power that flows through the place, W.
    pub flow: Option<f64>,
    /// Largest size that is explained, W; `null` where windows are too few to judge.
    pub band: Option<f64>,
    /// Whether noise, the parameters' errors, rounding and the tolerance explain what is missing.
    pub explained: bool,
}

impl Energy {
    /// Of an analysis of a recording under `model`.
    pub fn of(model: &Model, analysis: &EnergyAnalysis) -> Self {
        let phases = analysis.traces.cylinders.iter();
        let phases = phases.filter_map(|trace| Some((trace.name.clone(), trace.phase?)));
        let traces = analysis.traces.cylinders.iter();
        let name = |cylinder: usize| model.machine.cylinders[cylinder].name.clone();
        Energy {
            source: analysis.source.clone(),
            samples: analysis.samples,
            duration: finite(analysis.duration),
            gaps: analysis.gaps,
            budget: EnergyBudget::of(model, analysis),
            energy: Energies::of(model, &analysis.totals, true),
            cycle: analysis.cycle.as_ref().map(|cycle| Cycle::of(model, cycle)),
            by_opening: analysis.by_opening.iter().map(|one| (name(one.cylinder), ByOpening::of(one))).collect(),
            pump_line: analysis.pump_line(model).as_ref().map(PumpLine::of),
            phase_delays_degrees: phases.collect(),
            phase_criterion: analysis.phase_criterion(),
            traces: traces.map(|trace| (trace.name.clone(), EnergyTrace::of(trace))).collect(),
            ledger: analysis.places.iter().map(|place| LedgerPlace::of(model, place)).collect(),
            ledger_closes: analysis.is_explained(),
            missing_power: missing_power(model, analysis).iter().map(MissingPower::of).collect(),
            simulation_failed: analysis.simulation_failed.clone(),
            parameters_have_errors: analysis.parameters_have_errors,
        }
    }
}

impl Cycle {
    fn of(model: &Model, cycle: &energy::Cycle) -> Self {
        Cycle {
            period: finite(cycle.period),
            count: cycle.count,
            mean: Energies::of(model, &cycle.mean, true),
            standard_deviation: Energies::of(model, &cycle.deviation, false),
        }
    }
}

impl PumpLine {
    fn of(line: &energy::PumpLine) -> Self {
        let sections = line.sections.iter().map(|section| {
            let share = ValveSection {
                metering_loss: finite(section.metering_loss),
                into_cylinder: finite(section.into_cylinder),
            };
            (section.cylinder.clone(), share)
        });
        PumpLine {
            pump: finite(line.pump),
            bypass_loss: finite(line.bypass_loss),
            sections: sections.collect(),
            stored: finite(line.stored),
            residual: finite(line.residual),
        }
    }
}

impl LedgerPlace {
    fn of(model: &Model, place: &energy::PlaceJudgement) -> Self {
        let met = Regime::ALL.iter().zip(&place.regimes).filter(|(_, judged)| judged.windows > 0);
        LedgerPlace {
            equation: place.place.equation(model),
            closes: place.is_explained(),
            windows_outside: finite(place.share_outside),
            conditions: met.map(|(regime, judged)| (regime.name().to_string(), LedgerCondition::of(judged))).collect(),
        }
    }
}

impl LedgerCondition {
    fn of(judged: &energy::RegimeJudgement) -> Self {
        LedgerCondition {
            windows: judged.windows,
            mean: finite(judged.mean),
            peak: finite(judged.peak),
            size: finite(judged.size),
            noise: finite(judged.noise),
            parameters: finite(judged.parameters),
            flow: finite(judged.flow),
            band: finite(judged.band),
            explained: judged.is_explained(),
        }
    }
}
