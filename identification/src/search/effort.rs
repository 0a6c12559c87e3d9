//! How much a search tries. More effort finds more; it never changes how what was found is judged.

use crate::fit::FitSettings;

/// Limits of a search. Improvements here are falls of the fit's own loss ([`crate::fit::Fit::loss`]) on the identification recordings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Fits of all hypotheses.
    pub fit: FitSettings,
    /// Most further steps of the fit of the favoured hypothesis, where those of `fit` were not enough.
    pub settling_steps: usize,
    /// Most effects of one hypothesis: \[B\] adds five to its preliminary model.
    pub most_effects: usize,
    /// Most hypotheses that are extended beside the best, where that does not explain the recordings.
    pub most_second_beginnings: usize,
    /// Steps of a fit in the screening.
    pub screening_steps: usize,
    /// Share of the recordings on which candidates are screened, the stretches in which the model without them fails most. Half of
    /// them costs half the time and leads to the same verdicts on the practice recordings.
    pub screening_share: f64,
    /// So many candidates, the best of the screening, are fitted to the end.
    pub finalists: usize,
    /// And all others whose improvement in the screening is within this of the best.
    pub finalist_margin: f64,
    /// So many more, the next best that have not converged in the screening, where the best of them leaves something unexplained.
    pub further_finalists: usize,
    /// The first step of a candidate is trusted to foretell its improvement only where its start is no further than this from the model
    /// without it. Of 627 effects that ran on 40 blind machines this would have dropped 211: none was hidden in its machine.
    pub trusted_distance: f64,
    /// So many starts of an addition, the most promising by one simulation of the model without any, are simulated themselves.
    pub promised_starts: usize,
    /// Where the best of these brings less than this share of what was promised, all starts are tried: the addition is too large for the
    /// straight line that the promise was read from.
    pub borne_out: f64,
    /// Share of the misfit below which the best finalist does not end the screening: then all others are fitted too.
    pub little_share: f64,
    /// Share of the misfit from which on it does, where little more than noise remains. A twin of the right effect can reach this.
    pub most_share: f64,
    /// A rival is tried in the place of a selected effect where it improved at least this share of what that did.
    pub rival_share: f64,
    /// Most rivals that are tried in the place of one effect.
    pub most_rivals: usize,
    /// Times that a better fit of the given model begins the search anew.
    pub most_restarts: usize,
    /// Fall of the loss that makes another fit of the given model a better one.
    pub restart_improvement: f64,
    /// A structural alternative is fitted where its first step promises a loss at most this much above that of the model in whose place
    /// it stands, or half of what that explains, where that is more: a first step does not promise all.
    pub structural_distance: f64,
}

impl Default for Effort {
    fn default() -> Self {
        Effort {
            fit: FitSettings::default(),
            settling_steps: 40,
            most_effects: 5,
            most_second_beginnings: 1,
            screening_steps: 3,
            screening_share: 0.5,
            finalists: 4,
            finalist_margin: 0.5,
            further_finalists: 6,
            trusted_distance: 1.2,
            promised_starts: 2,
            borne_out: 0.5,
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
