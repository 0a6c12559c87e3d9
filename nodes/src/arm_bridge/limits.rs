//! Physical limits of a signal, by its kind, if the description does not narrow them.
//!
//! The limits are wide: no working instrument on any machine reaches them. They catch broken instruments, wrong units and
//! hostile datagrams.

/// Least and largest value of a signal, SI.
pub(super) fn limits_of(signal: &str) -> (f64, f64) {
    match signal.rsplit('.').next().unwrap_or(signal) {
        // Below: gauge pressure ends at a vacuum, -0.1 MPa; as much again for the zero error of a 60 MPa sensor (0.2 % of
        // its range). Above: machines run at 45 MPa with peaks of 60 MPa, hydraulic tools at 70 to 100 MPa.
        "cap_pressure" | "rod_pressure" | "pump_pressure" | "tank_pressure" => (-2e5, 1e8),
        // Telescopic cylinders are built with strokes to some 20 m.
        "displacement" => (-20.0, 20.0),
        // Seals are made for speeds to 15 m/s.
        "velocity" => (-20.0, 20.0),
        // A joint that a cylinder moves does not turn a full revolution. The limit catches angles in degrees.
        "joint_angle" => (-std::f64::consts::TAU, std::f64::consts::TAU),
        // A bore of 100 mm has 8e-3 m2; spools of the largest mobile valves open less than half of that.
        "orifice_area" => (-1e-2, 1e-2),
        // 100 MPa on a piston of 1 m2.
        "rod_force" => (-1e8, 1e8),
        // Ten times the pumps of the largest mining excavators, 6000 l/min; backwards in hydraulic hybrids.
        "pump_flow" => (-1.0, 1.0),
        // degC. Mineral oil is solid long before -100 and burns before 400.
        "oil_temperature" => (-100.0, 400.0),
        // The description rejects unknown signal names.
        _ => (f64::NEG_INFINITY, f64::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm_bridge::signals::{OF_CYLINDERS, OF_MACHINE};

    #[test]
    fn every_signal_has_limits_that_let_zero_through() {
        for name in OF_CYLINDERS.map(|name| format!("arm.{name}")).into_iter().chain(OF_MACHINE.map(str::to_string)) {
            let (least, largest) = limits_of(&name);
            assert!(least.is_finite() && largest.is_finite() && least < 0.0 && largest > 0.0, "{name}");
        }
    }
}
