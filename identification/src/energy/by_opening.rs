//! Energies of a cylinder while its valve is open towards one side, and towards the other.

use excavator_model::Model;

use super::{Books, Totals};

/// Energies of one cylinder by the sign of its opening: \[A\] Section 5.2 states that the pump gives it little while the opening is
/// positive.
#[derive(Debug, Clone, PartialEq)]
pub struct ByOpening {
    /// The cylinder, an index into those of the machine.
    pub cylinder: usize,
    /// While the opening is positive.
    pub positive: Totals,
    /// While it is negative.
    pub negative: Totals,
}

impl ByOpening {
    /// Zero energies of every cylinder of a model.
    pub(super) fn all(model: &Model) -> Vec<Self> {
        let each = 0..model.machine.cylinders.len();
        each.map(|cylinder| ByOpening { cylinder, positive: Totals::new(model), negative: Totals::new(model) })
            .collect()
    }

    /// Adds the time between an entry and the next one, unless the opening is zero or not known.
    pub(super) fn add(&mut self, books: &Books, entry: usize) {
        let opening = books.cylinders[self.cylinder].opening[entry];
        if opening > 0.0 {
            self.positive.add(books, entry);
        } else if opening < 0.0 {
            self.negative.add(books, entry);
        }
    }
}
