//! The machine: geometry and known constants, but no parameters to be identified.

mod cylinder;
mod linkage;
mod mechanism;
mod size;
mod supply;
mod units;

pub use cylinder::{Chambers, Cylinder, Drive, ImposedMotion};
pub use linkage::Linkage;
pub use mechanism::{Chain, Mechanism, Swing};
pub use size::{Growth, Size};
pub use supply::{PressureSource, PumpLine, Supply};
pub use units::CommandUnit;

/// A machine: a mechanism driven by one cylinder or motor per joint, fed by one supply.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// Short name for the command line: `zx30u-arm`.
    pub name: String,
    /// Description for the user.
    pub description: String,
    /// Gravity acceleration g in m/s².
    pub gravity: f64,
    /// Kinematics of the joints.
    pub mechanism: Mechanism,
    /// One cylinder or motor per joint, in the order of the joints.
    pub cylinders: Vec<Cylinder>,
    /// Source of the oil.
    pub supply: Supply,
}

impl Machine {
    /// Index of the cylinder with this name.
    pub fn cylinder_index(&self, name: &str) -> Option<usize> {
        self.cylinders.iter().position(|cylinder| cylinder.name == name)
    }

    /// Whether the cylinders have chambers; a machine without chambers is driven by a measured force.
    pub fn has_chambers(&self) -> bool {
        self.cylinders.iter().any(|cylinder| cylinder.chambers.is_some())
    }

    /// Whether the rods' motions are imposed, so that the forces on the rods are the outputs.
    pub fn has_imposed_motion(&self) -> bool {
        self.cylinders.iter().any(|cylinder| cylinder.imposed_motion.is_some())
    }
}
