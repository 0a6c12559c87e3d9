//! Why a procedure has no result: which signal or which manoeuvre is missing, with numbers.

use excavator_model::display::pressure_text;

/// "1 hold", "2 holds".
fn counted(number: usize, one: &str, more: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { more })
}

/// Why a recording does not suit a procedure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The cylinder has no oil, or no valve between its oil and the pump.
    #[error("{cylinder} has no valve section in this model, so there is nothing of it to measure")]
    NoValve {
        /// The cylinder.
        cylinder: String,
    },
    /// A signal is missing.
    #[error("{source_name} does not measure {signal}, which {needed_for}")]
    MissingSignal {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// What it is needed for.
        needed_for: &'static str,
    },
    /// The recording's clock or cylinders are invalid.
    #[error(transparent)]
    Recording(#[from] excavator_model::recording::RecordingError),
    /// The model has no bulk modulus.
    #[error(
        "the model gives {cylinder} no bulk modulus; pressure transients have no scale without (add oil_compressibility)"
    )]
    NoBulkModulus {
        /// The cylinder.
        cylinder: String,
    },
    /// The input has too few levels at which the piston moves steadily.
    #[error(
        "{found} steady stretches at {levels} different inputs; {needed} at {needed_levels} are needed. Hold several inputs of both signs until the piston has moved evenly"
    )]
    TooFewLevels {
        /// Steady stretches.
        found: usize,
        /// Different inputs among them.
        levels: usize,
        /// Steady stretches that are needed.
        needed: usize,
        /// Different inputs that are needed.
        needed_levels: usize,
    },
    /// Flow and input have no straight line.
    #[error("{0}")]
    Curve(String),
    /// The valve is hardly ever closed for long enough.
    #[error(
        "{} with closed valve (input within {:.0} % of the full one) of at least {least:.2} s, the longest {longest:.2} s; {needed} are needed. Close the valve for {suggested:.0} s and longer, after moves in both directions",
        counted(*found, "hold", "holds"),
        100.0 * limit
    )]
    TooFewHolds {
        /// Holds that are long enough.
        found: usize,
        /// Holds that are needed.
        needed: usize,
        /// Longest time with closed valve, s.
        longest: f64,
        /// Least time, s.
        least: f64,
        /// Input that counts as closed, as a share of the full one.
        limit: f64,
        /// Recommended time, s.
        suggested: f64,
    },
    /// The pressures of the closed valve do not determine the coefficients.
    #[error(
        "in {holds} holds with closed valve (the longest {longest:.2} s) the {side} pressure changes by {} at most: coefficients come out no better than {relative_error:.0} % of their value. Hold longer, and begin with the chamber near pump pressure and near tank pressure", pressure_text(*change)
    )]
    TransientsTooSmall {
        /// Which chamber.
        side: &'static str,
        /// Number of holds.
        holds: usize,
        /// The longest, s.
        longest: f64,
        /// Largest change within a hold, Pa.
        change: f64,
        /// Standard error over value of the better coefficient, %.
        relative_error: f64,
    },
    /// Oil would flow from the lower pressure to the higher one.
    #[error(
        "leakage {path} the {side} side comes out negative, {value:.1e} ± {:.1e} m3/(s Pa): something else moves oil while the valve is closed. Check the signs and the order of the pressures, and whether a load-holding valve or another consumer acts", 1.96 * error
    )]
    OpposedLeakage {
        /// Which chamber.
        side: &'static str,
        /// Leakage path.
        path: &'static str,
        /// Coefficient, m³/(s Pa).
        value: f64,
        /// Its standard error, m³/(s Pa).
        error: f64,
    },
    /// Flow through an edge begins at a smaller opening than the one at which it ends.
    #[error(
        "flow begins at {:.2} % of the full input while the valve opens and ends at {:.2} % while it closes: flow leads the opening. Check that pressures and openings share one clock", 100.0 * begins, 100.0 * ends
    )]
    FlowLeads {
        /// Input at which flow begins, as a share of the full one.
        begins: f64,
        /// Input at which it ends, as a share of the full one.
        ends: f64,
    },
    /// The opening does not pass the edge slowly enough.
    #[error(
        "{found_opening} opening and {found_closing} closing runs of the valve from below {low:.0} % to above {high:.0} % of its largest opening, within {slowest:.0} s and not faster than in {fastest:.2} s; {needed} of each are needed. Run sines of 0.3 Hz or slow trapezoids to this side"
    )]
    TooFewSweeps {
        /// Runs in which the valve opened.
        found_opening: usize,
        /// Runs in which the valve closed.
        found_closing: usize,
        /// Runs of each kind that are needed.
        needed: usize,
        /// Where a run must begin, % of the largest opening.
        low: f64,
        /// Where it must end, %.
        high: f64,
        /// Longest time of a run, s.
        slowest: f64,
        /// Shortest time of a run, s.
        fastest: f64,
    },
    /// Not enough steady stretches at this edge.
    #[error(
        "{} at {}; {needed} at {needed_openings} are needed, each {least:.2} s at constant opening and speed after {settling:.2} s of settling ({longest:.2} s is the longest time at constant opening to this side). Run trapezoids of many amplitudes to this side",
        counted(*found, "steady stretch", "steady stretches"), counted(*openings, "opening", "different openings")
    )]
    TooFewSteadyStretches {
        /// Stretches found.
        found: usize,
        /// Different openings among them.
        openings: usize,
        /// Stretches needed.
        needed: usize,
        /// Different openings needed.
        needed_openings: usize,
        /// Longest time at constant opening, s.
        longest: f64,
        /// Least length of a stretch, s.
        least: f64,
        /// Settling time, s.
        settling: f64,
    },
    /// Not enough speeds.
    #[error(
        "{}, {extending} extending and {retracting} retracting, at most {} in one direction, the fastest {ratio:.1} times the slowest; {needed} stretches, {needed_speeds} speeds and {needed_ratio:.0} times are needed{both}. Each takes {least:.2} s at constant speed after {settling:.2} s of settling",
        counted(*found, "steady stretch", "steady stretches"), counted(*speeds, "speed", "different speeds")
    )]
    TooFewSpeeds {
        /// Stretches found.
        found: usize,
        /// How many extend.
        extending: usize,
        /// How many retract.
        retracting: usize,
        /// Different speeds in the direction that has more of them.
        speeds: usize,
        /// Fastest over slowest in the direction where it is larger.
        ratio: f64,
        /// Stretches needed.
        needed: usize,
        /// Different speeds needed.
        needed_speeds: usize,
        /// Fastest over slowest needed.
        needed_ratio: f64,
        /// Text that asks for both directions, if they are needed.
        both: &'static str,
        /// Least length of a stretch, s.
        least: f64,
        /// Settling time, s.
        settling: f64,
    },
    /// Columns of the friction fit are collinear at these speeds.
    #[error("{found} steady stretches do not tell friction's terms apart; run more speeds in both directions")]
    SpeedsTooAlike {
        /// Stretches found.
        found: usize,
    },
}
