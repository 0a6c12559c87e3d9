//! Whether effects that are named with a probability are there as often as it says.

use std::fmt::Write as _;

use excavator_identification::decision::{Kind, Policy, decide, presence};

use crate::replay::Stored;

/// Bounds of the bins of the stated probability.
const BOUNDS: [f64; 6] = [0.0, 0.1, 0.5, 0.85, 0.98, 1.0];

/// Effects that were named with a similar probability.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bin {
    /// Sum of the stated probabilities.
    pub stated: f64,
    /// Number of effects.
    pub names: usize,
    /// How many of them were there.
    pub there: usize,
}

/// Effects named on machines with a known answer, by their stated probability. Machines that a verdict calls adequate have none.
pub fn reliability(stored: &[Stored], policy: &Policy) -> Vec<Bin> {
    let mut bins = vec![Bin::default(); BOUNDS.len() - 1];
    for one in stored {
        let verdict = decide(&one.scores, policy);
        if verdict.kind == Kind::Adequate {
            continue;
        }
        for effect in &one.scores.hypotheses[verdict.best].effects {
            let stated = presence(&one.scores, &verdict, effect, policy);
            let number = BOUNDS[1..].iter().position(|bound| stated < *bound).unwrap_or(bins.len() - 1);
            bins[number].stated += stated;
            bins[number].names += 1;
            bins[number].there += usize::from(one.secret.effects.contains(&effect.effect));
        }
    }
    bins
}

impl Bin {
    /// Mean stated probability.
    pub fn mean(&self) -> f64 {
        self.stated / self.names.max(1) as f64
    }

    /// Share that was there.
    pub fn share(&self) -> f64 {
        self.there as f64 / self.names.max(1) as f64
    }

    /// 95 % interval of that share (Wilson 1927).
    pub fn interval(&self) -> [f64; 2] {
        let (z, count) = (1.96_f64, self.names.max(1) as f64);
        let (share, scale) = (self.share(), 1.0 + z * z / count);
        let middle = (share + z * z / (2.0 * count)) / scale;
        let half = z / scale * (share * (1.0 - share) / count + z * z / (4.0 * count * count)).sqrt();
        [middle - half, middle + half].map(|bound| bound.clamp(0.0, 1.0))
    }
}

/// One line for each bin that has names.
pub fn table(bins: &[Bin]) -> String {
    let mut text = String::from("stated  names  there  share (95 % interval)");
    for bin in bins.iter().filter(|bin| bin.names > 0) {
        let [low, high] = bin.interval();
        let (mean, share) = (bin.mean(), bin.share());
        let _ = write!(text, "\n{mean:6.2} {:6} {:6}  {share:.2} ({low:.2} to {high:.2})", bin.names, bin.there);
    }
    text
}

/// Side of the diagram's square, and its distance from the edges, in pixels.
const SIDE: f64 = 280.0;
const EDGE: f64 = 56.0;

/// The bins as a diagram in SVG: stated probability to the right, share that was there upwards.
pub fn diagram(bins: &[Bin]) -> String {
    let right = |share: f64| EDGE + share * SIDE;
    let up = |share: f64| EDGE / 2.0 + (1.0 - share) * SIDE;
    let (width, height) = (SIDE + 1.5 * EDGE, SIDE + 1.5 * EDGE);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         font-family=\"sans-serif\" font-size=\"12\" fill=\"#444\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let (x, y) = (right(share), up(share));
        let _ = writeln!(
            svg,
            "<path d=\"M{x} {}V{}M{} {y}H{}\" stroke=\"#ddd\"/>",
            up(0.0),
            up(1.0),
            right(0.0),
            right(1.0)
        );
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{share}</text>", up(0.0) + 16.0);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{share}</text>", right(0.0) - 6.0, y + 4.0);
    }
    let _ = writeln!(
        svg,
        "<path d=\"M{} {}L{} {}\" stroke=\"#999\" stroke-dasharray=\"4 4\"/>",
        right(0.0),
        up(0.0),
        right(1.0),
        up(1.0)
    );
    for bin in bins.iter().filter(|bin| bin.names > 0) {
        let ([low, high], x) = (bin.interval(), right(bin.mean()));
        let _ = writeln!(svg, "<path d=\"M{x} {}V{}\" stroke=\"#1763a6\" stroke-width=\"2\"/>", up(low), up(high));
        let _ = writeln!(svg, "<circle cx=\"{x}\" cy=\"{}\" r=\"5\" fill=\"#1763a6\"/>", up(bin.share()));
        let (at, anchor) = if bin.mean() > 0.9 { (x - 9.0, "end") } else { (x + 9.0, "start") };
        let _ = writeln!(
            svg,
            "<text x=\"{at}\" y=\"{}\" text-anchor=\"{anchor}\">{}</text>",
            up(bin.share()) + 16.0,
            bin.names
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">stated probability</text>",
        right(0.5),
        up(0.0) + 36.0
    );
    let middle = format!("{} {}", 14.0, up(0.5));
    let _ = writeln!(
        svg,
        "<text transform=\"translate({middle}) rotate(-90)\" text-anchor=\"middle\">share that was there</text>"
    );
    svg + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_wilsons() {
        // Newcombe 1998, table I, method 3.
        let [low, high] = Bin { stated: 0.0, names: 263, there: 81 }.interval();
        assert!((low - 0.2553).abs() < 1e-4 && (high - 0.3662).abs() < 1e-4, "{low} {high}");
    }
}
