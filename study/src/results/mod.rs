//! Results of the verbs: computed once, then presented as JSON, as a sentence and as a page.

mod changed;
mod characterised;
mod compared;
mod designed;
mod diagnosed;
mod energetic;
mod identified;
mod proposed;
mod refined;

use excavator_model::Model;
use excavator_model::recording::Recording;

pub use changed::Changed;
pub use characterised::Characterised;
pub use compared::Compared;
pub use designed::{DesignOrder, Determined, Separated};
pub use diagnosed::Diagnosed;
pub use energetic::Energetic;
pub use identified::IdentifiedResult;
pub use proposed::Proposed;
pub use refined::Refined;

use crate::WorkError;

/// Receives the current action as text and its progress (0 to 1). It may be called from several threads.
pub type Progress<'p> = &'p (dyn Fn(&str, f64) + Sync);

/// Presentations of a result.
pub trait Outcome: Send + Sync {
    /// The content of `--json` if no other file was written.
    ///
    /// # Errors
    /// [`WorkError::Json`].
    fn json(&self) -> Result<String, WorkError>;

    /// The result in one sentence or two.
    fn sentence(&self) -> String;

    /// The page of `--report`; `None` for verbs without one.
    ///
    /// # Errors
    /// [`WorkError`] if the page needs a simulation that fails.
    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(None)
    }

    /// The model that the verb found; `None` for verbs that do not search for one.
    fn model(&self) -> Option<&Model> {
        None
    }

    /// The additional file of the verb besides its report: proposed laws or a profile (TOML).
    ///
    /// # Errors
    /// [`WorkError`] for numbers that TOML does not support.
    fn file(&self) -> Result<Option<String>, WorkError> {
        Ok(None)
    }

    /// Recordings that belong to the result, each with its role.
    fn recordings(&self) -> Vec<(&'static str, &Recording)> {
        Vec::new()
    }
}
