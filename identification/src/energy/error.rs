//! Why an energy analysis fails.

use excavator_model::SignalError;

/// Why the energy of a recording could not be analysed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnergyError {
    /// The recording lacks a signal that the model needs.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// A signal that the energy needs is not measured.
    #[error("{source_name} does not measure {signal}, without which the energy is unknown; record it, or give a map")]
    NotMeasured {
        /// The recording.
        source_name: String,
        /// Contract name.
        signal: String,
    },
    /// No stretch is long enough for a slope.
    #[error("{source_name} has {samples} samples in {duration:.3} s and no stretch of {needed:.2} s without a gap")]
    TooShort {
        /// The recording.
        source_name: String,
        /// Samples.
        samples: usize,
        /// Length, s.
        duration: f64,
        /// Length that is needed, s.
        needed: f64,
    },
    /// Too few samples within the half width of a slope.
    #[error(
        "{source_name} has {rate:.0} samples per second and energy takes slopes over {:.0} ms: record at least {needed:.0} per second; \
         compare, identify and diagnose do with fewer",
        2e3 * half_width
    )]
    TooSlow {
        /// The recording.
        source_name: String,
        /// Samples per second.
        rate: f64,
        /// Half width of the slopes, s.
        half_width: f64,
        /// Samples per second that are needed.
        needed: f64,
    },
}

/// Samples that a slope needs on each side within its half width.
const SAMPLES_PER_SIDE: f64 = 2.0;

impl EnergyError {
    /// The error for `samples` of a recording of `duration` s, with a usual interval of `interval` s, that allow no slopes over
    /// `half_width`; those need stretches of `needed` s.
    pub(super) fn of_nothing(
        source_name: String,
        (samples, duration): (usize, f64),
        interval: f64,
        half_width: f64,
        needed: f64,
    ) -> Self {
        // A tenth of tolerance for uneven clocks.
        if SAMPLES_PER_SIDE * interval > 1.1 * half_width {
            EnergyError::TooSlow {
                source_name,
                rate: 1.0 / interval,
                half_width,
                needed: SAMPLES_PER_SIDE / half_width,
            }
        } else {
            EnergyError::TooShort { source_name, samples, duration, needed }
        }
    }
}
