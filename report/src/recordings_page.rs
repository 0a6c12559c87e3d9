//! Signals of one or more recordings over time, without a model.

use excavator_model::recording::{Recording, is_measured, median_interval};
use maud::{Markup, html};

use super::numbers::significant;
use super::overlay::overlay;
use super::page::{Section, page, tile};
use super::plot_json::{array, shortest, text};
use super::time_plots::{hint, plot_box};
use super::words;

/// A recording on the page.
#[derive(Debug)]
pub struct Viewed<'r> {
    /// The recording.
    pub recording: &'r Recording,
    /// Moment of its clock (s) that is zero on the page.
    pub zero: f64,
}

/// A signal on the page.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewedSignal {
    /// Contract name.
    pub name: String,
    /// Displayed value = SI value times this.
    pub factor: f64,
    /// Symbol of the displayed unit.
    pub symbol: &'static str,
}

/// Colours of the lines, in the order of the recordings; solid first, then dashed.
const COLOURS: [&str; 5] = ["var(--blue)", "var(--orange)", "var(--purple)", "var(--good)", "var(--measured)"];

/// Largest number of points of one line: two for each pixel of a wide screen.
const MOST_POINTS: usize = 4000;

/// Total count of numbers on a page, with six characters each: two megabytes.
const NUMBERS_OF_A_PAGE: usize = 300_000;

/// A page that plots these signals of all recordings over each other.
pub fn recordings_page(recordings: &[Viewed<'_>], signals: &[ViewedSignal]) -> String {
    let longest = recordings.iter().map(|one| one.recording.duration()).fold(0.0, f64::max);
    let lead = html! {
        div.tiles {
            (tile(&recordings.len().to_string(), if recordings.len() == 1 { "recording" } else { "recordings" }))
            (tile(&signals.len().to_string(), "signals"))
            (tile(&format!("{longest:.1} s"), "longest"))
        }
    };
    let columns = signals.len() * (recordings.len() + 1);
    let budget = (NUMBERS_OF_A_PAGE / columns.max(1)).clamp(400, MOST_POINTS);
    let plots = html! {
        (hint())
        @for signal in signals { (one_signal(recordings, signal, budget)) }
        @if signals.is_empty() { p.empty { "No signal is measured." } }
    };
    let sections = [
        Section { anchor: "time", title: "Over time".into(), body: plots },
        Section { anchor: "recordings", title: "Recordings".into(), body: table(recordings) },
    ];
    let names: Vec<&str> = recordings.iter().map(|one| one.recording.source.as_str()).collect();
    page("Recordings", &names.join(", "), &lead, &sections)
}

fn one_signal(recordings: &[Viewed<'_>], signal: &ViewedSignal, budget: usize) -> Markup {
    let measured: Vec<(usize, &Viewed<'_>, &[f64])> = recordings
        .iter()
        .enumerate()
        .filter_map(|(number, one)| Some((number, one, one.recording.signal(&signal.name).filter(|s| is_measured(s))?)))
        .collect();
    let timed: Vec<(Vec<f64>, &[f64])> = measured
        .iter()
        .map(|(_, one, values)| (one.recording.time.iter().map(|time| time - one.zero).collect(), *values))
        .collect();
    let found = overlay(&timed, budget);
    let kept: Vec<usize> = (0..found.time.len()).collect();
    let labels: Vec<String> =
        measured.iter().map(|(number, one, _)| format!("{}: {}", number + 1, one.recording.source)).collect();
    let series: Vec<String> = measured
        .iter()
        .zip(&found.values)
        .zip(&labels)
        .map(|(((number, ..), values), label)| {
            let dash = if *number >= COLOURS.len() { r#","dash":[6,3]"# } else { "" };
            let (label, colour) = (text(label), COLOURS[number % COLOURS.len()]);
            let values = array(values, signal.factor, &kept);
            format!(r#"{{"label":{label},"colour":"{colour}","width":1.4{dash},"values":{values}}}"#)
        })
        .collect();
    let seconds: Vec<String> = found.time.iter().map(|time| shortest(&format!("{time:.4}"))).collect();
    let title = words::signal(&signal.name);
    let quantity = words::spoken(signal.name.rsplit('.').next().unwrap_or(&signal.name));
    let json = format!(
        r#"{{"group":"recordings","label":{},"unit":{},"height":230,"last":true,"gaps":[],"time":[{}],"series":[{}]}}"#,
        text(&quantity),
        text(signal.symbol),
        seconds.join(","),
        series.join(",")
    );
    html! {
        div.signal {
            h3 { (title) small { code { (signal.name) } } }
            (plot_box(&format!("{title} over time: {}", labels.join(", ")), &json))
        }
    }
}

fn table(recordings: &[Viewed<'_>]) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr { th.n { "No." } th { "Recording" } th.n { "Samples" } th.n { "Duration, s" } th.n { "Rate, Hz" } th.n { "Time zero, s" } } }
            tbody { @for (number, one) in recordings.iter().enumerate() { tr {
                td.n { (number + 1) }
                td { code { (one.recording.source) } }
                td.n { (one.recording.len()) }
                td.n { (format!("{:.2}", one.recording.duration())) }
                td.n { (significant(1.0 / median_interval(&one.recording.time), 4)) }
                td.n { (format!("{:.3}", one.zero)) }
            } } }
        } }
        p.note { "Time zero is counted from the first sample of the recording. Of many samples in one pixel, the smallest and the largest are drawn." }
    }
}
