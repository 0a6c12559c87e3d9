//! How pistons drive joints.

use crate::common;
use excavator_model::document::built_in;
use excavator_model::machine::{Linkage, Mechanism, Supply};

#[test]
fn displacement_and_joint_are_inverse() {
    for model in common::machines() {
        for cylinder in &model.machine.cylinders {
            for step in -100..=100 {
                let displacement = cylinder.usual_travel() / 2.0 * f64::from(step) / 100.0;
                let joint = cylinder.linkage.joint(displacement);
                let back = cylinder.linkage.displacement(joint);
                assert!((back - displacement).abs() < 1e-13, "{} {displacement} {back}", cylinder.name);
            }
        }
    }
}

#[test]
fn lever_is_the_slope_of_the_displacement() {
    for model in common::machines() {
        for cylinder in &model.machine.cylinders {
            for step in -20..=20 {
                let joint = cylinder.linkage.joint(cylinder.usual_travel() / 2.0 * f64::from(step) / 20.0);
                let width = 1e-5;
                let slope = (cylinder.linkage.displacement(joint + width)
                    - cylinder.linkage.displacement(joint - width))
                    / (2.0 * width);
                let lever: f64 = cylinder.linkage.lever(joint);
                assert!((slope - lever).abs() < 1e-9, "{} {slope} {lever}", cylinder.name);
            }
        }
    }
}

/// The boom's joint angle grows with extension, the arm's falls: theta = q and theta = 2 pi - q.
#[test]
fn the_two_orientations_turn_opposite_ways() {
    let model = built_in("zx30u").unwrap();
    let (boom, arm) = (&model.machine.cylinders[0].linkage, &model.machine.cylinders[1].linkage);
    assert!(matches!(boom, Linkage::Triangle { mirrored: false, .. }));
    assert!(matches!(arm, Linkage::Triangle { mirrored: true, .. }));
    let half_turn = std::f64::consts::PI;
    for displacement in [-0.29, 0.0, 0.29] {
        let (first, second) = (boom.joint(displacement), arm.joint(displacement));
        assert!((0.0..half_turn).contains(&first) && (half_turn..2.0 * half_turn).contains(&second));
        assert!(boom.lever::<f64>(first) > 0.0 && arm.lever::<f64>(second) < 0.0);
    }
    assert!(boom.joint(0.1) > boom.joint(-0.1) && arm.joint(0.1) < arm.joint(-0.1));
}

#[test]
fn a_direct_load_is_the_piston() {
    assert_eq!(Linkage::Direct.joint(0.123), 0.123);
    assert_eq!(Linkage::Direct.displacement(0.123), 0.123);
    assert_eq!(Linkage::Direct.lever(0.123), 1.0);
}

/// With la = 1.1 m and lb = 0.33 m the cosine law allows pin-to-pin lengths from 0.77 m to 1.43 m: 0.28 m as printed in
/// Table 1 of \[A\] is none, 1.10 m is the middle and leaves room for a stroke of 0.6 m.
#[test]
fn the_cosine_law_bounds_the_length() {
    let at = |mid_stroke_length| Linkage::Triangle { foot_arm: 1.1, rod_arm: 0.33, mid_stroke_length, mirrored: true };
    assert!(at(0.28).joint(0.0).is_nan());
    for (length, possible) in [(0.7699, false), (0.7701, true), (1.10, true), (1.4299, true), (1.4301, false)] {
        assert_eq!(at(length).joint(0.0).is_finite(), possible, "{length}");
    }
    for end in [-0.3, 0.3] {
        assert!(at(1.10).joint(end).is_finite());
    }
}

/// Table 1 of \[A\], and \[A\]'s start values.
#[test]
fn the_built_in_arm_is_that_of_the_paper() {
    let model = built_in("zx30u-arm").unwrap();
    let machine = &model.machine;
    assert_eq!(machine.gravity, 9.8);
    let Mechanism::SingleLink { base_angle } = machine.mechanism else { panic!("{:?}", machine.mechanism) };
    assert!((base_angle - std::f64::consts::FRAC_PI_3).abs() < 1e-15);
    let cylinder = &machine.cylinders[0];
    assert_eq!(cylinder.name, "arm");
    assert_eq!(cylinder.stroke, 0.6);
    assert_eq!(
        cylinder.linkage,
        Linkage::Triangle { foot_arm: 1.1, rod_arm: 0.33, mid_stroke_length: 1.10, mirrored: true }
    );
    let chambers = cylinder.chambers.unwrap();
    assert_eq!((chambers.cap_area, chambers.rod_area), (3.8e-3, 2.6e-3));
    assert_eq!((chambers.cap_dead_volume, chambers.rod_dead_volume), (3.4e-4, 3.0e-4));
    assert_eq!(chambers.full_command(), 1.15e-4);
    // V+ + V- changes by the rod's volume only.
    let mid: f64 = chambers.cap_volume(0.6, 0.0) + chambers.rod_volume(0.6, 0.0);
    let out = chambers.cap_volume(0.6, 0.1) + chambers.rod_volume(0.6, 0.1);
    assert!((out - mid - 0.1 * (3.8e-3 - 2.6e-3)).abs() < 1e-15);
    let Supply::PumpLine(line) = machine.supply else { panic!("{:?}", machine.supply) };
    assert_eq!((line.volume, line.flow), (1.2e-4, 3.8e-4));
    for (name, value) in [
        ("arm.inertia", 230.0),
        ("arm.viscous_damping", 1.3e4),
        ("arm.coulomb_friction", 160.0),
        ("arm.gravity_moment", 190.0),
        ("arm.bulk_modulus", 9.6e8),
        ("pump.bulk_modulus", 6.5e7),
        ("arm.flow_gain_cap", 4.6e-3),
        ("arm.flow_gain_rod", 4.0e-3),
        ("arm.internal_leakage", 1.4e-11),
        ("arm.external_leakage_cap", 4.1e-12),
        ("arm.external_leakage_rod", 3.0e-12),
        ("pump.bypass_flow_gain", 1.1e-2),
    ] {
        assert_eq!(model.value_of(name), Some(value), "{name}");
    }
}

/// The lumped parameters of the two-link machine are those of its links: m1 190, l1 2.5, lg1 1.1, I1 95; m2 190,
/// lg2 1.0, I2 40.
#[test]
fn the_built_in_boom_and_arm_have_the_masses_of_their_links() {
    let model = built_in("zx30u").unwrap();
    let (m1, l1, lg1, i1, m2, lg2, i2) = (190.0, 2.5, 1.1, 95.0, 190.0, 1.0, 40.0);
    for (name, value) in [
        ("boom.inertia", i1 + i2 + m1 * lg1 * lg1 + m2 * (l1 * l1 + lg2 * lg2)),
        ("boom.coupling_inertia", m2 * lg2 * l1),
        ("boom.gravity_moment", m1 * lg1 + m2 * l1),
        ("arm.inertia", i2 + m2 * lg2 * lg2),
        ("arm.gravity_moment", m2 * lg2),
    ] {
        let found = model.value_of(name).unwrap();
        assert!((found - value).abs() < 1e-9 * value, "{name}: {found}, from links {value}");
    }
}
