//! Kinematic chain of the joints, and the direction of gravity.

/// The kinematic chain that the cylinders drive. Parameters to be identified (inertias, gravity moments) are in the
/// effects `inertia` and `gravity`, not here.
#[derive(Debug, Clone, PartialEq)]
pub enum Mechanism {
    /// One link turning about a joint whose base is held at a fixed angle; the link hangs straight down at
    /// `base_angle + q = 0` (\[A\] Eq. 4 with q1 = q1const).
    SingleLink {
        /// Fixed angle q1const of everything before the joint, rad.
        base_angle: f64,
    },
    /// Two links in a vertical plane, \[A\] Eq. 1.
    TwoLink,
    /// Any number of links in a vertical plane, each turning about a joint of the one before it.
    PlanarChain {
        /// Distance from each joint to the next, m: one fewer than the links.
        link_lengths: Vec<f64>,
        /// The swing of the links' plane, if any: its joint comes first.
        swing: Option<Swing>,
    },
    /// A mass moving along the cylinder's own axis, \[B\] Eq. 5.
    LinearLoad,
    /// An inertia that turns about a fixed axis through its centre of gravity: a drum, a wheel, a turntable.
    Rotor,
}

/// A vertical axis about which the upper structure swings with all links.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// Distance of the first link's joint in front of the axis, m.
    pub boom_foot: f64,
}

/// The links of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chain<'m> {
    /// Distance from each joint to the next, m.
    pub lengths: &'m [f64],
    /// Number of the first link's joint: one if a swing precedes it.
    pub first: usize,
    /// The swing of the links' plane, if any.
    pub swing: Option<Swing>,
}

impl Chain<'_> {
    /// Whether `joint` is that of the swing.
    pub fn is_swing(&self, joint: usize) -> bool {
        joint < self.first
    }

    /// Distance from joint `joint` to the next one, m; zero for the last.
    pub fn length(&self, joint: usize) -> f64 {
        self.lengths.get(joint - self.first).copied().unwrap_or(0.0)
    }
}

impl Mechanism {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        match self {
            Mechanism::SingleLink { .. } | Mechanism::LinearLoad | Mechanism::Rotor => 1,
            Mechanism::TwoLink => 2,
            Mechanism::PlanarChain { link_lengths, swing } => link_lengths.len() + 1 + usize::from(swing.is_some()),
        }
    }

    /// The links, if they form a chain.
    pub fn chain(&self) -> Option<Chain<'_>> {
        match self {
            Mechanism::PlanarChain { link_lengths, swing } => {
                Some(Chain { lengths: link_lengths, first: usize::from(swing.is_some()), swing: *swing })
            }
            _ => None,
        }
    }

    /// Whether gravity does not act on this joint, because its axis is vertical.
    pub fn is_upright(&self, joint: usize) -> bool {
        self.chain().is_some_and(|chain| chain.is_swing(joint))
    }
}
