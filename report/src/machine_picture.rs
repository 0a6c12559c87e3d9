//! Side view of the machine, moving along a recording as measured and as simulated.

use excavator_identification::validation::Comparison;
use excavator_model::machine::{Cylinder, Linkage, Mechanism};
use excavator_model::recording::{Recording, is_measured};
use excavator_model::urdf;
use maud::{Markup, PreEscaped, html};

use super::plot_json::{shortest, text};
use super::plot_line::Line;

/// Largest number of positions of one joint. A motion of a minute is smooth with ten per second.
const MOST_POSITIONS: usize = 600;

/// Decimals of a joint position in rad or m, so that a deviation of a micrometre can be drawn enlarged.
const DECIMALS: usize = 6;

/// The box in which the page's script draws the machine of `models` at the cursor of the plots of `group`. It is empty
/// if no joint moves in the drawing plane, or if its position is not a compared output: an imposed motion cannot
/// deviate.
pub(super) fn machine_picture(models: &[(Line, &Comparison)], group: &str) -> Markup {
    let Some((_, first)) = models.first() else { return html! {} };
    if !drawn(first).any(|cylinder| is_compared(first, cylinder)) {
        return html! {};
    }
    let time = &first.measured.time;
    let kept = evenly(time.len());
    let joints: Vec<String> = drawn(first).filter_map(|cylinder| joint_json(cylinder, models, &kept)).collect();
    if joints.is_empty() || kept.len() < 2 {
        return html! {};
    }
    let seconds: Vec<String> = kept.iter().map(|&index| shortest(&format!("{:.4}", time[index]))).collect();
    let lines: Vec<String> = models
        .iter()
        .map(|(line, _)| {
            format!(r#"{{"label":{},"colour":"{}","dashed":{}}}"#, text(line.label), line.colour, line.dashed)
        })
        .collect();
    let json = format!(
        r#"{{"group":{},"robot":{},"models":[{}],"time":[{}],"joints":[{}]}}"#,
        text(group),
        text(&urdf(&first.machine)),
        lines.join(","),
        seconds.join(","),
        joints.join(",")
    );
    html! { div.machine { script type="application/json" { (PreEscaped(json)) } } }
}

/// Cylinders whose joints move in the drawing plane.
fn drawn(comparison: &Comparison) -> impl Iterator<Item = &Cylinder> {
    let machine = &comparison.machine;
    let beside = matches!(machine.mechanism, Mechanism::LinearLoad | Mechanism::Rotor) && machine.cylinders.len() > 1;
    let cylinders = machine.cylinders.iter().enumerate().filter(move |_| !beside);
    cylinders.filter(|(number, _)| !machine.mechanism.is_upright(*number)).map(|(_, cylinder)| cylinder)
}

/// Whether the position of a cylinder was compared.
fn is_compared(comparison: &Comparison, cylinder: &Cylinder) -> bool {
    let names = ["joint_angle", "displacement"].map(|quantity| format!("{}.{quantity}", cylinder.name));
    comparison.signals.iter().any(|signal| names.contains(&signal.name))
}

/// Indices of at most [`MOST_POSITIONS`] samples, including the first and the last.
fn evenly(samples: usize) -> Vec<usize> {
    let count = samples.min(MOST_POSITIONS);
    (0..count).map(|k| k * (samples - 1) / (count - 1).max(1)).collect()
}

/// Positions of a cylinder's joint, measured and of each model. Returns `None` if a model has no positions of it. If it
/// is not measured, the first model is the reference.
fn joint_json(cylinder: &Cylinder, models: &[(Line, &Comparison)], kept: &[usize]) -> Option<String> {
    let simulated: Vec<Vec<f64>> =
        models.iter().map(|(_, comparison)| positions(&comparison.simulated, cylinder)).collect::<Option<_>>()?;
    let measured = positions(&models.first()?.1.measured, cylinder);
    let known = measured.is_some();
    let reference = measured.or_else(|| simulated.first().cloned())?;
    let list = |values: &[f64]| -> String {
        let kept = kept.iter().map(|&index| values.get(index).filter(|value| value.is_finite()));
        let entries =
            kept.map(|value| value.map_or("null".to_string(), |value| shortest(&format!("{value:.DECIMALS$}"))));
        entries.collect::<Vec<_>>().join(",")
    };
    Some(format!(
        r#"{{"name":{},"measured":{known},"reference":[{}],"models":[{}]}}"#,
        text(&format!("{}_joint", cylinder.name)),
        list(&reference),
        simulated.iter().map(|values| format!("[{}]", list(values))).collect::<Vec<_>>().join(",")
    ))
}

/// Joint positions of a cylinder in a recording, rad or m: as recorded, or computed from its displacement.
fn positions(recording: &Recording, cylinder: &Cylinder) -> Option<Vec<f64>> {
    let of = |quantity: &str| {
        recording.signal(&format!("{}.{quantity}", cylinder.name)).filter(|values| is_measured(values))
    };
    if let Some(angles) = of("joint_angle").filter(|_| !matches!(cylinder.linkage, Linkage::Direct)) {
        return Some(angles.to_vec());
    }
    of("displacement").map(|values| values.iter().map(|&value| cylinder.linkage.joint(value)).collect())
}
