//! Leaves single values out that no machine can reach between two samples.

use excavator_bags::map::{SignalName, spike_line};
use excavator_model::recording::{Recording, spikes};

/// Neighbours of a value are at most this many median intervals away.
const NEAR: f64 = 3.0;

/// Replaces such values of a recording by the line between their neighbours, and returns one line for each signal that had
/// some. Reading with a map does the same for the values of each topic or column; this is for bags of our own topics.
pub(crate) fn leave_out_spikes(recording: &mut Recording) -> Vec<String> {
    let interval = recording.sample_interval();
    let mut found: Vec<(SignalName, Vec<usize>)> = Vec::new();
    for (name, values) in recording.signals() {
        let Ok(name) = name.parse::<SignalName>() else { continue };
        if name.kind.calm_interval().is_some_and(|longest| interval <= longest) {
            let mut indices = spikes(values);
            // Beyond a gap the signal may have moved.
            indices.retain(|&index| {
                let neighbours = &recording.time[index.saturating_sub(1)..(index + 2).min(recording.len())];
                neighbours.windows(2).all(|pair| pair[1] - pair[0] <= NEAR * interval)
            });
            if !indices.is_empty() {
                found.push((name, indices));
            }
        }
    }
    let mut lines = Vec::new();
    for (name, indices) in found {
        let first = recording.time[indices[0]];
        let time = recording.time.clone();
        let values = name.column(recording);
        let worst = values[indices[0]];
        for &index in &indices {
            values[index] = between(&time, values, index);
        }
        lines.push(spike_line(&name, indices.len(), first, worst));
    }
    lines
}

/// The value on the line between the neighbours that are measured; spikes have one on each side.
fn between(time: &[f64], values: &[f64], index: usize) -> f64 {
    let before = (0..index).rev().find(|&other| values[other].is_finite());
    let after = (index + 1..values.len()).find(|&other| values[other].is_finite());
    match (before, after) {
        (Some(a), Some(b)) => values[a] + (time[index] - time[a]) / (time[b] - time[a]) * (values[b] - values[a]),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_becomes_the_line_between_its_neighbours_and_a_command_keeps_its_pulse() {
        let time: Vec<f64> = (0..400).map(|sample| 0.002 * f64::from(sample)).collect();
        let mut recording = Recording::unmeasured("made up", time.clone(), &["arm"]);
        recording.cylinders[0].displacement = time.iter().map(|t| 0.1 * t).collect();
        recording.cylinders[0].orifice_command = vec![0.0; 400];
        recording.cylinders[0].displacement[100] = -0.3;
        recording.cylinders[0].orifice_command[100] = 1e-4;
        let lines = leave_out_spikes(&mut recording);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(
            lines[0].starts_with("arm.displacement: one value jumps away") && lines[0].contains("0.200 s"),
            "{lines:?}"
        );
        assert!((recording.cylinders[0].displacement[100] - 0.02).abs() < 1e-12);
        assert_eq!(recording.cylinders[0].orifice_command[100], 1e-4);
        assert!(leave_out_spikes(&mut recording).is_empty());
        // After a gap it may have moved and come back.
        let mut with_gap = recording.clone();
        with_gap.cylinders[0].displacement[100] = -0.3;
        with_gap.time.iter_mut().skip(100).for_each(|time| *time += 0.5);
        assert!(leave_out_spikes(&mut with_gap).is_empty());
        // Too slow to know: the same values at 10 Hz may be a motion.
        recording.cylinders[0].displacement[100] = -0.3;
        recording.time.iter_mut().for_each(|time| *time *= 50.0);
        assert!(leave_out_spikes(&mut recording).is_empty());
    }
}
