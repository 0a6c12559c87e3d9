//! Links in series in a vertical plane: contributions of one link to the mass matrix and the torques.
//!
//! Newton-Euler from each link back to the base. With `phi_i = q_1 + ... + q_i` and known lengths l_i, each of the n links has
//! two base parameters: a moment of inertia `A_i = I_i + m_i lg_i^2 + l_i^2 (m_{i+1} + ... + m_n)` about its joint and a first
//! moment `h_i = m_i lg_i + l_i (m_{i+1} + ... + m_n)`, with all later links as masses at its end. The coupling of two links is
//! `h_j l_i cos(phi_j - phi_i)`; no other parameter enters the motion. \[A\] Eq. 1 is the case n = 2 with `J1 = A_1 + A_2`, `J2 =
//! A_2`, `R12 = l_1 h_2`, `W1 = h_1`, `W2 = h_2`.
//!
//! If the plane itself swings about a vertical axis, the links add to the inertia about it. With the masses on the lines from
//! joint to joint, the same parameters determine it: `A_i sin(phi_i)^2 + 2 h_i sin(phi_i) (d + l_1 sin(phi_1) + ... + l_{i-1}
//! sin(phi_{i-1}))`, with d the distance from the axis to the first joint.
//!
//! Links are numbered like their joints, so the swing, if there is one, is number 0.

use super::{Rows, Situation};
use crate::machine::{Chain, Swing};
use crate::scalar::Scalar;

/// Adds a moment of inertia (kg m²) of link `link` about its joint, which turns with every joint up to its own.
pub fn add_inertia<T: Scalar>(link: usize, inertia: T, chain: Chain<'_>, now: &Situation<T>, rows: &mut Rows<T>) {
    for row in chain.first..=link {
        for column in chain.first..=link {
            rows.add_mass(row, column, inertia);
        }
    }
    if chain.swing.is_some() {
        let (sine, cosine) = sine_and_cosine(link, chain, now);
        let turns = |joint: usize| if joint <= link { sine * cosine * 2.0 } else { T::from(0.0) };
        add_swinging(inertia, sine * sine, turns, chain, now, rows);
    }
}

/// Adds a moment of inertia (kg m²) of all links from `link` on about their joint `link`, as J1 and J2 of \[A\] Eq. 1: to the
/// entries of the mass matrix from joint `link` on. The previous link has that much less.
pub fn add_composite_inertia<T: Scalar>(
    link: usize,
    inertia: T,
    chain: Chain<'_>,
    now: &Situation<T>,
    rows: &mut Rows<T>,
) {
    rows.add_mass(link, link, inertia);
    for before in chain.first..link {
        rows.add_mass(before, link, inertia);
        rows.add_mass(link, before, inertia);
    }
    if chain.swing.is_some() {
        let (sine, cosine) = sine_and_cosine(link, chain, now);
        let (mut squared, own) = (sine * sine, sine * cosine * 2.0);
        let mut before = T::from(0.0);
        if link > chain.first {
            let (sine, cosine) = sine_and_cosine(link - 1, chain, now);
            squared -= sine * sine;
            before = sine * cosine * 2.0;
        }
        let turns = |joint: usize| {
            if joint < link {
                own - before
            } else if joint == link {
                own
            } else {
                T::from(0.0)
            }
        };
        add_swinging(inertia, squared, turns, chain, now, rows);
    }
}

/// Adds the effect of the first moment (kg m) of link `link` through the previous joints: couplings in the mass matrix, and
/// Coriolis and centrifugal torques.
///
/// It works from the link back to the base: at link i the angle `phi_j - phi_i` and the rate of link i follow from the values of
/// the next link. A mass element of link j moves with `l_i`, so joints r up to i have the coupling `h_j l_i cos(phi_j - phi_i)`
/// with every joint up to j, and the torque `h_j l_i sin(phi_j - phi_i)` times squared rates.
pub fn add_first_moment<T: Scalar>(link: usize, moment: T, chain: Chain<'_>, now: &Situation<T>, rows: &mut Rows<T>) {
    let mut own_rate = T::from(0.0);
    for piston in &now.pistons[chain.first..=link] {
        own_rate += piston.rate;
    }
    let (mut angle, mut rate) = (T::from(0.0), own_rate);
    for carrier in (chain.first..link).rev() {
        let joint = &now.pistons[carrier + 1];
        angle += joint.joint;
        rate -= joint.rate;
        let coupling = moment * chain.length(carrier);
        let (sine, cosine) = (angle.sin() * coupling, angle.cos() * coupling);
        for row in chain.first..=carrier {
            for column in chain.first..=link {
                rows.add_mass(row, column, cosine);
                rows.add_mass(column, row, cosine);
            }
        }
        let (outward, own) = (sine * own_rate * own_rate, sine * rate * rate);
        for row in chain.first..=carrier {
            rows.torque[row] += outward;
        }
        for row in chain.first..=link {
            rows.torque[row] -= own;
        }
    }
    if let Some(swing) = chain.swing {
        add_swinging_moment(link, moment, swing, chain, now, rows);
    }
}

/// Contribution of a first moment to the inertia about the swing: `2 h sin(phi) R`, with R the distance of its joint from the
/// axis.
fn add_swinging_moment<T: Scalar>(
    link: usize,
    moment: T,
    swing: Swing,
    chain: Chain<'_>,
    now: &Situation<T>,
    rows: &mut Rows<T>,
) {
    let (sine, cosine) = sine_and_cosine(link, chain, now);
    let mut radius = T::from(swing.boom_foot);
    for carrier in chain.first..link {
        radius += sine_and_cosine(carrier, chain, now).0 * chain.length(carrier);
    }
    let turns = |joint: usize| {
        if joint > link {
            return T::from(0.0);
        }
        let mut farther = T::from(0.0);
        for carrier in joint..link {
            farther += sine_and_cosine(carrier, chain, now).1 * chain.length(carrier);
        }
        (cosine * radius + sine * farther) * 2.0
    };
    add_swinging(moment, sine * radius * 2.0, turns, chain, now, rows);
}

/// Adds `amount` times `shape` to the inertia about the swing, whose derivative with respect to joint j is `amount` times
/// `slope(j)`. Also adds the resulting torques: Coriolis on the swing, centrifugal on the links.
fn add_swinging<T: Scalar>(
    amount: T,
    shape: T,
    slope: impl Fn(usize) -> T,
    chain: Chain<'_>,
    now: &Situation<T>,
    rows: &mut Rows<T>,
) {
    let turn = now.pistons[0].rate;
    rows.add_mass(0, 0, amount * shape);
    let mut change = T::from(0.0);
    for joint in chain.first..now.pistons.len() {
        let slope = amount * slope(joint);
        change += slope * now.pistons[joint].rate;
        rows.torque[joint] += slope * turn * turn * 0.5;
    }
    rows.torque[0] -= change * turn;
}

/// Angle of link `link` from hanging straight down, rad.
pub fn absolute_angle<T: Scalar>(link: usize, chain: Chain<'_>, now: &Situation<T>) -> T {
    now.pistons[chain.first..=link].iter().fold(T::from(0.0), |sum, piston| sum + piston.joint)
}

fn sine_and_cosine<T: Scalar>(link: usize, chain: Chain<'_>, now: &Situation<T>) -> (T, T) {
    let angle = absolute_angle(link, chain, now);
    (angle.sin(), angle.cos())
}

/// Adds the weight of a first moment (kg m) of link `link`: `-h g sin(phi)` on every joint up to its own.
pub fn add_weight<T: Scalar>(link: usize, moment: T, chain: Chain<'_>, now: &Situation<T>, rows: &mut Rows<T>) {
    let torque = moment * now.machine.gravity * absolute_angle(link, chain, now).sin();
    for row in chain.first..=link {
        rows.torque[row] -= torque;
    }
}
