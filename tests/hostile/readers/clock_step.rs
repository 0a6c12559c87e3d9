//! A recording whose clock was set forward.

use std::path::Path;

use excavator_bags::map::{Origin, read_recording_or_mapped};
use excavator_bags::{Topics, write_recording};
use excavator_model::recording::Recording;
use rosbag2::WriteOptions;

use crate::hostile::child::{Run, run};
use crate::hostile::fault::Fault;

/// A swing of an arm: pressures and motion that belong together, from the program's own simulation.
fn simulated(folder: &Path) -> Recording {
    let profile = "rate = 200.0\nstart = { load = -0.1 }\n\n[[profiles]]\ncylinder = \"load\"\nsegments = [\n\
        { kind = \"hold\", duration = 0.5, area = 0.0 },\n\
        { kind = \"sine\", duration = 12.0, amplitude = 3e-5, frequency = 0.5 },\n\
        { kind = \"sine\", duration = 6.0, amplitude = 5e-5, frequency = 1.5 },\n]\n";
    std::fs::write(folder.join("profile.toml"), profile).unwrap();
    let done = run(folder, &["simulate", "--model", "servo-bench", "--input", "profile.toml", "-o", "plain"], 60.0);
    assert_eq!(done.status, Some(0), "{done:?}");
    let mut recording = read_recording_or_mapped(&folder.join("plain"), Origin::default()).unwrap().0;
    // Sensors are noisy, or intervals would have no width.
    let mut seed = 1_u64;
    let mut noise = |size: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        size * ((seed >> 33) as f64 / f64::from(1 << 30) - 1.0)
    };
    let load = &mut recording.cylinders[0];
    load.displacement.iter_mut().for_each(|value| *value += noise(3e-5));
    load.cap_pressure.iter_mut().chain(&mut load.rod_pressure).for_each(|value| *value += noise(4e3));
    recording
}

/// Writes the recording with its clock set forward by `gap` s in the middle.
fn write(folder: &Path, name: &str, recording: &Recording, gap: f64) {
    let mut stepped = recording.clone();
    stepped.start_nanoseconds = 1_000_000_000;
    let middle = stepped.len() / 2;
    stepped.time.iter_mut().skip(middle).for_each(|time| *time += gap);
    write_recording(&folder.join(name), &stepped, &Topics::default(), &WriteOptions::default()).unwrap();
}

/// Values with the half width of their 95 % intervals, by name.
fn parameters(run: &Run) -> Vec<(String, f64, f64)> {
    assert_eq!(run.status, Some(0), "{run:?}");
    let value: serde_json::Value = serde_json::from_str(&run.output).unwrap();
    let list = value["parameters"].as_array().unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
    list.iter()
        .filter(|parameter| parameter["margin_95"].is_number())
        .map(|p| (p["name"].as_str().unwrap().to_string(), number(&p["value"]), number(&p["margin_95"])))
        .collect()
}

#[test]
fn a_clock_set_forward_by_thirty_years() {
    let folder = tempfile::tempdir().unwrap();
    let recording = simulated(folder.path());
    // A pause of ten seconds as the comparison: it cuts as well, so the same samples are used.
    for (name, gap) in [("short", 10.0), ("long", 1e9)] {
        write(folder.path(), name, &recording, gap);
    }
    let identify =
        |bag: &str| run(folder.path(), &["identify", "--model", "servo-bench", "--bag", bag, "--json", "-"], 120.0);
    let (short, long) = (identify("short"), identify("long"));
    let (expected, found) = (parameters(&short), parameters(&long));
    assert!(expected.len() >= 3, "{expected:?}");
    assert_eq!(expected.len(), found.len());
    // Windows begin at other samples behind the pause, so both are estimates of their own: their difference has the margins of both.
    for ((name, value, margin), (other, now, own)) in expected.iter().zip(&found) {
        assert_eq!(name, other);
        let of_both = margin.hypot(*own).max(1e-4 * value.abs());
        assert!((value - now).abs() <= of_both, "{name}: {value} ± {margin} and {now} ± {own}");
    }
    assert!(long.seconds <= 2.0 * short.seconds + 0.5, "{} s instead of {} s", long.seconds, short.seconds);
    let mut slowest = long.seconds;
    for words in [
        &["compare", "--model", "servo-bench", "--bag", "long"][..],
        &["energy", "--model", "servo-bench", "--bag", "long"],
        &["info", "long"],
        &["characterise", "--model", "servo-bench", "long"],
    ] {
        let done = run(folder.path(), words, 30.0);
        assert!(matches!(done.status, Some(0 | 1)), "{done:?}");
        done.is_frugal();
        slowest = slowest.max(done.seconds);
    }
    Fault {
        group: "Files",
        tried: "a recording whose clock was set forward by 1e9 s",
        outcome: "it is cut there; nothing takes longer, and the parameters stay within their intervals",
    }
    .survived(&[
        ("identify with a gap of 10 s [s]", format!("{:.2}", short.seconds)),
        ("identify with a gap of 1e9 s [s]", format!("{:.2}", long.seconds)),
        ("slowest verb [s]", format!("{slowest:.2}")),
    ]);
}
