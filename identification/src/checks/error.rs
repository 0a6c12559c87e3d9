//! Why a recording cannot be used.

use excavator_model::display::pressure_text;

/// Shortest useful recording on a machine of the reference size, s: a stroke of a tenth of the cylinder.
pub(super) const SHORTEST: f64 = 0.5;

/// Fewest samples: a few for each number that is fitted per recording, which are its initial state and noise.
pub(super) const FEWEST_SAMPLES: usize = 50;

/// Why a recording cannot be used, in one line that states what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// Too short.
    #[error(
        "{source_name} is too short: {duration:.2} s with {samples} samples; at least {needed:.2} s and {FEWEST_SAMPLES} samples are needed"
    )]
    TooShort {
        /// The recording.
        source_name: String,
        /// Its length, s.
        duration: f64,
        /// Its samples.
        samples: usize,
        /// Least length on this machine, s.
        needed: f64,
    },
    /// A required signal of a cylinder was not measured.
    #[error("{source_name} does not measure {signal} (all {samples} values are NaN), which {machine} needs")]
    NotMeasured {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// Samples.
        samples: usize,
        /// The machine.
        machine: String,
    },
    /// The arm does not move.
    #[error(
        "{source_name} has no motion: {signal} stays within {range:.2e} {unit}, {times:.0} times its noise of {noise:.1e} {unit}; record while the arm moves"
    )]
    NoMotion {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// Largest minus smallest value.
        range: f64,
        /// SI unit.
        unit: &'static str,
        /// Range over noise.
        times: f64,
        /// Noise.
        noise: f64,
    },
    /// A value that is impossible in SI units.
    #[error(
        "{source_name}: {signal} reaches {} {unit}, but {machine} allows at most {} {unit}; is it in {unit}?",
        shown(*value),
        shown(*limit)
    )]
    ImpossibleValue {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The value of largest size.
        value: f64,
        /// SI unit.
        unit: &'static str,
        /// Largest possible size.
        limit: f64,
        /// The machine.
        machine: String,
    },
    /// A piston beyond the ends of its cylinder.
    #[error(
        "{source_name}: {signal} goes from {from:.3} m to {to:.3} m, but the piston of {machine} only from {:.3} m to {half:.3} m; it counts from mid-stroke, so give the map an offset, like \"{:.0} mm\" if the sensor counts from the retracted end",
        -half, -1e3 * half
    )]
    BeyondStroke {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// Smallest value, m.
        from: f64,
        /// Largest value, m.
        to: f64,
        /// Half of the stroke, m.
        half: f64,
        /// The machine.
        machine: String,
    },
    /// A signal that is far too small for SI units.
    #[error(
        "{source_name}: {signal} never exceeds {value:.3e} {unit}, far below anything hydraulic; is it in {unit}, not in kPa, bar or MPa?"
    )]
    TooSmall {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The value of largest size.
        value: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// The piston moves against its valve.
    #[error(
        "{source_name}: {cylinder} retracts where its valve feeds the cap side and extends where it feeds the rod side (correlation {correlation:.2}); check the signs of displacement and opening"
    )]
    WrongSign {
        /// The recording.
        source_name: String,
        /// The cylinder.
        cylinder: String,
        /// Correlation of piston travel with opening.
        correlation: f64,
    },
    /// A sensor reads one value while the machine works.
    #[error(
        "{source_name}: {signal} stands still at {value:.4e} {unit} from {begin:.2} s to {end:.2} s while the machine works; leave that time out (BAG@FROM..TO), or the sensor"
    )]
    Stuck {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The value.
        value: f64,
        /// SI unit.
        unit: &'static str,
        /// First sample with it, s.
        begin: f64,
        /// Last sample with it, s.
        end: f64,
    },
    /// A pressure exceeds the range of its sensor.
    #[error(
        "{source_name}: {signal} is cut off at {}, for {longest:.2} s at most and {share:.1} % of the time; the sensor's range is too small for this recording",
        pressure_text(*value)
    )]
    Clipped {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// Clipping value, Pa.
        value: f64,
        /// Longest time at that value, s.
        longest: f64,
        /// Share of the samples at that value, %.
        share: f64,
    },
    /// The sensors of the two chambers are swapped.
    #[error(
        "{source_name}: cap_pressure and rod_pressure of {cylinder} look swapped: as given, {given:.0} % of the piston's {what} stays unexplained; swapped, {swapped:.0} %"
    )]
    SwappedChambers {
        /// The recording.
        source_name: String,
        /// The cylinder.
        cylinder: String,
        /// What they leave unexplained: flow or force.
        what: &'static str,
        /// Unexplained as recorded, %.
        given: f64,
        /// Unexplained with the pressures exchanged, %.
        swapped: f64,
    },
    /// Two sensors whose readings are identical to the last digit.
    #[error("{source_name}: {} and {} are the same signal, reading for reading; check the map or the wiring", signals[0], signals[1])]
    SameSignal {
        /// The recording.
        source_name: String,
        /// Contract names of the two.
        signals: [String; 2],
    },
    /// The recording that should judge is mostly one that is fitted.
    #[error(transparent)]
    SharedReadings(#[from] super::SharedReadings),
    /// Two recordings of one role are mostly the same.
    #[error(transparent)]
    GivenTwice(#[from] super::GivenTwice),
    /// The recording is invalid or lacks a cylinder of the machine.
    #[error(transparent)]
    Recording(#[from] excavator_model::recording::RecordingError),
}

/// Names of the refusals that can be overruled, as in `--accept swapped-pressures`.
pub const OVERRULABLE: [&str; 11] = [
    "too-short",
    "no-motion",
    "impossible-value",
    "beyond-stroke",
    "too-small",
    "wrong-sign",
    "stuck",
    "cut-off",
    "swapped-pressures",
    "same-signal",
    "shared-readings",
];

/// A number with four significant digits, with a power of ten only where plain digits would be hard to read.
fn shown(value: f64) -> String {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    if (-3.0..5.0).contains(&exponent) {
        let decimals = (3.0 - exponent).max(0.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}

impl CheckError {
    /// The name under which the refusal can be overruled; `None` if the recording cannot be used at all.
    pub fn name(&self) -> Option<&'static str> {
        Some(match self {
            CheckError::TooShort { .. } => "too-short",
            CheckError::NoMotion { .. } => "no-motion",
            CheckError::ImpossibleValue { .. } => "impossible-value",
            CheckError::BeyondStroke { .. } => "beyond-stroke",
            CheckError::TooSmall { .. } => "too-small",
            CheckError::WrongSign { .. } => "wrong-sign",
            CheckError::Stuck { .. } => "stuck",
            CheckError::Clipped { .. } => "cut-off",
            CheckError::SwappedChambers { .. } => "swapped-pressures",
            CheckError::SameSignal { .. } => "same-signal",
            CheckError::SharedReadings(_) | CheckError::GivenTwice(_) => "shared-readings",
            CheckError::NotMeasured { .. } | CheckError::Recording(_) => return None,
        })
    }
}
