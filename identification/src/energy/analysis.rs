//! Results of an energy analysis.

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ByOpening, PhaseCriterion, PlaceJudgement, Totals, Traces};
use crate::nullable::Nullable;

/// Energies per cycle of the work.
#[derive(Debug, Clone, PartialEq)]
pub struct Cycle {
    /// Length of a cycle, s.
    pub period: f64,
    /// Whole cycles.
    pub count: usize,
    /// Mean over the cycles.
    pub mean: Totals,
    /// Standard deviation from cycle to cycle.
    pub deviation: Totals,
}

/// By how many degrees one rate of the stored energy lags behind another one at the frequency of the excitation. `null` where one of
/// them has no component there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PhaseDelays {
    /// Frequency, Hz.
    #[serde(with = "Nullable")]
    pub frequency: f64,
    /// Analytical behind experimental, degrees.
    pub analytical: Option<f64>,
    /// Numerical behind experimental, degrees.
    pub numerical: Option<f64>,
    /// Numerical behind analytical, degrees.
    pub numerical_behind_analytical: Option<f64>,
}

impl PhaseDelays {
    /// All lags, degrees.
    pub(super) fn all(&self) -> [Option<f64>; 3] {
        [self.analytical, self.numerical, self.numerical_behind_analytical]
    }

    /// The largest magnitude, degrees.
    pub fn largest(&self) -> Option<f64> {
        self.all().into_iter().flatten().map(f64::abs).max_by(f64::total_cmp)
    }
}

/// Missing power in one window.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowPoint {
    /// Centre of the window, s.
    pub time: f64,
    /// Power stored at each place without a source in the model, W.
    pub residuals: Vec<f64>,
    /// Half width of the band within which the residual is explained, W.
    pub bands: Vec<f64>,
}

/// Energies of one valve section in the balance of the pump line, J.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Name of its cylinder.
    pub cylinder: String,
    /// Lost in the section.
    pub metering_loss: f64,
    /// Passed on to the cylinder.
    pub into_cylinder: f64,
}

/// Balance of the pump line: `pump = bypass_loss + sum(metering_loss + into_cylinder) + stored - residual`, J.
#[derive(Debug, Clone, PartialEq)]
pub struct PumpLine {
    /// Delivered by the pump.
    pub pump: f64,
    /// Lost through bypass, relief valve and pump leakage.
    pub bypass_loss: f64,
    /// One entry per cylinder with a valve.
    pub sections: Vec<Section>,
    /// Gain of the line's own energy.
    pub stored: f64,
    /// Gained without a source in the model; negative: lost.
    pub residual: f64,
}

/// The energy of one recording under one model.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyAnalysis {
    /// The recording.
    pub source: String,
    /// Samples read.
    pub samples: usize,
    /// Time from the first to the last of them, s.
    pub duration: f64,
    /// Gaps that were skipped.
    pub gaps: usize,
    /// Energies over the recording.
    pub totals: Totals,
    /// The same by the sign of each cylinder's opening.
    pub by_opening: Vec<ByOpening>,
    /// Energies per cycle, if the command repeats.
    pub cycle: Option<Cycle>,
    /// The ledger of each place.
    pub places: Vec<PlaceJudgement>,
    /// Missing power over time; thinned in recordings of many hours.
    pub windows: Vec<WindowPoint>,
    /// Traces over time for the head of the recording.
    pub traces: Traces,
    /// Why there are no numerical results.
    pub simulation_failed: Option<String>,
    /// Whether parameters of the model have standard errors; without them, their part of the bands is zero.
    pub parameters_have_errors: bool,
}

impl EnergyAnalysis {
    /// The balance of the pump line; `None` if the supply is not part of the model.
    pub fn pump_line(&self, model: &Model) -> Option<PumpLine> {
        if !matches!(model.machine.supply, excavator_model::machine::Supply::PumpLine(_)) {
            return None;
        }
        let sections = model.machine.cylinders.iter().zip(&self.totals.cylinders);
        Some(PumpLine {
            pump: self.totals.pump,
            bypass_loss: self.totals.bypass_loss(),
            sections: sections
                .filter(|(cylinder, _)| cylinder.chambers.is_some())
                .map(|(cylinder, totals)| Section {
                    cylinder: cylinder.name.clone(),
                    metering_loss: totals.metering_loss,
                    into_cylinder: totals.supplied,
                })
                .collect(),
            stored: self.totals.pump_line,
            residual: self.totals.pump_residual(),
        })
    }

    /// Whether the three rates of the stored energy agree in phase; `None` if no frequency of the excitation stands out.
    pub fn phase_criterion(&self) -> Option<PhaseCriterion> {
        PhaseCriterion::of(self.traces.cylinders.iter().filter_map(|trace| trace.phase.as_ref()))
    }

    /// Whether the ledger closes at every place.
    pub fn is_explained(&self) -> bool {
        self.places.iter().all(PlaceJudgement::is_explained)
    }
}
