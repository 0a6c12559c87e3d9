//! Computes the ledger of the last seconds, equation by equation, with the same functions that analyse a recording.

use std::sync::Mutex;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError};

use excavator_bags::{ReadReport, StateTable};
use excavator_identification::energy::{EnergySettings, MissingPower, analyse, missing_power};
use excavator_model::Model;
use excavator_msgs::ArmState;

use excavator_ros::{Diagnostics, Health};

/// Highest plausible rate of states, Hz. Without this limit, a clock that jumps back and forth would fill the memory.
const FASTEST: f64 = 4000.0;

/// Collects states until they fill a window, and sends the window to [`judge_windows`] in a thread of its own.
pub(super) struct Ledger<'l> {
    length: f64,
    states: StateTable,
    /// Stamps of the window's first and last state, ns.
    ends: Option<(i64, i64)>,
    windows: SyncSender<StateTable>,
    tally: &'l Mutex<Tally>,
}

/// Counts of the windows.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Tally {
    judged: u64,
    passed_over: u64,
}

impl<'l> Ledger<'l> {
    /// A ledger with windows of `length` seconds.
    pub fn new(length: f64, windows: SyncSender<StateTable>, tally: &'l Mutex<Tally>) -> Self {
        Ledger { length, states: StateTable::default(), ends: None, windows, tally }
    }

    /// Adds a state. If the clock jumps back, a new window begins. A repeated stamp adds nothing.
    pub fn push(&mut self, state: &ArmState) {
        let stamp = state.header.stamp.nanoseconds();
        if self.ends.is_some_and(|(_, last)| stamp == last) {
            return;
        }
        let (first, last) = self.ends.unwrap_or((stamp, stamp));
        if stamp < last.saturating_sub((self.length * 1e9) as i64) || self.states.len() >= self.most_states() {
            self.begin_anew();
            return;
        }
        self.states.push(state);
        self.ends = Some((first, last.max(stamp)));
        if stamp.saturating_sub(first) as f64 * 1e-9 >= self.length {
            let window = self.begin_anew();
            // If the analysis is too slow, it skips windows, and reports that.
            if let Err(TrySendError::Full(_)) = self.windows.try_send(window)
                && let Ok(mut tally) = self.tally.lock()
            {
                tally.passed_over += 1;
            }
        }
    }

    fn most_states(&self) -> usize {
        (self.length * FASTEST) as usize
    }

    fn begin_anew(&mut self) -> StateTable {
        self.ends = None;
        std::mem::take(&mut self.states)
    }
}

/// Analyses windows as they arrive, until the sender is gone.
pub(super) fn judge_windows(
    model: &Model,
    windows: &Receiver<StateTable>,
    tally: &Mutex<Tally>,
    diagnostics: &Diagnostics,
) {
    for window in windows {
        let (recording, _) = window.into_recording("/arm/state", &mut ReadReport::default());
        let analysis = analyse(model, &recording, EnergySettings::default());
        let tally = tally.lock().map_or_else(
            |_| Tally::default(),
            |mut tally| {
                tally.judged += 1;
                *tally
            },
        );
        let duration = recording.time.last().copied().unwrap_or(0.0);
        let mut values = vec![
            ("window [s]", format!("{duration:.3}")),
            ("windows judged", tally.judged.to_string()),
            ("windows passed over", tally.passed_over.to_string()),
        ];
        match analysis {
            Err(error) => diagnostics.tell("ledger", Health::Warning, error.to_string(), &values),
            Ok(analysis) => {
                let missing = missing_power(model, &analysis);
                values.extend(details(&missing));
                let (health, word) = missing.first().map_or_else(
                    || (Health::Ok, "the ledger closes at every equation".to_string()),
                    |worst| (Health::Warning, worst.sentence.clone()),
                );
                diagnostics.tell("ledger", health, word, &values);
            }
        }
    }
}

/// The place with the most significant missing power, and the names of the others.
fn details(missing: &[MissingPower]) -> Vec<(&'static str, String)> {
    let Some((worst, others)) = missing.split_first() else { return Vec::new() };
    let mut values = vec![
        ("equation", worst.equation.clone()),
        ("cylinder", worst.cylinder.clone().unwrap_or_default()),
        ("when", worst.regime.words().to_string()),
        ("missing power, root mean square [W]", format!("{:.3}", worst.size)),
        ("missing power, largest [W]", format!("{:.3}", worst.peak)),
        ("explained by noise [W]", format!("{:.3}", worst.band)),
    ];
    if !others.is_empty() {
        let names: Vec<&str> = others.iter().map(|other| other.equation.as_str()).collect();
        values.push(("also at", names.join(", ")));
    }
    values
}
