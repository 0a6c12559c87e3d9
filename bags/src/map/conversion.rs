//! Converts the number in a message or cell to the value of a signal.

use super::error::MapError;
use super::signal_source::SignalSource;
use super::unit::{Dimension, Unit};

/// Value of the signal = `factor` · number in SI units + `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conversion {
    unit: Unit,
    factor: f64,
    offset: f64,
    /// What the values measure; `None` if neither map nor data say so.
    dimension: Option<Dimension>,
}

impl Conversion {
    /// The conversion in a map; `unit` is that of the column heading, used if the map has none.
    ///
    /// # Errors
    /// [`MapError::UnknownUnit`], [`MapError::WrongDimension`], [`MapError::BadQuantity`], [`MapError::BadNumber`].
    pub fn of(source: &SignalSource, heading: Option<&str>) -> Result<Conversion, MapError> {
        let signal = source.signal.to_string();
        let dimension = source.signal.kind.dimension();
        let unit = match source.unit.as_deref().or(heading) {
            None => Unit::si(dimension),
            Some(name) => unit_named(&signal, name)?,
        };
        let is_given = source.unit.is_some() || heading.is_some();
        let own = Some(unit.dimension).filter(|own| is_given && source.signal.kind.takes(*own));
        let (scale, measured) = match &source.scale {
            Some(scale) => {
                let ratio = scale.ratio_to_si(&signal, unit.dimension, |found| source.signal.kind.takes(found))?;
                (ratio.factor, ratio.over.or(own))
            }
            None if source.signal.kind.takes(unit.dimension) => (1.0, own),
            None => {
                return Err(MapError::WrongDimension {
                    signal,
                    wanted: dimension,
                    unit: unit.name.to_string(),
                    found: unit.dimension,
                });
            }
        };
        let sign = match source.sign {
            None | Some(1) => 1.0,
            Some(-1) => -1.0,
            Some(found) => {
                let found = f64::from(found);
                return Err(MapError::BadNumber { place: signal, key: "sign", found, wanted: "1 or -1" });
            }
        };
        let offset = match &source.offset {
            Some(offset) => {
                let of_unit = source.scale.is_none() && source.signal.kind.takes(unit.dimension);
                offset.to_si(&signal, "offset", if of_unit { unit.dimension } else { dimension })?
            }
            None => 0.0,
        };
        Ok(Conversion { unit, factor: sign * scale, offset, dimension: measured })
    }

    /// The conversion of a name in formulas: to SI if it has a unit, otherwise none. `place` is for error messages.
    ///
    /// # Errors
    /// [`MapError::UnknownUnit`].
    pub(super) fn of_name(place: &str, unit: Option<&str>) -> Result<Conversion, MapError> {
        let given = unit.map(|name| unit_named(place, name)).transpose()?;
        let dimension = given.map(|unit| unit.dimension);
        let unit = given.unwrap_or(Unit::si(Dimension::Number));
        Ok(Conversion { unit, factor: 1.0, offset: 0.0, dimension })
    }

    /// What the values measure, and the unit of the numbers; `None` if neither map nor data say so.
    pub(super) fn measures(&self) -> Option<(Dimension, &'static str)> {
        self.dimension.map(|dimension| (dimension, self.unit.name))
    }

    /// The value of the signal; a value that is not finite counts as not measured.
    pub fn apply(&self, number: f64) -> f64 {
        let value = self.unit.to_si(number) * self.factor;
        let value = if self.offset == 0.0 { value } else { value + self.offset };
        if value.is_finite() { value } else { f64::NAN }
    }
}

fn unit_named(place: &str, name: &str) -> Result<Unit, MapError> {
    Unit::named(name).ok_or_else(|| MapError::UnknownUnit {
        signal: place.to_string(),
        unit: name.to_string(),
        known: Unit::names(),
    })
}
