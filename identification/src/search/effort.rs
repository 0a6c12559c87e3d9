//! How much a search tries. More effort can find more. It never changes the criteria of the decision.

use crate::fit::FitSettings;

/// Limits of a search. Improvements here are decreases of the fit's own loss ([`crate::fit::Fit::loss`]) on the
/// identification recordings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Settings of the fits of all hypotheses.
    pub fit: FitSettings,
    /// Largest number of further steps in the fit of the favoured hypothesis, if those of `fit` were not enough.
    pub settling_steps: usize,
    /// Largest number of effects in one hypothesis. \[B\] adds five to its preliminary model, and its valve has a play; one more
    /// may be taken away in the end.
    pub most_effects: usize,
    /// Largest number of sets of the flow balances that are fitted to the whole machine.
    pub joined_sets: usize,
    /// Distance of the loss from that with an effect at which a fit without it is given up after four steps: the effect is
    /// needed. An improvement of 0.1 would be enough to attribute it.
    pub needed_beyond_doubt: f64,
    /// Largest number of hypotheses that are extended besides the best one, if that does not explain the recordings.
    pub most_second_beginnings: usize,
    /// Steps of each fit in the screening.
    pub screening_steps: usize,
    /// Share of the recordings on which candidates are screened: the stretches in which the model without them fails
    /// most. Half of the recordings costs half the time and leads to the same verdicts on the practice recordings.
    pub screening_share: f64,
    /// Number of candidates, the best of the screening, that are fitted to convergence.
    pub finalists: usize,
    /// All other candidates whose improvement in the screening is within this margin of the best are fitted too.
    pub finalist_margin: f64,
    /// Number of further candidates, the next best that have not converged in the screening, that are fitted if the
    /// best one leaves something unexplained.
    pub further_finalists: usize,
    /// The predicted improvement of a candidate's first step is trusted only if the loss of its start is within this
    /// distance of the model without it. Of 627 effects that were simulated on 40 blind machines this would have
    /// dropped 211. None of them was hidden in its machine.
    pub trusted_distance: f64,
    /// Number of starts of an addition that are simulated individually: the most promising ones according to one
    /// simulation of the model without additions.
    pub promised_starts: usize,
    /// If the best of these reaches less than this share of the predicted improvement, all starts are tried: the
    /// addition is too large for the linear prediction.
    pub least_reached_share: f64,
    /// If the best finalist explains less than this share of the misfit, all others are fitted too.
    pub little_share: f64,
    /// If the best finalist explains at least this share of the misfit and little more than noise remains, the
    /// screening ends. An effect similar to the right one can reach this share.
    pub most_share: f64,
    /// A rival is tried in place of a selected effect if it improved the fit by at least this share of that effect's
    /// improvement.
    pub rival_share: f64,
    /// Largest number of rivals that are tried in place of one effect.
    pub most_rivals: usize,
    /// Largest number of times that a better fit of the given model restarts the search.
    pub most_restarts: usize,
    /// Decrease of the loss from which another fit of the given model counts as better.
    pub restart_improvement: f64,
    /// A structural alternative is fitted if the predicted loss of its first step exceeds that of the replaced model by
    /// at most this much, or by half of what the replaced effect explains if that is more. A first step does not
    /// predict the full improvement.
    pub structural_distance: f64,
}

impl Default for Effort {
    fn default() -> Self {
        Effort {
            fit: FitSettings::default(),
            settling_steps: 40,
            most_effects: 7,
            joined_sets: 2,
            needed_beyond_doubt: 1.0,
            most_second_beginnings: 1,
            screening_steps: 3,
            screening_share: 0.5,
            finalists: 4,
            finalist_margin: 0.5,
            further_finalists: 6,
            trusted_distance: 1.2,
            promised_starts: 2,
            least_reached_share: 0.5,
            little_share: 0.25,
            most_share: 0.8,
            rival_share: 0.5,
            most_rivals: 4,
            most_restarts: 2,
            restart_improvement: 0.1,
            structural_distance: 0.5,
        }
    }
}
