//! The damaged places of one file, up to a readable number.

use super::damage::{Damage, DamageKind};

/// Places that are listed one by one. A corrupt chunk can have a million; beyond this many they are only counted.
const MOST_PLACES: usize = 1000;

/// Damaged places in the order in which they were met.
#[derive(Debug, Default)]
pub(crate) struct DamageList(Vec<Damage>);

impl DamageList {
    /// Adds a place. Beyond the first thousand, places are summed in the last entry.
    pub fn push(&mut self, damage: Damage) {
        if self.0.len() < MOST_PLACES {
            self.0.push(damage);
            return;
        }
        let Some(last) = self.0.last_mut() else { return };
        match &mut last.kind {
            DamageKind::More { places } => *places += 1,
            _ => last.kind = DamageKind::More { places: 2 },
        }
        last.lost_bytes = last.lost_bytes.saturating_add(damage.lost_bytes);
    }

    /// All entries.
    pub fn as_slice(&self) -> &[Damage] {
        &self.0
    }

    /// All entries, for later completion.
    #[cfg(feature = "sqlite")]
    pub fn as_mut_slice(&mut self) -> &mut [Damage] {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_places_are_counted_not_listed() {
        let mut list = DamageList::default();
        for offset in 0..1_000_000 {
            let kind = DamageKind::LostSync;
            list.push(Damage { file: "bag.mcap".into(), offset, lost_bytes: 3, readable_until: None, kind });
        }
        assert_eq!(list.as_slice().len(), MOST_PLACES);
        let last = &list.as_slice()[MOST_PLACES - 1];
        assert_eq!((&last.kind, last.lost_bytes), (&DamageKind::More { places: 999_001 }, 3 * 999_001));
    }
}
