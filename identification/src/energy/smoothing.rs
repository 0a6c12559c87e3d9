//! Value and slope of several noisy signals on a common uneven clock.

/// Weights that give value and slope, at one time, of the least-squares parabola through the samples around it.
#[derive(Debug, Default)]
pub(crate) struct Parabola {
    first: usize,
    /// Half width of the current weights, s.
    half_width: f64,
    /// Times of the samples of the current weights, relative to the centre, as shares of the half width.
    places: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
    /// Coefficient of the square of a place.
    bend: Vec<f64>,
}

/// Fewest samples: three coefficients, one more to average.
const FEWEST: usize = 4;
/// Tolerance of times, s: rounding must not decide whether a window is symmetric.
const ROUNDING: f64 = 1e-7;
/// Weights are reused if no sample is further than this from its previous place, as a share of the half width: on an even clock
/// places differ by rounding only.
const SAME_PLACE: f64 = 1e-9;

/// Largest mean squared misfit, in variances of the noise, of a parabola that follows a signal. Noise alone exceeds it once in a
/// thousand windows of eleven samples.
const LARGEST_MISFIT: f64 = 3.3;

/// Gauge pressure below which a chamber boils or is refilled from the tank, Pa: that of the atmosphere.
const REFILLED: f64 = 0.0;

/// Parabolas of several widths, for pressures with corners.
#[derive(Debug, Default)]
pub(super) struct Parabolas {
    /// From the widest to the narrowest; those with too few samples are absent.
    widths: Vec<Parabola>,
    centre: usize,
}

/// Widths relative to the widest one.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];

impl Parabolas {
    /// Sets the parabolas at sample `centre`. Returns `false` if the widest one cannot be.
    pub fn set(&mut self, time: &[f64], centre: usize, half_width: f64) -> bool {
        self.centre = centre;
        self.widths.resize_with(SHARES.len(), Parabola::default);
        let mut known = self.widths.iter_mut().zip(SHARES);
        let widest = known.next().is_some_and(|(parabola, share)| parabola.set(time, centre, share * half_width));
        known.for_each(|(parabola, share)| {
            parabola.set(time, centre, share * half_width);
        });
        widest
    }

    /// Value of a signal by the widest parabola.
    pub fn widest(&self, signal: &[f64]) -> f64 {
        self.widths.first().map_or(f64::NAN, |parabola| parabola.value(signal))
    }

    /// Pressure (gauge, Pa) at the centre, of a signal with this noise. Where the chamber stays filled, by the widest parabola;
    /// where it boils or is refilled from the tank, by the widest one that follows the signal, or the sample itself where none
    /// does. `NaN` if a sample of the widest window is.
    pub fn pressure(&self, signal: &[f64], noise: f64) -> f64 {
        let widest = self.widest(signal);
        let boils = self.widths.first().is_some_and(|parabola| parabola.lowest(signal) < REFILLED);
        if widest.is_nan() || !boils {
            return widest;
        }
        let mut usable = self.widths.iter().filter(|parabola| !parabola.value.is_empty());
        usable
            .find(|parabola| parabola.follows(signal, noise))
            .map_or(signal[self.centre], |parabola| parabola.value(signal))
    }
}

impl Parabola {
    /// Sets the parabola at sample `centre` through the samples within `half_width` of it. Returns `false`, without weights, if
    /// there are too few samples or the window is cut off on one side.
    pub fn set(&mut self, time: &[f64], centre: usize, half_width: f64) -> bool {
        let (at, reach) = (time[centre], half_width + ROUNDING);
        let first = centre - time[..centre].iter().rev().take_while(|&&t| at - t <= reach).count();
        let last = centre + time[centre..].iter().take_while(|&&t| t - at <= reach).count();
        self.first = first;
        // A window that is cut off ends well before its half width.
        let cut = at - time[first] < 0.6 * half_width || time[last - 1] - at < 0.6 * half_width;
        if last - first < FEWEST || cut {
            self.places.clear();
            self.value.clear();
            return false;
        }
        let places = time[first..last].iter().map(|t| (t - at) / half_width);
        let is_same = self.half_width == half_width
            && self.places.len() == last - first
            && places.clone().zip(&self.places).all(|(place, before)| (place - before).abs() <= SAME_PLACE);
        if !is_same {
            self.places.clear();
            self.places.extend(places);
            self.half_width = half_width;
            self.weigh();
        }
        !self.value.is_empty()
    }

    /// Computes the weights for the places; none if they do not determine a parabola.
    fn weigh(&mut self) {
        self.value.clear();
        self.slope.clear();
        self.bend.clear();
        let mut s = [0.0_f64; 5];
        for x in &self.places {
            let square = x * x;
            s[0] += 1.0;
            s[1] += x;
            s[2] += square;
            s[3] += square * x;
            s[4] += square * square;
        }
        // Rows of the inverse of [s0 s1 s2; s1 s2 s3; s2 s3 s4] that give value and slope.
        let cofactors = [
            s[2] * s[4] - s[3] * s[3],
            s[2] * s[3] - s[1] * s[4],
            s[1] * s[3] - s[2] * s[2],
            s[0] * s[4] - s[2] * s[2],
        ];
        let corner = s[1] * s[2] - s[0] * s[3];
        let last = s[0] * s[2] - s[1] * s[1];
        let determinant = s[0] * cofactors[0] + s[1] * cofactors[1] + s[2] * cofactors[2];
        if determinant.abs() < 1e-12 {
            return;
        }
        for x in &self.places {
            self.value.push((cofactors[0] + cofactors[1] * x + cofactors[2] * x * x) / determinant);
            self.slope.push((cofactors[1] + cofactors[3] * x + corner * x * x) / determinant / self.half_width);
            self.bend.push((cofactors[2] + corner * x + last * x * x) / determinant);
        }
    }

    /// Value of a signal; `NaN` if one of its samples is.
    pub fn value(&self, signal: &[f64]) -> f64 {
        dot(&self.value, &signal[self.first..])
    }

    /// Whether the parabola differs from a signal by no more than noise of this standard deviation. It does not at a corner, which
    /// it cuts off.
    pub fn follows(&self, signal: &[f64], noise: f64) -> bool {
        let samples = &signal[self.first..self.first + self.places.len()];
        let origin = samples[0];
        let coefficient = |weights: &[f64]| {
            weights.iter().zip(samples).map(|(weight, sample)| weight * (sample - origin)).sum::<f64>()
        };
        let (value, slope, bend) =
            (coefficient(&self.value), coefficient(&self.slope) * self.half_width, coefficient(&self.bend));
        let error = |(place, sample): (&f64, &f64)| sample - origin - value - slope * place - bend * place * place;
        let squares: f64 = self.places.iter().zip(samples).map(|both| error(both).powi(2)).sum();
        squares <= LARGEST_MISFIT * noise * noise * (samples.len() as f64 - 3.0)
    }

    /// Lowest sample of a signal in the window.
    fn lowest(&self, signal: &[f64]) -> f64 {
        signal[self.first..self.first + self.places.len()].iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Slope of a signal.
    pub fn slope(&self, signal: &[f64]) -> f64 {
        // The weights add up to zero; subtracting the first sample keeps rounding errors small.
        let origin = signal[self.first];
        self.slope.iter().zip(&signal[self.first..]).map(|(weight, sample)| weight * (sample - origin)).sum()
    }
}

fn dot(weights: &[f64], samples: &[f64]) -> f64 {
    weights.iter().zip(samples).map(|(weight, sample)| weight * sample).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parabolas_come_back_exactly_on_an_uneven_clock() {
        let time: Vec<f64> = (0..40).map(|k| f64::from(k) * 1e-3 + 2e-4 * f64::from(k * 7 % 5)).collect();
        let signal: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t + 500.0 * t * t).collect();
        let mut parabola = Parabola::default();
        assert!(parabola.set(&time, 20, 0.01));
        let t = time[20];
        assert!((parabola.value(&signal) - (3.0 - 2.0 * t + 500.0 * t * t)).abs() < 1e-10);
        assert!((parabola.slope(&signal) - (-2.0 + 1000.0 * t)).abs() < 1e-8);
    }

    #[test]
    fn cut_windows_have_no_slope() {
        let time: Vec<f64> = (0..40).map(|k| f64::from(k) * 1e-3).collect();
        let mut parabola = Parabola::default();
        assert!(!parabola.set(&time, 2, 0.01));
        assert!(!parabola.set(&time, 38, 0.01));
        assert!(parabola.set(&time, 10, 0.01));
    }
}
