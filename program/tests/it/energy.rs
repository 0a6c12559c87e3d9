//! The verb energy on recordings by an independent simulator, and on a long one.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{assert_one_clear_line, excavator, json, shared};
use excavator_bags::{Topics, write_recording};
use excavator_identification::energy::{EnergySettings, analyse, missing_power};
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use rosbag2::WriteOptions;
use serde_json::Value;

/// Identifies the nominal model on a case's first recording, and gives the ledgers of both. The weak form fits each balance by
/// itself: a method that fits outputs would spread what one balance lacks over the others.
fn ledgers(case: &str) -> Option<[Value; 2]> {
    let case = shared()?.join("practice").join(case);
    let folder = tempfile::tempdir().unwrap();
    let bag = |name: &str| case.join(name).to_str().unwrap().to_string();
    let words = [
        "identify",
        "--model",
        "zx30u-arm",
        "--method",
        "weak-form",
        "-o",
        "fitted.toml",
        "--bag",
        &bag("identification"),
    ];
    assert!(excavator(folder.path(), &words).status.success());
    Some(["identification", "validation"].map(|name| {
        let words = ["energy", "--model", "fitted.toml", "--json", "-", "--bag", &bag(name)];
        json(&excavator(folder.path(), &words))
    }))
}

/// Equations at which the ledger does not close, with size and band of the whole recording.
fn outside(result: &Value) -> Vec<String> {
    let mut found = Vec::new();
    for place in result["ledger"].as_array().unwrap() {
        let (name, always) = (place["equation"].as_str().unwrap(), &place["conditions"]["always"]);
        println!("{name}: {} W rms, explained {} W, closes: {}", always["size"], always["band"], place["closes"]);
        if place["closes"] == false {
            found.push(name.to_string());
        }
    }
    found
}

#[test]
fn leaking_valves_show_where_oil_is_balanced_and_nowhere_else() {
    let Some(results) = ledgers("p02") else { return };
    for result in results {
        let found = outside(&result);
        for equation in ["arm.cap_continuity", "arm.rod_continuity", "pump.continuity"] {
            assert!(found.iter().any(|name| name == equation), "{equation}: {found:?}");
        }
        assert!(!found.iter().any(|name| name == "arm.motion"));
    }
}

/// The arm swung by a program that sets the valve 20 times a second and records 250 states a second, its sensors as good
/// as can be bought: `early` tells whether a state shows the opening that led to it, or the one that comes after it.
fn stairs(early: bool, seed: u64) -> Recording {
    let model = built_in("zx30u-arm").unwrap();
    let time: Vec<f64> = (0..16_000).map(|index| f64::from(index) * 2.5e-4).collect();
    let mut fine = Recording::unmeasured("stairs", time, &["arm"]);
    fine.tank_pressure.fill(0.0);
    fine.pump_flow.fill(3.8e-4);
    // Steps of 52 ms, so that they fall between samples and on them.
    let area = |t: f64| 8e-5 * (std::f64::consts::PI * (t / 0.052).floor() * 0.052).sin();
    let areas: Vec<f64> = fine.time.iter().map(|&t| area(t)).collect();
    fine.cylinders[0].orifice_command.clone_from(&areas);
    fine.cylinders[0].orifice_area = areas;
    let mut recording = simulate_from_rest(&model, &fine, &[0.0], Tolerances::default()).unwrap().thinned(16);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut add = |signal: &mut Vec<f64>, size: f64| {
        let noise = Normal::new(0.0, size).unwrap();
        signal.iter_mut().for_each(|value| *value += noise.sample(&mut random));
    };
    add(&mut recording.pump_pressure, 2e3);
    let arm = &mut recording.cylinders[0];
    add(&mut arm.cap_pressure, 2e3);
    add(&mut arm.rod_pressure, 2e3);
    add(&mut arm.displacement, 5e-5);
    for signal in [&mut arm.velocity, &mut arm.joint_angle] {
        signal.fill(f64::NAN);
    }
    if early {
        arm.orifice_area.rotate_right(1);
    }
    arm.orifice_command.clone_from(&arm.orifice_area);
    recording
}

#[test]
fn a_valve_set_in_steps_is_no_missing_power() {
    let model = built_in("zx30u-arm").unwrap();
    for early in [false, true] {
        for seed in 0..6 {
            let analysis = analyse(&model, &stairs(early, seed), EnergySettings::default());
            let missing = missing_power(&model, &analysis.unwrap());
            let said: Vec<&str> = missing.iter().map(|place| place.sentence.as_str()).collect();
            assert!(said.is_empty(), "shown early: {early}, seed {seed}: {said:?}");
        }
    }
}

/// A minute of the arm that swings at 0.5 Hz, at 1 kHz.
fn minute() -> Recording {
    let model = built_in("zx30u-arm").unwrap();
    let time: Vec<f64> = (0..60_000).map(|index| f64::from(index) * 1e-3).collect();
    let mut recording = Recording::unmeasured("minute", time, &["arm"]);
    recording.tank_pressure.fill(0.0);
    recording.pump_flow.fill(3.8e-4);
    let areas: Vec<f64> = recording.time.iter().map(|t| 6e-5 * (std::f64::consts::PI * t).sin()).collect();
    recording.cylinders[0].orifice_command.clone_from(&areas);
    recording.cylinders[0].orifice_area = areas;
    simulate_from_rest(&model, &recording, &[0.0], Tolerances::default()).unwrap()
}

/// The minute `times` over, with a pause between that keeps them apart.
fn repeated(minute: &Recording, times: usize) -> Recording {
    let mut long = minute.clone();
    for column in long.columns_mut() {
        let once = column.clone();
        *column = once.iter().copied().cycle().take(once.len() * times).collect();
    }
    for (index, time) in long.time.iter_mut().enumerate() {
        *time += (index / minute.len()) as f64 * 60.2;
    }
    long
}

#[test]
fn what_is_not_measured_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut recording = minute();
    recording.cylinders[0].rod_pressure.fill(f64::NAN);
    let bag = folder.path().join("bag");
    write_recording(&bag, &recording, &Topics::default(), &WriteOptions::default()).unwrap();
    let output = excavator(folder.path(), &["energy", "--model", "zx30u-arm", "--bag", "bag"]);
    assert_one_clear_line(&output, &["arm.rod_pressure"]);
    let output = excavator(folder.path(), &["energy", "--model", "zx30u-arm", "--bag", "nowhere"]);
    assert_one_clear_line(&output, &["nowhere"]);
}

/// Largest resident memory of a process that is running, MB.
fn peak_memory(process: u32) -> Option<f64> {
    let status = std::fs::read_to_string(Path::new("/proc").join(process.to_string()).join("status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

#[test]
#[ignore = "writes an hour of bag; tests/run --long"]
fn an_hour_at_one_kilohertz_takes_little_memory() {
    for (what, minute) in [("noise-free", minute()), ("noisy", noisy(minute()))] {
        let (seconds, peak) = analyse_an_hour_of(&minute);
        println!("{what}: 3.6 million samples in {seconds:.1} s with {peak:.0} MB at most");
        assert!(peak < 400.0, "{what}: {peak} MB");
    }
}

/// The same as good sensors see it.
fn noisy(mut recording: Recording) -> Recording {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let mut add = |signal: &mut Vec<f64>, deviation: f64| {
        let noise = Normal::new(0.0, deviation).unwrap();
        signal.iter_mut().for_each(|value| *value += noise.sample(&mut generator));
    };
    let arm = &mut recording.cylinders[0];
    add(&mut arm.displacement, 5e-5);
    add(&mut arm.cap_pressure, 2e3);
    add(&mut arm.rod_pressure, 2e3);
    add(&mut arm.orifice_area, 2e-7);
    add(&mut recording.pump_pressure, 2e3);
    recording
}

/// Wall-clock time, s, and most memory, MB.
fn analyse_an_hour_of(minute: &Recording) -> (f64, f64) {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("hour");
    write_recording(&bag, &repeated(minute, 60), &Topics::default(), &WriteOptions::default()).unwrap();
    let started = Instant::now();
    let mut process = Command::new(env!("CARGO_BIN_EXE_excavator"))
        .args(["energy", "--model", "zx30u-arm", "--bag", "hour", "--report", "page.html"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut peak = 0.0_f64;
    let status = loop {
        peak = peak_memory(process.id()).map_or(peak, |now| now.max(peak));
        if let Some(status) = process.try_wait().unwrap() {
            break status;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert!(status.success());
    (started.elapsed().as_secs_f64(), peak)
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn a_long_bag_goes_through_in_blocks_and_gives_what_it_gives_in_one() {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        let long = repeated(&minute(), 4);
        write_recording(&bag, &long, &Topics::default(), &WriteOptions::default()).unwrap();
        let words = ["energy", "--model", "zx30u-arm", "--json", "-", "--report", "page.html", "--bag", "bag"];
        let result = json(&excavator(folder.path(), &words));
        let model = built_in("zx30u-arm").unwrap();
        let whole = excavator_identification::energy::analyse(&model, &long, Default::default()).unwrap();
        let close = |found: &Value, wanted: f64, what: &str| {
            let found = found.as_f64().unwrap();
            assert!((found - wanted).abs() <= 1e-6 * wanted.abs().max(1.0), "{what}: {found} {wanted}");
        };
        assert_eq!(result["gaps"], 3);
        close(&result["energy"]["pump"], whole.totals.pump, "pump");
        close(&result["energy"]["cylinders"]["arm"]["supplied"], whole.totals.cylinders[0].supplied, "supplied");
        close(&result["pump_line"]["bypass_loss"], whole.totals.bypass_loss(), "bypass");
        let period = result["cycle"]["period"].as_f64().unwrap();
        assert!((period / 2.0 - 1.0).abs() < 5e-3, "{period}");
        // What goes in comes out.
        let line = &result["pump_line"];
        let part = |name: &str| line[name].as_f64().unwrap();
        let arm = |name: &str| line["sections"]["arm"][name].as_f64().unwrap();
        let out = part("bypass_loss") + arm("metering_loss") + arm("into_cylinder") + part("stored") - part("residual");
        assert!((out / part("pump") - 1.0).abs() < 1e-9, "{line:#}");
        assert!(part("residual").abs() < 1e-3 * part("pump"), "{line:#}");
        let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
        assert!(page.contains("Where the energy went") && page.contains("<svg") && !page.contains("http://"));
    }

    #[test]
    fn with_nothing_missing_the_ledger_closes_within_its_noise() {
        let Some(results) = ledgers("p00") else { return };
        for result in results {
            assert_eq!(outside(&result), Vec::<String>::new());
            assert_eq!(result["ledger_closes"], true);
            assert_eq!(result["missing_power"].as_array().unwrap().len(), 0);
            for place in result["ledger"].as_array().unwrap() {
                let always = &place["conditions"]["always"];
                // The band says something: it is of the size of what is left, not wider by orders of magnitude.
                assert!(always["size"].as_f64().unwrap() > 0.05 * always["band"].as_f64().unwrap(), "{place:#}");
            }
        }
    }

    #[test]
    fn losses_in_hoses_show_between_pressure_and_link_and_nowhere_else() {
        let Some(results) = ledgers("p03") else { return };
        for result in results {
            assert_eq!(outside(&result), ["arm.motion"]);
            let evidence = &result["missing_power"][0];
            assert_eq!(evidence["cylinder"], "arm");
            assert!(evidence["sentence"].as_str().unwrap().contains("between the oil's pressure and the moving links"));
        }
    }
}
