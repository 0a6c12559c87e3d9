//! JSON schemas of the results, derived from their types.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::json;

use super::{
    Change, Characterisation, Comparison, Determination, Diagnosis, Energy, Identification, Proposals, Refinement,
    Separation,
};

/// The JSON schema (draft 2020-12) of every result, by name. A name is that of the verb that writes it; `design` writes two.
pub fn schemas() -> Vec<(&'static str, Schema)> {
    vec![
        ("identify", schema::<Identification>("identify")),
        ("compare", schema::<Comparison>("compare")),
        ("characterise", schema::<Characterisation>("characterise")),
        ("energy", schema::<Energy>("energy")),
        ("diagnose", schema::<Diagnosis>("diagnose")),
        ("propose", schema::<Proposals>("propose")),
        ("refine", schema::<Refinement>("refine")),
        ("changed", schema::<Change>("changed")),
        ("design-separation", schema::<Separation>("design")),
        ("design-determination", schema::<Determination>("design --parameter")),
    ]
}

fn schema<T: JsonSchema>(verb: &str) -> Schema {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    schema.insert("title".into(), json!(format!("Result of excavator {verb} --json")));
    schema
}
