//! Results for programs: what the verbs write as JSON, and what other front ends hand on.
//!
//! Each result is a type that is built `of` what the rest of this crate found. A part that is written as it was found is the type of
//! that place itself. The description of a field is also its description in the
//! JSON schema ([`schemas()`]) and on the reference page. Units are SI units and stand in the description; a number without one is a pure
//! number. JSON has no `NaN`: a number that is not known, or not finite, is `null`.
//!
//! Programs that read results must let pass what they do not know: fields may be added.

mod by_opening;
mod candidate;
mod change;
mod characterisation;
mod comparison;
mod determination;
mod diagnosis;
mod energies;
mod energy;
mod energy_budget;
mod energy_traces;
mod estimate;
mod friction;
mod gain;
mod given_value;
mod guess;
mod identification;
mod missing_power;
mod parameter;
mod plan;
mod proposals;
mod refinement;
mod schemas;
mod separation;
mod signal;
#[cfg(test)]
mod tests;
mod thinning;
mod unexplained;
mod valve_leakage;

pub use by_opening::{ByOpening, MeanPowers};
pub use candidate::{Bootstrap, Candidate};
pub use change::{Change, ChangedParameter};
pub use characterisation::{Characterisation, CylinderCharacterisation};
pub use comparison::{Baseline, Baselines, Comparison, OtherComparison};
pub use determination::Determination;
pub use diagnosis::{
    Construction, Diagnosis, ErrorChange, Instrument, Nuisance, Remains, ResidualShare, SelectedEffect,
};
pub use energies::{CylinderEnergies, EffectEnergies, Energies};
pub use energy::{Cycle, Energy, LedgerCondition, LedgerPlace, PumpLine, ValveSection};
pub use energy_budget::{EnergyBudget, EnergyBudgetLine};
pub use energy_traces::{EnergyTrace, PowerTrace};
pub use estimate::{Estimate, Outcome, Refused};
pub use friction::{Friction, FrictionTerm};
pub use gain::{DeadZone, Gain, GainPoint, Polynomial};
pub use given_value::GivenValue;
pub use guess::Guess;
pub use identification::{Companion, ConditionNumbers, Identification, NotIdentified, ProfileBounds};
pub use missing_power::{MissingPower, RecordingLedger};
pub use parameter::Parameter;
pub use plan::{Manoeuvre, Plan};
pub use proposals::{Proposal, Proposals};
pub use refinement::{Refinement, RefinementStep};
pub use schemas::schemas;
pub use separation::{Rival, Separation};
pub use signal::{Correlation, PhaseShare, SignalComparison};
pub use thinning::thinned;
pub use unexplained::Unexplained;
pub use valve_leakage::{ChamberLeakage, ValveLeakage};

use crate::nullable::finite;
