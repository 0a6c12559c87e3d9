//! Adds an effect of its own to the catalogue, from outside the crates, and simulates a machine with it.
//!
//! Most laws need no Rust: `docs/own-physics.md` says how to write one as a formula. Rust is for what a formula cannot say, such as a
//! law that looks at the whole machine.

mod tool_drag;

use std::sync::Arc;

use excavator_model::document::{DocumentError, built_in};
use excavator_model::effects::{Catalogue, TwiceInCatalogue};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Profile, RunError, Segment, Tolerances, simulate_from_rest};
use excavator_model::{Model, ModelError};

use tool_drag::ToolDrag;

/// What can go wrong here.
#[derive(Debug, thiserror::Error)]
enum ExampleError {
    #[error(transparent)]
    Document(#[from] DocumentError),
    #[error(transparent)]
    Catalogue(#[from] TwiceInCatalogue),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Run(#[from] RunError),
}

fn main() -> Result<(), ExampleError> {
    let catalogue = Catalogue::built_in().with([Arc::new(ToolDrag) as _])?;
    let plain = Model { catalogue, ..built_in("zx30u-arm")? };
    let mut dragged = plain.clone();
    for (physics, site) in plain.parse_addition("tool_drag@arm")? {
        dragged = dragged.with_effect(&physics, site)?;
    }
    println!("{}", dragged.parameter_names().last().map_or("", String::as_str));
    let drive = drive();
    for model in [&plain, &dragged] {
        let recording = simulate_from_rest(model, &drive, &[0.0], Tolerances::default())?;
        let reached = recording.signal("arm.displacement").and_then(<[f64]>::last).copied().unwrap_or(f64::NAN);
        println!("{} effects: {:.1} mm after {} samples", model.effects.len(), 1e3 * reached, recording.len());
    }
    Ok(())
}

/// Two seconds at 500 Hz with an opening of 90 mm² towards the cap side.
fn drive() -> Recording {
    let segments = vec![Segment::Hold { duration: 2.0, area: 9e-5 }];
    let profile = Profile { cylinder: "arm".into(), segments };
    let time: Vec<f64> = (0..1000).map(|sample| 2e-3 * f64::from(sample)).collect();
    let mut recording = Recording::unmeasured("drive", time, &["arm"]);
    Profile::command(&[profile], &mut recording);
    recording
}
