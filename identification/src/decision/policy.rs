//! Every number that can change a verdict.

/// The numbers of a verdict. Log error ratios are those of [`super::statistic`]: 0 is sensor noise alone, 0.7 twice its variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Policy {
    /// Log error ratio up to which the error of a model counts as noise. 0.2 is 1.2 times the noise variance. Larger: weak
    /// effects are taken for noise. Smaller: a machine whose friction or servo differs a little from the equations counts as
    /// unexplained.
    pub noise_margin: f64,
    /// Error beyond the noise, over the signal's variance, that is too small to act on: a hundredth of each signal's own size.
    /// Larger: effects of quiet machines are missed. Smaller: very good sensors make every model inadequate.
    pub small_error: f64,
    /// Log error ratio up to which an error may count as small. An error of several times the noise has a cause that could be
    /// found.
    pub small_error_ceiling: f64,
    /// Error over the signal's variance above which nothing counts as noise and no coarse input is an excuse: a tenth of each
    /// signal's own size is obvious in the plots.
    pub largest_error: f64,
    /// Decrease of the log error ratio on the validation recordings that an attributed effect must bring. Smaller: small
    /// imperfections, which every model has, are attributed.
    pub least_improvement: f64,
    /// The same if the model is adequate without the effect. Real machines have imperfections that no simulator has.
    pub least_improvement_when_adequate: f64,
    /// Standard errors, from the scatter between stretches of the recordings, by which an improvement must differ from zero.
    /// Without the least improvement, 3 alone would keep the chance of one false attribution among 30 candidates near 4 %.
    pub least_significance: f64,
    /// The same over a hypothesis whose masses, gains or bulk modulus left the data sheet, while those of the larger one stay near
    /// it. Data sheets are rarely that wrong, so little more evidence is needed. Larger: a wrong bulk modulus hides entrained air.
    pub least_significance_over_implausible: f64,
    /// Probability with which the best hypothesis may be left out of the model confidence set. Larger: fewer ties, more wrong
    /// attributions.
    pub set_error: f64,
    /// Error that a set of attributed effects may leave: a log error ratio, or a share of the error before. Larger: effects
    /// outside the catalogue are attributed to the ones that resemble them most. Smaller: machines whose laws differ a little in
    /// form count as unexplained.
    pub largest_remainder: f64,
    /// A lead over another hypothesis below this share of the error that the best one leaves does not count: an error of unknown
    /// origin that exceeds the lead may have caused it.
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
            least_significance_over_implausible: 1.0,
            set_error: 0.05,
            largest_remainder: 0.1,
            doubtful_share: 0.7,
        }
    }
}
