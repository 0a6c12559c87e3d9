//! Places of a machine.

/// Where one instance of an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Site {
    /// At the cylinder (or joint) with this index.
    Cylinder(usize),
    /// At the pump line.
    PumpLine,
    /// The whole machine: one effect with one set of parameters for all cylinders and the pump line.
    Machine,
}
