//! Does the ledger close, place by place?

use super::noise::WindowNoise;
use super::windows::Window;
use super::{EnergySettings, Place, Regime};

/// What is missing at a place under one condition.
#[derive(Debug, Clone, PartialEq)]
pub struct RegimeJudgement {
    /// The condition.
    pub regime: Regime,
    /// Windows in which it was met.
    pub windows: usize,
    /// Mean power that is stored without the model saying from where, W; negative: it goes missing. Zero for no windows.
    pub mean: f64,
    /// Largest of the windows' powers by size, with its sign, W.
    pub peak: f64,
    /// Standard error of the mean from sensor noise, W.
    pub noise: f64,
    /// Standard error of the mean from the parameters' standard errors, W; zero where the model has none.
    pub parameters: f64,
    /// Mean power that flows through the place, W.
    pub flow: f64,
    /// Half width of the band within which the mean is explained, W.
    pub band: f64,
}

impl RegimeJudgement {
    /// Whether noise, the parameters' errors and the tolerance explain the mean.
    pub fn is_explained(&self) -> bool {
        self.mean.abs() <= self.band
    }
}

/// The ledger of one place.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceJudgement {
    /// The place.
    pub place: Place,
    /// One entry per [`Regime`], in that order.
    pub regimes: Vec<RegimeJudgement>,
    /// Root mean square of what is missing in the windows, W.
    pub root_mean_square: f64,
    /// Root mean square that sensor noise and parameters explain, W.
    pub explained: f64,
    /// Share of the windows that are outside their own band.
    pub share_outside: f64,
}

impl PlaceJudgement {
    /// Whether the ledger closes at this place under every condition.
    pub fn is_explained(&self) -> bool {
        self.regimes.iter().all(RegimeJudgement::is_explained)
    }

    /// The condition under which most is missing, relative to its band; `None` where all is explained.
    pub fn worst(&self) -> Option<&RegimeJudgement> {
        let outside = self.regimes.iter().filter(|regime| !regime.is_explained());
        outside.max_by(|a, b| (a.mean / a.band).abs().total_cmp(&(b.mean / b.band).abs()))
    }
}

/// Fewest windows that a condition is judged by.
const FEWEST: usize = 6;
/// Windows overlap so that neighbours share their noise: this many are worth one.
const WORTH_ONE: f64 = 2.0;

/// Sums over windows.
#[derive(Debug, Clone)]
pub(super) struct Judge {
    settings: EnergySettings,
    places: Vec<(Place, Option<usize>)>,
    sums: Vec<Vec<Sum>>,
    squares: Vec<f64>,
    explained: Vec<f64>,
    outside: Vec<usize>,
    windows: usize,
    last_noise: Option<WindowNoise>,
}

#[derive(Debug, Clone, Default)]
struct Sum {
    windows: usize,
    residual: f64,
    peak: f64,
    variance: f64,
    parameters: Vec<f64>,
    flow: f64,
}

/// A window with its errors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    /// Residual of each place with what noise adds to it on average taken off, W.
    pub residuals: Vec<f64>,
    /// Half width of its band, W.
    pub bands: Vec<f64>,
}

impl Judge {
    /// `places` with the cylinder whose doings make their regimes.
    pub fn new(places: Vec<(Place, Option<usize>)>, settings: EnergySettings) -> Self {
        let count = places.len();
        Judge {
            settings,
            places,
            sums: vec![vec![Sum::default(); Regime::ALL.len()]; count],
            squares: vec![0.0; count],
            explained: vec![0.0; count],
            outside: vec![0; count],
            windows: 0,
            last_noise: None,
        }
    }

    /// Takes over the noise of a block for windows that come without.
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
            // The mean of the repeats that was taken off has noise of its own.
            let variance = noise.map_or(0.0, |noise| noise.variance[index] * (1.0 + 1.0 / draws));
            let parameters = noise.map_or(&[][..], |noise| &noise.parameters[index]);
            let total = variance + parameters.iter().map(|change| change * change).sum::<f64>();
            let flow = window.flows[index];
            let band = self.settings.significance * total.sqrt() + self.settings.tolerance * flow;
            self.squares[index] += residual * residual;
            self.explained[index] += total;
            self.outside[index] += usize::from(residual.abs() > band);
            for (regime, sum) in Regime::ALL.iter().zip(&mut self.sums[index]) {
                let met = match cylinder {
                    Some(cylinder) => window.situations[cylinder].is(*regime),
                    None => window.situations.iter().any(|situation| situation.is(*regime)),
                };
                if met {
                    sum.add(residual, variance, parameters, flow);
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
            .map(|(index, &(place, _))| PlaceJudgement {
                place,
                regimes: Regime::ALL.iter().zip(&self.sums[index]).map(|(r, sum)| sum.judge(*r, &self.settings)).collect(),
                root_mean_square: (self.squares[index] / count).sqrt(),
                explained: (self.explained[index] / count).sqrt(),
                share_outside: self.outside[index] as f64 / count,
            })
            .collect()
    }
}

impl Sum {
    fn add(&mut self, residual: f64, variance: f64, parameters: &[f64], flow: f64) {
        self.windows += 1;
        self.residual += residual;
        if residual.abs() > self.peak.abs() {
            self.peak = residual;
        }
        self.variance += variance;
        self.parameters.resize(parameters.len().max(self.parameters.len()), 0.0);
        self.parameters.iter_mut().zip(parameters).for_each(|(sum, change)| *sum += change);
        self.flow += flow;
    }

    fn judge(&self, regime: Regime, settings: &EnergySettings) -> RegimeJudgement {
        let count = self.windows.max(1) as f64;
        let noise = (self.variance * WORTH_ONE).sqrt() / count;
        // A wrong parameter is wrong in all windows alike: its part does not average out.
        let parameters = self.parameters.iter().map(|sum| (sum / count).powi(2)).sum::<f64>().sqrt();
        let flow = self.flow / count;
        let band = if self.windows < FEWEST {
            f64::INFINITY
        } else {
            settings.significance * noise.hypot(parameters) + settings.tolerance * flow
        };
        RegimeJudgement {
            regime,
            windows: self.windows,
            mean: self.residual / count,
            peak: self.peak,
            noise,
            parameters,
            flow,
            band,
        }
    }
}
