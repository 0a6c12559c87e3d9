//! Instruments that report late.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::{Channel, Instruments};
use crate::machine::Machine;

/// Instruments that report late.
///
/// A pure delay without states: [`crate::simulation::Observer`] looks back along the trajectory.
pub struct SensorDelay;

static CARD: Card = Card {
    name: text("sensor_delay"),
    acts_on: ActsOn::Instruments,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text(
        "Readings arrive later than they are stamped: filters, converters and buses on the way; the machine feels nothing of it.",
    ),
    equation: text(
        "reported y(t) = y(t - T), one T for position (displacement, angle, velocity), one for the pressures: of a cylinder, of the pump line, or of the whole machine",
    ),
    source: text("practice (group delay of filters, cycle time of field buses)"),
    shows: text(
        "Error in proportion to the rate of the signal, by the same time at all frequencies, in the late signals only: against valve_lag, pump pressure is not late.",
    ),
    experiment: text(
        "Sines of two frequencies: phase that grows in proportion to frequency. Knock on the boom: all sensors should see it at once.",
    ),
    energy: text("None: it acts on the instrument."),
};

const fn displacement_delay(meaning: &'static str) -> ParameterCard {
    ParameterCard {
        name: text("displacement_delay"),
        symbol: text("Ts"),
        unit: text("s"),
        meaning: text(meaning),
        kind: Kind::Shape,
        growth: Growth::TIME,
        minimum: 0.0,
        maximum: 0.5,
        typical: 0.01,
        start: Start::at(&[5e-3]),
        prior: None,
    }
}

const fn pressure_delay(meaning: &'static str) -> ParameterCard {
    ParameterCard {
        name: text("pressure_delay"),
        symbol: text("Tp"),
        unit: text("s"),
        meaning: text(meaning),
        kind: Kind::Shape,
        growth: Growth::TIME,
        minimum: 0.0,
        maximum: 0.5,
        typical: 0.01,
        start: Start::at(&[5e-3]),
        prior: None,
    }
}

static CYLINDER: &[ParameterCard] = &[
    displacement_delay("delay of displacement, velocity and joint angle"),
    pressure_delay("delay of both chamber pressures"),
];

static MACHINE: &[ParameterCard] = &[
    displacement_delay("delay of displacement, velocity and joint angle of every cylinder"),
    pressure_delay("delay of all chamber pressures and of the pump pressure"),
];

static LOAD: &[ParameterCard] = &[displacement_delay("delay of displacement, velocity and joint angle")];

static PUMP_LINE: &[ParameterCard] = &[pressure_delay("delay of the pump pressure")];

impl Physics for SensorDelay {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, site: Site) -> &[ParameterCard] {
        match site {
            Site::Cylinder(index) if machine.cylinders.get(index).is_some_and(|c| c.chambers.is_some()) => CYLINDER,
            Site::Machine if machine.has_chambers() => MACHINE,
            // Without chambers there are no pressure signals to delay, and no pump line either.
            Site::Cylinder(_) | Site::Machine => LOAD,
            Site::PumpLine => PUMP_LINE,
        }
    }

    fn has_power(&self) -> bool {
        false
    }

    fn distort<T: Scalar>(&self, site: Site, parameters: &[T], instruments: &mut Instruments<T>) {
        match site {
            Site::Cylinder(cylinder) => delay_cylinder(cylinder, parameters, instruments),
            Site::PumpLine => instruments.of_mut(Channel::PumpPressure).delay += parameters[0],
            Site::Machine => {
                for cylinder in 0..instruments.cylinders() {
                    delay_cylinder(cylinder, parameters, instruments);
                }
                if let Some(&late) = parameters.get(1) {
                    instruments.of_mut(Channel::PumpPressure).delay += late;
                }
            }
        }
    }
}

/// Delays the reports of one cylinder's instruments; parameters are the delay of the position and, with chambers, of the
/// pressures.
fn delay_cylinder<T: Scalar>(cylinder: usize, parameters: &[T], instruments: &mut Instruments<T>) {
    for channel in [Channel::JointAngle(cylinder), Channel::Displacement(cylinder), Channel::Velocity(cylinder)] {
        instruments.of_mut(channel).delay += parameters[0];
    }
    if let Some(&late) = parameters.get(1) {
        instruments.of_mut(Channel::CapPressure(cylinder)).delay += late;
        instruments.of_mut(Channel::RodPressure(cylinder)).delay += late;
    }
}
