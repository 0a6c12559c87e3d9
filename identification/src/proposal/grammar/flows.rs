//! Flows past the piston, out of the chambers and out of the pump line.

use excavator_model::formula::Row;

use super::factor::{Factor, Memory, memory, plain, remembering, shaped};
use super::forces::{GROWING, WAVE};
use super::quantity::Quantity;
use super::shapes::{HIGH, LAG, LOAD_THRESHOLD, LOW, threshold};
use super::term::Term;
use super::unit::{ACCELERATION, AREA, PRESSURE, PRESSURE_2, ROOT_OF_PRESSURE, SPEED, SPEED_TIMES_LENGTH};
use super::{one_shape_at_most, with_products};

/// How a flow past the piston depends on the pressure difference.
pub(in crate::proposal) static PAST_THE_PISTON: &[Factor] = &[
    plain("laminar", "(p_cap - p_rod)", PRESSURE),
    plain("turbulent", "root(p_cap - p_rod)", ROOT_OF_PRESSURE),
    plain("square", "(p_cap - p_rod)*abs(p_cap - p_rod)", PRESSURE_2),
    shaped("relief", "sign(p_cap - p_rod)*max(abs(p_cap - p_rod) - {p0}, 0)", PRESSURE, &[LOAD_THRESHOLD]),
    plain("dragged", "v", SPEED),
];

/// How a flow out of the cap side depends on its pressure.
static FROM_CAP: &[Factor] = &[
    plain("laminar", "(p_cap - p_tank)", PRESSURE),
    plain("turbulent", "root(p_cap - p_tank)", ROOT_OF_PRESSURE),
    plain("square", "(p_cap - p_tank)*abs(p_cap - p_tank)", PRESSURE_2),
    // To ambient air.
    plain("outwards", "p_cap", PRESSURE),
    plain("square_outwards", "p_cap*abs(p_cap)", PRESSURE_2),
    shaped("above", "max(p_cap - p_tank - {p0}, 0)", PRESSURE, &[threshold(Quantity::CapPressure, HIGH)]),
    shaped("square_above", "max(p_cap - p_tank - {p0}, 0)^2", PRESSURE_2, &[threshold(Quantity::CapPressure, HIGH)]),
    shaped("under", "max({p0} - (p_cap - p_tank), 0)", PRESSURE, &[threshold(Quantity::CapPressure, LOW)]),
    plain("area", "v", SPEED),
    plain("area_along_stroke", "v*s", SPEED_TIMES_LENGTH),
];

/// The same for the rod side.
static FROM_ROD: &[Factor] = &[
    plain("laminar", "(p_rod - p_tank)", PRESSURE),
    plain("turbulent", "root(p_rod - p_tank)", ROOT_OF_PRESSURE),
    plain("square", "(p_rod - p_tank)*abs(p_rod - p_tank)", PRESSURE_2),
    plain("outwards", "p_rod", PRESSURE),
    plain("square_outwards", "p_rod*abs(p_rod)", PRESSURE_2),
    shaped("above", "max(p_rod - p_tank - {p0}, 0)", PRESSURE, &[threshold(Quantity::RodPressure, HIGH)]),
    shaped("square_above", "max(p_rod - p_tank - {p0}, 0)^2", PRESSURE_2, &[threshold(Quantity::RodPressure, HIGH)]),
    shaped("under", "max({p0} - (p_rod - p_tank), 0)", PRESSURE, &[threshold(Quantity::RodPressure, LOW)]),
    plain("area", "v", SPEED),
    plain("area_along_stroke", "v*s", SPEED_TIMES_LENGTH),
];

/// Flow into the delayed elastic expansion of walls, which take up oil under pressure and give it back.
static CAP_WALL: Factor =
    remembering("lag", "(p_cap - {z})", PRESSURE, &[LAG], &[memory("p_cap", "(p_cap - {z})/{tau}", "Pa")]);
static ROD_WALL: Factor =
    remembering("lag", "(p_rod - {z})", PRESSURE, &[LAG], &[memory("p_rod", "(p_rod - {z})/{tau}", "Pa")]);

/// Flows of the pump line with a memory.
static PUMP_WALL: &[Factor] = &[
    remembering("lag", "(p_pump - {z})", PRESSURE, &[LAG], &[memory("p_pump", "(p_pump - {z})/{tau}", "Pa")]),
    remembering("lag_of_speed", "({c}.v - {z})", SPEED, &[LAG], &[memory("{c}.v", "({c}.v - {z})/{tau}", "m/s")]),
    remembering("lag_of_opening", "({c}.u - {z})", AREA, &[LAG], &[memory("{c}.u", "({c}.u - {z})/{tau}", "m2")]),
    // A drive that responds to acceleration in either direction.
    remembering(
        "lag_of_acceleration",
        "{z}",
        ACCELERATION,
        &[LAG],
        &[
            Memory { name: "y", start: "{c}.v", rate: "10*({c}.v - {y})/{tau}", unit: "m/s" },
            memory("0", "(10*abs({c}.v - {y})/{tau} - {z})/{tau}", "m/s2"),
        ],
    ),
];

/// What a flow out of the pump line may depend on at a cylinder.
static AT_CYLINDER: &[Factor] = &[
    plain("abs_speed", "abs({c}.v)", SPEED),
    plain("speed", "{c}.v", SPEED),
    plain("abs_opening", "abs({c}.u)", AREA),
    plain("load", "({c}.p_cap - {c}.p_rod)", PRESSURE),
];

/// Absolute speed, which drags oil along.
static ABS_SPEED: Factor = plain("abs_speed", "abs(v)", SPEED);

/// How a flow out of the pump line depends on its pressure.
static FROM_PUMP: &[Factor] = &[
    plain("laminar", "(p_pump - p_tank)", PRESSURE),
    plain("turbulent", "root(p_pump - p_tank)", ROOT_OF_PRESSURE),
    plain("square", "(p_pump - p_tank)*abs(p_pump - p_tank)", PRESSURE_2),
    plain("outwards", "p_pump", PRESSURE),
    plain("square_outwards", "p_pump*abs(p_pump)", PRESSURE_2),
    shaped("above", "max(p_pump - p_tank - {p0}, 0)", PRESSURE, &[threshold(Quantity::PumpPressure, HIGH)]),
    shaped("square_above", "max(p_pump - p_tank - {p0}, 0)^2", PRESSURE_2, &[threshold(Quantity::PumpPressure, HIGH)]),
];

/// Terms of flows that do not pass a valve edge.
pub(super) fn flows(terms: &mut Vec<Term>) {
    with_products(terms, Row::PistonLeak, PAST_THE_PISTON, GROWING);
    let chambers = [(Row::CapFlow, FROM_CAP, &CAP_WALL), (Row::RodFlow, FROM_ROD, &ROD_WALL)];
    let sides = chambers.iter().map(|(row, own, _)| (*row, *own)).chain([(Row::PistonLeak, PAST_THE_PISTON)]);
    for (row, own) in sides {
        let plain = own.iter().filter(|one| one.shapes.is_empty());
        terms.extend(plain.flat_map(|one| [Term::product(row, one, &WAVE), Term::product(row, one, &ABS_SPEED)]));
    }
    let along = |word: &str| {
        matches!(
            word,
            "position" | "abs_position" | "beyond" | "below" | "rising" | "falling" | "time" | "fading" | "abs_opening"
        )
    };
    for (row, own, wall) in chambers {
        for one in own {
            terms.push(Term::of(row, one));
            let others = GROWING.iter().filter(|other| along(other.word) && one_shape_at_most(one, other));
            terms.extend(others.map(|other| Term::product(row, one, other)));
        }
        terms.push(Term::of(row, wall));
    }
    terms.extend(PUMP_WALL.iter().chain(AT_CYLINDER).map(|one| Term::of(Row::PumpLeak, one)));
    for one in FROM_PUMP {
        terms.extend(AT_CYLINDER.iter().map(|other| Term::product(Row::PumpLeak, one, other)));
        terms.push(Term::of(Row::PumpLeak, one));
        let over_time = GROWING.iter().filter(|other| matches!(other.word, "time" | "fading"));
        let over_time = over_time.filter(|other| one_shape_at_most(one, other));
        terms.extend(over_time.map(|other| Term::product(Row::PumpLeak, one, other)));
    }
}
