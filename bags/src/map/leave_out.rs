//! Time ranges that a map leaves out.

use excavator_model::recording::Recording;
use serde::{Deserialize, Serialize};

use super::error::MapError;
use super::signal::{SignalKind, SignalName};
use crate::reading::ReadReport;

/// A stretch of time, or a condition, in which measurements are not compared with a model. Inputs stay: the machine has moved by them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeaveOut {
    /// Beginning, s after the first sample; without, from the first on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// End, s after the first sample; without, to the last one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Signals that are left out then; without, all that a model is compared with. Whether the pump pressure is one of these, the machine
    /// says: where a pump holds it, it is an input. So it is told in [`ReadReport::left_out`](crate::ReadReport::left_out).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub signals: Vec<SignalName>,
    /// In the place of times: left out where this holds, as in `abs(v) < 0.002`. Verbs that know a machine evaluate it.
    #[serde(default, rename = "where", skip_serializing_if = "Option::is_none")]
    pub condition: Option<String>,
}

impl LeaveOut {
    /// Removes the signals within the times. Records in the report what needs the machine to decide; conditions are
    /// only recorded.
    ///
    /// # Errors
    /// [`MapError::BadNumber`] for times that are not numbers or are in the wrong order, [`MapError::LeavesNothingOut`]
    /// for a cylinder that the recording does not have.
    pub(super) fn apply(&self, recording: &mut Recording, report: &mut ReadReport) -> Result<(), MapError> {
        if let Some(condition) = &self.condition {
            report.left_out_where.push(condition.clone());
            return Ok(());
        }
        let (from, to) = (self.from.unwrap_or(f64::NEG_INFINITY), self.to.unwrap_or(f64::INFINITY));
        if from.is_nan() || to.is_nan() || to < from {
            let place = "leave_out".to_string();
            return Err(MapError::BadNumber { place, key: "to", found: to, wanted: "a time after `from`" });
        }
        let begin = recording.time.first().copied().unwrap_or(0.0);
        let first = recording.time.partition_point(|time| time - begin < from);
        let last = recording.time.partition_point(|time| time - begin <= to);
        for name in self.names(recording) {
            let is_there = |cylinder: &String| recording.cylinders.iter().any(|known| known.name == *cylinder);
            if name.cylinder.as_ref().is_some_and(|cylinder| !is_there(cylinder)) {
                return Err(MapError::LeavesNothingOut { signal: name.to_string() });
            }
            name.column(recording)[first..last.max(first)].fill(f64::NAN);
        }
        if self.signals.is_empty() && first < last {
            let at = |sample: usize| {
                recording.start_nanoseconds.saturating_add((recording.time[sample] * 1e9).round() as i64)
            };
            report.left_out.push([at(first), at(last - 1)]);
        }
        Ok(())
    }

    fn names(&self, recording: &Recording) -> Vec<SignalName> {
        if !self.signals.is_empty() {
            return self.signals.clone();
        }
        const COMPARED: [SignalKind; 5] = [
            SignalKind::JointAngle,
            SignalKind::Displacement,
            SignalKind::Velocity,
            SignalKind::CapPressure,
            SignalKind::RodPressure,
        ];
        let cylinders = recording.cylinders.iter().map(|cylinder| cylinder.name.clone());
        let each = |name: String| COMPARED.map(|kind| SignalName { cylinder: Some(name.clone()), kind });
        cylinders.flat_map(each).collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn recording() -> Recording {
        let mut recording =
            Recording::unmeasured("bag", (0..10).map(|sample| 5.0 + f64::from(sample)).collect(), &["arm"]);
        let arm = &mut recording.cylinders[0];
        arm.displacement.fill(0.1);
        arm.orifice_area.fill(1e-5);
        arm.cap_pressure.fill(1e6);
        recording.pump_pressure.fill(2e7);
        recording
    }

    #[test]
    fn outputs_are_left_out_and_inputs_stay() {
        let (mut found, mut report) = (recording(), ReadReport::default());
        LeaveOut { from: Some(2.0), to: Some(4.0), ..LeaveOut::default() }.apply(&mut found, &mut report).unwrap();
        let arm = &found.cylinders[0];
        let missing: Vec<usize> = (0..10).filter(|sample| arm.displacement[*sample].is_nan()).collect();
        assert_eq!(missing, [2, 3, 4]);
        assert!(arm.orifice_area.iter().all(|area| area.is_finite()));
        // What only the machine can decide is recorded in the report.
        assert!(found.pump_pressure.iter().all(|pressure| *pressure == 2e7));
        assert_eq!(report.left_out, [[7_000_000_000, 9_000_000_000]]);
    }

    #[test]
    fn one_signal_alone_and_open_ends() {
        let (mut found, mut report) = (recording(), ReadReport::default());
        let signals = vec!["arm.cap_pressure".parse().unwrap()];
        LeaveOut { from: Some(7.0), signals, ..LeaveOut::default() }.apply(&mut found, &mut report).unwrap();
        assert_eq!(found.cylinders[0].cap_pressure.iter().filter(|value| value.is_nan()).count(), 3);
        assert!(found.cylinders[0].displacement.iter().all(|value| value.is_finite()));
        let backwards = LeaveOut { from: Some(3.0), to: Some(1.0), ..LeaveOut::default() };
        assert!(backwards.apply(&mut found, &mut report).is_err());
        let absent = LeaveOut { signals: vec!["boom.cap_pressure".parse().unwrap()], ..LeaveOut::default() };
        assert!(absent.apply(&mut found, &mut report).unwrap_err().to_string().contains("boom"));
        assert_eq!((found.cylinders.len(), report.left_out.len()), (1, 0));
    }
}
