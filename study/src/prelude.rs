//! Imports that most programs need: `use excavator_study::prelude::*;`.

pub use crate::diagnosis_file::DiagnosisFile;
pub use crate::profile_file::ProfileFile;
pub use crate::recording_part::Part;
pub use crate::recordings::{Use, checked, most_informative};
pub use crate::results::{
    Characterised, Compared, DesignOrder, Determined, Diagnosed, Energetic, IdentifiedResult, Outcome, Progress,
    Proposed, Refined, Separated,
};
pub use crate::simulated::simulate_profile;
pub use crate::{Study, StudyFile, StudyOptions, WorkError};
