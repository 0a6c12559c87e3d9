//! Flows through the four paths of a valve, and the openings of its edges.

use excavator_model::formula::Row;

use super::factor::{Factor, plain, shaped, whole};
use super::shapes::SMALL_OPENING;
use super::term::Term;
use super::unit::{AREA, AREA_2, AREA_3, LENGTH, PRESSURE, PURE, ROOT_OF_PRESSURE, SPEED, TIME};
use super::with_products;

/// How the flow through one path of the valve depends on the pressure drop.
static PUMP_TO_CAP: &[Factor] =
    &[plain("laminar", "(p_pump - p_cap)", PRESSURE), plain("turbulent", "root(p_pump - p_cap)", ROOT_OF_PRESSURE)];
static PUMP_TO_ROD: &[Factor] =
    &[plain("laminar", "(p_pump - p_rod)", PRESSURE), plain("turbulent", "root(p_pump - p_rod)", ROOT_OF_PRESSURE)];
static CAP_TO_TANK: &[Factor] =
    &[plain("laminar", "(p_cap - p_tank)", PRESSURE), plain("turbulent", "root(p_cap - p_tank)", ROOT_OF_PRESSURE)];
static ROD_TO_TANK: &[Factor] =
    &[plain("laminar", "(p_rod - p_tank)", PRESSURE), plain("turbulent", "root(p_rod - p_tank)", ROOT_OF_PRESSURE)];

/// How an edge of the valve may depend on the opening.
static EDGE: &[Factor] = &[
    plain("towards_cap", "max(u, 0)", AREA),
    plain("towards_rod", "max(-u, 0)", AREA),
    plain("square_opening", "u^2", AREA_2),
    plain("abs_opening", "abs(u)", AREA),
    // Effect of a resistance in series: the first term of a power series in it.
    plain("cube_towards_cap", "max(u, 0)^3", AREA_3),
    plain("cube_towards_rod", "max(-u, 0)^3", AREA_3),
];

/// How a change of the opening depends on the opening.
pub(in crate::proposal) static OPENING: &[Factor] = &[
    plain("gain", "u", AREA),
    plain("square_gain", "u*abs(u)", AREA_2),
    plain("cubic_gain", "u^3", AREA_3),
    plain("overlap", "sign(u)", PURE),
    shaped("small_openings", "clamp(u, -{w}, {w})", AREA, &[SMALL_OPENING]),
    shaped("fading_overlap", "sign(u)*exp(-abs(u)/{w})", PURE, &[SMALL_OPENING]),
    plain("abs_gain", "abs(u)", AREA),
];

/// The opening with a second orifice in series. The pressure drops add up, and k is one over the square of the second
/// opening.
static IN_SERIES: Factor = whole("in_series", "u/sqrt(1 + {k}*u^2)", AREA_3);

/// What else an opening may depend on.
pub(in crate::proposal) static SHIFTING: &[Factor] = &[
    plain("pump_pressure", "p_pump", PRESSURE),
    plain("cap_pressure", "p_cap", PRESSURE),
    plain("rod_pressure", "p_rod", PRESSURE),
    plain("load", "(p_cap - p_rod)", PRESSURE),
    plain("abs_load", "abs(p_cap - p_rod)", PRESSURE),
    plain("pressure_drop", "if(u > 0, p_pump - p_cap, p_pump - p_rod)", PRESSURE),
    plain("root_of_drop", "if(u > 0, root(p_pump - p_cap), root(p_pump - p_rod))", ROOT_OF_PRESSURE),
    plain("position", "s", LENGTH),
    plain("abs_position", "abs(s)", LENGTH),
    plain("abs_speed", "abs(v)", SPEED),
    plain("speed", "v", SPEED),
    plain("time", "t", TIME),
];

/// What else the edge to the tank may depend on, including its pressure drop.
static BACK: &[Factor] = &[
    plain("cap_pressure", "p_cap", PRESSURE),
    plain("rod_pressure", "p_rod", PRESSURE),
    plain("drop", "if(u > 0, p_rod - p_tank, p_cap - p_tank)", PRESSURE),
    plain("root_of_drop", "if(u > 0, root(p_rod - p_tank), root(p_cap - p_tank))", ROOT_OF_PRESSURE),
    plain("abs_speed", "abs(v)", SPEED),
];

/// Terms of the valve.
pub(super) fn valve(terms: &mut Vec<Term>) {
    let ways = [
        (Row::PumpToCap, PUMP_TO_CAP),
        (Row::PumpToRod, PUMP_TO_ROD),
        (Row::CapToTank, CAP_TO_TANK),
        (Row::RodToTank, ROD_TO_TANK),
    ];
    for (row, own) in ways {
        for one in own {
            terms.push(Term::of(row, one));
            terms.extend(EDGE.iter().map(|edge| Term::product(row, one, edge)));
        }
    }
    with_products(terms, Row::Opening, OPENING, SHIFTING);
    let drops = &SHIFTING[5..7];
    for (row, besides) in [(Row::SupplyOpening, drops), (Row::ReturnOpening, BACK)] {
        with_products(terms, row, &OPENING[..2], besides);
        terms.push(Term::of(row, &OPENING[2]));
    }
    terms.extend([Row::Opening, Row::SupplyOpening, Row::ReturnOpening].map(|row| Term::of(row, &IN_SERIES)));
}
