//! The four metering edges of a valve section.

/// Which chamber an edge feeds or drains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Cap side, 1 in \[B\].
    Cap,
    /// Rod side, 2 in \[B\].
    Rod,
}

/// To which side the spool moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// u > 0: pump to cap side.
    Positive,
    /// u < 0: pump to rod side.
    Negative,
}

impl Direction {
    /// +1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Positive => 1.0,
            Direction::Negative => -1.0,
        }
    }
}

/// One metering edge. It is open while the spool is on its side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    /// Chamber.
    pub side: Side,
    /// Side of the spool.
    pub direction: Direction,
}

impl Edge {
    /// k1+, k2+, k1-, k2- of \[B\] Eq. 7-8.
    pub const ALL: [Edge; 4] = [
        Edge { side: Side::Cap, direction: Direction::Positive },
        Edge { side: Side::Rod, direction: Direction::Positive },
        Edge { side: Side::Cap, direction: Direction::Negative },
        Edge { side: Side::Rod, direction: Direction::Negative },
    ];

    /// Where the oil comes from and where it goes.
    pub fn name(self) -> &'static str {
        match (self.side, self.direction) {
            (Side::Cap, Direction::Positive) => "pump to cap side",
            (Side::Rod, Direction::Positive) => "rod side to tank",
            (Side::Cap, Direction::Negative) => "cap side to tank",
            (Side::Rod, Direction::Negative) => "pump to rod side",
        }
    }

    /// Name in JSON: the chamber and the sign of the opening.
    pub fn key(self) -> &'static str {
        match (self.side, self.direction) {
            (Side::Cap, Direction::Positive) => "cap_positive",
            (Side::Rod, Direction::Positive) => "rod_positive",
            (Side::Cap, Direction::Negative) => "cap_negative",
            (Side::Rod, Direction::Negative) => "rod_negative",
        }
    }

    /// Flow through the edge in its normal direction (m³/s), from the flow into its chamber.
    pub fn flow(self, into_chamber: f64) -> f64 {
        if self.is_fed() { into_chamber } else { -into_chamber }
    }

    /// Pressure drop over the edge (Pa), \[B\] Eq. 4.
    pub fn pressure_drop(self, pump: f64, chamber: f64, tank: f64) -> f64 {
        if self.is_fed() { pump - chamber } else { chamber - tank }
    }

    fn is_fed(self) -> bool {
        (self.side == Side::Cap) == (self.direction == Direction::Positive)
    }
}
