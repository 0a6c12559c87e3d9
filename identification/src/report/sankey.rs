//! A picture of flows that part and join: nodes in columns, ribbons as wide as what flows.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::svg::{picture, short};

/// One node.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// What it is.
    pub label: String,
    /// How much, for people.
    pub amount: String,
    /// Column, from the left.
    pub column: usize,
    /// CSS colour.
    pub colour: &'static str,
}

/// One ribbon between nodes, by their index.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ribbon {
    /// Node on its left.
    pub from: usize,
    /// Node on its right.
    pub to: usize,
    /// How much flows; not negative.
    pub amount: f64,
}

const WIDTH: f64 = 1080.0;
const BAR: f64 = 13.0;
/// Space for labels right of a bar.
const LABEL: f64 = 235.0;
/// Distance between nodes of a column.
const GAP: f64 = 30.0;
/// Height of the largest column without its gaps.
const FLOW_HEIGHT: f64 = 250.0;
const TOP: f64 = 14.0;

/// The picture. Nodes stand in the order in which they are given; without any flow it is empty.
pub(super) fn sankey(nodes: &[Node], ribbons: &[Ribbon], description: &str) -> Markup {
    let ribbons: Vec<Ribbon> = ribbons.iter().copied().filter(|ribbon| ribbon.amount > 0.0).collect();
    let sum = |of: &dyn Fn(&Ribbon) -> bool| ribbons.iter().filter(|r| of(r)).map(|r| r.amount).sum::<f64>();
    let sizes: Vec<f64> = (0..nodes.len()).map(|node| sum(&|r| r.from == node).max(sum(&|r| r.to == node))).collect();
    let columns = nodes.iter().map(|node| node.column + 1).max().unwrap_or(0);
    let column_size = |column: usize| {
        nodes.iter().zip(&sizes).filter(|(node, _)| node.column == column).map(|(_, size)| size).sum::<f64>()
    };
    let largest = (0..columns).map(column_size).fold(0.0, f64::max);
    if !(largest > 0.0 && largest.is_finite()) {
        return html! { p.empty { "No energy flowed." } };
    }
    let scale = FLOW_HEIGHT / largest;
    let mut tops = vec![TOP; nodes.len()];
    let mut next = vec![TOP; columns];
    for (index, node) in nodes.iter().enumerate() {
        if sizes[index] > 0.0 {
            tops[index] = next[node.column];
            next[node.column] += sizes[index] * scale + GAP;
        }
    }
    let height = next.iter().copied().fold(0.0, f64::max);
    let spacing = if columns > 1 { (WIDTH - LABEL - BAR) / (columns - 1) as f64 } else { 0.0 };
    let left = |node: usize| nodes[node].column as f64 * spacing;
    let (mut leaving, mut arriving) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
    let mut drawing = String::new();
    for ribbon in &ribbons {
        let width = ribbon.amount * scale;
        let (x0, x1) = (left(ribbon.from) + BAR, left(ribbon.to));
        let y0 = tops[ribbon.from] + leaving[ribbon.from] + 0.5 * width;
        let y1 = tops[ribbon.to] + arriving[ribbon.to] + 0.5 * width;
        leaving[ribbon.from] += width;
        arriving[ribbon.to] += width;
        // What stands above another node of its column joins it by that alone.
        if nodes[ribbon.from].column == nodes[ribbon.to].column {
            continue;
        }
        let middle = 0.5 * (x0 + x1);
        let _ = write!(
            drawing,
            r#"<path d="M{} {} C{} {} {} {} {} {}" fill="none" stroke="{}" stroke-opacity="0.38" stroke-width="{}"></path>"#,
            short(x0),
            short(y0),
            short(middle),
            short(y0),
            short(middle),
            short(y1),
            short(x1),
            short(y1),
            nodes[ribbon.to].colour,
            short(width.max(0.6))
        );
    }
    let content = html! {
        (PreEscaped(drawing))
        @for (index, node) in nodes.iter().enumerate() {
            @if sizes[index] > 0.0 {
                @let (x, y, tall) = (left(index), tops[index], (sizes[index] * scale).max(1.0));
                rect x=(short(x)) y=(short(y)) width=(BAR) height=(short(tall)) fill=(node.colour) {}
                text.label.on-flow x=(short(x + BAR + 7.0)) y=(short(y + 0.5 * tall.max(8.0) - 1.0)) { (node.label) }
                text.on-flow x=(short(x + BAR + 7.0)) y=(short(y + 0.5 * tall.max(8.0) + 12.0)) { (node.amount) }
            }
        }
    };
    picture((WIDTH, height), description, &content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_tall_as_what_flows() {
        let node =
            |label: &str, column: usize| Node { label: label.into(), amount: String::new(), column, colour: "#123456" };
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
}
