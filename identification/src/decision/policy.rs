//! Every number that can change a verdict.

/// The numbers of a verdict. Log error ratios are those of [`super::statistic`]: 0 is sensor noise alone, 0.7 twice its variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Policy {
    /// Up to this log error ratio what a model leaves counts as noise. 0.2 is 1.2 times the noise variance. Larger: weak effects are
    /// called noise. Smaller: a machine whose friction or servo differs a little from the equations is called unexplained.
    pub noise_margin: f64,
    /// Error beyond the noise, over the signal's variance, that nobody would act on: a hundredth of each signal's own size. Larger: effects
    /// of quiet machines go unseen. Smaller: very good sensors make every model inadequate.
    pub small_error: f64,
    /// Up to this log error ratio an error may be called small. An error of several times the noise has a cause that could be found.
    pub small_error_ceiling: f64,
    /// Above this error over the signal's variance nothing is called noise, and no coarse input excuses it: a tenth of each signal's
    /// own size is seen by anybody who looks at the plots.
    pub largest_error: f64,
    /// Fall of the log error ratio on the validation recordings that an effect must bring to be attributed. Smaller: small
    /// imperfections, which every model has, get names.
    pub least_improvement: f64,
    /// The same where the model is adequate without it. Machines have imperfections that no simulator has.
    pub least_improvement_when_adequate: f64,
    /// Standard errors by which an improvement must differ from zero, from stretch to stretch of the recordings. 3 keeps the chance of
    /// one false name among 30 candidates near 4 %, were it not for the least improvement.
    pub least_significance: f64,
    /// Chance with which the best hypothesis may be left out of the model confidence set. Larger: fewer ties, more wrong names.
    pub set_error: f64,
    /// What an attributed effect may leave: a log error ratio, or that share of what it explains. Several effects imitate more than one can,
    /// so each of n leaves an nth. Larger: effects outside the catalogue get the name of the one that resembles them most.
    pub largest_remainder: f64,
    /// A lead over another hypothesis that is less than this share of what the best one leaves is none: an error of unknown origin that is larger
    /// than a lead may as well have made it.
    pub doubtful_share: f64,
}

impl Default for Policy {
    fn default() -> Self {
        Policy {
            noise_margin: 0.2,
            small_error: 1.5e-4,
            small_error_ceiling: 1.0,
            largest_error: 0.01,
            least_improvement: 0.1,
            least_improvement_when_adequate: 0.2,
            least_significance: 3.0,
            set_error: 0.05,
            largest_remainder: 0.1,
            doubtful_share: 0.7,
        }
    }
}
