//! Quantities that scale the shape parameters of terms: how far, how fast and how strong things were in the recordings.

use excavator_model::equations::Situation;

/// A quantity of a machine. Its values in the recordings provide start values for a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::proposal) enum Quantity {
    Position,
    Speed,
    CapPressure,
    RodPressure,
    Load,
    PumpPressure,
    Opening,
    Time,
}

/// Start values of the search for a shape parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::proposal) enum Levels {
    /// Quantiles of the quantity.
    Quantiles(&'static [f64]),
    /// Shares of its magnitude: the 95 % quantile of its absolute value.
    OfSize(&'static [f64]),
    /// Shares of its range from the 5 % to the 95 % quantile.
    OfRange(&'static [f64]),
    /// Times on a machine of the reference size, s.
    Times(&'static [f64]),
    /// Pure numbers.
    Values(&'static [f64]),
}

impl Quantity {
    fn of(self, now: &Situation<'_, f64>, cylinder: usize) -> f64 {
        let piston = &now.pistons[cylinder];
        match self {
            Quantity::Position => piston.displacement,
            Quantity::Speed => piston.velocity,
            Quantity::CapPressure => piston.cap_pressure - now.tank_pressure,
            Quantity::RodPressure => piston.rod_pressure - now.tank_pressure,
            Quantity::Load => piston.cap_pressure - piston.rod_pressure,
            Quantity::PumpPressure => now.pump_pressure - now.tank_pressure,
            Quantity::Opening => piston.opening,
            Quantity::Time => now.time,
        }
    }

    /// Start values for a parameter that is scaled by this quantity at `cylinder`. There are none if the quantity was
    /// not measured or did not change.
    pub fn starts(self, levels: Levels, situations: &[Vec<Situation<'_, f64>>], cylinder: usize) -> Vec<f64> {
        if let Levels::Values(values) = levels {
            return values.to_vec();
        }
        if let Levels::Times(times) = levels {
            let scale = situations.iter().flatten().next().map_or(1.0, |now| now.time_scale);
            return times.iter().map(|time| time * scale).collect();
        }
        let all = situations.iter().flatten().filter(|now| cylinder < now.pistons.len());
        let mut values: Vec<f64> = all.map(|now| self.of(now, cylinder)).filter(|value| value.is_finite()).collect();
        if values.is_empty() {
            return Vec::new();
        }
        if matches!(levels, Levels::OfSize(_)) {
            values.iter_mut().for_each(|value| *value = value.abs());
        }
        values.sort_by(f64::total_cmp);
        let quantile = |level: f64| values[((values.len() - 1) as f64 * level).round() as usize];
        let (scale, shares) = match levels {
            Levels::Quantiles(levels) => return levels.iter().map(|&level| quantile(level)).collect(),
            Levels::OfSize(shares) => (quantile(0.95), shares),
            Levels::OfRange(shares) => (quantile(0.95) - quantile(0.05), shares),
            Levels::Times(values) | Levels::Values(values) => (1.0, values),
        };
        if scale > 0.0 { shares.iter().map(|share| share * scale).collect() } else { Vec::new() }
    }
}
