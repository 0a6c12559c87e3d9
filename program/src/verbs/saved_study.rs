//! A saved study in the words of the command line.

use excavator_study::recording_files::RecordingFile;
use excavator_study::{StudyFile, StudyOptions};

use crate::cli::{Extent, Mapping, ModelChoice, OwnEffects, Recordings};

/// How the model and the recordings were named.
pub fn options(model: &ModelChoice, recordings: &Recordings) -> StudyOptions {
    let mapping = recordings.mapping.clone();
    StudyOptions {
        model: model.model.clone(),
        catalogue: model.own.catalogue.clone(),
        map: mapping.map,
        namespace: mapping.namespace,
        accept: mapping.accept,
        conditions: mapping.conditions,
        leave_out_stops: mapping.leave_out_stops,
        whole: recordings.extent.whole,
    }
}

/// The model of a study.
pub fn model(study: &StudyFile) -> ModelChoice {
    let options = &study.options;
    ModelChoice { model: options.model.clone(), own: OwnEffects { catalogue: options.catalogue.clone() } }
}

/// The recordings of a study.
pub fn recordings(study: &StudyFile) -> Recordings {
    let options = study.options.clone();
    let paths = |files: &[RecordingFile]| files.iter().map(|file| file.path.clone()).collect();
    Recordings {
        identification: paths(&study.identification),
        validation: paths(&study.validation),
        mapping: Mapping {
            map: options.map,
            namespace: options.namespace,
            accept: options.accept,
            conditions: options.conditions,
            leave_out_stops: options.leave_out_stops,
        },
        extent: Extent { whole: options.whole },
    }
}
