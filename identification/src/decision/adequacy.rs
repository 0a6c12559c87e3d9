//! Whether the error of the given model needs an explanation.

use super::statistic::{error_ratio_shares, log_error_ratio, log_error_ratio_beyond_inputs, relative_error};
use super::{Policy, Reason, Scores};

/// Whether the given model is adequate, with the reasons.
pub(super) struct Adequacy {
    /// Whether nothing that matters is missing.
    pub is_adequate: bool,
    /// Whether that is beyond doubt, so that a partial explanation is no reason to think otherwise.
    pub is_beyond_doubt: bool,
    /// In the order of their weight.
    pub reasons: Vec<Reason>,
}

/// Judges the given model by what it leaves on the validation recordings.
pub(super) fn adequacy(scores: &Scores, policy: &Policy) -> Adequacy {
    let (side, misfit) = (&scores.validation, &scores.given().validation);
    let (ratio, error) = (log_error_ratio(side, misfit), relative_error(side, misfit));
    let limit = policy.noise_margin;
    if ratio <= limit && error <= policy.largest_error {
        let mut reasons = vec![Reason::WithinNoise { log_error_ratio: ratio, limit }];
        let share_of_time = error_ratio_shares(side, misfit, policy.bad_moment);
        if share_of_time > 0.0 {
            reasons.push(Reason::ExceptMoments { share_of_time });
        }
        return Adequacy { is_adequate: true, is_beyond_doubt: true, reasons };
    }
    if error <= policy.small_error && ratio <= policy.small_error_ceiling {
        let reasons = vec![Reason::SmallError { relative_error: error, limit: policy.small_error }];
        return Adequacy { is_adequate: true, is_beyond_doubt: true, reasons };
    }
    let beyond_inputs = log_error_ratio_beyond_inputs(side, misfit);
    if beyond_inputs > limit {
        return Adequacy { is_adequate: false, is_beyond_doubt: false, reasons: Vec::new() };
    }
    if error > policy.largest_error {
        let reasons = vec![Reason::TooCoarse { relative_error: error, limit: policy.largest_error }];
        return Adequacy { is_adequate: false, is_beyond_doubt: false, reasons };
    }
    let reasons = vec![Reason::WithinInputs { log_error_ratio: beyond_inputs, limit }];
    Adequacy { is_adequate: true, is_beyond_doubt: false, reasons }
}
