//! A spool sensor that is read earlier than the other instruments.

use super::{
    ActsOn, Card, Family, Finding, Growth, Kind, Needs, ParameterCard, Physics, Prior, PriorScale, Scalar, Site,
    Spread, Start, text,
};
use crate::machine::Machine;

/// A spool sensor that is read earlier than the other instruments, by less than a sample.
///
/// Samples with the same timestamp are not simultaneous: converters sample in sequence, and controllers compute an output at the
/// end of a cycle and report it at its beginning. A command that is held between two samples acts half an interval later than
/// linear interpolation of its samples. Half a millisecond is nothing for an arm, but matters for a bulk modulus: a chamber fills
/// in two to ten milliseconds.
///
/// The rate at a sample is the mean of the rates before and after it, as for a smooth curve. If the two differ much, the input
/// jumps, and the rate is that of the side on which the true value lies. Then no lead of up to a sample interval makes the
/// opening larger than its samples, and the oil volume is that of the jump at its right time.
pub struct SpoolSensorLead;

static CARD: Card = Card {
    name: text("spool_sensor_lead"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Recording,
    summary: text(
        "The spool's sensor is read a little earlier (or later) than the other instruments, or its opening is held between samples.",
    ),
    equation: text(
        "u(t) = reading(t) - T d(reading)/dt; where reading jumps, with its rate before t for T > 0 and after t for T < 0",
    ),
    source: text("practice (converters that take turns, cycles of controllers)"),
    shows: text(
        "Pressures rise before their cause, by less than a sample; bulk moduli come out too low (lead) or too high.",
    ),
    experiment: text("Steps and fast sines of the spool."),
    energy: text("None: it acts on the instrument."),
};

/// An opening held between samples acts half a sample interval late, and converters sample in sequence within one interval. So a
/// third of the interval is one standard deviation, and a sensor may lead by two thirds. In fast recordings a controller's cycle
/// of a millisecond is longer: 1.3 ms are two deviations of 0.65 ms. A spool sensor with a filter lags by up to 5 ms, which is
/// eight deviations.
const PRIOR: Prior = Prior {
    spread: Spread::OfSampleInterval { part: 1.0 / 3.0, at_least_s: 6.5e-4 },
    scale: PriorScale::Linear,
    range: [-8.0, 2.0],
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("spool_lead_time"),
    symbol: text("T"),
    unit: text("s"),
    meaning: text("how much later than its stamp the opening is what the sensor reports"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: -2e-2,
    maximum: 2e-2,
    typical: 5e-4,
    start: Start::at(&[0.0]),
    prior: Some(PRIOR),
}];

impl Physics for SpoolSensorLead {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn finding(&self, parameters: &[(f64, &str)]) -> Option<Finding> {
        let (time, _) = *parameters.first()?;
        let sentences = [
            "The spool sensor is sampled at a different time from the other sensors",
            "The spool sensors are sampled at a different time from the other sensors",
        ];
        Some(Finding {
            sentences,
            value: format!("{:.2} ms {}", 1e3 * time.abs(), if time > 0.0 { "earlier" } else { "later" }),
        })
    }

    fn has_power(&self) -> bool {
        false
    }

    fn reads_input_rate(&self) -> bool {
        true
    }

    fn read<T: Scalar>(&self, parameters: &[T], reading: T, course: [T; 2]) -> T {
        let lead = parameters[0];
        let [before, after] = course;
        let (side, other) = if lead.value() >= 0.0 { (before, after) } else { (after, before) };
        let size = side.value().abs() + other.value().abs();
        let jump = if size > 0.0 { (side.value() - other.value()).abs() / size } else { 0.0 };
        reading - lead * (side + (other - side) * (0.5 * (1.0 - jump)))
    }
}
