//! Thresholds of a verdict, with their reasons.

use crate::fit::FitSettings;

/// Settings of a diagnosis. Losses are mean logarithms of squared error over noise variance: 0 is pure noise, 0.7 twice
/// the noise variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagnosisSettings {
    /// Fits of nominal and candidate models.
    pub fit: FitSettings,
    /// Least gain of validation loss that makes a candidate worth naming. An effect that lowers the mean squared error
    /// by less than a seventh cannot be told from the small errors that every model has.
    pub least_gain: f64,
    /// The same where the model is adequate already: an effect that acts in a few moments only can still halve its squared
    /// error. Where nothing is hidden no effect gains more than 0.02 on the recordings of three simulators, once instruments
    /// that are read apart are known for that; but machines have imperfections that no simulator has.
    pub least_gain_when_adequate: f64,
    /// Least number of standard errors by which that gain must differ from zero; 3 keeps the chance of one false name
    /// among 26 candidates near 3 %, were it not for the least gain.
    pub least_significance: f64,
    /// The same with the gain on the identification recordings, both together. An effect that acts in a few moments of a
    /// short validation recording can differ by so many standard errors only as it has moments; more recordings have more.
    pub least_joint_significance: f64,
    /// Candidates whose loss is within this of the best one's are tied with it, if they need no more parameters than that.
    pub tie_gain: f64,
    /// Candidates whose loss differs from the best one's by fewer standard errors are tied with it.
    pub tie_significance: f64,
    /// Candidates whose loss is within this share of what the best explanation leaves are tied with it: an error of unknown
    /// origin that is larger than a lead may as well have made it.
    pub doubtful_lead: f64,
    /// A model whose typical loss ([`crate::fit::Fit::typical_loss`]) is below this is adequate. 0.2 is 1.1 times the
    /// sensors' noise; the right model of one joint or two comes to -0.08 to 0.07 on the recordings of four simulators, and to 0.14
    /// where the servo or the rate of the commands is another than the spool's estimate takes it to be.
    pub adequate_loss: f64,
    /// Or its normalised mean squared error, mean over signals, is below this: a hundredth of each signal's own size,
    /// which nobody would act on.
    pub adequate_error: f64,
    /// Unless its typical loss is above this, 1.6 times the sensors' noise: ordinary imperfections (friction of another sharpness, a servo of second order)
    /// leave 0.75 at most on machines of other simulators that hide nothing; one spool that takes 2 % of the other's opening leaves 1.6, with an error of
    /// 1.2e-4.
    pub small_error_loss: f64,
    /// Below this normalised error, half a hundredth of each signal, sensors may be as quiet as they like.
    pub negligible_error: f64,
    /// A model whose normalised mean squared error on clear signals is above this is not adequate, however few moments it
    /// comes from: a sixth of each signal's own size is seen by anybody who looks at the plots.
    pub largest_error: f64,
    /// What the readings of the inputs leave open excuses a model up to this normalised mean squared error, a tenth of
    /// each signal's own size. Above it the recordings are too coarse to say that nothing is missing: at 50 Hz the right
    /// model of p00 comes to 0.005, a crane joint with a dead zone that is not in the model to 0.02 at 100 Hz.
    pub excused_error: f64,
    /// And where no instrument's typical loss is above this, its noise and sampling taken together. On p00 at 100 Hz and 50 Hz, which
    /// hides nothing, none is above -0.2; a droop of the engine and play in a pin leave one instrument or two at 1.0 to 1.4.
    pub excused_loss: f64,
    /// Effects that make the model adequate explain a recording only when they take away at least this share of the loss. A
    /// model that was nearly adequate needs little for it: play in a pin was called a sensor's offset that took a fifth, and a force on a
    /// spool a loss in a hose that took half. Right ones take all of it but noise.
    pub least_explained_share: f64,
    /// And several effects that only together explain it, at least this share: what no catalogue has is taken away by two
    /// effects in turns that each resemble it a little (a force on the spool of two blind machines 68 % and 82 %). Right pairs take 92 %
    /// and more.
    pub least_shared_share: f64,
    /// Effects that do not make it adequate explain it when they take away at least this share of the loss. The
    /// right effects take away 80 % and more; effects that only resemble one that no catalogue has took away 68 % at most.
    pub explained_share: f64,
    /// And only when the typical loss left is below this: three times the noise variance. Whoever takes most of an error
    /// away that large may still be the wrong one, as a share of it says nothing about what is left. Right effects whose law is a little
    /// another than the catalogue's leave 0.2 to 0.6.
    pub explained_loss: f64,
    /// Typical loss that right effects leave at most: 58 of 59 blind machines with the right name on them left no more. Whatever leaves
    /// more than this resembles what is missing, and is asked for [`DiagnosisSettings::resembling_share`]. Two effects together imitate
    /// more than one can, so it is divided by their number, and so is what that share leaves: a worn linkage was a pump's leak and a shifted
    /// sensor, which left 0.08 of 0.87, where 18 right pairs left 0.05 or less, or 4.7 % of 2.1 or less.
    pub right_loss: f64,
    /// Share of the typical loss that effects must take away which leave more than [`DiagnosisSettings::right_loss`]. A gain curve took
    /// 86 % of what a flow force on a spool did and left 0.17; the one right name of 59 that left more, a valve of second order that
    /// lags, took 94 %.
    pub resembling_share: f64,
    /// Most effects added one after the other: \[B\] adds five to its preliminary model.
    pub most_effects: usize,
    /// Steps of a fit in the race.
    pub race_steps: usize,
    /// Share of the recordings that the race is run on, the stretches in which the model without additions fails most.
    /// Half of them costs half the time and leads to the same verdicts on the practice recordings.
    pub race_share: f64,
    /// So many candidates, the best of the race, are fitted to the end.
    pub finalists: usize,
    /// So many more, the next best that have not converged in the race, where the best of them leaves much of the loss.
    pub further_finalists: usize,
    /// And all others whose gain in the race is within this of the best.
    pub finalist_margin: f64,
}

impl Default for DiagnosisSettings {
    fn default() -> Self {
        DiagnosisSettings {
            fit: FitSettings::default(),
            least_gain: 0.15,
            least_gain_when_adequate: 0.3,
            least_significance: 3.0,
            least_joint_significance: 4.5,
            tie_gain: 0.1,
            tie_significance: 2.0,
            doubtful_lead: 0.7,
            adequate_loss: 0.2,
            adequate_error: 1.5e-4,
            small_error_loss: 1.0,
            negligible_error: 2.5e-5,
            largest_error: 0.03,
            excused_error: 0.01,
            excused_loss: 0.5,
            least_explained_share: 0.75,
            least_shared_share: 0.85,
            explained_share: 0.75,
            explained_loss: 1.0,
            right_loss: 0.1,
            resembling_share: 0.9,
            most_effects: 5,
            race_steps: 3,
            race_share: 0.5,
            finalists: 4,
            further_finalists: 6,
            finalist_margin: 0.5,
        }
    }
}
