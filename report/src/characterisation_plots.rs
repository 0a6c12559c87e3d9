//! Pictures of gains, edges, transients and friction.

use excavator_identification::characterisation::{
    ClosedValve, DeadZone, Direction, DirectionalGain, Edge, FrictionCurve, Polynomial,
};
use excavator_model::machine::CommandUnit;
use maud::{Markup, html};

use super::numbers::{SIDES_95, superscript};
use super::svg::{Frame, picture, range_of};
use super::units;

/// Pairs of colours that are distinguishable with any colour vision: from closed and from the edge, opening and
/// closing.
const FIRST: &str = "var(--blue)";
const SECOND: &str = "var(--orange)";
/// Number of points of a curve.
const POINTS: usize = 60;
const SIZE: (f64, f64) = (265.0, 205.0);
const MARGINS: (f64, f64, f64, f64) = (46.0, 8.0, 20.0, 36.0);

fn key(entries: [(&str, &str); 2]) -> Markup {
    html! { div.key { @for (colour, label) in entries { span style={ "--swatch:" (colour) } { (label) } } } }
}

fn dot(frame: &Frame, (x, y): (f64, f64), colour: &str) -> Markup {
    html! { circle cx=(frame.at_x(x)) cy=(frame.at_y(y)) r="2.2" style={ "fill:" (colour) } fill-opacity="0.8" {} }
}

fn along(range: (f64, f64)) -> impl Iterator<Item = f64> {
    (0..=POINTS).map(move |k| range.0 + (range.1 - range.0) * k as f64 / POINTS as f64)
}

/// A curve with its band, with heights times `scale`.
fn banded(frame: &Frame, curve: &Polynomial, range: (f64, f64), scale: f64, colour: &str) -> Markup {
    let band: Vec<(f64, f64, f64)> = along(range)
        .map(|x| (x, curve.at(x) - SIDES_95 * curve.error_at(x), curve.at(x) + SIDES_95 * curve.error_at(x)))
        .map(|(x, low, high)| (x, scale * low, scale * high))
        .collect();
    let line: Vec<(f64, f64)> = along(range).map(|x| (x, scale * curve.at(x))).collect();
    html! { (frame.band(&band, colour)) (frame.line(&line, colour, false)) }
}

/// Gain over opening, edge by edge: \[B\] Figure 4.
pub(super) fn gain_plots(found: &[(Edge, &DirectionalGain)], unit: CommandUnit) -> Markup {
    let largest = found.iter().flat_map(|(_, gain)| &gain.points).map(|point| point.gain.value).fold(0.0, f64::max);
    // A power of a thousand, as for units.
    let power = if largest > 0.0 { 3 * (largest.log10() / 3.0).floor() as i32 } else { 0 };
    let scale = 10_f64.powi(-power);
    let axis = format!("gain (10{} {})", superscript(power), unit.flow_gain());
    html! {
        (key([(FIRST, "counted from closed"), (SECOND, "counted from the edge of the dead zone")]))
        div.panels { @for (edge, gain) in found {
            @let from_closed = |k: usize| (gain.points[k].opening / gain.maximum, scale * gain.points[k].gain.value);
            @let from_edge = |k: usize| gain.points[k].gain_past_edge.map(|past| (gain.points[k].opening / gain.maximum, scale * past.value));
            @let count = gain.points.len();
            @let heights = (0..count).flat_map(|k| [Some(from_closed(k).1), from_edge(k).map(|point| point.1)]).flatten();
            @let frame = Frame { size: SIZE, margins: MARGINS, x: range_of((0..count).map(|k| from_closed(k).0)), y: range_of(heights) };
            @let range = (from_closed(0).0, from_closed(count - 1).0);
            (picture(SIZE, &format!("gain of the edge {} against opening", edge.name()), &html! {
                (frame.axes(&format!("opening over umax, {}", edge.name()), &axis))
                (banded(&frame, &gain.polynomial, range, scale, FIRST))
                @if let Some(curve) = &gain.past_edge { (banded(&frame, curve, range, scale, SECOND)) }
                @for k in 0..count { (dot(&frame, from_closed(k), FIRST)) @if let Some(point) = from_edge(k) { (dot(&frame, point, SECOND)) } }
            }))
        } }
    }
}

/// Flow over root of the pressure drop against opening: \[B\] Figure 5.
pub(super) fn edge_plots(found: &[(Edge, &DeadZone)], unit: CommandUnit) -> Markup {
    let (factor, symbol) = unit.for_people();
    html! {
        (key([(FIRST, "opening"), (SECOND, "closing")]))
        div.panels { @for (edge, zone) in found {
            // Most of a run is far from the edge, so the picture shows only three dead zones.
            @let shown = 3.0 * zone.opening.value.abs().max(5.0 * zone.hysteresis.value.abs()) * factor;
            @let points = |opens: bool| -> Vec<Vec<(f64, f64)>> {
                zone.curves.iter().filter(|curve| curve.opens == opens)
                    .map(|curve| curve.points.iter().map(|&(u, q)| (u.abs() * factor, q * 1e6)).filter(|(u, _)| *u <= shown).collect()).collect()
            };
            @let (opening, closing) = (points(true), points(false));
            @let all = || opening.iter().chain(&closing).flatten();
            @let edges = [zone.opening.value * factor, zone.closing.value * factor];
            @let frame = Frame { size: SIZE, margins: MARGINS, x: range_of(all().map(|point| point.0).chain(edges)), y: range_of(all().map(|point| point.1)) };
            (picture(SIZE, &format!("normalised flow through the edge {} against opening", edge.name()), &html! {
                (frame.axes(&format!("opening ({symbol}), {}", edge.name()), "flow / √drop (10⁻⁶ m³/(s √Pa))"))
                @for curve in &opening { (frame.dots(curve, FIRST)) }
                @for curve in &closing { (frame.dots(curve, SECOND)) }
                @for (begin, colour) in [(zone.opening, FIRST), (zone.closing, SECOND)] {
                    (frame.line(&[(begin.value * factor, frame.y.0), (begin.value * factor, frame.y.1)], colour, true))
                }
            }))
        } }
        p.note { (direction_note(found)) }
    }
}

fn direction_note(found: &[(Edge, &DeadZone)]) -> &'static str {
    let both = [Direction::Positive, Direction::Negative]
        .iter()
        .all(|direction| found.iter().any(|(edge, _)| edge.direction == *direction));
    if both { "Dashed: where flow begins and ends." } else { "Dashed: where flow begins and ends. One direction only." }
}

/// Chamber pressures while the valve is closed.
pub(super) fn transient_plots(found: &ClosedValve) -> Markup {
    let pump = found.holds.iter().map(|hold| hold.pump_pressure).sum::<f64>() / found.holds.len() as f64;
    let unit = units::pressure();
    let sides = [("cap pressure", true, &found.cap), ("rod pressure", false, &found.rod)];
    html! {
        (key([(FIRST, "pressures after the valve closes"), (SECOND, "static gain times pump pressure")]))
        div.panels { @for (name, cap, side) in sides {
            @let curves: Vec<Vec<(f64, f64)>> = found.holds.iter().map(|hold| {
                let pressure = if cap { &hold.cap_pressure } else { &hold.rod_pressure };
                hold.time.iter().zip(pressure).map(|(&t, &p)| (t, p * unit.factor)).collect()
            }).collect();
            @let level = side.as_ref().ok().map(|side| side.static_gain.value * pump * unit.factor);
            @let all = || curves.iter().flatten();
            @let frame = Frame { size: SIZE, margins: MARGINS, x: range_of(all().map(|p| p.0)), y: range_of(all().map(|p| p.1).chain(level)) };
            (picture(SIZE, &format!("{name} while the valve is closed"), &html! {
                (frame.axes("time since closed and settled (s)", &format!("{name} ({})", unit.symbol)))
                @for curve in &curves { (frame.line(curve, FIRST, false)) }
                @if let Some(level) = level { (frame.line(&[(frame.x.0, level), (frame.x.1, level)], SECOND, true)) }
            }))
        } }
    }
}

/// Friction over speed: \[B\] Figure 6.
pub(super) fn friction_plot(curve: &FrictionCurve) -> Markup {
    let size = (760.0, 340.0);
    let points: Vec<(f64, f64)> = curve.points.iter().map(|point| (1e3 * point.speed, 1e-3 * point.force)).collect();
    let frame = Frame {
        size,
        margins: (64.0, 12.0, 24.0, 40.0),
        x: range_of(points.iter().map(|point| point.0).chain([0.0])),
        y: range_of(points.iter().map(|point| point.1).chain([0.0])),
    };
    // Friction jumps at zero: one branch for each direction.
    let branch = |from: f64, to: f64| -> Vec<(f64, f64, f64)> {
        along((from, to))
            .filter(|speed| speed.abs() > 1e-6)
            .map(|speed| (speed, curve.at(speed)))
            .map(|(speed, force)| {
                (
                    1e3 * speed,
                    1e-3 * (force.value - SIDES_95 * force.error),
                    1e-3 * (force.value + SIDES_95 * force.error),
                )
            })
            .collect()
    };
    let (low, high) = (1e-3 * frame.x.0, 1e-3 * frame.x.1);
    let branches = [branch(low, 0.0), branch(0.0, high)];
    let content = html! {
        (frame.axes("speed (mm/s)", "friction (kN)"))
        @for branch in branches.iter().filter(|branch| branch.len() > 1) {
            (frame.band(branch, SECOND))
            (frame.line(&branch.iter().map(|&(x, low, high)| (x, 0.5 * (low + high))).collect::<Vec<_>>(), SECOND, false))
        }
        @for &point in &points { (dot(&frame, point, FIRST)) }
    };
    picture(size, "friction against speed", &content)
}
