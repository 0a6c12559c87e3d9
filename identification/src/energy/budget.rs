//! Where the delivered energy went, as one sum: delivered = lost + stored + unexplained.

use excavator_model::effects::ActsOn;
use excavator_model::machine::Supply;
use excavator_model::{Model, site_name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{EnergyAnalysis, Regime, Totals};

/// What became of a part of the delivered energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BudgetShare {
    /// Turned into heat; negative where the effect gave energy.
    Lost,
    /// Stored in motion, height or compressed oil, and so of use later; negative where a store gave it back.
    Stored,
    /// Not accounted for; negative where energy appeared that the model does not know of.
    Unexplained,
}

/// A part of the delivered energy.
#[derive(Debug, Clone, PartialEq)]
pub struct BudgetLine {
    /// What became of it.
    pub share: BudgetShare,
    /// Name of the effect or of the store, with spaces.
    pub what: String,
    /// Name of the place: a cylinder, `pump` or `machine`.
    pub place: String,
    /// Energy, J.
    pub energy: f64,
}

/// One sum over a stretch of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Budget {
    /// Delivered by the pump, or by the supply of the valves, or by the force on the rods, J.
    pub delivered: f64,
    /// Where it went; the lines add up to `delivered`. The last is what is not explained.
    pub lines: Vec<BudgetLine>,
}

impl Budget {
    /// Of the energies over a stretch of time.
    pub fn of(model: &Model, totals: &Totals) -> Budget {
        let machine = &model.machine;
        let has_pump = matches!(machine.supply, Supply::PumpLine(_));
        let delivered = if has_pump {
            totals.pump
        } else {
            totals.cylinders.iter().map(|own| own.supplied + own.metering_loss).sum()
        };
        let mut lines = Vec::new();
        let mut add = |share, what: String, place: &str, energy: f64| {
            // What a machine does not have is no line.
            if energy != 0.0 {
                lines.push(BudgetLine { share, what, place: place.to_string(), energy });
            }
        };
        for (cylinder, own) in machine.cylinders.iter().zip(&totals.cylinders) {
            add(BudgetShare::Lost, "metering".to_string(), &cylinder.name, own.metering_loss);
        }
        for effect in totals.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve && effect.has_power) {
            let into_line = if has_pump { effect.into_pump_line } else { 0.0 };
            let given = effect.into_cylinders + into_line;
            add(BudgetShare::Lost, effect.effect.replace('_', " "), site_name(machine, effect.site), -given);
        }
        for (cylinder, own) in machine.cylinders.iter().zip(&totals.cylinders) {
            add(BudgetShare::Stored, "motion and height".to_string(), &cylinder.name, own.kinetic + own.potential);
            add(BudgetShare::Stored, "compressed oil".to_string(), &cylinder.name, own.cap_internal + own.rod_internal);
        }
        if has_pump {
            add(BudgetShare::Stored, "compressed oil".to_string(), "pump", totals.pump_line);
        }
        let known: f64 = lines.iter().map(|line| line.energy).sum();
        let what = "not explained".to_string();
        lines.push(BudgetLine {
            share: BudgetShare::Unexplained,
            what,
            place: "machine".to_string(),
            energy: delivered - known,
        });
        Budget { delivered, lines }
    }

    /// The line of the same share, effect or store, and place as `other`.
    fn find(&self, other: &BudgetLine) -> Option<&BudgetLine> {
        let is_same =
            |line: &&BudgetLine| (line.share, &line.what, &line.place) == (other.share, &other.what, &other.place);
        self.lines.iter().find(is_same)
    }

    /// What is not explained, J.
    pub fn unexplained(&self) -> f64 {
        self.lines.last().map_or(0.0, |line| line.energy)
    }

    /// Part of the delivered energy, a pure number.
    pub fn share_of(&self, energy: f64) -> f64 {
        energy / self.delivered.abs()
    }
}

/// The sum of a mean cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleBudget {
    /// Of the mean cycle.
    pub mean: Budget,
    deviation: Budget,
}

impl CycleBudget {
    /// Energy of a line in the mean cycle, and its standard deviation over cycles, J. The deviation of a sum is not the sum of
    /// deviations, so stores and what is left have none.
    pub fn line(&self, line: &BudgetLine) -> Option<(f64, Option<f64>)> {
        let deviation = self.deviation.find(line).filter(|_| line.share == BudgetShare::Lost);
        Some((self.mean.find(line)?.energy, deviation.map(|one| one.energy.abs())))
    }
}

impl EnergyAnalysis {
    /// The sum over the whole recording.
    pub fn budget(&self, model: &Model) -> Budget {
        Budget::of(model, &self.totals)
    }

    /// Energy that noise of sensors, uncertainty of parameters and smoothing can leave unexplained over the whole recording, J: the
    /// powers that explain each equation's residual, added up as if all of them had one sign.
    pub fn explicable(&self) -> f64 {
        let always = self
            .places
            .iter()
            .filter_map(|place| place.regimes.iter().find(|judged| matches!(judged.regime, Regime::Always)));
        always.map(|judged| judged.band).filter(|band| band.is_finite()).sum::<f64>() * self.totals.duration
    }

    /// Whether what a sum leaves unexplained over the whole recording is within that.
    pub fn is_within_noise(&self, budget: &Budget) -> bool {
        budget.unexplained().abs() <= self.explicable()
    }

    /// The sum of a mean cycle, and that of the standard deviations over cycles, if the work repeats.
    pub fn cycle_budget(&self, model: &Model) -> Option<CycleBudget> {
        let cycle = self.cycle.as_ref()?;
        let [mean, deviation] = [&cycle.mean, &cycle.deviation].map(|one| Budget::of(model, one));
        Some(CycleBudget { mean, deviation })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;
    use excavator_model::effects::Site;

    use super::*;

    #[test]
    fn the_lines_add_up_and_what_is_left_is_the_residual_of_all_places() {
        let model = built_in("zx30u-arm").unwrap();
        let mut totals = Totals::new(&model);
        for (number, own) in totals.numbers_mut().into_iter().enumerate() {
            *own = 10.0 + 3.0 * number as f64;
        }
        // Effects of the pump line give nothing to a cylinder.
        let at_the_pump = totals.effects.iter_mut().filter(|effect| !matches!(effect.site, Site::Cylinder(_)));
        at_the_pump.for_each(|effect| effect.into_cylinders = 0.0);
        // What a valve's effects give to the cylinder is what is supplied to it, and the rest of what they draw is lost.
        let valve = totals.effects.iter().filter(|effect| effect.acts_on == ActsOn::Valve);
        let [into, drawn] =
            valve.fold([0.0; 2], |[into, drawn], one| [into + one.into_cylinders, drawn + one.into_pump_line]);
        (totals.cylinders[0].supplied, totals.cylinders[0].metering_loss) = (into, -into - drawn);
        let budget = Budget::of(&model, &totals);
        let sum: f64 = budget.lines.iter().map(|line| line.energy).sum();
        assert!((sum / budget.delivered - 1.0).abs() < 1e-12, "{sum} {}", budget.delivered);
        let residual = totals.residual(0) + totals.pump_residual();
        assert!((budget.unexplained() + residual).abs() < 1e-9, "{} {residual}", budget.unexplained());
    }
}
