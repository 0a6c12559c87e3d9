//! Kinds of effects that no catalogue lists.

use super::kinds::{Kind, between, new, sign};

/// Effects in nobody's catalogue: the right verdict is that something is left unexplained.
pub static FOREIGN: &[Kind] = &[
    new(
        "friction_bump",
        10.0,
        |effects, shape, factor| {
            effects.foreign.bump_force = factor * between(shape[0], 300.0, 600.0);
            effects.foreign.bump_place = between(shape[1], -0.05, 0.01);
            effects.foreign.bump_width = between(shape[2], 0.01, 0.025);
        },
        |effects| vec![("bump_force", effects.foreign.bump_force)],
    ),
    new(
        "stroke_leakage",
        20.0,
        |effects, shape, factor| {
            effects.foreign.stroke_leakage = factor * between(shape[0], 1e-11, 2e-11);
            effects.foreign.stroke_period = between(shape[1], 0.03, 0.08);
        },
        |effects| vec![("stroke_leakage", effects.foreign.stroke_leakage)],
    ),
    new(
        "viscosity_step",
        4.0,
        |effects, shape, factor| {
            effects.foreign.viscosity_step = (factor * between(shape[0], 0.1, 0.2)).min(0.8);
            effects.foreign.viscosity_time = between(shape[1], 0.25, 0.5);
        },
        |effects| vec![("viscosity_step", effects.foreign.viscosity_step)],
    ),
    new(
        "engine_droop",
        8.0,
        |effects, shape, factor| effects.foreign.engine_droop = factor * between(shape[0], 0.02, 0.04),
        |effects| vec![("engine_droop", effects.foreign.engine_droop)],
    ),
    new(
        "pin_play",
        15.0,
        |effects, shape, factor| effects.foreign.pin_play = factor * between(shape[0], 5e-4, 1e-3),
        |effects| vec![("pin_play", effects.foreign.pin_play)],
    ),
    new(
        "spool_flow_force",
        10.0,
        |effects, shape, factor| effects.foreign.flow_force = factor * between(shape[0], 0.03, 0.06),
        |effects| vec![("flow_force", effects.foreign.flow_force)],
    ),
    new(
        "port_relief",
        3.0,
        |effects, shape, factor| {
            effects.foreign.port_relief_pressure = 2.4e6 - factor * 4e5;
            effects.foreign.port_relief_gain = between(shape[0], 5e-11, 2e-10);
        },
        |effects| vec![("port_relief_pressure", effects.foreign.port_relief_pressure)],
    ),
    new(
        "return_filter",
        20.0,
        |effects, shape, factor| effects.foreign.return_resistance = factor * between(shape[0], 5e11, 1e12),
        |effects| vec![("return_resistance", effects.foreign.return_resistance)],
    ),
    new(
        "balance_spring",
        20.0,
        |effects, shape, factor| {
            effects.foreign.spring_stiffness = factor * between(shape[0], 150.0, 300.0);
            effects.foreign.spring_angle = between(shape[1], 4.4, 5.0);
        },
        |effects| vec![("spring_stiffness", effects.foreign.spring_stiffness)],
    ),
    new(
        "gain_drift",
        15.0,
        |effects, shape, factor| {
            effects.foreign.gain_drift = factor * sign(shape[0]) * between(shape[1], 0.01, 0.02);
        },
        |effects| vec![("gain_drift", effects.foreign.gain_drift)],
    ),
    new(
        "worn_linkage",
        20.0,
        |effects, shape, factor| {
            effects.sensors.linkage_error = factor * sign(shape[0]) * between(shape[1], 5e-4, 1e-3);
            effects.sensors.linkage_period = between(shape[2], 0.1, 0.3);
        },
        |effects| vec![("linkage_error", effects.sensors.linkage_error)],
    ),
];
