//! The ledger as evidence of what a model is missing.

use excavator_model::Model;
use serde::{Deserialize, Serialize};

use super::{EnergyAnalysis, Place, PlaceJudgement, Regime, RegimeJudgement};

/// Power that is lost, or appears, at one equation of a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissingPower {
    /// Cylinder; `None` for the pump line, or where several joints share an equation.
    pub cylinder: Option<String>,
    /// Name of the equation: `arm.cap_continuity`.
    pub equation: String,
    /// The condition under which it is most significant.
    pub regime: Regime,
    /// Mean power, W; negative: lost, positive: appears without a source.
    pub mean: f64,
    /// Root mean square of the power, W: a fit hides the mean of a missing effect, but not its size.
    pub size: f64,
    /// The power of largest magnitude in one window, W; negative: lost.
    pub peak: f64,
    /// Size that noise, the parameters' errors and the tolerance explain, W.
    pub band: f64,
    /// The size as a share of the power that flows through the place.
    pub share_of_flow: f64,
    /// Summary in one sentence.
    pub sentence: String,
}

/// The places with more missing power than noise explains, most significant first; empty if the ledger closes.
pub fn missing_power(model: &Model, analysis: &EnergyAnalysis) -> Vec<MissingPower> {
    let mut found: Vec<(f64, MissingPower)> = analysis
        .places
        .iter()
        .filter_map(|judgement| {
            let worst = judgement.worst()?;
            Some((worst.size / worst.band, evidence(model, judgement, worst)))
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(_, evidence)| evidence).collect()
}

fn evidence(model: &Model, judgement: &PlaceJudgement, worst: &RegimeJudgement) -> MissingPower {
    let place = judgement.place;
    let cylinder = place.cylinder(model).and_then(|index| model.machine.cylinders.get(index));
    let cylinder = cylinder.map(|cylinder| cylinder.name.clone());
    let verb = if worst.peak < 0.0 { "go missing" } else { "appear without a source" };
    let sentence = format!(
        "{}, up to {} W {verb} {} ({} W root mean square, where {} W would be within the noise).",
        capitalised(worst.regime.words()),
        watts(worst.peak.abs()),
        whereabouts(place, cylinder.as_deref()),
        watts(worst.size),
        watts(worst.band),
    );
    MissingPower {
        cylinder,
        equation: place.equation(model),
        regime: worst.regime,
        mean: worst.mean,
        size: worst.size,
        peak: worst.peak,
        band: worst.band,
        share_of_flow: worst.size / worst.flow,
        sentence,
    }
}

fn whereabouts(place: Place, cylinder: Option<&str>) -> String {
    let of = cylinder.map_or(String::new(), |name| format!(" of the {name} cylinder"));
    match place {
        Place::Motion => format!("between the oil's pressure and the moving links{of}"),
        Place::CapContinuity(_) => format!("between the valve and the cap side chamber{of}"),
        Place::RodContinuity(_) => format!("between the valve and the rod side chamber{of}"),
        Place::PumpContinuity => "between the pump and the valve, in the pump line".to_string(),
    }
}

/// Watts to two significant digits.
fn watts(power: f64) -> String {
    let decimals = if power >= 10.0 {
        0
    } else if power >= 1.0 {
        1
    } else {
        2
    };
    format!("{power:.decimals$}")
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
