//! The types most programs need: `use excavator_model::prelude::*;`.
//!
//! Error types are not included: each step has its own, and `Box<dyn Error>` covers them all. Types that only the card of an
//! effect needs are not included either; they are in [`effects`](crate::effects).

pub use crate::document::built_in;
pub use crate::effects::{Catalogue, Physics, Site};
pub use crate::energy::{Accountant, Ledger, ledger};
pub use crate::equations::System;
pub use crate::machine::Machine;
pub use crate::recording::Recording;
pub use crate::simulation::{
    InputSignals, Integrator, Profile, Segment, Tolerances, rest_state, simulate, simulate_from_rest,
};
pub use crate::{Model, ModelEffect};
