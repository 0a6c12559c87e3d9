//! Effects of sensor noise and parameter errors on the ledger.

use excavator_model::SignalError;
use excavator_model::equations::System;
use excavator_model::recording::{Recording, is_measured, noise_level};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::block::{Block, Entries, books_of, measured_books};
use super::windows::windows;
use super::{Books, EnergySettings, Place};

/// Errors of the residuals of one window, one entry per place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WindowNoise {
    /// Mean shift by noise, W.
    pub bias: Vec<f64>,
    /// Variance due to noise, W².
    pub variance: Vec<f64>,
    /// Changes of the residual by errors that are common to all windows, W: one standard error of each parameter that has one,
    /// and a shift of the valve openings by half a sample.
    pub parameters: Vec<Vec<f64>>,
    /// Upper estimate of what the parabolas cut off, W.
    pub rounding: Vec<f64>,
}

/// The noise analysis of a block.
#[derive(Debug, Clone)]
pub(super) struct NoiseStudy {
    /// The books with noise added, one per repeat.
    pub draws: Vec<Books>,
    /// One entry per window.
    pub windows: Vec<WindowNoise>,
}

/// Windows on each side over which a variance is averaged. Repeats alone would leave it a fifth uncertain, and windows further
/// away belong to another part of a stroke.
const POOLED: usize = 2;

/// Factor on the half widths for estimating the rounding of the parabolas.
const WIDER: f64 = 1.4;

/// Repeats the books of a block with added noise of each sensor's own level, estimated from the signal's second differences. The
/// repeats' residuals scatter as noise scatters the residual itself, and the shift of their mean equals the shift that noise has
/// already caused (simulation and extrapolation, Cook and Stefanski 1994): squares, magnitudes and square roots of noisy signals
/// do not average out. Parameters are shifted by one standard error each.
pub(super) fn study_noise(
    system: &System<'_>,
    block: &Block,
    entries: &Entries,
    books: &Books,
    places: &[Place],
    settings: &EnergySettings,
) -> Result<NoiseStudy, SignalError> {
    let model = system.model();
    let parameters = model.parameter_values();
    let base = windows(model, books, places, block.own, settings);
    let mut random = ChaCha8Rng::seed_from_u64(settings.seed.wrapping_add(block.first_sample as u64));
    let noisy: Vec<Block> = (0..settings.draws)
        .map(|_| Block { recording: with_more_noise(&block.recording, &mut random), ..block.clone() })
        .collect();
    let draws = noisy
        .par_iter()
        .map(|block| measured_books(system, &parameters, block, settings))
        .collect::<Result<Vec<Books>, SignalError>>()?;
    let residuals_of = |books: &Books| -> Vec<Vec<f64>> {
        windows(model, books, places, block.own, settings).into_iter().map(|window| window.residuals).collect()
    };
    let drawn: Vec<Vec<Vec<f64>>> = draws.par_iter().map(residuals_of).collect();
    let errors: Vec<(usize, f64)> = model
        .parameters()
        .enumerate()
        .filter_map(|(index, (_, parameter))| Some((index, parameter.standard_error?)))
        .filter(|(_, error)| error.is_finite() && *error > 0.0)
        .collect();
    let mut moved: Vec<Vec<Vec<f64>>> = errors
        .into_par_iter()
        .map(|(index, error)| {
            let mut values = parameters.clone();
            values[index] += error;
            residuals_of(&books_of(system, &values, entries))
        })
        .collect();
    // A valve step causes a kink in a pressure. What a parabola cuts off a kink is proportional to its width, so the total is the
    // change caused by wider parabolas, divided by the relative increase of the width.
    let wider = EnergySettings {
        half_width: WIDER * settings.half_width,
        motion_half_width: WIDER * settings.motion_half_width,
        ..*settings
    };
    let widened = |block: &Block| measured_books(system, &parameters, block, &wider).map(|books| residuals_of(&books));
    let wide = widened(block)?;
    let noisy_wide =
        noisy[..noisy.len().div_ceil(4)].par_iter().map(widened).collect::<Result<Vec<_>, SignalError>>()?;
    let shifted = Block { recording: with_shifted_openings(&block.recording), ..block.clone() };
    moved.push(residuals_of(&measured_books(system, &parameters, &shifted, settings)?));
    let difference = |draw: &[Vec<f64>], window: usize, place: usize| {
        Some(draw.get(window)?.get(place)? - base.get(window)?.residuals.get(place)?)
    };
    // Squared change by wider parabolas, less the part due to noise, which the repeats' scatter already includes.
    let rounded_off = |window: usize, place: usize| {
        let change = difference(&wide, window, place).unwrap_or(0.0);
        let of_noise = drawn
            .iter()
            .zip(&noisy_wide)
            .filter_map(|(draw, wide)| Some(wide.get(window)?.get(place)? - draw.get(window)?.get(place)? - change));
        change * change - of_noise.map(|change| change * change).sum::<f64>() / noisy_wide.len().max(1) as f64
    };
    let of_window = |window: usize| -> Vec<(f64, f64)> {
        (0..places.len())
            .map(|place| {
                let found: Vec<f64> = drawn.iter().filter_map(|draw| difference(draw, window, place)).collect();
                let count = found.len().max(1) as f64;
                (found.iter().sum::<f64>() / count, found.iter().map(|d| d * d).sum::<f64>() / count)
            })
            .collect()
    };
    let raw: Vec<Vec<(f64, f64)>> = (0..base.len()).map(of_window).collect();
    let pooled = (0..base.len()).map(|index| {
        let near = index.saturating_sub(POOLED)..(index + POOLED + 1).min(base.len());
        let mean = |place: usize, part: fn(&(f64, f64)) -> f64| {
            near.clone().map(|k| part(&raw[k][place])).sum::<f64>() / near.len() as f64
        };
        WindowNoise {
            bias: (0..places.len()).map(|place| mean(place, |both| both.0)).collect(),
            variance: (0..places.len()).map(|place| mean(place, |both| both.1)).collect(),
            parameters: (0..places.len())
                .map(|place| moved.iter().map(|draw| difference(draw, index, place).unwrap_or(0.0)).collect())
                .collect(),
            rounding: (0..places.len())
                .map(|place| near.clone().map(|k| rounded_off(k, place)).sum::<f64>() / near.len() as f64)
                .map(|squared| squared.max(0.0).sqrt() / (WIDER - 1.0))
                .collect(),
        }
    });
    Ok(NoiseStudy { windows: pooled.collect(), draws })
}

/// The recording with valve openings shifted by half a sample. A valve that is set in steps holds its opening from one sample on,
/// or up to it. The samples do not show which, and interpolation is half a sample off either way.
fn with_shifted_openings(recording: &Recording) -> Recording {
    let mut shifted = recording.clone();
    for cylinder in &mut shifted.cylinders {
        let before = cylinder.orifice_area.clone();
        for (opening, pair) in cylinder.orifice_area.iter_mut().zip(before.windows(2)) {
            *opening = 0.5 * (pair[0] + pair[1]);
        }
    }
    shifted
}

/// The recording with added white noise of each sensor's own level. Commands have no noise.
fn with_more_noise(recording: &Recording, random: &mut ChaCha8Rng) -> Recording {
    let mut noisy = recording.clone();
    let mut add = |signal: &mut Vec<f64>| {
        if !is_measured(signal) {
            return;
        }
        let level = noise_level(signal);
        for value in signal {
            let normal: f64 = StandardNormal.sample(random);
            *value += level * normal;
        }
    };
    for cylinder in &mut noisy.cylinders {
        add(&mut cylinder.joint_angle);
        add(&mut cylinder.displacement);
        add(&mut cylinder.velocity);
        add(&mut cylinder.cap_pressure);
        add(&mut cylinder.rod_pressure);
        add(&mut cylinder.orifice_area);
        add(&mut cylinder.rod_force);
    }
    add(&mut noisy.pump_pressure);
    add(&mut noisy.tank_pressure);
    add(&mut noisy.pump_flow);
    noisy
}
