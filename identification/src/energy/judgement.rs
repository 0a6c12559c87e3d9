//! Judges place by place whether the ledger closes.

use std::collections::VecDeque;

use super::noise::WindowNoise;
use super::windows::Window;
use super::{EnergySettings, Place, Regime};

/// Missing power at a place under one condition.
#[derive(Debug, Clone, PartialEq)]
pub struct RegimeJudgement {
    /// The condition.
    pub regime: Regime,
    /// Windows under this condition.
    pub windows: usize,
    /// Mean power that is stored without a source in the model, W; negative: lost. Zero if there are no windows.
    pub mean: f64,
    /// The window power of largest magnitude, with its sign, W.
    pub peak: f64,
    /// Root mean square of the windows' powers, W. A fit moves the mean of a missing effect to zero, but not its size.
    pub size: f64,
    /// The same without the worst event, W: the stretch of one window's length with the most missing power.
    pub size_elsewhere: f64,
    /// Standard deviation of a window's power from sensor noise, W.
    pub noise: f64,
    /// Standard deviation from the parameters' standard errors, if the model has them, and from the unknown time between two
    /// samples at which a valve opens, W.
    pub parameters: f64,
    /// Upper estimate of what the parabolas through the measurements cut off, root mean square, W.
    pub rounding: f64,
    /// Mean power through the place, W.
    pub flow: f64,
    /// Largest size that noise, parameters, rounding and tolerance explain, W; infinite if there are too few windows to judge.
    pub band: f64,
}

impl RegimeJudgement {
    /// Whether noise, the parameters' errors, rounding and the tolerance explain the missing power. Power that is missing in a
    /// single event does not count: near tank pressure noise has rare large effects that no standard deviation describes, while
    /// missing physics appears whenever the condition is met.
    pub fn is_explained(&self) -> bool {
        self.size.min(self.size_elsewhere) <= self.band
    }
}

/// The ledger of one place.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceJudgement {
    /// The place.
    pub place: Place,
    /// One entry per [`Regime`], in that order.
    pub regimes: Vec<RegimeJudgement>,
    /// Share of the windows outside their own band.
    pub share_outside: f64,
}

impl PlaceJudgement {
    /// Whether the ledger closes at this place: over the whole recording and under every condition.
    pub fn is_explained(&self) -> bool {
        self.regimes.iter().all(RegimeJudgement::is_explained)
    }

    /// The condition with the most missing power relative to its band; `None` if all is explained.
    pub fn worst(&self) -> Option<&RegimeJudgement> {
        let outside = self.regimes.iter().filter(|regime| !regime.is_explained());
        outside.max_by(|a, b| (a.size / a.band).total_cmp(&(b.size / b.band)))
    }
}

/// Fewest windows for judging a condition. Windows overlap, so this is worth half as many: noise alone exceeds twice its standard
/// deviation over six in one of two thousand cases.
const FEWEST: usize = 12;

/// Share of the largest mean flow of a place's conditions that sets the minimum of the tolerance. Signal slopes do not become
/// more accurate under a condition in which little power flows.
const QUIET: f64 = 0.5;

/// Sums over windows.
#[derive(Debug, Clone)]
pub(super) struct Judge {
    settings: EnergySettings,
    places: Vec<(Place, Option<usize>)>,
    sums: Vec<Vec<Sum>>,
    outside: Vec<usize>,
    windows: usize,
    last_noise: Option<WindowNoise>,
}

#[derive(Debug, Clone, Default)]
struct Sum {
    windows: usize,
    residual: f64,
    squares: f64,
    peak: f64,
    variance: f64,
    parameter_variance: f64,
    rounding_squares: f64,
    flow: f64,
    /// Times and squares of the latest windows within the length of an event.
    recent: VecDeque<(f64, f64)>,
    worst_event: Event,
}

/// Windows within one event length.
#[derive(Debug, Clone, Copy, Default)]
struct Event {
    windows: usize,
    squares: f64,
}

/// Contributions that explain a window's power, W or W².
#[derive(Debug, Clone, Copy, Default)]
struct Explained {
    variance: f64,
    parameter_variance: f64,
    rounding: f64,
    flow: f64,
}

/// A window with its errors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    /// Residual of each place, less its mean shift by noise, W.
    pub residuals: Vec<f64>,
    /// Half width of its band, W.
    pub bands: Vec<f64>,
}

impl Judge {
    /// `places`, each with the cylinder whose motion determines the regime.
    pub fn new(places: Vec<(Place, Option<usize>)>, settings: EnergySettings) -> Self {
        let count = places.len();
        Judge {
            settings,
            places,
            sums: vec![vec![Sum::default(); Regime::ALL.len()]; count],
            outside: vec![0; count],
            windows: 0,
            last_noise: None,
        }
    }

    /// Stores the noise of a block for windows without their own.
    pub fn learn(&mut self, noises: &[WindowNoise]) {
        let Some(first) = noises.first() else { return };
        let count = noises.len() as f64;
        let mean = |of: &dyn Fn(&WindowNoise) -> f64| noises.iter().map(of).sum::<f64>() / count;
        let places = self.places.len();
        self.last_noise = Some(WindowNoise {
            bias: (0..places).map(|place| mean(&|noise| noise.bias[place])).collect(),
            variance: (0..places).map(|place| mean(&|noise| noise.variance[place])).collect(),
            parameters: (0..places)
                .map(|place| {
                    (0..first.parameters[place].len()).map(|j| mean(&|noise| noise.parameters[place][j])).collect()
                })
                .collect(),
            rounding: (0..places).map(|place| mean(&|noise| noise.rounding[place])).collect(),
        });
    }

    /// Judges one window and adds it to the sums.
    pub fn judge(&mut self, window: &Window, noise: Option<&WindowNoise>) -> Judged {
        let noise = noise.or(self.last_noise.as_ref());
        let draws = self.settings.draws.max(1) as f64;
        let mut judged = Judged { residuals: Vec::new(), bands: Vec::new() };
        self.windows += 1;
        for (index, &(_, cylinder)) in self.places.iter().enumerate() {
            let residual = window.residuals[index] - noise.map_or(0.0, |noise| noise.bias[index]);
            // The subtracted mean of the repeats has noise of its own.
            let variance = noise.map_or(0.0, |noise| noise.variance[index] * (1.0 + 1.0 / draws));
            let parameters = noise.map_or(&[][..], |noise| &noise.parameters[index]);
            let parameter_variance: f64 = parameters.iter().map(|change| change * change).sum();
            let rounding = noise.map_or(0.0, |noise| noise.rounding[index]);
            let explained = Explained { variance, parameter_variance, rounding, flow: window.flows[index] };
            // A single window among thousands needs a wider band than the root mean square of many.
            let band = 2.0 * band(&self.settings, explained);
            self.outside[index] += usize::from(residual.abs() > band);
            for (regime, sum) in Regime::ALL.iter().zip(&mut self.sums[index]) {
                let met = match cylinder {
                    Some(cylinder) => window.situations[cylinder].is(*regime),
                    None => window.situations.iter().any(|situation| situation.is(*regime)),
                };
                if met {
                    sum.add(window.time, residual, explained, 2.0 * self.settings.window_half_width);
                }
            }
            judged.residuals.push(residual);
            judged.bands.push(band);
        }
        judged
    }

    /// The judgement over all windows.
    pub fn finish(&self) -> Vec<PlaceJudgement> {
        let count = self.windows.max(1) as f64;
        self.places
            .iter()
            .enumerate()
            .map(|(index, &(place, _))| {
                let sums = &self.sums[index];
                let overall = sums.iter().map(Sum::mean_flow).fold(0.0, f64::max);
                let judge = |(regime, sum): (&Regime, &Sum)| sum.judge(*regime, QUIET * overall, &self.settings);
                PlaceJudgement {
                    place,
                    regimes: Regime::ALL.iter().zip(sums).map(judge).collect(),
                    share_outside: self.outside[index] as f64 / count,
                }
            })
            .collect()
    }
}

/// Size that is explained, W: standard deviations times their allowed factors, rounding and tolerance.
fn band(settings: &EnergySettings, explained: Explained) -> f64 {
    let noise = settings.significance.powi(2) * explained.variance;
    let parameters = settings.parameter_significance.powi(2) * explained.parameter_variance;
    let tolerance = settings.tolerance * explained.flow;
    (noise + parameters + tolerance.powi(2) + explained.rounding.powi(2)).sqrt()
}

impl Sum {
    /// `length` of an event, s.
    fn add(&mut self, time: f64, residual: f64, explained: Explained, length: f64) {
        self.recent.push_back((time, residual * residual));
        while self.recent.front().is_some_and(|(first, _)| *first < time - length) {
            self.recent.pop_front();
        }
        let squares = self.recent.iter().map(|window| window.1).sum();
        if squares > self.worst_event.squares {
            self.worst_event = Event { windows: self.recent.len(), squares };
        }
        self.windows += 1;
        self.residual += residual;
        self.squares += residual * residual;
        if residual.abs() > self.peak.abs() {
            self.peak = residual;
        }
        self.variance += explained.variance;
        self.parameter_variance += explained.parameter_variance;
        self.rounding_squares += explained.rounding.powi(2);
        self.flow += explained.flow;
    }

    fn mean_flow(&self) -> f64 {
        self.flow / self.windows.max(1) as f64
    }

    /// `least_flow`: minimum of the power to which the tolerance applies.
    fn judge(&self, regime: Regime, least_flow: f64, settings: &EnergySettings) -> RegimeJudgement {
        let count = self.windows.max(1) as f64;
        let (variance, parameter_variance) = (self.variance / count, self.parameter_variance / count);
        let elsewhere = self.windows.saturating_sub(self.worst_event.windows).max(1) as f64;
        let squares_elsewhere = (self.squares - self.worst_event.squares).max(0.0);
        let rounding = (self.rounding_squares / count).sqrt();
        let flow = self.mean_flow();
        RegimeJudgement {
            regime,
            windows: self.windows,
            mean: self.residual / count,
            peak: self.peak,
            size: (self.squares / count).sqrt(),
            size_elsewhere: (squares_elsewhere / elsewhere).sqrt(),
            noise: variance.sqrt(),
            parameters: parameter_variance.sqrt(),
            rounding,
            flow,
            band: if self.windows < FEWEST {
                f64::INFINITY
            } else {
                band(settings, Explained { variance, parameter_variance, rounding, flow: flow.max(least_flow) })
            },
        }
    }
}
