//! Manoeuvres that separate effects, or show a parameter.

use std::collections::BTreeMap;

use excavator_identification::design::{
    DesignSettings, ParameterDesign, Plan, Rival, SeparationDesign, determine, separate,
};
use excavator_model::Model;
use excavator_model::simulation::Profile;
use serde_json::Value;

use super::{Outcome, Progress};
use crate::WorkError;
use crate::diagnosis_file::DiagnosisFile;
use crate::json::{determination_json, separation_json};
use crate::numbers::number;
use crate::profile_file::{ProfileFile, usual_rate};

/// What a design is for, and what it must keep to.
#[derive(Debug, Clone)]
pub struct DesignOrder {
    /// Effects to separate; for a parameter, effects that the model is to have besides.
    pub between: Vec<String>,
    /// Longest profile, s.
    pub duration: f64,
    /// Share of the stroke that is kept free at each end.
    pub stroke_margin: f64,
    /// Highest pressure anywhere, Pa.
    pub highest_pressure: f64,
}

impl DesignOrder {
    /// The model with what a diagnosis estimated besides, and the settings.
    fn prepared(&self, model: &Model, diagnosis: Option<&DiagnosisFile>) -> Result<(Model, DesignSettings), WorkError> {
        let model = diagnosis.map_or_else(|| Ok(model.clone()), |file| file.with_nuisances(model))?;
        let mut settings = DesignSettings::usual(&model.machine);
        settings.duration = self.duration;
        settings.limits.stroke_margin = self.stroke_margin;
        settings.limits.highest_pressure = self.highest_pressure;
        if let Some(file) = diagnosis {
            file.noise_into(&mut settings.sensors);
        }
        Ok((model, settings))
    }
}

/// Result of `design --between`.
pub struct Separated {
    model: Model,
    design: SeparationDesign,
}

impl Separated {
    /// Designs a profile between rivals: those of the order, else those that the diagnosis left tied.
    ///
    /// # Errors
    /// [`WorkError::Design`], [`WorkError::NoTie`].
    pub fn of(
        model: &Model,
        order: &DesignOrder,
        diagnosis: Option<&DiagnosisFile>,
        progress: Progress<'_>,
    ) -> Result<Self, WorkError> {
        let (model, settings) = order.prepared(model, diagnosis)?;
        let names = match (order.between.as_slice(), diagnosis) {
            ([], Some(file)) => file.tied()?,
            (names, _) => names.to_vec(),
        };
        let mut rivals = Rival::named(&model, &names)?;
        // Only values of all rivals from one diagnosis make them as alike as the recordings did.
        let fitted = diagnosis.is_some_and(|file| rivals.iter().all(|rival| file.has(&rival.name)));
        if let Some(file) = diagnosis {
            rivals.iter_mut().for_each(|rival| rival.set(file.values(&rival.name)));
        }
        let design = separate(rivals, fitted, &settings, progress)?;
        Ok(Separated { model, design })
    }
}

/// What is expected of each pair, a line each.
pub fn expectations(design: &SeparationDesign) -> Vec<String> {
    let one = design.pairs.iter().map(|pair| {
        format!(
            "{} from {}: expected improvement {:.2} ({:.1} standard errors), {}",
            pair.first,
            pair.second,
            pair.expected_improvement,
            pair.expected_significance,
            if pair.separated { "separated" } else { "not separated" }
        )
    });
    one.collect()
}

impl Outcome for Separated {
    fn json(&self) -> Value {
        separation_json(&self.design, None)
    }

    fn sentence(&self) -> String {
        let separated = self.design.pairs.iter().filter(|pair| pair.separated).count();
        let pairs = self.design.pairs.len();
        format!(
            "A profile of {:.1} s is expected to separate {separated} of {pairs} {}.",
            self.design.plan.duration,
            if pairs == 1 { "pair" } else { "pairs" }
        )
    }

    fn file(&self) -> Result<Option<String>, WorkError> {
        if !self.design.any_separated() {
            return Ok(None);
        }
        profile_text(&self.model, &self.design.profiles, &self.design.plan, expectations(&self.design)).map(Some)
    }
}

/// Result of `design --parameter`.
pub struct Determined {
    model: Model,
    design: ParameterDesign,
}

impl Determined {
    /// Designs a profile that shows one parameter.
    ///
    /// # Errors
    /// [`WorkError::Design`].
    pub fn of(
        model: &Model,
        parameter: &str,
        order: &DesignOrder,
        diagnosis: Option<&DiagnosisFile>,
        progress: Progress<'_>,
    ) -> Result<Self, WorkError> {
        let (model, settings) = order.prepared(model, diagnosis)?;
        let mut rival = Rival { name: "none".into(), addition: None, model };
        for one in &order.between {
            for more in Rival::named(&rival.model, std::slice::from_ref(one))? {
                rival = more;
            }
        }
        if let Some(file) = diagnosis {
            rival.set(file.values(&rival.name));
        }
        let design = determine(&rival.model, parameter, &settings, progress)?;
        Ok(Determined { model: rival.model, design })
    }
}

impl Outcome for Determined {
    fn json(&self) -> Value {
        determination_json(&self.design, None)
    }

    fn sentence(&self) -> String {
        format!(
            "A profile of {:.1} s is expected to determine {} to within {:.1} % (one standard error).",
            self.design.plan.duration,
            self.design.name,
            100.0 * (self.design.trial_run_error / self.design.value).abs()
        )
    }

    fn file(&self) -> Result<Option<String>, WorkError> {
        if !self.design.determined {
            return Ok(None);
        }
        let design = &self.design;
        let expectation = format!(
            "{}: expected standard error {} {} of {}",
            design.name,
            number(design.trial_run_error),
            design.unit,
            number(design.value)
        );
        profile_text(&self.model, &design.profiles, &design.plan, vec![expectation]).map(Some)
    }
}

/// The profile file.
///
/// # Errors
/// [`WorkError::ProfileWrite`].
pub fn profile_text(
    model: &Model,
    profiles: &[Profile],
    plan: &Plan,
    expectation: Vec<String>,
) -> Result<String, WorkError> {
    let file = ProfileFile { rate: usual_rate(), start: BTreeMap::new(), profiles: profiles.to_vec() };
    let mut comment = vec![format!(
        "Proposed by `excavator design` for {}: {:.1} s from rest at mid-stroke. Areas in m2, times in s.",
        model.machine.name, plan.duration
    )];
    comment.extend(plan.chosen.iter().map(|(name, start)| format!("{start:6.1} s  {name}")));
    comment.extend(expectation);
    file.text(&comment)
}
