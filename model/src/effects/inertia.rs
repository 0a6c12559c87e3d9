//! Inertia of the links, or the mass of a linear load.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::equations::planar_chain::{add_composite_inertia, add_first_moment};
use crate::machine::Machine;
use crate::machine::Mechanism;

/// Inertia of the links, or the mass of a linear load.
pub struct Inertia;

static CARD: Card = Card {
    name: text("inertia"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Base,
    summary: text("Inertia of the link that the cylinder moves."),
    equation: text(
        "mass matrix J(q) = [[J1 + 2 R12 cos q2, J2 + R12 cos q2], [., J2]] with the Coriolis torque \
        c(q, qd); one link: J; chain: J_k = A_k + ... + A_n where joint k begins, h_j l_i cos(phi_j - phi_i) between links i < j; swing: the house's own inertia, with A_i sin(phi_i)^2 + 2 h_i sin(phi_i) (d + l_1 sin(phi_1) + ...) of the links; linear load: M",
    ),
    source: text(
        "[A] Eq. 1, [B] Eq. 5. Eq. 1 of [A] multiplies C(q, qd) by qd; as printed C already is the \
        torque.",
    ),
    shows: text("Pressure difference needed to accelerate: force error in phase with acceleration."),
    experiment: text("Fast reversals: sines of 1 Hz and above."),
    energy: text("Stores kinetic energy 1/2 qd' J(q) qd."),
};

static SINGLE: &[ParameterCard] = &[ParameterCard {
    name: text("inertia"),
    symbol: text("J2"),
    unit: text("kg m2"),
    meaning: text("moment of inertia about the joint"),
    kind: Kind::Linear,
    growth: Growth::INERTIA,
    minimum: 1e-3,
    maximum: 1e7,
    typical: 200.0,
    start: Start::at(&[200.0]),
    prior: None,
}];

static FIRST_OF_TWO: &[ParameterCard] = &[
    ParameterCard {
        name: text("inertia"),
        symbol: text("J1"),
        unit: text("kg m2"),
        meaning: text("moment of inertia of both links about the first joint"),
        kind: Kind::Linear,
        growth: Growth::INERTIA,
        minimum: 1e-3,
        maximum: 1e7,
        typical: 2000.0,
        start: Start::at(&[2000.0]),
        prior: None,
    },
    ParameterCard {
        name: text("coupling_inertia"),
        symbol: text("R12"),
        unit: text("kg m2"),
        meaning: text("coupling m2 lg2 l1 between the links"),
        kind: Kind::Linear,
        growth: Growth::INERTIA,
        minimum: -1e7,
        maximum: 1e7,
        typical: 500.0,
        start: Start::at(&[500.0]),
        prior: None,
    },
];

/// Inertia about joint `k` of a chain of n links, J_k = A_k + ... + A_n: the links' own inertias with all later masses at their
/// ends.
const CHAIN_INERTIA: ParameterCard = ParameterCard {
    name: text("inertia"),
    symbol: text("J"),
    unit: text("kg m2"),
    meaning: text(
        "moments of inertia A of this link and all later ones, each about its own joint with later masses at its end",
    ),
    kind: Kind::Linear,
    growth: Growth::INERTIA,
    minimum: 1e-3,
    maximum: 1e7,
    typical: 500.0,
    start: Start::at(&[500.0]),
    prior: None,
};

static FIRST_OF_CHAIN: &[ParameterCard] = &[CHAIN_INERTIA];

/// For rigid links `coupling_moment` equals `gravity_moment`. It is a separate parameter, as \[A\] keeps R12 apart from W2: if
/// both come out equal, that confirms an identification.
static LATER_OF_CHAIN: &[ParameterCard] = &[
    CHAIN_INERTIA,
    ParameterCard {
        name: text("coupling_moment"),
        symbol: text("h"),
        unit: text("kg m"),
        meaning: text(
            "first moment of the link about its joint, with later masses at its end: couples it to the links before and to the swing",
        ),
        kind: Kind::Linear,
        growth: Growth::MASS_MOMENT,
        minimum: -1e6,
        maximum: 1e6,
        typical: 100.0,
        start: Start::at(&[100.0]),
        prior: None,
    },
];

static LOAD: &[ParameterCard] = &[ParameterCard {
    name: text("mass"),
    symbol: text("M"),
    unit: text("kg"),
    meaning: text("mass of the load"),
    kind: Kind::Linear,
    growth: Growth::MASS,
    minimum: 1e-3,
    maximum: 1e6,
    typical: 100.0,
    start: Start::at(&[100.0]),
    prior: None,
}];

impl Physics for Inertia {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, site: Site) -> &[ParameterCard] {
        match (&machine.mechanism, site) {
            (Mechanism::LinearLoad, _) => LOAD,
            (Mechanism::TwoLink, Site::Cylinder(0)) => FIRST_OF_TWO,
            (Mechanism::PlanarChain { swing: Some(_), .. }, Site::Cylinder(0)) => SINGLE,
            (Mechanism::PlanarChain { swing: Some(_), .. }, _) => LATER_OF_CHAIN,
            (Mechanism::PlanarChain { .. }, Site::Cylinder(link)) if link > 0 => LATER_OF_CHAIN,
            (Mechanism::PlanarChain { .. }, _) => FIRST_OF_CHAIN,
            _ => SINGLE,
        }
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(joint) = site else { return };
        match (&now.machine.mechanism, joint) {
            (Mechanism::TwoLink, 0) => {
                let (first, second) = (&now.pistons[0], &now.pistons[1]);
                let [inertia, coupling] = [parameters[0], parameters[1]];
                let (cosine, sine) = (second.joint.cos() * coupling, second.joint.sin() * coupling);
                rows.add_mass(0, 0, inertia + cosine * 2.0);
                rows.add_mass(0, 1, cosine);
                rows.add_mass(1, 0, cosine);
                rows.torque[0] += sine * second.rate * (first.rate * 2.0 + second.rate);
                rows.torque[1] -= sine * first.rate * first.rate;
            }
            (Mechanism::TwoLink, _) => {
                for (row, column) in [(0, 1), (1, 0), (1, 1)] {
                    rows.add_mass(row, column, parameters[0]);
                }
            }
            (mechanism, _) => match mechanism.chain() {
                Some(chain) if !chain.is_swing(joint) => {
                    add_composite_inertia(joint, parameters[0], chain, now, rows);
                    if let Some(&moment) = parameters.get(1) {
                        add_first_moment(joint, moment, chain, now, rows);
                    }
                }
                _ => rows.add_mass(joint, joint, parameters[0]),
            },
        }
    }
}
