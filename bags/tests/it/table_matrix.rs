//! One recording written as strangers write tables: in every encoding, with every separator, header and form of time. Each is read as
//! the same recording.

use std::fmt::Write;

use excavator_bags::map::{TopicMap, read_mapped};

/// Rows of the recording, and their distance, s.
const ROWS: usize = 120;
const STEP: f64 = 0.002;
/// Time of day of the first row, s: midnight passes.
const BEGIN: f64 = 86_399.9;
/// 20 November 2023, days since 1970.
const DATE: i64 = 19_681;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Utf8,
    Utf8WithMark,
    Utf16Little,
    Utf16Big,
    Utf16WithMark,
    Windows,
    OldEnds,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Header {
    Nothing,
    Units,
    LineOfUnits,
    Title,
    Logger,
    Comment,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Time {
    Seconds,
    Milliseconds,
    OfDay,
    OfDayWithColons,
    Iso,
    German,
    American,
    Month,
    TwoColumns,
    DayBeside,
    Spreadsheet,
    Matlab,
    Epoch,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Gaps {
    Nothing,
    Blank,
    Word,
    Code,
    Merged,
}

const ENCODINGS: [Encoding; 7] = [
    Encoding::Utf8,
    Encoding::Utf8WithMark,
    Encoding::Utf16Little,
    Encoding::Utf16Big,
    Encoding::Utf16WithMark,
    Encoding::Windows,
    Encoding::OldEnds,
];
const HEADERS: [Header; 6] =
    [Header::Nothing, Header::Units, Header::LineOfUnits, Header::Title, Header::Logger, Header::Comment];
const TIMES: [Time; 13] = [
    Time::Seconds,
    Time::Milliseconds,
    Time::OfDay,
    Time::OfDayWithColons,
    Time::Iso,
    Time::German,
    Time::American,
    Time::Month,
    Time::TwoColumns,
    Time::DayBeside,
    Time::Spreadsheet,
    Time::Matlab,
    Time::Epoch,
];
const GAPS: [Gaps; 5] = [Gaps::Nothing, Gaps::Blank, Gaps::Word, Gaps::Code, Gaps::Merged];
/// Separators with decimal signs.
const SIGNS: [(char, char); 6] = [(',', '.'), (';', '.'), (';', ','), ('\t', '.'), ('\t', ','), (' ', '.')];
/// Units of displacement, pressure and oil temperature, and the factors to SI.
const UNITS: [[(&str, f64); 3]; 3] = [
    [("mm", 1e-3), ("bar", 1e5), ("°C", 1.0)],
    [("m", 1.0), ("Pa", 1.0), ("Celsius", 1.0)],
    [("in", 0.0254), ("psig", 6_894.757_293), ("deg C", 1.0)],
];

/// One way to write the recording.
#[derive(Clone, Copy, Debug)]
struct Way {
    encoding: Encoding,
    signs: (char, char),
    header: Header,
    time: Time,
    gaps: Gaps,
    units: [(&'static str, f64); 3],
    has_thousands: bool,
}

/// Displacement m, pressure Pa and temperature °C at a row.
fn truth(row: usize) -> [f64; 3] {
    let t = row as f64 * STEP;
    [0.05 + 0.04 * (7.0 * t).sin(), 9e6 + 4e6 * (5.0 * t).cos(), 40.0 + t]
}

fn is_gap(row: usize) -> bool {
    row % 17 == 11
}

impl Way {
    /// A number with this way's signs.
    fn number(&self, value: f64, digits: usize) -> String {
        let plain = format!("{value:.digits$}");
        let (whole, fraction) = plain.split_once('.').unwrap_or((&plain, ""));
        let decimal = self.signs.1;
        let mut grouped = String::new();
        for (place, digit) in whole.chars().enumerate() {
            if self.has_thousands && place > 0 && (whole.len() - place) % 3 == 0 && digit.is_ascii_digit() {
                grouped.push(if decimal == '.' { ',' } else { '.' });
            }
            grouped.push(digit);
        }
        if fraction.is_empty() { grouped } else { format!("{grouped}{decimal}{fraction}") }
    }

    /// The cells of the time of a row.
    fn times(&self, row: usize) -> Vec<String> {
        let since = row as f64 * STEP;
        let seconds = BEGIN + since;
        let milliseconds = (seconds * 1e3).round() as i64;
        let (day, of_day) = (DATE + milliseconds / 86_400_000, milliseconds % 86_400_000);
        let (hours, minutes, rest) = (of_day / 3_600_000, of_day / 60_000 % 60, of_day % 60_000);
        let (second, milli) = (rest / 1000, rest % 1000);
        let clock = format!("{hours:02}:{minutes:02}:{second:02}.{milli:03}");
        let date = 20 + day - DATE;
        let plain = |value: f64, digits: usize| format!("{value:.digits$}").replace('.', &self.signs.1.to_string());
        match self.time {
            Time::Seconds => vec![plain(since, 4)],
            Time::Milliseconds => vec![plain(1e3 * since, 1)],
            Time::OfDay => vec![clock],
            Time::OfDayWithColons => vec![clock.replace('.', ":")],
            Time::Iso => vec![format!("2023-11-{date}T{clock}Z")],
            Time::German => vec![format!("{date}.11.2023 {}", clock.replace('.', ","))],
            Time::American => {
                let half = if hours < 12 { "AM" } else { "PM" };
                let hours = if hours % 12 == 0 { 12 } else { hours % 12 };
                vec![format!("11/{date}/2023 {hours}:{minutes:02}:{second:02}.{milli:03} {half}")]
            }
            Time::Month => vec![format!("{date}-Nov-2023 {clock}")],
            Time::TwoColumns => {
                let whole = DATE * 86_400 + milliseconds / 1000;
                vec![whole.to_string(), (milliseconds % 1000 * 1_000_000).to_string()]
            }
            Time::DayBeside => vec![format!("{date}.11.2023"), clock],
            Time::Spreadsheet => vec![plain((DATE + 25_569) as f64 + seconds / 86_400.0, 10)],
            Time::Matlab => vec![plain((DATE + 719_529) as f64 + seconds / 86_400.0, 10)],
            Time::Epoch => vec![plain((DATE * 86_400) as f64 + seconds, 3)],
        }
    }

    fn time_headings(&self) -> Vec<(&'static str, &'static str)> {
        match self.time {
            Time::Seconds => vec![("Time", "s")],
            Time::Milliseconds => vec![("Time", "msec")],
            Time::TwoColumns => vec![("stamp.secs", ""), ("stamp.nsecs", "")],
            Time::DayBeside => vec![("Date", ""), ("Time", "")],
            _ => vec![("Time", "")],
        }
    }

    fn cells(&self, row: usize) -> Vec<String> {
        let mut cells = self.times(row);
        for (column, (value, (_, factor))) in truth(row).iter().zip(self.units).enumerate() {
            let text = self.number(value / factor, 5);
            cells.push(match self.gaps {
                Gaps::Merged if row % 3 != column => String::new(),
                Gaps::Blank if column < 2 && is_gap(row) => String::new(),
                Gaps::Word if column < 2 && is_gap(row) => "NaN".to_string(),
                // Far from all pressures in any of the units.
                Gaps::Code if column < 2 && is_gap(row) => if column == 0 { "-9999" } else { "1e30" }.to_string(),
                _ => text,
            });
        }
        cells
    }

    fn line(&self, cells: &[String]) -> String {
        let sign = self.signs.0;
        let needs_quotes = |cell: &String| sign != ' ' && cell.contains(sign);
        let shown = cells.iter().map(|cell| if needs_quotes(cell) { format!("\"{cell}\"") } else { cell.clone() });
        shown.collect::<Vec<_>>().join(&sign.to_string())
    }

    fn text(&self) -> String {
        let quantities = ["x", "p", "T_oil"].iter().zip(self.units).map(|(name, (unit, _))| (*name, unit));
        let columns: Vec<(&str, &str)> = self.time_headings().into_iter().chain(quantities).collect();
        let names: Vec<String> = columns.iter().map(|(name, _)| name.to_string()).collect();
        let gap = if self.signs.0 == ' ' { "" } else { " " };
        let with_units: Vec<String> = columns
            .iter()
            .map(
                |(name, unit)| {
                    if unit.is_empty() { name.to_string() } else { format!("{name}{gap}[{}]", unit.replace(' ', "")) }
                },
            )
            .collect();
        let units: Vec<String> = columns
            .iter()
            .map(|(_, unit)| if unit.is_empty() { "-".to_string() } else { unit.replace(' ', "") })
            .collect();
        let mut text = String::new();
        let head: Vec<Vec<String>> = match self.header {
            Header::Nothing => vec![],
            Header::Units => vec![with_units],
            Header::LineOfUnits => vec![names, units],
            Header::Title => {
                text += "Bench 7\nOperator: Smith\n\n";
                vec![with_units]
            }
            Header::Logger => {
                let width = columns.len();
                let row = |first: &str, other: &str| {
                    std::iter::once(first.to_string())
                        .chain(std::iter::repeat_n(other.to_string(), width - 1))
                        .collect()
                };
                vec![
                    row("Samples", "5001"),
                    row("Date", "2023/11/20"),
                    row("Start", "10:20:00"),
                    row("X0", "0"),
                    with_units,
                ]
            }
            Header::Comment => {
                text += "# ";
                vec![with_units]
            }
        };
        let rows = (0..ROWS).map(|row| self.cells(row));
        for cells in head.into_iter().chain(rows) {
            let _ = writeln!(text, "{}", self.line(&cells));
        }
        text
    }

    fn bytes(&self) -> Vec<u8> {
        let text = self.text();
        let little = || text.encode_utf16().flat_map(u16::to_le_bytes);
        match self.encoding {
            Encoding::Utf8 => text.into_bytes(),
            Encoding::Utf8WithMark => format!("\u{feff}{text}").into_bytes(),
            Encoding::Utf16Little => little().collect(),
            Encoding::Utf16WithMark => [0xff, 0xfe].into_iter().chain(little()).collect(),
            Encoding::Utf16Big => text.encode_utf16().flat_map(u16::to_be_bytes).collect(),
            Encoding::Windows => text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect(),
            Encoding::OldEnds => text.replace('\n', "\r").into_bytes(),
        }
    }

    fn map(&self) -> TopicMap {
        let own = self.time_headings();
        let clock = match self.time {
            Time::TwoColumns => 1,
            _ => own.len(),
        };
        let unit_of_time = own[clock - 1].1;
        let has_units = self.header != Header::Nothing;
        let mut map = format!("[clock]\ncolumn = {clock}\n");
        if !has_units && !unit_of_time.is_empty() {
            let _ = writeln!(map, "unit = \"{unit_of_time}\"");
        }
        let signals = ["load.displacement", "load.cap_pressure", "oil_temperature"];
        for (index, (signal, (unit, _))) in signals.iter().zip(self.units).enumerate() {
            let _ = writeln!(map, "[[signals]]\nsignal = \"{signal}\"\ncolumn = {}", own.len() + index + 1);
            if !has_units {
                let _ = writeln!(map, "unit = \"{unit}\"");
            }
        }
        map.parse().unwrap()
    }

    /// Why the recording is not the one that was written.
    fn fault(&self, folder: &std::path::Path) -> Option<String> {
        let path = folder.join("table.csv");
        std::fs::write(&path, self.bytes()).unwrap();
        let (recording, report) = match read_mapped(&path, &self.map()) {
            Ok(read) => read,
            Err(error) => return Some(error.to_string()),
        };
        let told = || report.problems().join("; ");
        let rows: Vec<usize> =
            if self.gaps == Gaps::Merged { (0..ROWS).step_by(3).collect() } else { (0..ROWS).collect() };
        if recording.time.len() != rows.len() {
            return Some(format!("{} samples instead of {}: {}", recording.time.len(), rows.len(), told()));
        }
        let load = &recording.cylinders[0];
        let found = [&load.displacement, &load.cap_pressure, &recording.oil_temperature];
        for (sample, &row) in rows.iter().enumerate() {
            let time = (row - rows[0]) as f64 * STEP;
            if (recording.time[sample] - time).abs() > 5e-5 {
                return Some(format!("row {row} is at {} instead of {time}: {}", recording.time[sample], told()));
            }
            let is_hole = matches!(self.gaps, Gaps::Blank | Gaps::Word | Gaps::Code) && is_gap(row);
            for (column, (wanted, values)) in truth(row).into_iter().zip(found).enumerate() {
                let value = values[sample];
                let is_end = self.gaps == Gaps::Merged && column > 0 && (sample == 0 || sample + 1 == rows.len());
                let tolerance = if self.gaps == Gaps::Merged { 1e-3 } else { 1e-6 } * wanted.abs().max(0.1);
                let is_right = match is_hole && column < 2 {
                    true => value.is_nan(),
                    false => (value - wanted).abs() <= tolerance.max(6e-6 * self.units[column].1),
                };
                if !(is_right || is_end && value.is_nan()) {
                    return Some(format!("column {column} row {row} is {value} instead of {wanted}: {}", told()));
                }
            }
        }
        None
    }
}

fn ways() -> Vec<Way> {
    let mut ways = Vec::new();
    for encoding in ENCODINGS {
        for signs in SIGNS {
            for header in HEADERS {
                for time in TIMES {
                    let has_blank = matches!(time, Time::German | Time::American | Time::Month);
                    // Cells with a blank in them cannot be told from two cells.
                    let number = ways.len();
                    let gaps = GAPS[number % GAPS.len()];
                    let is_blank = matches!(gaps, Gaps::Blank | Gaps::Merged);
                    if signs.0 == ' ' && (has_blank || is_blank) {
                        ways.push(Way {
                            encoding,
                            signs: ('\t', '.'),
                            header,
                            time,
                            gaps,
                            units: UNITS[number % 3],
                            has_thousands: false,
                        });
                        continue;
                    }
                    let units = UNITS[(number / 5) % UNITS.len()];
                    let has_thousands = number % 4 == 1 && signs.0 != ' ';
                    ways.push(Way { encoding, signs, header, time, gaps, units, has_thousands });
                }
            }
        }
    }
    ways
}

#[test]
fn one_recording_in_every_way_that_strangers_write() {
    let folder = tempfile::tempdir().unwrap();
    let ways = ways();
    assert!(ways.len() >= 400, "{}", ways.len());
    let faults: Vec<String> =
        ways.iter().filter_map(|way| way.fault(folder.path()).map(|fault| format!("{way:?}: {fault}"))).collect();
    let first: Vec<&String> = faults.iter().take(12).collect();
    assert!(faults.is_empty(), "{} of {} tables: {first:#?}", faults.len(), ways.len());
}
