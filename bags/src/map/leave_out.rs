//! Moments that a map leaves out.

use excavator_model::recording::Recording;
use serde::{Deserialize, Serialize};

use super::error::MapError;
use super::signal::{SignalKind, SignalName};

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
    /// Signals that are left out then; without, all that a model is compared with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub signals: Vec<SignalName>,
    /// In the place of times: left out where this holds, as in `abs(v) < 0.002`. Verbs that know a machine evaluate it.
    #[serde(default, rename = "where", skip_serializing_if = "Option::is_none")]
    pub condition: Option<String>,
}

impl LeaveOut {
    /// Takes the signals away within the times; nothing for a condition.
    ///
    /// # Errors
    /// [`MapError::BadNumber`] for times that are no numbers or in the wrong order.
    pub(super) fn apply(&self, recording: &mut Recording) -> Result<(), MapError> {
        if self.condition.is_some() {
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
            name.column(recording)[first..last.max(first)].fill(f64::NAN);
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
        let pump = SignalName { cylinder: None, kind: SignalKind::PumpPressure };
        cylinders.flat_map(each).chain([pump]).collect()
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
        recording
    }

    #[test]
    fn outputs_are_left_out_and_inputs_stay() {
        let mut found = recording();
        LeaveOut { from: Some(2.0), to: Some(4.0), ..LeaveOut::default() }.apply(&mut found).unwrap();
        let arm = &found.cylinders[0];
        let missing: Vec<usize> = (0..10).filter(|sample| arm.displacement[*sample].is_nan()).collect();
        assert_eq!(missing, [2, 3, 4]);
        assert!(arm.orifice_area.iter().all(|area| area.is_finite()));
    }

    #[test]
    fn one_signal_alone_and_open_ends() {
        let mut found = recording();
        let signals = vec!["arm.cap_pressure".parse().unwrap()];
        LeaveOut { from: Some(7.0), signals, ..LeaveOut::default() }.apply(&mut found).unwrap();
        assert_eq!(found.cylinders[0].cap_pressure.iter().filter(|value| value.is_nan()).count(), 3);
        assert!(found.cylinders[0].displacement.iter().all(|value| value.is_finite()));
        let backwards = LeaveOut { from: Some(3.0), to: Some(1.0), ..LeaveOut::default() };
        assert!(backwards.apply(&mut found).is_err());
    }
}
