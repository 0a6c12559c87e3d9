//! Manoeuvres that separate effects or determine a parameter.

use excavator_identification::design::{DesignSettings, ParameterDesign, Rival, SeparationDesign, determine, separate};
use excavator_identification::results;
use excavator_model::Model;

use super::{Outcome, Progress};
use crate::diagnosis_file::DiagnosisFile;
use crate::sentences::{determination_profile, determination_sentence, separation_profile, separation_sentence};
use crate::{WorkError, json_text};

/// Purpose and limits of a design.
#[derive(Debug, Clone)]
pub struct DesignOrder {
    /// Effects to separate; for a parameter, additional effects of the model.
    pub between: Vec<String>,
    /// Longest profile, s.
    pub duration: f64,
    /// Share of the stroke that is kept free at each end.
    pub stroke_margin: f64,
    /// Highest pressure anywhere, Pa.
    pub highest_pressure: f64,
}

impl DesignOrder {
    /// The model with the nuisance effects of a diagnosis, and the settings.
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
    /// Designs a profile between rivals: those of the order, or else those that are tied in the diagnosis.
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
        // Rivals are as similar as in the recordings only if one diagnosis has values for all of them.
        let fitted = diagnosis.is_some_and(|file| rivals.iter().all(|rival| file.has(&rival.name)));
        if let Some(file) = diagnosis {
            rivals.iter_mut().for_each(|rival| rival.set(file.values(&rival.name)));
        }
        let design = separate(rivals, fitted, &settings, progress)?;
        Ok(Separated { model, design })
    }

    /// The design.
    pub fn design(&self) -> &SeparationDesign {
        &self.design
    }

    /// The result for JSON, with the name of the written profile file.
    pub fn result(&self, profile: Option<&str>) -> results::Separation {
        results::Separation::of(&self.design, profile)
    }
}

impl Outcome for Separated {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&self.result(None))
    }

    fn sentence(&self) -> String {
        separation_sentence(&self.design)
    }

    fn file(&self) -> Result<Option<String>, WorkError> {
        let text = || separation_profile(&self.model, &self.design);
        self.design.any_separated().then(text).transpose()
    }
}

/// Result of `design --parameter`.
pub struct Determined {
    model: Model,
    design: ParameterDesign,
}

impl Determined {
    /// Designs a profile that determines one parameter.
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

    /// The design.
    pub fn design(&self) -> &ParameterDesign {
        &self.design
    }

    /// The result for JSON, with the name of the written profile file.
    pub fn result(&self, profile: Option<&str>) -> results::Determination {
        results::Determination::of(&self.design, profile)
    }
}

impl Outcome for Determined {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&self.result(None))
    }

    fn sentence(&self) -> String {
        determination_sentence(&self.design)
    }

    fn file(&self) -> Result<Option<String>, WorkError> {
        self.design.determined.then(|| determination_profile(&self.model, &self.design)).transpose()
    }
}
