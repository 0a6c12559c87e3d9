//! Parses the sampling rate from a line before the table: `Sampling rate: 500 Hz`, `dt = 0.002 s`.

use crate::map::{Dimension, Unit};

/// The sampling rate of a table, from a line before it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampling {
    /// Rows per second, Hz.
    pub rate: f64,
    /// The line.
    pub line: String,
}

/// Keys of a rate, in lower case.
const RATES: [&str; 21] = [
    "sampling rate",
    "sample rate",
    "samplingrate",
    "samplerate",
    "sampling frequency",
    "sample frequency",
    "sampling freq",
    "sample freq",
    "fs",
    "f s",
    "scan rate",
    "acquisition rate",
    "logging rate",
    "data rate",
    "samples per second",
    "samples/s",
    "abtastrate",
    "abtastfrequenz",
    "messrate",
    "messfrequenz",
    "aufzeichnungsrate",
];
/// Keys of a sampling interval.
const INTERVALS: [&str; 17] = [
    "sample interval",
    "sampling interval",
    "sample period",
    "sampling period",
    "time step",
    "timestep",
    "time interval",
    "dt",
    "delta t",
    "δt",
    "ts",
    "x increment",
    "xincrement",
    "abtastintervall",
    "abtastperiode",
    "abtastschritt",
    "zeitschritt",
];
/// Keys of either a sampling interval or the duration of the measurement.
const INTERVALS_OR_DURATIONS: [&str; 3] = ["sample time", "sampling time", "abtastzeit"];
/// For the latter keys, longer times are durations, s.
const LONGEST_INTERVAL: f64 = 1.0;
/// Valid rates, Hz.
const SENSIBLE: std::ops::RangeInclusive<f64> = 1e-6..=1e7;
/// Maximum relative difference between two lines that agree.
const TOLERANCE: f64 = 1e-3;
/// Maximum number of characters kept of a line.
const LONGEST_LINE: usize = 120;

impl Sampling {
    /// Parses a line. `delimiter` and `decimal` are those of the table.
    pub(super) fn of(line: &str, delimiter: u8, decimal: char) -> Option<Sampling> {
        let line = line.trim();
        let text = line.trim_start_matches(|c: char| c.is_whitespace() || "#%/*\"'".contains(c));
        let begin = text.char_indices().find(|(at, c)| {
            c.is_ascii_digit() || (*c == '.' && text[at + 1..].starts_with(|next: char| next.is_ascii_digit()))
        })?;
        let (before, rest) = text.split_at(begin.0);
        if before.ends_with('-') {
            return None;
        }
        let (key, unit_of_key) = key(before);
        let written = rest;
        let (number, rest) = number(rest, delimiter, decimal)?;
        // One for each channel.
        let of_first = &written[..written.len() - rest.len()];
        let mut others = rest.split(char::from(delimiter)).map(str::trim).filter(|cell| !cell.is_empty());
        let rest = if delimiter != b' ' && others.all(|other| other == of_first) { "" } else { rest };
        let unit = unit(rest, unit_of_key, delimiter)?;
        let is_rate = RATES.contains(&key.as_str());
        // The key of LabVIEW; without its underscore it may be a length.
        let is_interval = INTERVALS.contains(&key.as_str()) || before.trim_end().eq_ignore_ascii_case("delta_x");
        let is_doubtful = INTERVALS_OR_DURATIONS.contains(&key.as_str());
        let rate = match unit {
            _ if !(is_rate || is_interval || is_doubtful) => return None,
            Some(Given::Frequency(factor)) => number * factor,
            Some(Given::Time(factor)) => 1.0 / (number * factor),
            None if is_rate => number,
            None => 1.0 / number,
        };
        if is_doubtful && 1.0 / rate > LONGEST_INTERVAL {
            return None;
        }
        SENSIBLE.contains(&rate).then(|| Sampling { rate, line: line.chars().take(LONGEST_LINE).collect() })
    }

    /// The rate on which all lines agree; otherwise adds a note.
    pub(super) fn agreed(found: Vec<Sampling>, notes: &mut Vec<String>) -> Option<Sampling> {
        let first = found.first()?.clone();
        let differs = |other: &&Sampling| (other.rate / first.rate - 1.0).abs() > TOLERANCE;
        if let Some(other) = found.iter().find(differs) {
            notes.push(format!(
                "lines before the table say {} and {} rows per second; neither is used, give [clock] rate",
                first.rate, other.rate
            ));
            return None;
        }
        Some(first)
    }
}

/// Key in lower case, and the unit in brackets after it.
fn key(before: &str) -> (String, Option<String>) {
    let open = before.find(['[', '(']);
    let unit = open.map(|at| before[at + 1..].split([']', ')']).next().unwrap_or_default().trim().to_string());
    let name = before[..open.unwrap_or(before.len())].to_lowercase().replace(['_', '-', '.'], " ");
    let name = name.trim_matches(|c: char| c.is_whitespace() || ":=;,\"'".contains(c));
    (name.split_whitespace().collect::<Vec<_>>().join(" "), unit)
}

/// The leading number and the text after it; `None` if a comma or point is ambiguous.
fn number(text: &str, delimiter: u8, decimal: char) -> Option<(f64, &str)> {
    let is_part = |c: char| c.is_ascii_digit() || c == '.' || (c == ',' && delimiter != b',');
    let mut end = text.find(|c: char| !is_part(c)).unwrap_or(text.len());
    // A trailing separator is not part of the number.
    end = text[..end].trim_end_matches(['.', ',']).len();
    let mantissa = &text[..end];
    let separators: Vec<char> = mantissa.chars().filter(|c| !c.is_ascii_digit()).collect();
    let is_fraction = mantissa.starts_with("0.") || mantissa.starts_with("0,") || mantissa.starts_with('.');
    let plain = match separators.as_slice() {
        [] => mantissa.to_string(),
        // 1,000 is one or a thousand, unless the table defines the meaning of a comma.
        [separator] if *separator == decimal || is_fraction => mantissa.replace(',', "."),
        _ => return None,
    };
    let rest = &text[end..];
    let exponent = rest.strip_prefix(['e', 'E']).map_or(0, |after| {
        let sign = usize::from(after.starts_with(['+', '-']));
        let digits = after[sign..].bytes().take_while(u8::is_ascii_digit).count();
        if digits > 0 { 1 + sign + digits } else { 0 }
    });
    let value: f64 = format!("{plain}{}", &rest[..exponent]).parse().ok()?;
    (value > 0.0 && value.is_finite()).then_some((value, &rest[exponent..]))
}

/// The quantity of a number, with its factor to Hz or s.
enum Given {
    Frequency(f64),
    Time(f64),
}

/// The unit after a number, otherwise that of its key. `Some(None)` without a unit, `None` for a unit of neither
/// frequency nor time.
fn unit(rest: &str, of_key: Option<String>, delimiter: u8) -> Option<Option<Given>> {
    let is_sign = |c: char| c.is_whitespace() || ";,\"'".contains(c) || c == char::from(delimiter);
    let rest = rest.trim_matches(is_sign).trim_start_matches(['[', '(']);
    let word = rest.split(|c: char| is_sign(c) || c == ']' || c == ')').next().unwrap_or_default();
    let name = if word.is_empty() { of_key.unwrap_or_default() } else { word.to_string() };
    if name.is_empty() {
        return rest.is_empty().then_some(None);
    }
    let frequency = match name.as_str() {
        "Hz" | "hz" | "HZ" | "1/s" | "S/s" | "Sa/s" | "sps" | "SPS" | "samples/s" | "samples/sec" | "Samples/s" => 1.0,
        "kHz" | "khz" | "KHz" | "KHZ" | "kS/s" | "kSa/s" | "ksps" => 1e3,
        "MHz" | "MS/s" => 1e6,
        _ => {
            let unit = Unit::named(&name).filter(|unit| unit.dimension == Dimension::Time)?;
            return Some(Some(Given::Time(unit.factor())));
        }
    };
    Some(Some(Given::Frequency(frequency)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(line: &str) -> Option<f64> {
        Sampling::of(line, b';', '.').map(|sampling| (sampling.rate * 1e6).round() / 1e6)
    }

    #[test]
    fn lines_of_loggers_say_how_often() {
        for (line, wanted) in [
            ("Sampling rate: 500 Hz", 500.0),
            ("# fs=1000", 1000.0),
            ("dt = 0.002 s", 500.0),
            ("dt = 0,002 s;;;", 500.0),
            ("Abtastrate [Hz]; 1000", 1000.0),
            ("\"Sample Interval\";1.0E-3;", 1000.0),
            ("Sample_Rate (kHz): 2.5", 2500.0),
            ("sampling rate 2 ms", 500.0),
            ("% Ts: 5ms", 200.0),
            ("Delta_X\t.01", 100.0),
            ("Abtastzeit: 10 ms", 100.0),
            ("fs = 500 Hz (nominal)", 500.0),
            ("Messrate = 100 1/s", 100.0),
        ] {
            assert_eq!(rate(line), Some(wanted), "{line}");
        }
        let comma = Sampling::of("Sample interval,0.001", b',', '.').map(|sampling| sampling.rate);
        assert_eq!(comma, Some(1000.0));
        let german = Sampling::of("Abtastrate: 2,5 kHz", b';', ',').map(|sampling| sampling.rate);
        assert_eq!(german, Some(2500.0));
        let each = Sampling::of("Delta_X\t0,002\t0,002\t", b'\t', ',').map(|sampling| sampling.rate);
        assert_eq!(each, Some(500.0));
    }

    #[test]
    fn what_could_be_something_else_says_nothing() {
        for line in [
            "",
            "Sampling rate: 1,000 Hz",
            "Sampling rate: -5 Hz",
            "Sampling rate: 0 Hz",
            "Sampling rate: 1e99 Hz",
            "Sampling rate: fast",
            "Sampling time: 60 s",
            "Frequency: 5 Hz",
            "fs1 = 500",
            "fs 2 channels",
            "Ts;1;2;3",
            "Delta x: 5",
            "dt: 5 mm",
            "Start: 2026-05-04 09:30:00",
            "t;p_A;p_B",
            "0.0;1.5;2",
            "äöü 500 Hz",
        ] {
            assert_eq!(rate(line), None, "{line}");
        }
    }

    #[test]
    fn lines_must_agree() {
        let of = |lines: &[&str]| {
            let mut notes = Vec::new();
            let found = lines.iter().filter_map(|line| Sampling::of(line, b';', '.')).collect();
            (Sampling::agreed(found, &mut notes).map(|sampling| sampling.rate), notes.len())
        };
        assert_eq!(of(&["fs = 500 Hz", "dt = 2 ms"]), (Some(500.0), 0));
        assert_eq!(of(&["fs = 500 Hz", "dt = 3 ms"]), (None, 1));
        assert_eq!(of(&[]), (None, 0));
    }
}
