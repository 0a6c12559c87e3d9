//! Joins parts of one recording.

use excavator_model::recording::{CylinderSignals, Recording};

/// Joins parts of a recording, in the order of their starts, into one recording with gaps in its sample times. Signals
/// of a cylinder that a part lacks are `NaN` there. Samples that are not later than those of the previous part are left
/// out.
pub fn joined(source: &str, parts: &[Recording]) -> Recording {
    let Some(first) = parts.first() else { return Recording { source: source.to_string(), ..Recording::default() } };
    let mut names: Vec<&str> = Vec::new();
    for name in parts.iter().flat_map(|part| &part.cylinders).map(|cylinder| cylinder.name.as_str()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut whole = Recording::unmeasured(source, Vec::new(), &names);
    whole.start_nanoseconds = first.start_nanoseconds;
    for part in parts {
        let offset = (part.start_nanoseconds - first.start_nanoseconds) as f64 * 1e-9;
        let last = whole.time.last().copied().unwrap_or(f64::NEG_INFINITY);
        let from = part.time.partition_point(|time| time + offset <= last);
        let mut part = part.clone();
        part.cylinders = names
            .iter()
            .map(|name| match part.cylinder(name) {
                Ok(signals) => signals.clone(),
                Err(_) => CylinderSignals::unmeasured(name, part.len()),
            })
            .collect();
        part.time.iter_mut().for_each(|time| *time += offset);
        for (column, own) in whole.columns_mut().into_iter().zip(part.columns_mut()) {
            column.extend_from_slice(own.get(from..).unwrap_or_default());
        }
    }
    whole
}
