//! What is said of the signals of a recording.

use excavator_bags::SignalsInfo;
use excavator_model::recording::Recording;

#[test]
fn what_is_missing_for_each_equation_is_named() {
    let mut recording = Recording::unmeasured("made up", vec![0.0, 1.0, 2.0, 3.0], &["arm"]);
    let equations = |recording: &Recording| -> Vec<(String, Vec<String>)> {
        SignalsInfo::of(recording).equations.into_iter().map(|e| (e.equation, e.missing)).collect()
    };
    let nothing = equations(&recording);
    assert_eq!(nothing.len(), 1);
    assert_eq!((nothing[0].0.as_str(), nothing[0].1.len()), ("arm motion", 2));
    let arm = &mut recording.cylinders[0];
    arm.displacement = vec![0.1, f64::NAN, 0.2, -0.3];
    arm.rod_force.fill(5.0);
    assert_eq!(equations(&recording), [("arm motion".to_string(), vec![])]);
    let arm = &mut recording.cylinders[0];
    arm.cap_pressure.fill(1e6);
    let missing = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
    let opening = "arm.orifice_area or arm.orifice_command";
    let expected = [
        ("arm motion".to_string(), missing(&[])),
        ("arm chambers".to_string(), missing(&["arm.rod_pressure", opening])),
        ("pump line".to_string(), missing(&["pump_pressure", opening])),
    ];
    assert_eq!(equations(&recording), expected);
    // A supply or a tank that nobody measures may be a constant of the machine.
    let constant: Vec<_> = SignalsInfo::of(&recording).equations.into_iter().map(|e| e.constant).collect();
    assert_eq!(constant[1], missing(&["pump_pressure", "tank_pressure"]));
    assert_eq!(constant[2], missing(&["tank_pressure", "pump_flow"]));
    let signals = SignalsInfo::of(&recording);
    let displacement = &signals.measured[0];
    assert_eq!((displacement.missing, displacement.least, displacement.most), (0.25, -0.3, 0.2));
}
