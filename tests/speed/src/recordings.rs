//! The recordings that costs are measured on.

use std::path::{Path, PathBuf};

use excavator_bags::{Topics, write_recording};
use excavator_blind::cases::{Case, Sort, Wish};
use excavator_blind::instruments::Instruments;
use excavator_blind::scoring::make;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Profile, Segment, Tolerances, simulate_from_rest};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rosbag2::WriteOptions;

use crate::common;
use crate::truth::truth;

/// Seed of the blind machines.
const SEED: u64 = 91;
/// Seed of the manoeuvre of long recordings.
const MANOEUVRE: u64 = 5;
/// Noise of the instruments: displacement 50 um, pressures 2 kPa, opening 0.2 mm2.
const NOISE: [f64; 3] = [5e-5, 2e3, 2e-7];

/// A pair of recordings of one machine.
pub struct Pair {
    /// For `--identification`.
    pub identification: PathBuf,
    /// For `--validation`.
    pub validation: PathBuf,
    /// What the machine hides.
    pub secret: String,
}

/// 38 s and 20 s at 500 Hz of a machine that hides something of this sort.
///
/// # Errors
/// In words, where the machine cannot be recorded or the bags not written.
pub fn blind_pair(folder: &Path, sort: Sort) -> Result<Pair, String> {
    let mut case = Case::draw(SEED, 0, &Wish { sort: Some(sort), ..Wish::default() });
    let evidence = make(&mut case, &Instruments::default()).map_err(|error| error.to_string())?;
    let folder = folder.join(case.secret());
    let write = |name: &str, recording: &Recording| {
        let path = folder.join(name);
        write_recording(&path, recording, &Topics::default(), &WriteOptions::default())
            .map(|()| path)
            .map_err(|error| error.to_string())
    };
    Ok(Pair {
        identification: write("identification", &evidence.identification)?,
        validation: write("validation", &evidence.validation)?,
        secret: case.secret(),
    })
}

/// So many seconds of an arm at a rate in Hz, as a bag: sines, trapezoids and holds at random, with noise of instruments.
///
/// # Errors
/// In words, where the machine cannot be simulated or the bag not written.
pub fn long(folder: &Path, seconds: f64, rate: f64) -> Result<PathBuf, String> {
    let path = folder.join(format!("{seconds:.0}s-{rate:.0}Hz"));
    let recording = recorded(seconds, rate)?;
    write_recording(&path, &recording, &Topics::default(), &WriteOptions::default())
        .map_err(|error| error.to_string())?;
    Ok(path)
}

/// So many hours at a rate in Hz, each with the motions of the first, as a bag.
///
/// # Errors
/// In words, where the machine cannot be simulated or the bag not written.
pub fn hours(folder: &Path, number: usize, rate: f64) -> Result<PathBuf, String> {
    let path = folder.join(format!("{number}h-{rate:.0}Hz"));
    let hour = recorded(3600.0, rate)?;
    let mut all = hour.clone();
    for (column, first) in all.columns_mut().into_iter().zip(hour.clone().columns_mut()) {
        *column = first.repeat(number);
    }
    all.time = (0..number * hour.len()).map(|index| index as f64 / rate).collect();
    write_recording(&path, &all, &Topics::default(), &WriteOptions::default()).map_err(|error| error.to_string())?;
    Ok(path)
}

/// The recording of [`long`].
///
/// # Errors
/// In words, where the machine cannot be simulated.
pub fn recorded(seconds: f64, rate: f64) -> Result<Recording, String> {
    let model = truth()?;
    let mut generator = ChaCha8Rng::seed_from_u64(MANOEUVRE);
    let profile = Profile { cylinder: "arm".into(), segments: segments(seconds, &mut generator) };
    let samples = (seconds * rate) as usize;
    let time = (0..samples).map(|index| index as f64 / rate).collect();
    let mut recording = Recording::unmeasured("arm", time, &["arm"]);
    Profile::command(&[profile], &mut recording);
    recording.tank_pressure.fill(0.0);
    let mut recording =
        simulate_from_rest(&model, &recording, &[0.0], Tolerances::default()).map_err(|error| error.to_string())?;
    add_noise(&mut recording, &mut common::Random(MANOEUVRE));
    Ok(recording)
}

/// Motions that come back to where they begin, for a time in s.
fn segments(seconds: f64, generator: &mut ChaCha8Rng) -> Vec<Segment> {
    let mut segments = Vec::new();
    let mut length = 0.0;
    while length < seconds {
        let amplitude = generator.random_range(1e-5..8e-5);
        match generator.random_range(0..3) {
            0 => {
                let frequency = [0.25, 0.5, 1.0, 2.0][generator.random_range(0..4)];
                let duration = f64::from(generator.random_range(1..4_u8)) / frequency;
                segments.push(Segment::Sine { duration, amplitude, frequency });
            }
            1 => {
                let (duration, amplitude) = (generator.random_range(1.0..1.5), 0.7 * amplitude);
                segments.extend([amplitude, -amplitude].map(|amplitude| Segment::Trapezoid {
                    duration,
                    amplitude,
                    ramp: 0.2,
                }));
            }
            _ => segments.push(Segment::Hold { duration: generator.random_range(0.5..2.5), area: 0.0 }),
        }
        length = segments.iter().map(Segment::duration).sum();
    }
    segments
}

fn add_noise(recording: &mut Recording, random: &mut common::Random) {
    let [displacement, pressure, area] = NOISE;
    let pump = std::iter::once((&mut recording.pump_pressure, pressure));
    let cylinders = recording.cylinders.iter_mut().flat_map(|cylinder| {
        [
            (&mut cylinder.displacement, displacement),
            (&mut cylinder.cap_pressure, pressure),
            (&mut cylinder.rod_pressure, pressure),
            (&mut cylinder.orifice_area, area),
        ]
    });
    for (column, deviation) in pump.chain(cylinders) {
        for value in column {
            *value += deviation * random.normal();
        }
    }
    for cylinder in &mut recording.cylinders {
        // What no instrument of this machine measures.
        cylinder.velocity.fill(f64::NAN);
        cylinder.joint_angle.fill(f64::NAN);
    }
}
