//! The manoeuvres of the simulated operator.

use excavator_model::simulation::{Profile, Segment};

/// Manoeuvre for the fit: sines of two amplitudes, trapezoids of both signs, a sweep, pauses.
pub fn identification() -> Profile {
    let pause = |duration| Segment::Hold { duration, area: 0.0 };
    let trapezoid = |amplitude| Segment::Trapezoid { duration: 1.2, amplitude, ramp: 0.15 };
    let mut segments = vec![pause(0.5), Segment::Sine { duration: 6.0, amplitude: 1.0e-4, frequency: 0.5 }, pause(0.8)];
    for amplitude in [8e-5, 3e-5, 1.5e-5] {
        segments.extend([trapezoid(amplitude), pause(0.5), trapezoid(-amplitude), pause(0.5)]);
    }
    segments.push(Segment::Sweep { duration: 5.0, amplitude: 7e-5, from_frequency: 0.4, to_frequency: 2.5 });
    segments.push(pause(0.8));
    segments.push(Segment::Sine { duration: 3.0, amplitude: 4e-5, frequency: 0.8 });
    segments.push(pause(0.5));
    Profile { cylinder: "arm".into(), segments }
}

/// Manoeuvre for the validation.
pub fn validation() -> Profile {
    let pause = |duration| Segment::Hold { duration, area: 0.0 };
    let segments = vec![
        pause(0.5),
        Segment::Sine { duration: 5.0, amplitude: 9e-5, frequency: 1.0 },
        pause(0.7),
        Segment::Trapezoid { duration: 1.5, amplitude: 5e-5, ramp: 0.2 },
        pause(0.6),
        Segment::Trapezoid { duration: 1.5, amplitude: -5e-5, ramp: 0.2 },
        pause(0.6),
        Segment::Sweep { duration: 4.0, amplitude: 5e-5, from_frequency: 0.5, to_frequency: 1.8 },
        pause(0.6),
    ];
    Profile { cylinder: "arm".into(), segments }
}
