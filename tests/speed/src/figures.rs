//! What was measured, as it is stored.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// All figures of one run on one machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// The processor as the operating system names it.
    pub processor: String,
    /// How many threads it runs at once.
    pub threads: usize,
    /// The parts that were measured, by name.
    pub parts: BTreeMap<String, Part>,
}

/// Groups that are measured together, so that nothing else changes between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// The day, as in 2026-02-28.
    pub date: String,
    /// The groups in the order of the page.
    pub groups: Vec<Group>,
}

/// Runs that are compared with each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Heading.
    pub name: String,
    /// One or two sentences: the work, and what the last column means.
    pub what: String,
    /// Heading of [`Run::result`].
    pub result: String,
    /// The runs. The first is what ratios refer to.
    pub runs: Vec<Run>,
}

/// One piece of work, timed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// What ran.
    pub name: String,
    /// Wall time, s; the shortest of the repetitions. `None` where it did not run, with the reason in `result`, and where time is no cost.
    pub seconds: Option<f64>,
    /// Time of processors, s, of a run in a process of its own.
    pub processor_seconds: Option<f64>,
    /// Largest resident memory in 10⁶ bytes, of a run in a process of its own.
    pub peak_megabytes: Option<f64>,
    /// How good the result is: an error, a verdict, a number of messages.
    pub result: String,
}

impl Run {
    /// A run inside this process.
    pub fn timed(name: impl Into<String>, seconds: f64, result: impl Into<String>) -> Self {
        Run {
            name: name.into(),
            seconds: Some(seconds),
            processor_seconds: None,
            peak_megabytes: None,
            result: result.into(),
        }
    }

    /// What has no time: a run that could not be done, or one whose length was chosen.
    pub fn untimed(name: impl Into<String>, result: impl Into<String>) -> Self {
        Run { name: name.into(), seconds: None, processor_seconds: None, peak_megabytes: None, result: result.into() }
    }
}

impl Part {
    /// Measured today.
    pub fn of_today(groups: Vec<Group>) -> Self {
        Part { date: jiff::Zoned::now().date().to_string(), groups }
    }
}

impl Figures {
    /// No parts yet, on this machine.
    pub fn of_this_machine() -> Self {
        let information = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let named = information.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
        Figures {
            processor: named.map_or_else(|| "unknown processor".to_string(), |(_, name)| name.trim().to_string()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            parts: BTreeMap::new(),
        }
    }

    /// These with the parts of an earlier run on the same sort of machine that were not measured again.
    pub fn over(mut self, earlier: Figures) -> Self {
        if (&self.processor, self.threads) == (&earlier.processor, earlier.threads) {
            for (name, part) in earlier.parts {
                self.parts.entry(name).or_insert(part);
            }
        }
        self
    }
}
