//! Assigns candidates to signals.

use std::collections::{BTreeSet, HashSet};
use std::f64::consts::{PI, TAU};

use excavator_model::display::pressure_text;
use excavator_model::recording::has_noise;

use super::super::quantity::Quantity;
use super::super::signal::{SignalKind, SignalName};
use super::super::unit::{Dimension, Unit};
use super::candidate::{Candidate, Origin};
use super::confidence::{alternatives, confidence};
use super::names;
use super::pair::Pair;
use super::shapes::{Shape, derivative, rest, short};
use super::{Confidence, GuessedSignal, Hints, Possibility, SheetColumn, ZeroAt};
use crate::table::heading_of;

/// A column with a smaller share of values is hardly measured.
const LEAST_FILLED: f64 = 0.05;

/// Below this score, a name alone is not sufficient.
const LEAST_SCORE: f64 = 0.5;
/// A velocity that correlates this strongly with the derivative of a position belongs to it.
const LEAST_CORRELATION: f64 = 0.8;

/// A column whose derivative correlates this strongly with the command is the position that the command moves. The
/// second value applies if its name marks it as measured.
const LEAST_FOLLOWING: [f64; 2] = [0.5, 0.3];

/// The signals, and the labels of unused candidates.
pub(super) fn choose(candidates: Vec<Candidate>, hints: Hints<'_>) -> (Vec<GuessedSignal>, Vec<String>) {
    let shapes: Vec<Option<Shape>> = candidates.iter().map(|candidate| Shape::of(&candidate.values)).collect();
    let mut pairs = pairs(&candidates, &shapes, hints);
    pairs.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.candidate.cmp(&b.candidate)));
    let (mut used, mut taken, mut signals) = (HashSet::new(), HashSet::new(), Vec::new());
    let cylinder_in = |words: &[String]| names::cylinder(words).filter(|name| hints.may_have_cylinder(name));
    let named: BTreeSet<&str> = candidates.iter().filter_map(|candidate| cylinder_in(&candidate.words)).collect();
    // If the names mention only one cylinder, all signals belong to it.
    let cylinder = if named.len() == 1 { named.first().copied().unwrap_or(hints.cylinder) } else { hints.cylinder };
    let own = |candidate: usize| cylinder_in(&candidates[candidate].words).unwrap_or(cylinder).to_string();
    let name_of = |pair: &Pair| {
        let cylinder = pair.kind.is_of_cylinder().then(|| own(pair.candidate));
        SignalName { cylinder, kind: pair.kind }
    };
    let mut by_sheet = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        let Some(column) = described(candidate, hints) else { continue };
        let kind = column.signal.0;
        let name = SignalName { cylinder: kind.is_of_cylinder().then(|| own(index)), kind };
        used.insert(index);
        taken.insert(name.clone());
        by_sheet.push(from_sheet(candidate, shapes[index], name, column, hints));
    }
    for (place, pair) in pairs.iter().enumerate() {
        let name = name_of(pair);
        if pair.score < LEAST_SCORE || used.contains(&pair.candidate) || taken.contains(&name) {
            continue;
        }
        let (confidence, remark) = confidence(&pairs, place, &used, &name_of);
        let confidence = match &candidates[pair.candidate].unit {
            Some((unit, _)) if pair.kind.takes(unit.dimension) => confidence,
            // The assignment may be certain, but the unit is not.
            _ => confidence.min(Confidence::Likely),
        };
        let candidate = &candidates[pair.candidate];
        let (confidence, remark) = if candidate.filled < LEAST_FILLED {
            (Confidence::Unsure, format!("{remark}; {:.1} % of its cells are empty", 100.0 * (1.0 - candidate.filled)))
        } else {
            (confidence, remark)
        };
        used.insert(pair.candidate);
        taken.insert(name.clone());
        let Possibility { source, label, reason, unit_reason, needs_scale } =
            possibility(candidate, shapes[pair.candidate], name, &pair.reason, hints);
        let reason = reason + &remark;
        let guessed =
            GuessedSignal { source, label, reason, unit_reason, needs_scale, confidence, alternatives: Vec::new() };
        signals.push((place, guessed));
    }
    let sure: HashSet<usize> = signals
        .iter()
        .filter(|(_, guessed)| guessed.confidence > Confidence::Unsure)
        .map(|(place, _)| pairs[*place].candidate)
        .collect();
    for (place, guessed) in &mut signals {
        if guessed.confidence == Confidence::Unsure {
            let others = alternatives(&pairs, *place, &sure, &name_of).into_iter();
            let possible = others.map(|pair| {
                possibility(&candidates[pair.candidate], shapes[pair.candidate], name_of(pair), &pair.reason, hints)
            });
            guessed.alternatives = possible.collect();
        }
    }
    let mut signals: Vec<GuessedSignal> =
        by_sheet.into_iter().chain(signals.into_iter().map(|(_, guessed)| guessed)).collect();
    signals.sort_by(|a, b| a.source.signal.cmp(&b.source.signal));
    let left = (0..candidates.len()).filter(|index| !used.contains(index)).map(|index| candidates[index].label());
    (signals, left.collect())
}

/// What the owner says of this column; its heading may be given with or without the unit.
fn described<'h>(candidate: &Candidate, hints: Hints<'h>) -> Option<&'h SheetColumn> {
    let Origin::Column { name, .. } = &candidate.origin else { return None };
    hints
        .columns
        .iter()
        .find(|(heading, _)| *heading == name || heading_of(heading).0 == *name)
        .map(|(_, column)| column)
}

/// A column as the signal that its owner says it is.
fn from_sheet(
    candidate: &Candidate,
    shape: Option<Shape>,
    name: SignalName,
    column: &SheetColumn,
    hints: Hints<'_>,
) -> GuessedSignal {
    let stroke = hints.stroke(name.cylinder.as_ref());
    let Possibility { mut source, label, reason, unit_reason, needs_scale } =
        possibility(candidate, shape, name, "the data sheet says so", hints);
    let needs_scale = needs_scale && column.scale.is_none();
    source.scale = column.scale.clone().or(source.scale);
    source.sign = column.sign;
    if let Some(zero) = column.zero {
        let from_middle = |sign: f64| stroke.map(|stroke| Quantity::Text(format!("{} mm", sign * 500.0 * stroke)));
        source.offset = match zero {
            ZeroAt::Retracted => from_middle(-1.0),
            ZeroAt::Extended => from_middle(1.0),
            ZeroAt::Middle => None,
        };
        if zero == ZeroAt::Extended && stroke.is_some() {
            source.sign = column.sign.or(Some(-1));
        }
    }
    let confidence = Confidence::Chosen;
    GuessedSignal { source, label, reason, unit_reason, needs_scale, confidence, alternatives: Vec::new() }
}

/// A candidate as a signal: its map entry, and the reasons.
fn possibility(
    candidate: &Candidate,
    shape: Option<Shape>,
    mut name: SignalName,
    reason: &str,
    hints: Hints<'_>,
) -> Possibility {
    let mut reason = reason.to_string();
    if name.kind == SignalKind::OrificeCommand && has_noise(&candidate.values) {
        name.kind = SignalKind::OrificeArea;
        reason += "; it has noise, so it was measured: it runs straight between samples, where a command is held";
    }
    let (kind, stroke) = (name.kind, hints.stroke(name.cylinder.as_ref()));
    // The input has the dimension that the model's drive takes; without a model, any that an input can have.
    let is_input = matches!(kind, SignalKind::OrificeArea | SignalKind::OrificeCommand);
    let of_drive = hints.input(name.cylinder.as_ref()).filter(|_| is_input);
    let takes = |found: Dimension| of_drive.map_or(kind.takes(found), |wanted| found == wanted);
    let wanted = of_drive.unwrap_or(kind.dimension());
    let (unit, mut unit_reason) = unit(candidate, shape, wanted, of_drive.is_some());
    if let Some((own, who)) = &candidate.unit
        && takes(own.dimension)
    {
        unit_reason.clone_from(who);
    }
    let mut source = candidate.source(name, unit.as_ref().map(|unit| unit.name));
    let needs_scale = unit.as_ref().is_some_and(|unit| !takes(unit.dimension));
    if let Some(unit) = unit.as_ref().filter(|_| needs_scale) {
        // The map needs a scale here, which only the sensor's data sheet provides.
        let text = format!("1 {}/{}", wanted.si_unit(), unit.name);
        source.scale = Some(Quantity::Text(text));
    }
    if kind == SignalKind::Displacement && shape.is_some_and(|shape| shape.least >= 0.0) {
        match stroke {
            Some(stroke) => {
                let half = 500.0 * stroke;
                source.offset = Some(Quantity::Text(format!("-{half} mm")));
                reason += "; never below 0, so it counts from one end: the offset is half the stroke of the model";
            }
            None => reason += "; never below 0: if it counts from one end, put mid-stroke as offset (\"-300 mm\")",
        }
    }
    if kind == SignalKind::OrificeCommand
        && let Some((value, share)) = rest(&candidate.values)
    {
        let unit = unit.filter(|unit| takes(unit.dimension)).unwrap_or(Unit::si(wanted));
        source.offset = Some(Quantity::Text(format!("{} {}", -value, unit.name)));
        reason += &format!(
            "; rests at {value} for {:.0} % of the time, which is taken for closed (the offset goes with the scale)",
            100.0 * share
        );
    }
    Possibility { source, label: candidate.label(), reason, unit_reason, needs_scale }
}

fn pairs(candidates: &[Candidate], shapes: &[Option<Shape>], hints: Hints<'_>) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        let Some(shape) = shapes[index] else { continue };
        for kind in SignalKind::ALL {
            if let Some((score, reason)) = by_name_and_unit(kind, candidate, hints) {
                // A signal that never changes is weak evidence, except for tank pressure, flow and oil temperature.
                let may_rest =
                    matches!(kind, SignalKind::TankPressure | SignalKind::PumpFlow | SignalKind::OilTemperature);
                let score = if shape.is_constant() && !may_rest { 0.7 * score } else { score };
                pairs.push(Pair { candidate: index, kind, score, reason, is_weak: false });
            }
        }
    }
    add_derivatives(candidates, &mut pairs, hints.has_motor());
    add_places_of_pressures(candidates, shapes, &mut pairs);
    add_only_input(candidates, shapes, &mut pairs, hints);
    add_followers(candidates, &mut pairs);
    pairs
}

/// The score from name, unit and type together.
fn by_name_and_unit(kind: SignalKind, candidate: &Candidate, hints: Hints<'_>) -> Option<(f64, String)> {
    let wanted = kind.dimension();
    let named = names::score(kind, &candidate.words);
    match candidate.dimension {
        // A pump of its own that drives a cylinder: its speed is the input, except for the displacement per revolution.
        Some(Dimension::RotationalSpeed) if hints.has_pump_drive() => (kind == SignalKind::OrificeCommand)
            .then(|| (0.9, "speed of the pump that drives the cylinder".to_string())),
        // The flow of the pump, except for the displacement per revolution.
        Some(Dimension::RotationalSpeed) if kind == SignalKind::PumpFlow && names::is_of_pump(&candidate.words) => {
            Some((LEAST_SCORE, "speed of the pump".to_string()))
        }
        Some(found) if found == wanted => {
            let what = candidate.unit.as_ref().map_or(wanted.to_string(), |(unit, _)| format!("unit {}", unit.name));
            // The type is sufficient evidence: a joint's speed in a JointState, a force in a Wrench.
            match named {
                // A pressure without a place may be any of them.
                Some((score, word)) if wanted == Dimension::Pressure && score < LEAST_SCORE => {
                    Some((0.3, format!("named \"{word}\", {what}")))
                }
                Some((score, word)) => Some((0.4 + 0.6 * score, format!("named \"{word}\", {what}"))),
                None if wanted == Dimension::Pressure || kind == SignalKind::OrificeArea => Some((0.3, what)),
                None if kind == SignalKind::OrificeCommand => None,
                None => Some((0.55, what)),
            }
        }
        // Raw volts and counts: the name is the only evidence.
        Some(Dimension::Voltage | Dimension::Current | Dimension::Number) | None => {
            named.map(|(score, word)| (0.9 * score, format!("named \"{word}\"")))
        }
        Some(_) => None,
    }
}

/// A position and the velocity that is its derivative confirm each other. A ratio that no units have is evidence against: the input of
/// a valve goes with the speed as well.
fn add_derivatives(candidates: &[Candidate], pairs: &mut [Pair], may_rotate: bool) {
    let of_kind =
        |pairs: &[Pair], kind| -> Vec<usize> { (0..pairs.len()).filter(|&index| pairs[index].kind == kind).collect() };
    for position in of_kind(pairs, SignalKind::Displacement) {
        for velocity in of_kind(pairs, SignalKind::Velocity) {
            let (x, v) = (&candidates[pairs[position].candidate], &candidates[pairs[velocity].candidate]);
            if pairs[position].candidate == pairs[velocity].candidate {
                continue;
            }
            let Some((correlation, ratio)) = derivative((&x.time, &x.values), (&v.time, &v.values)) else { continue };
            if correlation.abs() < LEAST_CORRELATION {
                continue;
            }
            let sign = if correlation < 0.0 { ", with the sign turned" } else { "" };
            let told = format!("correlation {correlation:.2}, {} per 1{sign}", short(ratio.abs()));
            if is_ratio_of_units([x, v], ratio.abs(), correlation.abs(), may_rotate) {
                pairs[position].score += 0.5;
                pairs[position].reason += &format!("; its derivative is {} ({told})", v.label());
                pairs[velocity].score += 0.5;
                pairs[velocity].reason += &format!("; derivative of {} ({told})", x.label());
            } else {
                pairs[velocity].score -= 0.5;
                pairs[velocity].reason +=
                    &format!("; goes with the derivative of {}, but no units have this ratio ({told})", x.label());
            }
        }
    }
}

/// Ratios of a position in one unit to a velocity in another: mm, cm, m, in; per s, per min. With angles also degrees, radians and
/// turns.
const LINEAR_RATIOS: [f64; 12] =
    [1.0, 10.0, 100.0, 1000.0, 0.1, 0.01, 1e-3, 25.4, 1.0 / 25.4, 1.0 / 60.0, 1000.0 / 60.0, 1.0 / 3.6];
const ANGULAR_RATIOS: [f64; 6] = [180.0 / PI, PI / 180.0, PI / 30.0, 6.0, TAU, 1.0 / TAU];
/// Relative difference within which a measured ratio is one of these: velocities are filtered and noisy.
const RATIO_TOLERANCE: f64 = 0.12;

/// Whether the derivative of a position is a velocity by its size.
fn is_ratio_of_units([x, v]: [&Candidate; 2], ratio: f64, correlation: f64, may_rotate: bool) -> bool {
    // The slope is between the ratio and this much larger one, for noise in the velocity.
    let is_near = |wanted: f64| {
        wanted * (1.0 - RATIO_TOLERANCE) <= ratio / correlation && ratio <= wanted * (1.0 + RATIO_TOLERANCE)
    };
    match (&x.unit, &v.unit) {
        (Some((x, _)), Some((v, _))) => match (x.dimension, v.dimension) {
            (Dimension::Length, Dimension::Velocity) | (Dimension::Angle, Dimension::RotationalSpeed) => {
                is_near(v.factor() / x.factor())
            }
            // A transducer in volts may have any scale.
            _ => true,
        },
        _ => {
            let is_raw = |candidate: &Candidate| {
                matches!(candidate.dimension, Some(Dimension::Voltage | Dimension::Current | Dimension::Number))
            };
            let angular = ANGULAR_RATIOS.into_iter().filter(|_| may_rotate);
            is_raw(x) || LINEAR_RATIOS.into_iter().chain(angular).any(is_near)
        }
    }
}

/// Score of the only column that can be the input: enough, and less than any name.
const ONLY_INPUT_SCORE: f64 = 0.6;

/// Where no name says which column is the input of the model, the only voltage (or current) is that, if the model takes one.
fn add_only_input(candidates: &[Candidate], shapes: &[Option<Shape>], pairs: &mut Vec<Pair>, hints: Hints<'_>) {
    let is_input = |kind| matches!(kind, SignalKind::OrificeCommand | SignalKind::OrificeArea);
    let wanted = hints.input(Some(&hints.cylinder.to_string()));
    let Some(wanted) = wanted.filter(|wanted| matches!(wanted, Dimension::Voltage | Dimension::Current)) else {
        return;
    };
    if pairs.iter().any(|pair| is_input(pair.kind) && pair.score >= LEAST_SCORE) {
        return;
    }
    let has_place = |index: usize| pairs.iter().any(|pair| pair.candidate == index && pair.score >= LEAST_SCORE);
    let of = |index: usize| {
        candidates[index].unit.as_ref().map(|(unit, _)| *unit).or(raw_unit(&candidates[index], shapes[index]))
    };
    let mut possible = (0..candidates.len())
        .filter(|&index| !has_place(index) && of(index).is_some_and(|unit| unit.dimension == wanted))
        .filter(|&index| shapes[index].is_some_and(|shape| !shape.is_constant()));
    if let (Some(candidate), None) = (possible.next(), possible.next()) {
        let reason = format!("the only {wanted}, and the model takes one as its input");
        let kind = SignalKind::OrificeCommand;
        pairs.push(Pair { candidate, kind, score: ONLY_INPUT_SCORE, reason, is_weak: false });
    }
}

/// Unidentified columns whose derivative follows the command of the same cylinder.
fn add_followers(candidates: &[Candidate], pairs: &mut Vec<Pair>) {
    let placed: HashSet<usize> =
        pairs.iter().filter(|pair| pair.score >= LEAST_SCORE).map(|pair| pair.candidate).collect();
    let is_command = |pair: &&Pair| pair.kind == SignalKind::OrificeCommand && pair.score >= LEAST_SCORE;
    let commands: Vec<&Candidate> = pairs.iter().filter(is_command).map(|pair| &candidates[pair.candidate]).collect();
    let mut found = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        if placed.contains(&index) || !matches!(candidate.dimension, None | Some(Dimension::Number)) {
            continue;
        }
        let own = names::cylinder(&candidate.words);
        let mine = |command: &&&Candidate| names::cylinder(&command.words) == own;
        let Some(command) = commands.iter().find(mine) else { continue };
        let closed = rest(&command.values).map_or(0.0, |(value, _)| value);
        let opening: Vec<f64> = command.values.iter().map(|value| value - closed).collect();
        let Some((correlation, _)) = derivative((&candidate.time, &candidate.values), (&command.time, &opening)) else {
            continue;
        };
        let measured = names::is_measured(&candidate.words);
        if correlation.abs() >= LEAST_FOLLOWING[usize::from(measured)] {
            let sign = if correlation < 0.0 { ", with the sign turned" } else { "" };
            let reason = format!(
                "its derivative follows {} (correlation {correlation:.2}{sign}); displacement, unless it is an angle",
                command.label()
            );
            let kind = SignalKind::Displacement;
            found.push(Pair { candidate: index, kind, score: LEAST_SCORE, reason, is_weak: true });
        }
    }
    pairs.extend(found);
}

/// Pressures whose names give no place: the highest mean is the supply, the lowest the tank, two between them the
/// chambers.
fn add_places_of_pressures(candidates: &[Candidate], shapes: &[Option<Shape>], pairs: &mut Vec<Pair>) {
    let placed: HashSet<usize> =
        pairs.iter().filter(|pair| pair.score >= LEAST_SCORE).map(|pair| pair.candidate).collect();
    let has = |kind: SignalKind| pairs.iter().any(|pair| pair.kind == kind && pair.score >= LEAST_SCORE);
    let mut loose: Vec<(usize, f64)> = pairs
        .iter()
        .filter(|pair| pair.kind == SignalKind::CapPressure && !placed.contains(&pair.candidate))
        .filter_map(|pair| Some((pair.candidate, si_mean(&candidates[pair.candidate], shapes[pair.candidate]?))))
        .collect();
    loose.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut found = Vec::new();
    let mut add = |candidate: usize, kind: SignalKind, why: String| {
        found.push(Pair { candidate, kind, score: LEAST_SCORE, reason: why, is_weak: true });
    };
    let mut open: Vec<SignalKind> =
        [SignalKind::CapPressure, SignalKind::RodPressure].into_iter().filter(|&kind| !has(kind)).collect();
    if loose.len() > open.len() && !has(SignalKind::PumpPressure) {
        let (candidate, mean) = loose.remove(0);
        add(
            candidate,
            SignalKind::PumpPressure,
            format!("highest of the pressures, {} on average", pressure_text(mean)),
        );
    }
    if loose.len() > open.len()
        && !has(SignalKind::TankPressure)
        && let Some((candidate, mean)) = loose.pop()
    {
        add(
            candidate,
            SignalKind::TankPressure,
            format!("lowest of the pressures, {} on average", pressure_text(mean)),
        );
    }
    // In the order of the data: the cap side usually comes first.
    loose.sort_by_key(|&(candidate, _)| candidate);
    for (candidate, mean) in loose {
        if open.is_empty() {
            break;
        }
        let kind = open.remove(0);
        let why = format!("a pressure of {} on average; which chamber is only the order: check", pressure_text(mean));
        add(candidate, kind, why);
    }
    pairs.extend(found);
}

fn si_mean(candidate: &Candidate, shape: Shape) -> f64 {
    let (unit, _) = unit(candidate, Some(shape), Dimension::Pressure, false);
    unit.unwrap_or(Unit::si(Dimension::Pressure)).to_si(shape.mean)
}

/// The unit of a candidate as a signal of this dimension, `None` for SI, and the reason. `is_of_model` says that the model states the
/// dimension.
fn unit(
    candidate: &Candidate,
    shape: Option<Shape>,
    dimension: Dimension,
    is_of_model: bool,
) -> (Option<Unit>, String) {
    if let Some((unit, who)) = &candidate.unit {
        let why = match unit.dimension == dimension {
            true => who.clone(),
            false if unit.dimension == Dimension::RotationalSpeed => {
                format!("{who}; the scale is a placeholder: put the pump's, like \"28 cm3/rev\"")
            }
            false if dimension == Dimension::Area => {
                format!("{who}; the scale is a placeholder: put the valve's opening per {}", unit.name)
            }
            false => format!("{who}; the scale is a placeholder: put the sensor's"),
        };
        return (Some(*unit), why);
    }
    if let Some(raw) = raw_unit(candidate, shape) {
        let why = format!(
            "named so; the scale is a placeholder: put the {}'s",
            if raw.dimension == Dimension::Current { "valve" } else { "sensor" }
        );
        return (Some(raw), why);
    }
    match shape.and_then(|shape| shape.unit(dimension)) {
        Some((name, why)) => (Unit::named(name), why),
        None if is_of_model => (Some(Unit::si(dimension)), "no unit given; the model takes this".to_string()),
        None => (Some(Unit::si(dimension)), "no unit given, and the numbers fit SI".to_string()),
    }
}

/// The electrical unit that a name refers to.
fn raw_unit(candidate: &Candidate, shape: Option<Shape>) -> Option<Unit> {
    let says = |wanted: &[&str]| candidate.words.iter().any(|word| wanted.contains(&word.as_str()));
    // No valve draws 30 A, and 30 mA moves none.
    let is_large = shape.is_some_and(|shape| shape.most.abs().max(shape.least.abs()) > 30.0);
    match () {
        () if says(&["current", "strom"]) => Unit::named(if is_large { "mA" } else { "A" }),
        () if says(&["voltage", "volt", "volts", "spannung"]) => Unit::named(if is_large { "mV" } else { "V" }),
        () => None,
    }
}
