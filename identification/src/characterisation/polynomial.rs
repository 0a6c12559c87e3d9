//! Fits polynomials to points with errors, with the lowest degree that the points require.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Significance for a higher degree: one needless term in a hundred.
const SIGNIFICANCE: f64 = 0.01;

/// A polynomial `y = c0 + c1 x + c2 x^2 + ...` with the covariance of its coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial {
    /// c0, c1, ...
    pub coefficients: Vec<f64>,
    /// Covariance of the coefficients: from the points' errors, or from their scatter where that is larger.
    pub covariance: DMatrix<f64>,
    /// Why this degree.
    pub reason: String,
    /// Root mean square distance of the points from the curve, in units of their errors.
    pub scatter: f64,
}

/// A point with the standard error of y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    pub error: f64,
}

impl Polynomial {
    /// The polynomial of lowest degree, at most `highest`, for which neither one nor two more degrees reduce the squared error
    /// with a significance of 1 % (F test against scatter or stated errors, whichever is larger). `None` if there are fewer than
    /// two points more than coefficients, or if all points coincide in x.
    pub(super) fn through(points: &[Point], highest: usize) -> Option<Polynomial> {
        let fits: Vec<Fitted> =
            (0..=highest).take_while(|degree| points.len() >= degree + 3).map_while(|d| fitted(points, d)).collect();
        let mut degree = 0;
        let mut reason = String::new();
        while degree < fits.len() {
            let tests: Vec<FTest> =
                [1, 2].iter().filter_map(|more| f_test(&fits, degree, degree + more, points.len())).collect();
            match tests.iter().find(|test| test.probability < SIGNIFICANCE) {
                Some(test) => {
                    reason = format!("degree {} needed: {test}", test.degree);
                    degree = test.degree;
                }
                None => {
                    let enough: Vec<String> =
                        tests.first().iter().map(|test| format!("degree {} not needed: {test}", test.degree)).collect();
                    let parts = [reason, enough.join("")];
                    reason = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ");
                    break;
                }
            }
        }
        if degree == fits.len().saturating_sub(1) && degree == highest && degree > 0 {
            reason.push_str("; the highest that is tried");
        }
        let chosen = fits.into_iter().nth(degree)?;
        let freedom = (points.len() - degree - 1) as f64;
        let excess = (chosen.squares / freedom).max(1.0);
        Some(Polynomial {
            coefficients: chosen.coefficients,
            covariance: chosen.covariance * excess,
            reason: if reason.is_empty() { "too few points for more than a constant".into() } else { reason },
            scatter: (chosen.squares / freedom).sqrt(),
        })
    }

    /// Degree.
    pub fn degree(&self) -> usize {
        self.coefficients.len().saturating_sub(1)
    }

    /// Value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
    }

    /// Standard error of the curve at `x`.
    pub fn error_at(&self, x: f64) -> f64 {
        let powers = DVector::from_fn(self.coefficients.len(), |power, _| x.powi(power as i32));
        powers.dot(&(&self.covariance * &powers)).max(0.0).sqrt()
    }

    /// Adds to the covariance the effect of an error common to all points, given the curve through the shifted points.
    pub(super) fn widen(&mut self, shifted: &Polynomial) {
        let moved = DVector::from_fn(self.coefficients.len(), |power, _| {
            shifted.coefficients.get(power).copied().unwrap_or(0.0) - self.coefficients[power]
        });
        self.covariance += &moved * moved.transpose();
    }

    /// The polynomial of exactly this degree.
    pub(super) fn of_degree(points: &[Point], degree: usize) -> Option<Polynomial> {
        let found = fitted(points, degree)?;
        Some(Polynomial {
            coefficients: found.coefficients,
            covariance: found.covariance,
            reason: String::new(),
            scatter: f64::NAN,
        })
    }
}

struct Fitted {
    coefficients: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Sum of squared residuals over squared errors.
    squares: f64,
}

fn fitted(points: &[Point], degree: usize) -> Option<Fitted> {
    // Centred and scaled, so that the powers of x are well conditioned.
    let count = points.len() as f64;
    let centre = points.iter().map(|point| point.x).sum::<f64>() / count;
    let width = points.iter().map(|point| (point.x - centre).abs()).fold(0.0, f64::max);
    if degree > 0 && width <= 0.0 {
        return None;
    }
    let width = if width > 0.0 { width } else { 1.0 };
    let matrix = DMatrix::from_fn(points.len(), degree + 1, |row, power| {
        ((points[row].x - centre) / width).powi(power as i32) / points[row].error
    });
    let right = DVector::from_fn(points.len(), |row, _| points[row].y / points[row].error);
    let inverse = (matrix.transpose() * &matrix).try_inverse()?;
    let scaled = &inverse * (matrix.transpose() * &right);
    let squares = (&right - &matrix * &scaled).norm_squared();
    // Converts powers of (x - centre) / width to powers of x.
    let change = DMatrix::from_fn(degree + 1, degree + 1, |power, from| {
        if power > from {
            return 0.0;
        }
        binomial(from, power) * (-centre).powi((from - power) as i32) / width.powi(from as i32)
    });
    let coefficients: Vec<f64> = (&change * scaled).iter().copied().collect();
    let covariance = &change * inverse * change.transpose();
    coefficients.iter().all(|c| c.is_finite()).then_some(Fitted { coefficients, covariance, squares })
}

fn binomial(of: usize, chosen: usize) -> f64 {
    (0..chosen).map(|k| (of - k) as f64 / (k + 1) as f64).product()
}

struct FTest {
    degree: usize,
    taken: f64,
    ratio: f64,
    probability: f64,
}

impl std::fmt::Display for FTest {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            formatter,
            "it takes {:.0} % of the squared error away (F = {:.1}, p = {:.2})",
            100.0 * self.taken,
            self.ratio,
            self.probability
        )
    }
}

fn f_test(fits: &[Fitted], from: usize, to: usize, points: usize) -> Option<FTest> {
    let (lower, higher) = (fits.get(from)?, fits.get(to)?);
    let freedom = points.checked_sub(to + 1).filter(|&left| left > 0)?;
    // Squares are in units of the points' errors. Scatter below these errors is chance, not precision.
    let ratio_to_errors = (higher.squares / freedom as f64).max(1.0) * freedom as f64;
    let (ratio, probability) = f_ratio(lower.squares - higher.squares, ratio_to_errors, to - from, freedom)?;
    Some(FTest { degree: to, taken: 1.0 - higher.squares / lower.squares, ratio, probability })
}

/// F ratio of two nested fits and its p-value if the added terms are zero. `taken` is the squared error that the `added` terms
/// remove, `left` the remaining one with `freedom` degrees of freedom.
pub(super) fn f_ratio(taken: f64, left: f64, added: usize, freedom: usize) -> Option<(f64, f64)> {
    let ratio = (taken / added as f64) / (left / freedom as f64);
    let distribution = FisherSnedecor::new(added as f64, freedom as f64).ok()?;
    let probability = if ratio.is_finite() && ratio > 0.0 { distribution.sf(ratio) } else { 1.0 };
    Some((ratio, probability))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn points(of: impl Fn(f64) -> f64, noise: f64) -> Vec<Point> {
        (0..30)
            .map(|k| {
                let x = 0.25 + 0.025 * f64::from(k);
                // A fixed pattern without a trend serves as noise.
                let pattern = f64::from((k * 7919 + 13) % 101) / 50.0 - 1.0;
                Point { x, y: of(x) + noise * pattern, error: noise }
            })
            .collect()
    }

    #[test]
    fn degree_and_coefficients_of_a_parabola_come_back() {
        let found = Polynomial::through(&points(|x| 2.0 - 3.0 * x + 5.0 * x * x, 0.01), 4).unwrap();
        assert_eq!(found.degree(), 2, "{}", found.reason);
        for (power, truth) in [2.0, -3.0, 5.0].into_iter().enumerate() {
            let error = found.covariance[(power, power)].sqrt();
            assert!((found.coefficients[power] - truth).abs() < 3.0 * error, "{found:?}");
        }
        assert!((found.at(0.5) - 1.75).abs() < 3.0 * found.error_at(0.5));
        assert!(found.error_at(0.6) < found.error_at(1.2));
    }

    #[test]
    fn a_constant_stays_a_constant() {
        let found = Polynomial::through(&points(|_| 4.6, 0.01), 4).unwrap();
        assert_eq!(found.degree(), 0, "{}", found.reason);
        assert!(found.reason.contains("degree 1 not needed"), "{}", found.reason);
    }

    #[test]
    fn points_at_one_place_give_no_slope() {
        let same = [Point { x: 1.0, y: 2.0, error: 0.1 }; 6];
        assert_eq!(Polynomial::through(&same, 3).unwrap().degree(), 0);
        assert!(Polynomial::through(&same[..2], 3).is_none());
    }
}
