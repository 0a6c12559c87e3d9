//! Limits the rate of openings, as the last step before the valve.

/// The current request for a valve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    /// Orifice area, m².
    pub area: f64,
    /// Whether the valve closes for safety, because its lease expired or the machine is stopped.
    pub closing: bool,
}

/// Openings that follow the requests by ramps. Oil that stops at once causes a pressure surge, and a full reversal from one
/// sample to the next is a fault of the sender.
#[derive(Debug, Clone)]
pub(crate) struct Slew {
    areas: Vec<f64>,
    opening_rates: Vec<f64>,
    closing_rates: Vec<f64>,
    limited: u64,
}

impl Slew {
    /// Closed valves with these largest areas (m²), which take `opening_time` (s) from closed to fully open, and
    /// `closing_time` (s) from fully open to closed for safety.
    pub fn new(maximum_areas: &[f64], opening_time: f64, closing_time: f64) -> Self {
        let rates = |time: f64| maximum_areas.iter().map(|area| area / time).collect();
        Slew {
            areas: vec![0.0; maximum_areas.len()],
            opening_rates: rates(opening_time),
            closing_rates: rates(closing_time),
            limited: 0,
        }
    }

    /// Advances by `step` seconds.
    pub fn follow(&mut self, wanted: impl IntoIterator<Item = Wanted>, step: f64) {
        let rates = self.opening_rates.iter().zip(&self.closing_rates);
        for ((area, wanted), (opening, closing)) in self.areas.iter_mut().zip(wanted).zip(rates) {
            let rate = if wanted.closing { closing } else { opening };
            let most = rate * step;
            let change = wanted.area - *area;
            if !wanted.closing && change.abs() > most * (1.0 + ROUNDING) {
                self.limited += 1;
            }
            *area = if change.abs() <= most { wanted.area } else { *area + most.copysign(change) };
        }
    }

    /// Current areas, m².
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Whether every valve is closed.
    pub fn are_closed(&self) -> bool {
        self.areas.iter().all(|&area| area == 0.0)
    }

    /// Steps in which the rate of a commanded opening was limited, so far.
    pub fn limited(&self) -> u64 {
        self.limited
    }
}

/// Tolerance, so that a command at exactly the largest rate is not limited.
const ROUNDING: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-3;

    fn open(area: f64) -> [Wanted; 1] {
        [Wanted { area, closing: false }]
    }

    #[test]
    fn a_full_reversal_takes_its_time() {
        let mut slew = Slew::new(&[1e-4], 0.05, 0.05);
        for step in 1..=50 {
            slew.follow(open(1e-4), STEP);
            assert!((slew.areas()[0] - 2e-6 * f64::from(step)).abs() < 1e-12);
        }
        let before = slew.limited();
        assert!((49..=50).contains(&before), "{before}");
        for _ in 0..101 {
            slew.follow(open(-1e-4), STEP);
        }
        assert_eq!(slew.areas(), [-1e-4]);
    }

    #[test]
    fn a_slow_sine_is_not_limited() {
        let mut slew = Slew::new(&[1e-4], 0.05, 0.05);
        for step in 0..2000 {
            let area = 8e-5 * (2.0 * std::f64::consts::PI * 2.0 * f64::from(step) * STEP).sin();
            slew.follow(open(area), STEP);
            assert_eq!(slew.areas(), [area]);
        }
        assert_eq!(slew.limited(), 0);
    }

    #[test]
    fn closing_for_safety_arrives_and_does_not_overshoot() {
        let mut slew = Slew::new(&[1e-4], 1e-3, 0.05);
        slew.follow(open(1e-4), STEP);
        assert_eq!(slew.areas(), [1e-4]);
        // Fifty steps to close, and one more for rounding errors.
        for _ in 0..51 {
            let before = slew.areas()[0];
            slew.follow([Wanted { area: 0.0, closing: true }], STEP);
            assert!(slew.areas()[0] <= before && slew.areas()[0] >= 0.0);
        }
        assert!(slew.are_closed());
    }
}
