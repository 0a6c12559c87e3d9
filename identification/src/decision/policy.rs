//! Every number that can change a verdict.

use serde::{Deserialize, Serialize};

/// The numbers of a verdict. Log error ratios are those of [`super::statistic`]: 0 is sensor noise alone, 0.7 twice its variance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    /// Share of an improvement that must show on the recordings that were fitted. An effect that helps only where nothing was fitted
    /// does so by chance.
    pub share_where_fitted: f64,
    /// Log error ratio on all recordings up to which nothing is left that another effect could explain: half of what it would have
    /// to bring.
    pub nothing_left: f64,
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
    /// A block whose error is this many times the noise variance counts as a bad moment of an adequate model. 4 is twice the noise.
    pub bad_moment: f64,
    /// Share of the named effects that were there, of those named alone, by two and by more by a verdict that leaves something
    /// unexplained. A law outside the catalogue is often imitated by one effect of it, or by two, and hardly by three. From stored
    /// machines (`docs/blind-benchmark.md`): 3 of 31, 3 of 18 and 10 of 11.
    pub trust_when_unexplained: [f64; 3],
    /// Mean squared residual of a balance, over the variance of its noise, up to which a remainder is noise. Right models leave 0.3
    /// to 1.3 at 500 Hz.
    pub noise_in_balance: f64,
    /// Share of the misfit from which a single effect is called most of what is missing.
    pub most_of_misfit: f64,
    /// Share of a balance's residual that one variable must explain, so that what an effect leaves is called another form of it.
    pub share_of_a_law: f64,
    /// The same, so that the variable is named at all.
    pub share_of_a_variable: f64,
    /// Smallest change of a parameter between two sets of recordings that counts, relative to the larger of both values: sensors
    /// and oil of one machine differ by less on the same day.
    pub least_change: f64,
    /// Standard errors of its difference by which a parameter must change. With twenty parameters, chance makes one such change
    /// in a thousand comparisons.
    pub least_significance_of_change: f64,
}

impl Default for Policy {
    fn default() -> Self {
        Policy {
            noise_margin: 0.2,
            small_error: 1.5e-4,
            small_error_ceiling: 1.0,
            largest_error: 0.01,
            least_improvement: 0.1,
            share_where_fitted: 0.5,
            nothing_left: 0.05,
            least_improvement_when_adequate: 0.2,
            least_significance: 3.0,
            least_significance_over_implausible: 1.0,
            set_error: 0.05,
            largest_remainder: 0.1,
            doubtful_share: 0.7,
            bad_moment: 4.0,
            trust_when_unexplained: [0.08, 0.2, 0.85],
            noise_in_balance: 2.0,
            most_of_misfit: 0.7,
            share_of_a_law: 0.5,
            share_of_a_variable: 0.1,
            least_change: 0.05,
            least_significance_of_change: 4.0,
        }
    }
}
