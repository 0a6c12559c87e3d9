//! The line about single values that were left out.

use super::signal::SignalName;

/// Tells that `count` single values of a signal were left out, the first of them `at` s after the start with this value, SI.
pub fn spike_line(signal: &SignalName, count: usize, at: f64, value: f64) -> String {
    let unit = signal.kind.dimension().si_unit();
    match count {
        1 => format!(
            "{signal}: one value jumps away from its neighbours and back, at {at:.3} s to {value:.4e} {unit}; it is left out"
        ),
        _ => format!(
            "{signal}: {count} single values jump away from their neighbours and back, the first at {at:.3} s to {value:.4e} {unit}; \
             they are left out"
        ),
    }
}
