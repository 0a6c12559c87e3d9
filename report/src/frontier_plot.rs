//! Plots error against complexity.

use excavator_identification::proposal::Proposals;
use maud::{Markup, html};

use super::svg::{Frame, picture, range_of};

const DOT: &str = "var(--purple)";
const LINE: &str = "var(--brown)";

/// Each proposal by its number of parameters and the logarithm of its error. The given model has zero parameters.
pub(super) fn frontier_plot(found: &Proposals) -> Markup {
    let point = |count: usize, error: f64| (count as f64, error.log10());
    let mut points = vec![point(0, found.error_before)];
    points.extend(found.proposals.iter().map(|proposal| {
        let trial = &found.diagnosis.trials[proposal.trial];
        point(trial.added_parameters(), proposal.validation_error)
    }));
    points.retain(|(_, error)| error.is_finite());
    let most = points.iter().map(|point| point.0).fold(0.0, f64::max);
    let mut best = f64::INFINITY;
    let frontier: Vec<(f64, f64)> = (0..=most as usize)
        .filter_map(|count| {
            let own = points.iter().filter(|point| point.0 == count as f64).map(|point| point.1);
            let least = own.fold(f64::INFINITY, f64::min);
            let falls = least < best;
            best = best.min(least);
            falls.then_some((count as f64, least))
        })
        .collect();
    let size = (760.0, 260.0);
    let frame = Frame {
        size,
        margins: (64.0, 12.0, 24.0, 40.0),
        // Wide enough for whole numbers at the ticks.
        x: (-0.3, most.max(2.0) + 0.3),
        y: range_of(points.iter().map(|point| point.1)),
    };
    let y_label = "logarithm (base 10) of the NMSE on validation";
    let content = html! {
        (frame.axes("parameters of the law", y_label))
        (frame.line(&frontier, LINE, false))
        @for (x, y) in &points { circle cx=(frame.at_x(*x)) cy=(frame.at_y(*y)) r="3.4" style={ "fill:" (DOT) } {} }
    };
    picture(size, "error against number of parameters", &content)
}
