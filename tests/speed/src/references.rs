//! Solutions of another solver that the tests of the model compare with: `model/tests/data/diffsol`.

use crate::common::references::{Motion, STATES, distance, motions, stored, text};
use crate::diffsol::{Method, solve};

/// Relative tolerance of the solutions: a thousand times what the tests ask for.
const TOLERANCE: f64 = 1e-11;
/// Relative tolerance of the second solver, of lower order, that must agree.
const SECOND_TOLERANCE: f64 = 1e-9;
/// How far two solutions may be from each other, in units of sensor noise.
const AGREEMENT: f64 = 1e-4;

/// Solves every motion by two methods, and writes the solutions or compares them with the stored ones.
///
/// # Errors
/// In words, where diffsol gives up, solutions differ or a file cannot be written.
pub fn references(check: bool) -> Result<(), String> {
    for motion in motions() {
        let states = solve(&motion.model, &motion.signals, &motion.start, Method::Bdf, TOLERANCE)?;
        let second = solve(&motion.model, &motion.signals, &motion.start, Method::Esdirk34, SECOND_TOLERANCE)?;
        agree(&motion, "two solvers of diffsol", &states, &second)?;
        if check {
            agree(&motion, "diffsol and the stored solution", &states, &stored(&motion))?;
        } else {
            let path = motion.path();
            std::fs::write(&path, text(&states)).map_err(|error| format!("{}: {error}", path.display()))?;
            eprintln!("{}: {} samples", path.display(), states.len());
        }
    }
    Ok(())
}

fn agree(motion: &Motion, what: &str, one: &[Vec<f64>], other: &[Vec<f64>]) -> Result<(), String> {
    for (state, kind) in motion.kinds().into_iter().enumerate() {
        let (unit, noise) = STATES[kind];
        let apart = distance(one, other, state);
        eprintln!("{}, state {state}: {what} are {apart:.1e} {unit} apart", motion.name);
        if apart.is_nan() || apart >= AGREEMENT * noise {
            return Err(format!("{}, state {state}: {what} are {apart:e} {unit} apart", motion.name));
        }
    }
    Ok(())
}
