//! Kinds of effects that the catalogue lists.

use super::Lag;
use super::kinds::{Kind, between, new, sign};

/// The candidates of the effect catalogue.
pub static CATALOGUE: &[Kind] = &[
    new(
        "valve_dead_zone",
        5.0,
        |effects, shape, factor| {
            effects.valve.dead_zone_positive = factor * between(shape[0], 4e-6, 8e-6);
            effects.valve.dead_zone_negative = factor * between(shape[1], 4e-6, 8e-6);
        },
        |effects| {
            vec![
                ("arm.dead_zone_positive", effects.valve.dead_zone_positive),
                ("arm.dead_zone_negative", effects.valve.dead_zone_negative),
            ]
        },
    ),
    new(
        "valve_directional_gain",
        4.0,
        |effects, shape, factor| {
            effects.valve.directional_cap = factor * sign(shape[0]) * between(shape[1], 0.03, 0.12);
            effects.valve.directional_rod = factor * sign(shape[2]) * between(shape[3], 0.03, 0.12);
        },
        |effects| {
            vec![("directional_cap", effects.valve.directional_cap), ("directional_rod", effects.valve.directional_rod)]
        },
    ),
    new(
        "valve_gain_curve",
        3.5,
        |effects, shape, factor| {
            effects.valve.bend = factor * sign(shape[0]) * between(shape[1], 0.1, 0.3);
            effects.valve.curl = factor * sign(shape[2]) * between(shape[3], 0.0, 0.1);
        },
        |effects| vec![("bend", effects.valve.bend), ("curl", effects.valve.curl)],
    ),
    new(
        "valve_hysteresis",
        6.0,
        |effects, shape, factor| effects.valve.hysteresis = factor * between(shape[0], 4e-6, 8e-6),
        |effects| vec![("hysteresis_width", effects.valve.hysteresis)],
    ),
    new(
        "valve_leakage",
        10.0,
        |effects, shape, factor| effects.valve.leakage = shape.map(|number| factor * between(number, 5e-12, 1.5e-11)),
        |effects| {
            let [pump_cap, cap_tank, pump_rod, rod_tank] = effects.valve.leakage;
            vec![
                ("arm.valve_leakage_pump_cap", pump_cap),
                ("arm.valve_leakage_cap_tank", cap_tank),
                ("arm.valve_leakage_pump_rod", pump_rod),
                ("arm.valve_leakage_rod_tank", rod_tank),
            ]
        },
    ),
    new(
        "valve_lag",
        4.0,
        |effects, shape, factor| {
            let time = factor * 0.03;
            // Half of them first order, a quarter second order, a quarter first order after a delay.
            effects.valve.lag = Some(match shape[0] {
                form if form < 0.5 => Lag { first: time, second: 0.0, delay: 0.0 },
                form if form < 0.75 => Lag { first: time / 2.0, second: time / 2.0, delay: 0.0 },
                _ => Lag { first: time * 0.7, second: 0.0, delay: time * 0.3 },
            });
        },
        |effects| {
            effects.valve.lag.map_or_else(Vec::new, |lag| vec![("arm.lag_time", lag.first + lag.second + lag.delay)])
        },
    ),
    new(
        "load_check_valve",
        1.0,
        |effects, _, factor| effects.valve.load_check = factor.min(1.0),
        |effects| vec![("load_check", effects.valve.load_check)],
    ),
    new(
        "hose_loss",
        10.0,
        |effects, shape, factor| effects.friction.hose_loss = factor * between(shape[0], 1.5e5, 2.5e5),
        |effects| vec![("arm.hose_loss", effects.friction.hose_loss)],
    ),
    new(
        "entrained_air",
        15.0,
        |effects, shape, factor| {
            effects.oil.air_fraction = factor * between(shape[0], 7e-3, 1.3e-2);
            effects.oil.polytropic_index = between(shape[1], 1.2, 1.4);
        },
        |effects| vec![("arm.air_fraction", effects.oil.air_fraction)],
    ),
    new(
        "stribeck_friction",
        6.0,
        |effects, shape, factor| {
            effects.friction.stribeck_force = factor * between(shape[0], 350.0, 650.0);
            effects.friction.stribeck_speed = between(shape[1], 0.008, 0.02);
        },
        |effects| {
            vec![
                ("arm.stribeck_force", effects.friction.stribeck_force),
                ("arm.stribeck_speed", effects.friction.stribeck_speed),
            ]
        },
    ),
    new(
        "pressure_dependent_friction",
        10.0,
        |effects, shape, factor| effects.friction.pressure_coefficient = factor * between(shape[0], 1e-4, 2e-4),
        |effects| vec![("pressure_coefficient", effects.friction.pressure_coefficient)],
    ),
    new(
        "asymmetric_friction",
        6.0,
        |effects, shape, factor| {
            let extra = factor * between(shape[1], 120.0, 180.0);
            if shape[0] < 0.5 {
                effects.friction.extra_extending = extra;
            } else {
                effects.friction.extra_retracting = extra;
            }
        },
        |effects| {
            vec![
                ("extra_extending", effects.friction.extra_extending),
                ("extra_retracting", effects.friction.extra_retracting),
            ]
        },
    ),
    new(
        "end_cushion",
        30.0,
        |effects, shape, factor| {
            effects.friction.cushion_length = between(shape[0], 0.06, 0.1);
            effects.friction.cushion_damping = factor * between(shape[1], 2e4, 4e4);
        },
        |effects| {
            vec![
                ("cushion_length", effects.friction.cushion_length),
                ("cushion_damping", effects.friction.cushion_damping),
            ]
        },
    ),
    new(
        "relief_valve",
        2.6,
        |effects, shape, factor| {
            effects.pump.relief_pressure = 2.4e6 - factor * 5e5;
            effects.pump.relief_gain = between(shape[0], 7e-10, 1.3e-9);
        },
        |effects| {
            vec![("pump.relief_pressure", effects.pump.relief_pressure), ("pump.relief_gain", effects.pump.relief_gain)]
        },
    ),
    new(
        "pump_leakage",
        10.0,
        |effects, shape, factor| effects.pump.leakage = factor * between(shape[0], 7e-12, 1.3e-11),
        |effects| vec![("pump_leakage", effects.pump.leakage)],
    ),
    new(
        "bypass_overlap",
        8.0,
        |effects, shape, factor| effects.pump.bypass_overlap = factor * between(shape[0], 3e-6, 6e-6),
        |effects| vec![("bypass_overlap", effects.pump.bypass_overlap)],
    ),
    new(
        "pressure_sensor_offset",
        6.0,
        |effects, shape, factor| {
            let offset = factor * sign(shape[1]) * between(shape[2], 4e4, 6e4);
            match (shape[0] * 3.0) as usize {
                0 => effects.sensors.cap_offset = offset,
                1 => effects.sensors.rod_offset = offset,
                _ => effects.sensors.pump_offset = offset,
            }
        },
        |effects| {
            let sensors = &effects.sensors;
            vec![
                ("cap_offset", sensors.cap_offset),
                ("rod_offset", sensors.rod_offset),
                ("pump_offset", sensors.pump_offset),
            ]
        },
    ),
    new(
        "displacement_sensor_offset",
        6.0,
        |effects, shape, factor| {
            effects.sensors.displacement_offset = factor * sign(shape[0]) * between(shape[1], 8e-3, 1.2e-2)
        },
        |effects| vec![("displacement_offset", effects.sensors.displacement_offset)],
    ),
    new(
        "sensor_delay",
        10.0,
        |effects, shape, factor| {
            let delay = factor * between(shape[1], 3e-3, 5e-3);
            // Two in five: displacement only; two in five: pressures only; else all of them.
            effects.sensors.displacement_delay = if shape[0] < 0.4 || shape[0] >= 0.8 { delay } else { 0.0 };
            effects.sensors.pressure_delay = if shape[0] >= 0.4 { delay } else { 0.0 };
        },
        |effects| {
            vec![
                ("displacement_delay", effects.sensors.displacement_delay),
                ("pressure_delay", effects.sensors.pressure_delay),
            ]
        },
    ),
    Kind {
        // Adds to J2 and W2, which are both unknown: in one recording it is a heavier arm.
        identifiable: false,
        ..new(
            "payload",
            10.0,
            |effects, shape, factor| effects.load.payload = factor * between(shape[0], 10.0, 20.0),
            |effects| vec![("payload", effects.load.payload)],
        )
    },
    Kind {
        answer: "payload",
        ..new(
            "picked_up_payload",
            30.0,
            |effects, shape, factor| {
                effects.load.payload = factor * between(shape[0], 10.0, 20.0);
                effects.load.payload_begin = between(shape[1], 0.2, 0.7);
            },
            |effects| vec![("payload_mass", effects.load.payload)],
        )
    },
    new(
        "external_contact",
        10.0,
        |effects, shape, factor| {
            effects.load.contact_force = factor * sign(shape[0]) * between(shape[1], 400.0, 600.0);
            effects.load.contact_begin = between(shape[2], 0.1, 0.5);
            effects.load.contact_end = effects.load.contact_begin + between(shape[3], 0.15, 0.4);
        },
        |effects| vec![("contact_force", effects.load.contact_force)],
    ),
    new(
        "make_up_valve",
        3.0,
        |effects, _, factor| effects.oil.make_up_pressure = Some(-9e4 + 2e5 * factor),
        |effects| effects.oil.make_up_pressure.map_or_else(Vec::new, |pressure| vec![("make_up_pressure", pressure)]),
    ),
    new(
        "hose_pressure_loss",
        20.0,
        |effects, shape, factor| effects.valve.hose_resistance = factor * between(shape[0], 5e11, 1e12),
        |effects| vec![("arm.hose_resistance", effects.valve.hose_resistance)],
    ),
];
