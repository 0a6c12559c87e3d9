//! Draws the energy flow as ribbons from the pump to the losses and stores.

use excavator_identification::energy::{Budget, Totals};
use excavator_model::Model;
use excavator_model::effects::ActsOn;
use excavator_model::machine::Supply;
use excavator_model::site_name;
use maud::Markup;

use super::energy_text::delivered_by;
use super::numbers::{percent, significant};
use super::sankey::{Node, Ribbon, sankey};
use super::words;

const SOURCE: &str = "var(--blue)";
const LOSS: &str = "var(--orange)";
const CYLINDER: &str = "var(--green)";
const STORED: &str = "var(--sky)";
const UNEXPLAINED: &str = "var(--purple)";

/// Columns of the picture. Sources that return energy to the pump line are left of the pump.
const PUMP: usize = 1;
const CYLINDERS: usize = 2;
const TAKERS: usize = 3;

/// Parts below this share of the total are left out of the picture. The table includes them.
const SMALLEST: f64 = 5e-4;

/// The picture of some energies.
pub(super) fn energy_flow(model: &Model, totals: &Totals) -> Markup {
    let mut flow = Flow { nodes: Vec::new(), ribbons: Vec::new(), whole: Budget::of(model, totals).delivered };
    let machine = &model.machine;
    let pump = matches!(machine.supply, Supply::PumpLine(_)).then(|| flow.node("pump", totals.pump, PUMP, SOURCE));
    let cylinders: Vec<usize> = machine
        .cylinders
        .iter()
        .zip(&totals.cylinders)
        .map(|(cylinder, own)| {
            flow.node(&format!("into the {} cylinder", cylinder.name), own.supplied, CYLINDERS, CYLINDER)
        })
        .collect();
    if let Some(pump) = pump {
        for (index, own) in totals.cylinders.iter().enumerate() {
            flow.pass(pump, cylinders[index], own.supplied);
        }
        for (cylinder, own) in machine.cylinders.iter().zip(&totals.cylinders) {
            flow.give(pump, &format!("metering, {} valve", cylinder.name), own.metering_loss, CYLINDERS, LOSS);
        }
        for effect in totals.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve && effect.has_power) {
            flow.give(pump, &words::spoken(&effect.effect), -effect.into_pump_line, CYLINDERS, LOSS);
        }
        flow.give(pump, "stored in the pump line", totals.pump_line, CYLINDERS, STORED);
        flow.give(pump, "not explained in the pump line", -totals.pump_residual(), CYLINDERS, UNEXPLAINED);
    } else {
        let source = flow.node(delivered_by(model), flow.whole, PUMP, SOURCE);
        for ((index, cylinder), own) in machine.cylinders.iter().enumerate().zip(&totals.cylinders) {
            flow.pass(source, cylinders[index], own.supplied);
            flow.give(source, &format!("metering, {} valve", cylinder.name), own.metering_loss, CYLINDERS, LOSS);
        }
    }
    for (index, (cylinder, own)) in machine.cylinders.iter().zip(&totals.cylinders).enumerate() {
        let from = cylinders[index];
        let many = machine.cylinders.len() > 1;
        let label = |what: &str| if many { format!("{what}, {}", cylinder.name) } else { what.to_string() };
        for effect in totals.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve && effect.has_power) {
            if site_name(machine, effect.site) == cylinder.name {
                flow.give(from, &label(&words::spoken(&effect.effect)), -effect.into_cylinders, TAKERS, LOSS);
            }
        }
        flow.give(from, &label("stored: motion and height"), own.kinetic + own.potential, TAKERS, STORED);
        flow.give(from, &label("stored: compressed oil"), own.cap_internal + own.rod_internal, TAKERS, STORED);
        flow.give(from, &label("not explained"), -totals.residual(index), TAKERS, UNEXPLAINED);
    }
    sankey(&flow.nodes, &flow.ribbons, "flow of energy from the pump to losses and storage")
}

struct Flow {
    nodes: Vec<Node>,
    ribbons: Vec<Ribbon>,
    whole: f64,
}

impl Flow {
    fn node(&mut self, label: &str, amount: f64, column: usize, colour: &'static str) -> usize {
        let amount = format!("{} J · {}", significant(amount, 3), percent(amount / self.whole));
        self.nodes.push(Node { label: label.to_string(), amount, column, colour });
        self.nodes.len() - 1
    }

    fn pass(&mut self, from: usize, to: usize, amount: f64) {
        let (from, to) = if amount < 0.0 { (to, from) } else { (from, to) };
        self.ribbons.push(Ribbon { from, to, amount: amount.abs() });
    }

    /// Adds a ribbon of `amount` from a node to a new sink in `column`. If the amount is negative, the new node is a
    /// source to the left of the node, and the ribbon leads from it.
    fn give(&mut self, node: usize, label: &str, amount: f64, column: usize, colour: &'static str) {
        if !amount.is_finite() || amount.abs() < SMALLEST * self.whole.abs() {
            return;
        }
        if amount >= 0.0 {
            let to = self.node(label, amount, column, colour);
            self.ribbons.push(Ribbon { from: node, to, amount });
        } else {
            let from = self.node(&format!("{label}: given back"), -amount, column.saturating_sub(2), colour);
            self.ribbons.push(Ribbon { from, to: node, amount: -amount });
        }
    }
}
