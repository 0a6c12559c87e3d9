//! Motions that another solver has solved, and its solutions.
//!
//! The files of `data/diffsol` are written by `cargo run --release -p excavator-speed -- references`: the same equations and the same
//! inputs, solved by the backward differences of `diffsol` at a relative tolerance of 1e-11. `diffsol` itself is no dependency of the
//! tests: it takes three minutes to build.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::InputSignals;

/// Between two samples, s.
const INTERVAL: f64 = 1e-3;

/// Units of joint angles, joint rates and pressures, and what a good sensor of each resolves: 0.05 mm of piston are about 2e-4 rad,
/// pressure sensors have 2 kPa of noise.
pub const STATES: [(&str, f64); 3] = [("rad", 2e-4), ("rad/s", 5e-3), ("Pa", 2e3)];

/// A model, its inputs and where it starts.
pub struct Motion {
    pub name: &'static str,
    pub model: Model,
    pub recording: Recording,
    pub signals: InputSignals,
    pub start: Vec<f64>,
}

impl Motion {
    fn new(name: &'static str, model: &str, duration: f64, area: impl Fn(usize, f64) -> f64) -> Self {
        let model = built_in(model).unwrap();
        let recording = super::driven(&model, duration, INTERVAL, area, |_| 0.0);
        let signals = InputSignals::from_recording(&model, &recording).unwrap();
        let start = super::at_rest(&System::new(&model));
        Self { name, model, recording, signals, start }
    }

    /// Where the solution is stored: for tests of the model, and for the program that writes it.
    pub fn path(&self) -> PathBuf {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let model = if here.ends_with("model") { here.to_path_buf() } else { here.join("../../model") };
        model.join("tests/data/diffsol").join(format!("{}.csv", self.name))
    }

    /// Which of `STATES` each state is.
    pub fn kinds(&self) -> Vec<usize> {
        let joints = self.model.machine.cylinders.len();
        (0..self.start.len()).map(|state| (state / joints).min(2)).collect()
    }
}

/// The identification motion of \[A\]. It does not start at zero, so that the opening crosses zero inside a step of any size.
pub fn arm() -> Motion {
    Motion::new("arm", "zx30u-arm", 4.0, |_, t| 1e-4 * (std::f64::consts::TAU * 0.5 * t + 0.4).sin())
}

/// Two joints that pull on each other.
pub fn two_joints() -> Motion {
    Motion::new("two-joints", "zx30u", 2.0, |number, t| {
        7e-5 * (std::f64::consts::TAU * 0.6 * t + 0.3 + number as f64).sin()
    })
}

pub fn motions() -> [Motion; 2] {
    [arm(), two_joints()]
}

/// States at all samples, as text: thirteen digits, a line for each sample.
pub fn text(states: &[Vec<f64>]) -> String {
    let mut text = String::new();
    for state in states {
        let numbers: Vec<String> = state.iter().map(|value| format!("{value:.12e}")).collect();
        writeln!(text, "{}", numbers.join(",")).unwrap();
    }
    text
}

/// The stored solution: states at all samples.
pub fn stored(motion: &Motion) -> Vec<Vec<f64>> {
    let path = motion.path();
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let states: Vec<Vec<f64>> =
        text.lines().map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect();
    assert_eq!(states.len(), motion.recording.time.len(), "{}", path.display());
    states
}

/// Largest distance of one state between two trajectories.
pub fn distance(a: &[Vec<f64>], b: &[Vec<f64>], state: usize) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a[state] - b[state]).abs()).fold(0.0, f64::max)
}
