//! The result of each verb: computed once, then told as JSON, as a sentence, and as a page.

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

pub use characterised::Characterised;
pub use compared::Compared;
pub use designed::{DesignOrder, Determined, Separated};
pub use diagnosed::Diagnosed;
pub use energetic::Energetic;
pub use identified::IdentifiedResult;
pub use proposed::Proposed;
pub use refined::Refined;

use crate::WorkError;

/// Told what is being done, in words, and the fraction that is done (0 to 1). It may be called from several threads.
pub type Progress<'p> = &'p (dyn Fn(&str, f64) + Sync);

/// What every result can tell.
pub trait Outcome: Send + Sync {
    /// The content of `--json`, where no file was written beside it.
    ///
    /// # Errors
    /// [`WorkError::Json`].
    fn json(&self) -> Result<String, WorkError>;

    /// The result in one sentence or two.
    fn sentence(&self) -> String;

    /// The page of `--report`; `None` for verbs without one.
    ///
    /// # Errors
    /// [`WorkError`] where the page needs a simulation that fails.
    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(None)
    }

    /// The model that the verb found; `None` for verbs that look for none.
    fn model(&self) -> Option<&Model> {
        None
    }

    /// The file that the verb writes beside its report: proposed laws or a profile (TOML).
    ///
    /// # Errors
    /// [`WorkError`] for numbers that TOML does not have.
    fn file(&self) -> Result<Option<String>, WorkError> {
        Ok(None)
    }

    /// Signals over time that belong to the result, by what they are.
    fn recordings(&self) -> Vec<(&'static str, &Recording)> {
        Vec::new()
    }
}
