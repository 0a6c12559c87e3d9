//! How the joints move, and where gravity pulls.

/// The kinematic chain that the cylinders drive. Parameters to be identified (inertias, gravity moments) are not here
/// but in the effects `inertia` and `gravity`.
#[derive(Debug, Clone, PartialEq)]
pub enum Mechanism {
    /// One link turning about a joint whose base is held at a fixed angle; the link hangs straight down at
    /// `base_angle + q = 0` (\[A\] Eq. 4 with q1 = q1const).
    SingleLink {
        /// Angle q1const at which everything before the joint is held, rad.
        base_angle: f64,
    },
    /// Two links in a vertical plane, \[A\] Eq. 1.
    TwoLink,
    /// Any number of links in a vertical plane, each turning about a joint of the one before it.
    PlanarChain {
        /// Distance from each joint to the next, m: one less than there are joints.
        link_lengths: Vec<f64>,
    },
    /// A mass moving along the cylinder's own axis, \[B\] Eq. 5.
    LinearLoad,
}

impl Mechanism {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        match self {
            Mechanism::SingleLink { .. } | Mechanism::LinearLoad => 1,
            Mechanism::TwoLink => 2,
            Mechanism::PlanarChain { link_lengths } => link_lengths.len() + 1,
        }
    }
}
