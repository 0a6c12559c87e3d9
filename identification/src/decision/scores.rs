//! The input of a verdict: plain data, without models or recordings.

use serde::{Deserialize, Serialize};

/// Version of the stored form; a reader rejects any other.
pub const FORMAT: u32 = 1;

/// The scores of all hypotheses of one search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct Scores {
    /// [`FORMAT`].
    pub format: u32,
    /// Name of the machine.
    pub machine: String,
    /// The recordings that parameters were fitted to.
    pub identification: Side,
    /// The recordings that evidence is taken from.
    pub validation: Side,
    /// The given model first, its parameters refitted; then every hypothesis in the order in which it was tried.
    pub hypotheses: Vec<Hypothesis>,
}

/// One kind of recordings: what was compared, and how often.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Side {
    /// Longest sample interval among the recordings, s.
    pub sample_interval_s: f64,
    /// The instruments that were compared.
    pub instruments: Vec<InstrumentScale>,
    /// Error variance that the readings of the inputs alone leave, over the variance of the instrument's noise, for each
    /// instrument: no model can be better. Empty where it was not asked for.
    pub input_floor: Vec<f64>,
    /// Blocks of half a second, in order.
    pub blocks: Vec<Block>,
}

/// The scales of one instrument.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InstrumentScale {
    /// Contract name: `arm.displacement`, `pump_pressure`.
    pub name: String,
    /// SI unit of the two numbers below.
    pub unit: String,
    /// Standard deviation of its noise.
    pub noise: f64,
    /// Standard deviation of the signal itself, of the recording in which it is largest.
    pub spread: f64,
}

/// A stretch of half a second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Number of the recording.
    pub recording: usize,
    /// Where it begins, s after the recording's first sample.
    pub begin_s: f64,
    /// Readings of each instrument that were compared.
    pub readings: Vec<usize>,
}

/// A model that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct Hypothesis {
    /// Effects that the given model has not, in the order in which they were selected.
    pub effects: Vec<EffectScore>,
    /// Nuisance effects that differ from nothing, `effect@place`.
    pub nuisances: Vec<String>,
    /// On the recordings it was fitted to.
    pub identification: Misfit,
    /// On the others.
    pub validation: Misfit,
    /// Whether what every machine has (masses, flow gains, bulk modulus) stays near the data sheet. Scores that were stored before
    /// this was asked count as plausible.
    #[serde(default = "plausible")]
    pub is_plausible: bool,
    /// Unknown parameters of the whole model.
    pub parameter_count: usize,
    /// Wall-clock time of its fit, s.
    pub seconds: f64,
}

fn plausible() -> bool {
    true
}

/// Squared errors of one hypothesis on one kind of recordings.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Misfit {
    /// For each block and instrument: mean squared error over the variance of the instrument's noise; 1 is noise alone, 0 where
    /// nothing was read.
    pub error_ratios: Vec<Vec<f32>>,
}

/// One effect of a hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EffectScore {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of the place: a cylinder, `pump` or `machine`.
    pub place: String,
    /// Whether a verdict may name it.
    pub role: Role,
    /// Whether it acts in a window of time that belongs to one recording.
    pub is_transient: bool,
    /// Whether an effect of this size says anything about a machine.
    pub is_practically_significant: bool,
    /// Whether the recordings were on both sides of the threshold or of the window in which it acts.
    pub is_seen_from_both_sides: bool,
    /// Its parameters.
    pub parameters: Vec<ParameterScore>,
}

/// Whether a verdict may name an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A candidate of the catalogue.
    Candidate,
    /// How the machine is built, which anybody can see: compared with the candidates, never named.
    Structural,
}

/// A parameter with its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterScore {
    /// Name in the model: `arm.dead_zone`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Fitted value.
    pub value: f64,
    /// Half of its 95 % interval; none where it was not fitted or the recordings do not show it.
    pub margin_95: Option<f64>,
    /// The bound at which it ended, if it did.
    pub at_bound: Option<Bound>,
}

/// A bound of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The least value that is physically possible.
    Lower,
    /// The largest plausible value.
    Upper,
}

/// Why scores cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScoresError {
    /// The text is not the expected JSON.
    #[error("not the scores of a diagnosis: {0}")]
    Json(#[from] serde_json::Error),
    /// Written by another version.
    #[error("scores of format {found}; this program reads format {FORMAT}: run the diagnosis again")]
    Format {
        /// The format of the file.
        found: u32,
    },
    /// The number of blocks or instruments differs between a hypothesis and its recordings.
    #[error(
        "hypothesis {hypothesis} has {found} error ratios on the {side} recordings, which have {expected}: the file is damaged"
    )]
    Shape {
        /// Its number.
        hypothesis: usize,
        /// `identification` or `validation`.
        side: &'static str,
        /// Ratios found.
        found: usize,
        /// Blocks times instruments.
        expected: usize,
    },
    /// There is no hypothesis, not even the given model.
    #[error("scores without any hypothesis: run the diagnosis again")]
    Empty,
}

impl Scores {
    /// Reads the output of `diagnose --scores`.
    ///
    /// # Errors
    /// [`ScoresError`].
    pub fn from_json(text: &str) -> Result<Self, ScoresError> {
        #[derive(Deserialize)]
        struct Version {
            format: u32,
        }
        let Version { format } = serde_json::from_str(text)?;
        if format != FORMAT {
            return Err(ScoresError::Format { found: format });
        }
        let scores: Scores = serde_json::from_str(text)?;
        scores.checked()
    }

    /// Checks that every hypothesis has as many error ratios as its recordings have blocks and instruments.
    ///
    /// # Errors
    /// [`ScoresError`].
    pub fn checked(self) -> Result<Self, ScoresError> {
        if self.hypotheses.is_empty() {
            return Err(ScoresError::Empty);
        }
        for (number, hypothesis) in self.hypotheses.iter().enumerate() {
            let sides = [
                ("identification", &self.identification, &hypothesis.identification),
                ("validation", &self.validation, &hypothesis.validation),
            ];
            for (name, side, misfit) in sides {
                let instruments = side.instruments.len();
                let is_whole = misfit.error_ratios.len() == side.blocks.len()
                    && misfit.error_ratios.iter().all(|block| block.len() == instruments)
                    && side.blocks.iter().all(|block| block.readings.len() == instruments);
                if !is_whole {
                    let found = misfit.error_ratios.iter().map(Vec::len).sum();
                    let expected = side.blocks.len() * instruments;
                    return Err(ScoresError::Shape { hypothesis: number, side: name, found, expected });
                }
            }
        }
        Ok(self)
    }

    /// The given model, refitted.
    pub fn given(&self) -> &Hypothesis {
        &self.hypotheses[0]
    }
}

impl Hypothesis {
    /// Whether it adds the effect.
    pub fn has(&self, effect: &EffectScore) -> bool {
        self.effects.iter().any(|own| own.is_same(effect))
    }

    /// Whether it adds all effects of `other`, and more.
    pub fn extends(&self, other: &Hypothesis) -> bool {
        self.effects.len() > other.effects.len() && other.effects.iter().all(|effect| self.has(effect))
    }

    /// Whether one of its effects is structural.
    pub fn is_structural(&self) -> bool {
        self.effects.iter().any(|effect| effect.role == Role::Structural)
    }

    /// Whether one of its effects acts in a window of time.
    pub fn is_transient(&self) -> bool {
        self.effects.iter().any(|effect| effect.is_transient)
    }
}

impl EffectScore {
    /// Whether both are the same effect at the same place; parameters do not matter.
    pub fn is_same(&self, other: &EffectScore) -> bool {
        self.effect == other.effect && self.place == other.place
    }

    /// `effect@place`.
    pub fn name(&self) -> String {
        format!("{}@{}", self.effect, self.place)
    }
}
