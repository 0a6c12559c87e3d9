//! Links in a vertical plane, one after the other: what one link adds to mass matrix and torques.
//!
//! Newton-Euler from each link back to the base. With `phi_i = q_1 + ... + q_i` and lengths l_i known, the base parameters of
//! n links are, link by link, two: a moment of inertia `A_i = I_i + m_i lg_i^2 + l_i^2 (m_{i+1} + ... + m_n)` about its joint
//! and a first moment `h_i = m_i lg_i + l_i (m_{i+1} + ... + m_n)`, all later links taken as masses at its end. What two links
//! share is `h_j l_i cos(phi_j - phi_i)`; no other parameter enters the motion. \[A\] Eq. 1 is the case n = 2 with `J1 = A_1 + A_2`,
//! `J2 = A_2`, `R12 = l_1 h_2`, `W1 = h_1`, `W2 = h_2`.

use super::{Rows, Situation};
use crate::scalar::Scalar;

/// Adds a moment of inertia (kg m²) of link `link` about its joint, which turns with every joint up to its own.
pub fn add_inertia<T: Scalar>(link: usize, inertia: T, rows: &mut Rows<T>) {
    for row in 0..=link {
        for column in 0..=link {
            rows.add_mass(row, column, inertia);
        }
    }
}

/// Adds a moment of inertia (kg m²) of all links from `link` on about their joint `link`, as J1 and J2 of \[A\] Eq. 1: the
/// entries of the mass matrix that joint `link` begins.
pub fn add_composite_inertia<T: Scalar>(link: usize, inertia: T, rows: &mut Rows<T>) {
    rows.add_mass(link, link, inertia);
    for before in 0..link {
        rows.add_mass(before, link, inertia);
        rows.add_mass(link, before, inertia);
    }
}

/// Adds what the first moment (kg m) of link `link` does through the joints before it: couplings in the mass matrix, and
/// Coriolis and centrifugal torques.
///
/// From the link back to the base: at link i the angle `phi_j - phi_i` and the rate of link i follow from those one link on.
/// A mass element of link j is carried along by `l_i`, so that joints r up to i feel `h_j l_i cos(phi_j - phi_i)` with every
/// joint up to j, and `h_j l_i sin(phi_j - phi_i)` times squared rates.
pub fn add_first_moment<T: Scalar>(link: usize, moment: T, lengths: &[f64], now: &Situation<T>, rows: &mut Rows<T>) {
    let mut own_rate = T::from(0.0);
    for piston in &now.pistons[..=link] {
        own_rate += piston.rate;
    }
    let (mut angle, mut rate) = (T::from(0.0), own_rate);
    for carrier in (0..link).rev() {
        let joint = &now.pistons[carrier + 1];
        angle += joint.joint;
        rate -= joint.rate;
        let coupling = moment * lengths[carrier];
        let (sine, cosine) = (angle.sin() * coupling, angle.cos() * coupling);
        for row in 0..=carrier {
            for column in 0..=link {
                rows.add_mass(row, column, cosine);
                rows.add_mass(column, row, cosine);
            }
        }
        let (outward, own) = (sine * own_rate * own_rate, sine * rate * rate);
        for row in 0..=carrier {
            rows.torque[row] += outward;
        }
        for row in 0..=link {
            rows.torque[row] -= own;
        }
    }
}

/// Angle of link `link` from hanging straight down, rad.
pub fn absolute_angle<T: Scalar>(link: usize, now: &Situation<T>) -> T {
    now.pistons[..=link].iter().fold(T::from(0.0), |sum, piston| sum + piston.joint)
}

/// Adds the weight of a first moment (kg m) of link `link`: `-h g sin(phi)` on every joint up to its own.
pub fn add_weight<T: Scalar>(link: usize, moment: T, now: &Situation<T>, rows: &mut Rows<T>) {
    let torque = moment * now.machine.gravity * absolute_angle(link, now).sin();
    for row in 0..=link {
        rows.torque[row] -= torque;
    }
}
