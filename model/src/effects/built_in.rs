//! The effects that the program knows.

use std::sync::Arc;

use super::*;

/// Every built-in effect: base effects of \[A\] first, then the candidates beyond them.
pub(super) fn built_in() -> Vec<AnyEffect> {
    vec![
        Arc::new(inertia::Inertia),
        Arc::new(gravity::Gravity),
        Arc::new(viscous_damping::ViscousDamping),
        Arc::new(coulomb_friction::CoulombFriction),
        Arc::new(force_offset::ForceOffset),
        Arc::new(oil_compressibility::OilCompressibility),
        Arc::new(orifice_flow::OrificeFlow),
        Arc::new(open_centre_bypass::OpenCentreBypass),
        Arc::new(internal_leakage::InternalLeakage),
        Arc::new(external_leakage::ExternalLeakage),
        Arc::new(end_stop::EndStop),
        Arc::new(cavitation::Cavitation),
        Arc::new(spool_sensor_lead::SpoolSensorLead),
        Arc::new(spool_sensor_offset::SpoolSensorOffset),
        Arc::new(friction_reversal::FrictionReversal),
        Arc::new(friction_corner::FrictionCorner),
        Arc::new(orifice_transition::OrificeTransition),
        Arc::new(end_stop_correction::EndStopCorrection),
        Arc::new(pressure_compensation::PressureCompensation),
        Arc::new(joint_spring::JointSpring),
        Arc::new(valve_dead_zone::ValveDeadZone),
        Arc::new(valve_directional_gain::ValveDirectionalGain),
        Arc::new(valve_gain_curve::ValveGainCurve),
        Arc::new(valve_hysteresis::ValveHysteresis),
        Arc::new(valve_leakage::ValveLeakage),
        Arc::new(valve_lag::ValveLag),
        Arc::new(load_check_valve::LoadCheckValve),
        Arc::new(make_up_valve::MakeUpValve),
        Arc::new(hose_loss::HoseLoss),
        Arc::new(hose_pressure_loss::HosePressureLoss),
        Arc::new(entrained_air::EntrainedAir),
        Arc::new(stribeck_friction::StribeckFriction),
        Arc::new(pressure_dependent_friction::PressureDependentFriction),
        Arc::new(asymmetric_friction::AsymmetricFriction),
        Arc::new(end_cushion::EndCushion),
        Arc::new(relief_valve::ReliefValve),
        Arc::new(pump_leakage::PumpLeakage),
        Arc::new(bypass_overlap::BypassOverlap),
        Arc::new(opening_scale::OpeningScale),
        Arc::new(pressure_sensor_offset::PressureSensorOffset),
        Arc::new(displacement_sensor_offset::DisplacementSensorOffset),
        Arc::new(sensor_delay::SensorDelay),
        Arc::new(payload::Payload),
        Arc::new(external_contact::ExternalContact),
    ]
}
