//! Drag of a tool in soil: a torque against the rate of the joint that grows with the square of the rate.

use excavator_model::effects::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Site, Start, text};
use excavator_model::equations::{Rows, Situation};
use excavator_model::machine::Machine;
use excavator_model::scalar::Scalar;

/// Drag of a tool in soil.
pub struct ToolDrag;

static CARD: Card = Card {
    name: text("tool_drag"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("A torque against the joint's rate that grows with its square."),
    equation: text("torque -k qd |qd|"),
    source: text("example"),
    shows: text("Torque error that bends upward with the rate, opposite for the two directions."),
    experiment: text("Steady strokes at several rates, in soil and in air."),
    energy: text("Dissipates k |qd|^3."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("tool_drag"),
    symbol: text("k"),
    unit: text("N m s2"),
    meaning: text("torque at a rate of 1 rad/s"),
    kind: Kind::Linear,
    growth: Growth::TORQUE,
    minimum: 0.0,
    maximum: 1e6,
    typical: 5e3,
    start: Start::at(&[5e3]),
    prior: None,
}];

impl Physics for ToolDrag {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let rate = now.pistons[cylinder].rate;
        rows.torque[cylinder] -= parameters[0] * rate * rate.abs();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use excavator_model::document::{DocumentError, built_in};
    use excavator_model::effects::Catalogue;
    use excavator_model::energy::ledger;
    use excavator_model::equations::{Inputs, System};
    use excavator_model::{Model, ModelError};

    use super::*;

    /// What the built-in effects get without further code: power in the ledger, from the same formula.
    #[test]
    fn its_power_is_in_the_ledger() -> Result<(), Box<dyn std::error::Error>> {
        let model = with_drag()?;
        let system = System::new(&model);
        let mut state = vec![0.0; system.layout().len];
        state[system.layout().rate(0)] = 0.5;
        let book = ledger(&system, &model.parameter_values(), &state, &Inputs::zero(1));
        let own = book.effects.last().ok_or("no effect")?;
        assert_eq!(own.effect, "tool_drag");
        assert!((own.mechanical + 5e3 * 0.125).abs() < 1e-9, "{}", own.mechanical);
        Ok(())
    }

    /// A name that is there already is one clear line.
    #[test]
    fn it_is_there_once() -> Result<(), Box<dyn std::error::Error>> {
        let model = with_drag()?;
        let error = model.catalogue.with([Arc::new(ToolDrag) as _]).err().ok_or("twice")?;
        assert_eq!(error.to_string(), "there are two effects named \"tool_drag\"; give yours another name");
        Ok(())
    }

    fn with_drag() -> Result<Model, Box<dyn std::error::Error>> {
        let catalogue = Catalogue::built_in().with([Arc::new(ToolDrag) as _])?;
        let plain = Model { catalogue, ..built_in("zx30u-arm").map_err(|error: DocumentError| error.to_string())? };
        let (physics, site) = plain.parse_addition("tool_drag@arm")?.remove(0);
        plain.with_effect(&physics, site).map_err(|error: ModelError| error.into())
    }
}
