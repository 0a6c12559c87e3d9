//! A Sankey diagram: nodes in columns, and ribbons as wide as their flow.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::svg::{picture, short};

/// One node.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// What it is.
    pub label: String,
    /// Amount as text.
    pub amount: String,
    /// Column, from the left.
    pub column: usize,
    /// CSS colour.
    pub colour: &'static str,
}

/// One ribbon between nodes of neighbouring columns, by their index.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ribbon {
    /// Where it comes from.
    pub from: usize,
    /// Where it goes to.
    pub to: usize,
    /// How much flows; not negative.
    pub amount: f64,
}

/// Width of the picture, px, unless labels need more.
const WIDTH: f64 = 940.0;
const BAR: f64 = 13.0;
/// Distance between a bar and its label.
const SPACE: f64 = 7.0;
/// Width of a character of a label, rounded up for safety.
const CHARACTER: f64 = 6.6;
/// Height of a label of two lines.
const LABEL: f64 = 31.0;
/// Distance between nodes of a column.
const GAP: f64 = 10.0;
/// Smallest width in which ribbons bend from one column to the next.
const BEND: f64 = 60.0;
/// Height of the largest column without its labels and gaps.
const FLOW_HEIGHT: f64 = 250.0;
const TOP: f64 = 4.0;

/// Draws the diagram. Nodes keep the given order. It is empty without any flow.
pub(super) fn sankey(nodes: &[Node], ribbons: &[Ribbon], description: &str) -> Markup {
    let Some(layout) = Layout::of(nodes, ribbons) else { return html! { p.empty { "No energy flowed." } } };
    let content = html! {
        (PreEscaped(layout.paths()))
        @for (node, bar) in nodes.iter().zip(&layout.bars) {
            @if let Some(bar) = bar {
                rect x=(short(bar.x)) y=(short(bar.y)) width=(BAR) height=(short(bar.height)) style={ "fill:" (node.colour) } {}
                text.label x=(short(bar.label.0)) y=(short(bar.label.1 + 12.0)) { (node.label) }
                text x=(short(bar.label.0)) y=(short(bar.label.1 + 25.0)) { (node.amount) }
            }
        }
    };
    picture(layout.size, description, &content)
}

/// A node in the picture.
#[derive(Debug)]
struct Bar {
    x: f64,
    y: f64,
    height: f64,
    /// Upper left corner of its label.
    label: (f64, f64),
}

/// A ribbon in the picture: horizontal from `start` to `bend`, then curved to `end`. Heights are those of its middle.
#[derive(Debug)]
struct Path {
    start: (f64, f64),
    bend: f64,
    end: (f64, f64),
    width: f64,
    colour: &'static str,
}

/// Positions of all parts.
///
/// No label lies under a flow. A column has a bar, room for its labels, and room for the outgoing ribbons to bend.
/// Ribbons are horizontal in the room of the labels, so that they cover only the heights of their own bars. A bar with
/// outgoing ribbons has its label above it; all others have theirs beside it.
struct Layout {
    size: (f64, f64),
    /// `None` for a node without flow.
    bars: Vec<Option<Bar>>,
    paths: Vec<Path>,
}

impl Layout {
    fn of(nodes: &[Node], ribbons: &[Ribbon]) -> Option<Self> {
        let flows: Vec<Flow> =
            ribbons.iter().filter(|ribbon| ribbon.amount > 0.0).map(|r| Flow::of(r, nodes)).collect();
        let (mut leaving, mut arriving) = (vec![0.0_f64; nodes.len()], vec![0.0_f64; nodes.len()]);
        for flow in &flows {
            leaving[flow.left] += flow.amount;
            arriving[flow.right] += flow.amount;
        }
        let sizes: Vec<f64> = leaving.iter().zip(&arriving).map(|(out, into)| out.max(*into)).collect();
        let columns = nodes.iter().map(|node| node.column + 1).max().unwrap_or(0);
        let (mut totals, mut rooms) = (vec![0.0_f64; columns], vec![0.0_f64; columns]);
        for (node, size) in nodes.iter().zip(&sizes).filter(|(_, size)| **size > 0.0) {
            totals[node.column] += size;
            rooms[node.column] = rooms[node.column].max(BAR + SPACE + text_width(node));
        }
        let largest = totals.iter().copied().fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let scale = FLOW_HEIGHT / largest;
        let (lefts, width) = across(&rooms);
        let (bars, height) = bars(nodes, &sizes, &leaving, &lefts, scale);
        let paths = paths(&flows, nodes, &bars, &rooms, scale);
        Some(Layout { size: (width, height), bars, paths })
    }

    fn paths(&self) -> String {
        let mut drawing = String::new();
        for path in &self.paths {
            let half = 0.5 * path.width;
            let [x0, bend, x1] = [path.start.0, path.bend, path.end.0].map(short);
            let middle = short(0.5 * (path.bend + path.end.0));
            let [above0, below0] = [path.start.1 - half, path.start.1 + half].map(short);
            let [above1, below1] = [path.end.1 - half, path.end.1 + half].map(short);
            // Outlines instead of thick lines, which bulge where they are wide and bend sharply.
            let _ = write!(
                drawing,
                r#"<path d="M{x0} {above0}H{bend}C{middle} {above0} {middle} {above1} {x1} {above1}V{below1}C{middle} {below1} {middle} {below0} {bend} {below0}H{x0}Z" style="fill:{}" fill-opacity="0.38"></path>"#,
                path.colour
            );
        }
        drawing
    }
}

/// A ribbon from left to right. A backward flow is drawn between the same sides of its nodes.
struct Flow {
    left: usize,
    right: usize,
    amount: f64,
    colour: &'static str,
}

impl Flow {
    fn of(ribbon: &Ribbon, nodes: &[Node]) -> Self {
        let Ribbon { from, to, amount } = *ribbon;
        let (left, right) = if nodes[from].column <= nodes[to].column { (from, to) } else { (to, from) };
        Flow { left, right, amount, colour: nodes[to].colour }
    }
}

fn text_width(node: &Node) -> f64 {
    node.label.chars().count().max(node.amount.chars().count()) as f64 * CHARACTER
}

/// Left edges of columns with these widths, and the total width. A column without width is left out.
fn across(rooms: &[f64]) -> (Vec<f64>, f64) {
    let needed: f64 = rooms.iter().sum();
    let bends = rooms.iter().filter(|room| **room > 0.0).count().saturating_sub(1);
    let bend = if bends > 0 { ((WIDTH - needed) / bends as f64).max(BEND) } else { 0.0 };
    let mut next = 0.0;
    let lefts = rooms
        .iter()
        .map(|&room| {
            let left = next;
            next += if room > 0.0 { room + bend } else { 0.0 };
            left
        })
        .collect();
    (lefts, needed + bend * bends as f64)
}

/// Bars stacked in their columns, and the height of the highest column.
fn bars(nodes: &[Node], sizes: &[f64], leaving: &[f64], lefts: &[f64], scale: f64) -> (Vec<Option<Bar>>, f64) {
    let mut next = vec![TOP; lefts.len()];
    let mut bars = Vec::with_capacity(nodes.len());
    for (index, node) in nodes.iter().enumerate() {
        if sizes[index] <= 0.0 {
            bars.push(None);
            continue;
        }
        let (x, top) = (lefts[node.column], next[node.column]);
        let height = (sizes[index] * scale).max(1.0);
        let (slot, bar) = if leaving[index] > 0.0 {
            (LABEL + height, Bar { x, y: top + LABEL, height, label: (x, top) })
        } else {
            let slot = height.max(LABEL);
            let label = (x + BAR + SPACE, top + 0.5 * (slot - LABEL));
            (slot, Bar { x, y: top + 0.5 * (slot - height), height, label })
        };
        next[node.column] = top + slot + GAP;
        bars.push(Some(bar));
    }
    (bars, next.iter().copied().fold(0.0, f64::max))
}

/// Ribbons stacked at their bars, in their order.
fn paths(flows: &[Flow], nodes: &[Node], bars: &[Option<Bar>], rooms: &[f64], scale: f64) -> Vec<Path> {
    let (mut left, mut arrived) = (vec![0.0; bars.len()], vec![0.0; bars.len()]);
    let mut paths = Vec::with_capacity(flows.len());
    for flow in flows {
        let (Some(from), Some(to)) = (&bars[flow.left], &bars[flow.right]) else { continue };
        let width = flow.amount * scale;
        paths.push(Path {
            start: (from.x + BAR, from.y + left[flow.left] + 0.5 * width),
            bend: from.x + rooms[nodes[flow.left].column],
            end: (to.x, to.y + arrived[flow.right] + 0.5 * width),
            width: width.max(0.8),
            colour: flow.colour,
        });
        left[flow.left] += width;
        arrived[flow.right] += width;
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(label: &str, column: usize) -> Node {
        Node { label: label.into(), amount: "1 J · 1 %".into(), column, colour: "var(--blue)" }
    }

    #[test]
    fn bars_are_as_tall_as_what_flows() {
        let nodes = [node("in", 0), node("most", 1), node("little", 1), node("nothing", 1)];
        let ribbons = [
            Ribbon { from: 0, to: 1, amount: 75.0 },
            Ribbon { from: 0, to: 2, amount: 25.0 },
            Ribbon { from: 0, to: 3, amount: 0.0 },
        ];
        let drawn = sankey(&nodes, &ribbons, "test").into_string();
        for height in ["height=\"250\"", "height=\"187.5\"", "height=\"62.5\""] {
            assert!(drawn.contains(height), "{height} in {drawn}");
        }
        assert!(!drawn.contains("nothing"));
    }

    /// Height of the middle of a path at `x`: a cubic curve that is horizontal at both ends, with `x` and `y` as
    /// functions of one parameter.
    fn height_at(path: &Path, x: f64) -> Option<f64> {
        if x < path.start.0 || x > path.end.0 {
            return None;
        }
        let reached = |s: f64| {
            let middle = 0.5 * (path.bend + path.end.0);
            let (r, span) = (1.0 - s, 3.0 * s * (1.0 - s) * middle);
            r * r * r * path.bend + span + s * s * s * path.end.0
        };
        let s = (0..=1000).map(|k| f64::from(k) / 1000.0).find(|&s| reached(s) >= x).unwrap_or(1.0);
        let over = if x <= path.bend { 0.0 } else { s * s * (3.0 - 2.0 * s) };
        Some(path.start.1 + over * (path.end.1 - path.start.1))
    }

    #[test]
    fn no_label_lies_under_a_flow_or_on_another_label() {
        let nodes = [
            node("given back by a spring with a long name", 0),
            node("pump", 1),
            node("lost in a valve section", 2),
            node("into the first cylinder", 2),
            node("into the second cylinder", 2),
            node("tiny", 3),
            node("friction of the seals", 3),
            node("stored: motion and height", 3),
        ];
        let flow = |from, to, amount| Ribbon { from, to, amount };
        let ribbons = [
            flow(0, 1, 3.0),
            flow(1, 2, 60.0),
            flow(1, 3, 0.4),
            flow(1, 4, 30.0),
            flow(3, 5, 0.1),
            flow(4, 6, 29.0),
            // A backward flow.
            flow(7, 4, 2.0),
        ];
        let Some(layout) = Layout::of(&nodes, &ribbons) else { unreachable!("energy flows") };
        assert!(layout.size.0 >= WIDTH);
        let label = |node: &Node, bar: &Bar| {
            let (x, y) = bar.label;
            (x, y, x + text_width(node), y + LABEL)
        };
        let labels: Vec<_> =
            nodes.iter().zip(&layout.bars).filter_map(|(node, bar)| Some(label(node, bar.as_ref()?))).collect();
        assert_eq!(labels.len(), nodes.len());
        for (number, &(x0, y0, x1, y1)) in labels.iter().enumerate() {
            assert!(x0 >= 0.0 && y0 >= 0.0 && x1 <= layout.size.0 && y1 <= layout.size.1, "{number} is outside");
            for path in &layout.paths {
                for x in (0..=20).map(|k| x0 + (x1 - x0) * f64::from(k) / 20.0) {
                    let Some(middle) = height_at(path, x) else { continue };
                    let half = 0.5 * path.width;
                    assert!(middle + half <= y0 + 1.0 || middle - half >= y1 - 1.0, "{number} at {x} under {path:?}");
                }
            }
            for &(a0, b0, a1, b1) in &labels[number + 1..] {
                assert!(x1 <= a0 || a1 <= x0 || y1 <= b0 || b1 <= y0, "{number} touches another label");
            }
        }
    }
}
