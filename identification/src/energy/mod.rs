//! Computes where the energy of a recording went, and whether the model's ledger closes (\[A\] Section 5, Eq. 9-12).
//!
//! The effect code that drives the simulation is also evaluated on the measured state. Three rates of the Hamiltonian are
//! compared as in \[A\] Figure 10: *experimental* (slope of the energy stored in the measured state), *analytical* (supply and
//! dissipation of Eq. 10-12 at the measured state) and *numerical* (the same at the simulated state).
//!
//! Beyond \[A\], the ledger is kept at every place where the model has an equation ([`Place`]): in the motion of the links, in
//! each chamber, and in the pump line. The missing power there is compared with sensor noise and with the standard errors of the
//! model's parameters, window by window. A ledger that does not close therefore identifies the equation.
//!
//! Recordings come in blocks of any length ([`Analyser::push`]); memory does not grow with the length of the recording.

mod analyser;
mod analysis;
mod block;
mod books;
mod budget;
mod by_opening;
mod cycle;
mod error;
mod judgement;
mod ledgers;
mod missing_power;
mod noise;
mod phase_criterion;
mod place;
mod regime;
mod settings;
mod smoothing;
mod totals;
mod traces;
mod windows;

pub(crate) use smoothing::Parabola;

pub use analyser::{Analyser, analyse};
pub use analysis::{Cycle, EnergyAnalysis, PhaseDelays, PumpLine, Section, WindowPoint};
pub use books::{Books, CylinderBooks, EffectBooks};
pub use budget::{Budget, BudgetLine, BudgetShare, CycleBudget};
pub use by_opening::ByOpening;
pub use error::EnergyError;
pub use judgement::{PlaceJudgement, RegimeJudgement};
pub use ledgers::ledgers;
pub use missing_power::{MissingPower, missing_power};
pub use phase_criterion::PhaseCriterion;
pub use place::Place;
pub use regime::Regime;
pub use settings::EnergySettings;
pub use totals::{CylinderTotals, EffectTotal, Totals};
pub use traces::{Band, CylinderTraces, TermTrace, Traces};
