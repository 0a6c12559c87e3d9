//! Computes the states of a law with memory along a recording.

use excavator_model::effects::{Physics, Site};
use excavator_model::equations::Situation;
use excavator_model::formula::Law;

/// States of a law with memory at each sample; empty for a law without memory. Each step is linearised and implicit
/// (Rosenbrock and Euler), so that a bristle that follows within a fraction of a sample does not oscillate.
pub(super) fn memory_along(
    law: &Law,
    site: Site,
    parameters: &[f64],
    situations: &[Situation<'_, f64>],
) -> Vec<Vec<f64>> {
    let count = law.states();
    let Some(first) = situations.first().filter(|_| count > 0) else { return Vec::new() };
    let mut states = vec![0.0; count];
    law.begin(site, parameters, first, &mut states);
    let mut all = vec![states.clone()];
    let (mut rates, mut moved) = (vec![0.0; count], vec![0.0; count]);
    for pair in situations.windows(2) {
        let [before, now] = pair else { continue };
        let step = now.time - before.time;
        law.remember(site, parameters, &states, now, &mut rates);
        for state in 0..count {
            let size = law.state_scale(state);
            let mut other = states.clone();
            other[state] += 1e-3 * size;
            law.remember(site, parameters, &other, now, &mut moved);
            let slope = (moved[state] - rates[state]) / (1e-3 * size);
            let damping = 1.0 - step * slope.min(0.0);
            states[state] += step * rates[state] / damping;
        }
        // The states are reset after a sample that was not measured.
        if states.iter().any(|state| !state.is_finite()) {
            law.begin(site, parameters, now, &mut states);
        }
        all.push(states.clone());
    }
    all
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::grammar::{REMEMBERING, Sized, Term, law_text};
    use super::*;
    use excavator_model::document::built_in;
    use excavator_model::formula::Row;

    #[test]
    fn a_lag_follows_as_it_should_however_short_it_is() {
        let term = Term::of(Row::PistonForce, &REMEMBERING[1]);
        let sized = Sized { term, shapes: vec![0.1], coefficient: 1.0, cylinder: "arm".into() };
        let law = Law::read(&law_text(&[sized], "").unwrap()).unwrap();
        let model = built_in("zx30u-arm").unwrap();
        let situations: Vec<Situation<'_, f64>> = (0..501)
            .map(|sample| {
                let mut now = Situation::empty(&model.machine);
                now.time = f64::from(sample) * 2e-3;
                now.pistons[0].velocity = if sample == 0 { 0.0 } else { 1.0 };
                now
            })
            .collect();
        for tau in [0.1, 1e-5] {
            let states = memory_along(&law, Site::Cylinder(0), &[1.0, tau], &situations);
            for (now, state) in situations.iter().zip(&states).skip(1) {
                assert!((state[0] - (1.0 - (-now.time / tau).exp())).abs() < 0.01, "{tau} {} {}", now.time, state[0]);
            }
        }
    }
}
