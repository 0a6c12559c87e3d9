//! A payload on the link.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::equations::planar_chain::{absolute_angle, add_first_moment, add_inertia, add_weight};
use crate::equations::smooth::window;
use crate::machine::{Chain, Machine, Mechanism};

/// A payload on the link.
///
/// The machine description has the distances of the pins but not of the tip, so the payload's distance is a parameter,
/// known if it was measured. A permanent load cannot be separated from the inertia and gravity of its link if these are
/// unknown. A load that is picked up or put down can, and it takes its energy along.
pub struct Payload;

static CARD: Card = Card {
    name: text("payload"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text(
        "A mass at the tip, permanent or carried for a time: it adds mass times distance squared to the inertia, and mass times distance to the gravity moment.",
    ),
    equation: text(
        "J += m r^2, W += m r; second of two links: J1 += m (l1^2 + r^2), J2 += m r^2, R12 += m r l1, W1 += m l1, W2 += m r; link of a chain: the same with the known lengths; linear load: M += m, Fg += m g i; rotor: J += m r^2; m times w(t), w = s(t - t0) s(t0 + d - t), s(x) = 1/(1 + exp(-2 x/e)), e = 30 ms",
    ),
    source: text("practice; point mass in [A] Eq. 1"),
    shows: text(
        "Static pressure difference and force at reversals both larger than the unloaded machine's, in a fixed ratio, from one moment on. Always there, it is to be told from inertia and gravity only where these are known.",
    ),
    experiment: text("One recording with the bucket empty at first and filled then."),
    energy: text(
        "Stores kinetic energy m |velocity|^2 / 2 and potential energy m g height, brought along when it is picked up.",
    ),
};

const MASS: ParameterCard = ParameterCard {
    name: text("payload_mass"),
    symbol: text("m"),
    unit: text("kg"),
    meaning: text("added mass"),
    kind: Kind::Linear,
    growth: Growth::MASS,
    minimum: 0.0,
    maximum: 1e5,
    typical: 100.0,
    start: Start::at(&[20.0]),
    prior: None,
};

const DISTANCE: ParameterCard = ParameterCard {
    name: text("payload_distance"),
    symbol: text("r"),
    unit: text("m"),
    meaning: text("distance of its centre from the joint"),
    kind: Kind::Shape,
    growth: Growth::LEVER,
    minimum: 0.0,
    maximum: 20.0,
    typical: 1.5,
    start: Start::at(&[1.5]),
    prior: None,
};

const START: ParameterCard = ParameterCard {
    name: text("payload_start"),
    symbol: text("t0"),
    unit: text("s"),
    meaning: text("time after the first sample at which it is picked up, -1 where it is there from the beginning"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: BEFORE,
    maximum: FOREVER,
    typical: 5.0,
    start: Start::WorstStretchBegin,
    prior: None,
};

const DURATION: ParameterCard = ParameterCard {
    name: text("payload_duration"),
    symbol: text("d"),
    unit: text("s"),
    meaning: text("how long it is carried, 1e9 where it is never put down"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: 0.02,
    maximum: FOREVER,
    typical: 5.0,
    start: Start::WorstStretchDuration,
    prior: None,
};

/// A time before every recording, s, by more than the opening time of a window.
const BEFORE: f64 = -1.0;

/// Longer than any recording, s.
const FOREVER: f64 = 1e9;

static LINK: &[ParameterCard] = &[MASS, DISTANCE, START, DURATION];

static SECOND_OF_TWO: &[ParameterCard] = &[
    MASS,
    DISTANCE,
    ParameterCard {
        name: text("payload_joint_distance"),
        symbol: text("l1"),
        unit: text("m"),
        meaning: text("distance between the two joints"),
        kind: Kind::Shape,
        growth: Growth::LEVER,
        minimum: 0.0,
        maximum: 20.0,
        typical: 2.5,
        start: Start::at(&[2.5]),
        prior: None,
    },
    START,
    DURATION,
];

static LOAD: &[ParameterCard] = &[
    MASS,
    ParameterCard {
        name: text("payload_incline"),
        symbol: text("i"),
        unit: text("-"),
        meaning: text("sine of the slope of the axis: 1 lifts, 0 level"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: -1.0,
        maximum: 1.0,
        typical: 0.5,
        start: Start::at(&[0.0]),
        prior: None,
    },
    START,
    DURATION,
];

impl Physics for Payload {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, site: Site) -> &[ParameterCard] {
        match (&machine.mechanism, site) {
            (Mechanism::LinearLoad, _) => LOAD,
            (Mechanism::TwoLink, Site::Cylinder(1)) => SECOND_OF_TWO,
            _ => LINK,
        }
    }

    fn why_not(&self, machine: &Machine, site: Site) -> Option<String> {
        match site {
            Site::Cylinder(joint) if machine.mechanism.is_upright(joint) => {
                Some("this joint's axis stands upright; add it to the last link".to_string())
            }
            _ => None,
        }
    }

    fn value_where_left_out(&self, parameter: &str) -> Option<f64> {
        match parameter {
            "payload_start" => Some(BEFORE),
            "payload_duration" => Some(FOREVER),
            _ => None,
        }
    }

    /// `-m g` times the height below the level position of all links.
    fn potential<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>) -> Option<T> {
        let Site::Cylinder(cylinder) = site else { return None };
        let weight = carried(parameters, now) * now.machine.gravity;
        let joint = now.pistons[cylinder].joint;
        Some(match (&now.machine.mechanism, cylinder) {
            (Mechanism::LinearLoad, _) => weight * parameters[1] * joint,
            (Mechanism::SingleLink { base_angle }, _) => -weight * parameters[1] * (joint + *base_angle).cos(),
            (Mechanism::TwoLink, 0) => -weight * parameters[1] * joint.cos(),
            (Mechanism::TwoLink, _) => {
                let first = now.pistons[0].joint;
                -weight * (parameters[2] * first.cos() + parameters[1] * (first + joint).cos())
            }
            (Mechanism::Rotor, _) => T::from(0.0),
            (mechanism @ Mechanism::PlanarChain { .. }, _) => {
                let chain = mechanism.chain()?;
                let carried =
                    (chain.first..cylinder).map(|link| absolute_angle(link, chain, now).cos() * chain.length(link));
                let own = parameters[1] * absolute_angle(cylinder, chain, now).cos();
                -weight * carried.fold(own, |sum, drop| sum + drop)
            }
        })
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let mass = carried(parameters, now);
        let weight = mass * now.machine.gravity;
        let joint = now.pistons[cylinder].joint;
        match (&now.machine.mechanism, cylinder) {
            (Mechanism::LinearLoad, _) => {
                rows.add_mass(cylinder, cylinder, mass);
                rows.torque[cylinder] -= weight * parameters[1];
            }
            (Mechanism::TwoLink, 1) => second_of_two(mass, weight, parameters[1], parameters[2], now, rows),
            (Mechanism::Rotor, _) => rows.add_mass(cylinder, cylinder, mass * parameters[1] * parameters[1]),
            (mechanism, _) => {
                if let Some(chain) = mechanism.chain() {
                    on_a_chain(cylinder, mass, parameters[1], chain, now, rows);
                    return;
                }
                let base_angle = if let Mechanism::SingleLink { base_angle } = mechanism { *base_angle } else { 0.0 };
                rows.add_mass(cylinder, cylinder, mass * parameters[1] * parameters[1]);
                rows.torque[cylinder] -= weight * parameters[1] * (joint + base_angle).sin();
            }
        }
    }
}

/// The mass carried at this instant.
fn carried<T: Scalar>(parameters: &[T], now: &Situation<T>) -> T {
    match parameters {
        [mass, .., begin, duration] => *mass * window(now.time, *begin, *duration, now.time_scale),
        _ => T::from(0.0),
    }
}

/// A mass on link `link` of a chain, at `distance` from its joint; each previous link has it at its end.
fn on_a_chain<T: Scalar>(link: usize, mass: T, distance: T, chain: Chain<'_>, now: &Situation<T>, rows: &mut Rows<T>) {
    for carrier in chain.first..=link {
        let reach = if carrier == link { distance } else { T::from(chain.length(carrier)) };
        add_inertia(carrier, mass * reach * reach, chain, now, rows);
        add_first_moment(carrier, mass * reach, chain, now, rows);
        add_weight(carrier, mass * reach, chain, now, rows);
    }
    if let Some(swing) = chain.swing {
        rows.add_mass(0, 0, mass * swing.boom_foot * swing.boom_foot);
    }
}

/// A mass on the second of two links, at `distance` from the second joint, which is `between` away from the first.
fn second_of_two<T: Scalar>(mass: T, weight: T, distance: T, between: T, now: &Situation<T>, rows: &mut Rows<T>) {
    let (first, second) = (&now.pistons[0], &now.pistons[1]);
    let own = mass * distance * distance;
    let coupling = mass * distance * between;
    let (cosine, sine) = (coupling * second.joint.cos(), coupling * second.joint.sin());
    rows.add_mass(0, 0, own + mass * between * between + cosine * 2.0);
    rows.add_mass(0, 1, own + cosine);
    rows.add_mass(1, 0, own + cosine);
    rows.add_mass(1, 1, own);
    let moment = weight * distance * (first.joint + second.joint).sin();
    rows.torque[0] += sine * second.rate * (first.rate * 2.0 + second.rate);
    rows.torque[0] -= moment + weight * between * first.joint.sin();
    rows.torque[1] -= sine * first.rate * first.rate + moment;
}
