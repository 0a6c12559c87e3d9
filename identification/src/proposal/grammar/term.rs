//! Terms: products of factors that enter one row of the equations.

use std::collections::BTreeMap;

use excavator_model::formula::{FormulaText, ParameterText, Row, StateText};

use super::factor::{Factor, ONE};
use super::unit;

/// Source text of a proposed law.
pub(in crate::proposal) const PROPOSED: &str = "proposed from recordings";

/// A product of two factors in a row, times a coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::proposal) struct Term {
    /// The row that it enters.
    pub row: Row,
    /// Its factors; the second may be one.
    pub factors: [&'static Factor; 2],
}

/// A term with numbers.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::proposal) struct Sized {
    /// The term.
    pub term: Term,
    /// Values of the shape parameters of its factors, in their order.
    pub shapes: Vec<f64>,
    /// The coefficient, SI.
    pub coefficient: f64,
    /// Name of the cylinder in its formula, if its row does not belong to a cylinder.
    pub cylinder: String,
}

impl Sized {
    /// Whether both are the same term with the same sign, apart from their numbers.
    pub fn is_same_kind(&self, other: &Sized) -> bool {
        self.term == other.term
            && self.cylinder == other.cylinder
            && self.coefficient.is_sign_negative() == other.coefficient.is_sign_negative()
    }
}

impl Term {
    /// A term of one factor.
    pub fn of(row: Row, factor: &'static Factor) -> Term {
        Term { row, factors: [factor, &ONE] }
    }

    /// A term of two factors.
    pub fn product(row: Row, one: &'static Factor, other: &'static Factor) -> Term {
        Term { row, factors: [one, other] }
    }

    /// Number of parameters, the coefficient among them.
    pub fn parameters(&self) -> usize {
        1 + self.factors.iter().map(|factor| factor.shapes.len()).sum::<usize>()
    }

    /// Whether a variable is in its formula; `z` is its memory. The coordinate and rate of the joint count as position
    /// and speed of the piston.
    pub fn uses(&self, variable: &str) -> bool {
        let is_word = |part: &str| part == variable || matches!((variable, part), ("v", "qd") | ("s", "q"));
        self.factors.iter().any(|factor| {
            let words = factor.text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
            !factor.memory.is_empty() && variable == "z" || words.into_iter().any(is_word)
        })
    }

    /// Whether its formula names a cylinder.
    pub fn names_a_cylinder(&self) -> bool {
        self.factors.iter().any(|factor| factor.text.contains("{c}"))
    }

    /// Whether neither of its factors is one.
    pub fn is_product(&self) -> bool {
        self.factors.iter().all(|factor| !factor.text.is_empty())
    }

    /// Whether it is a whole law, not a product.
    pub fn is_whole(&self) -> bool {
        self.factors[0].is_whole
    }

    /// Length of its formula, for choosing the simpler one of two.
    pub fn length(&self) -> usize {
        self.factors.iter().map(|factor| factor.text.len()).sum()
    }

    /// Whether it is a force that depends on a pressure. Together with others it can compensate for the known areas, so
    /// that the equation of motion determines nothing.
    pub fn is_a_force_of_pressure(&self) -> bool {
        self.row == Row::PistonForce && self.factors[0].text.contains("p_")
    }

    fn words(&self) -> String {
        let words = self.factors.iter().map(|factor| factor.word).filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join("_by_")
    }
}

/// The text of a law of these terms, which enter one row. Returns `None` if a whole law is combined with others or has
/// a negative coefficient.
pub(in crate::proposal) fn law_text(terms: &[Sized], summary: &str) -> Option<FormulaText> {
    let row = terms.first()?.term.row;
    let is_whole = |sized: &&Sized| sized.term.is_whole();
    if terms.iter().find(is_whole).is_some_and(|whole| terms.len() > 1 || whole.coefficient < 0.0) {
        return None;
    }
    let (mut parameters, mut states) = (BTreeMap::new(), BTreeMap::new());
    let mut formula = if row.is_an_opening() { "u".to_string() } else { String::new() };
    let mut words = vec![row.card().name.to_string()];
    for (number, sized) in terms.iter().enumerate() {
        let suffix = if number == 0 { String::new() } else { format!("_{}", number + 1) };
        let mut factors = vec![format!("k{suffix}")];
        let mut shapes = sized.shapes.iter();
        for factor in sized.term.factors.iter().filter(|factor| !factor.text.is_empty()) {
            let mut names = vec![("c", sized.cylinder.clone()), ("k", format!("k{suffix}"))];
            names.extend(factor.memory.iter().map(|state| (state.name, format!("{}{suffix}", state.name))));
            for shape in factor.shapes {
                let name = format!("{}{suffix}", shape.name);
                parameters.insert(name.clone(), shape_text(shape, *shapes.next()?));
                names.push((shape.name, name));
            }
            let filled = |text: &str| {
                names.iter().fold(text.to_string(), |text, (place, name)| text.replace(&format!("{{{place}}}"), name))
            };
            factors.push(filled(factor.text));
            for state in factor.memory {
                let (start, rate) = (filled(state.start), filled(state.rate));
                let text = StateText { start, rate, unit: state.unit.to_string(), typical: None };
                states.insert(format!("{}{suffix}", state.name), text);
            }
        }
        let units: Vec<unit::Unit> = sized.term.factors.iter().map(|factor| factor.unit).collect();
        let coefficient = ParameterText {
            unit: unit::of_coefficient(row, &units),
            minimum: Some(0.0),
            start: starts(row, sized.coefficient.abs()),
            meaning: COEFFICIENT.to_string(),
            ..blank()
        };
        parameters.insert(format!("k{suffix}"), coefficient);
        if sized.term.is_whole() {
            formula = factors.pop()?;
        } else {
            formula += match (formula.is_empty(), sized.coefficient < 0.0) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            formula += &factors.join("*");
        }
        words.push(sized.term.words());
    }
    let name: String = words.join("_").chars().take(LONGEST_NAME).collect();
    Some(FormulaText {
        name,
        acts_on: row.card().name.to_string(),
        formula,
        summary: summary.to_string(),
        source: PROPOSED.to_string(),
        shows: String::new(),
        experiment: String::new(),
        parameters,
        states,
    })
}

/// Meaning of a coefficient on its card.
pub(in crate::proposal) const COEFFICIENT: &str = "coefficient";

/// Start values for a coefficient. A flow is not linear in a change of the opening. If that change is large, the
/// regression overestimates the coefficient.
fn starts(row: Row, coefficient: f64) -> Vec<f64> {
    let shares: &[f64] = if row.is_an_opening() { &[1.0, 0.5, 0.25] } else { &[1.0] };
    shares.iter().map(|share| rounded(share * coefficient)).collect()
}

/// Longest name of a formula effect.
const LONGEST_NAME: usize = 60;

fn shape_text(shape: &super::factor::Shape, value: f64) -> ParameterText {
    let value = rounded(value);
    let size = value.abs().max(f64::MIN_POSITIVE);
    ParameterText {
        unit: shape.unit.to_string(),
        // Wide enough for every fit, and a limit for one that diverges.
        minimum: Some(if shape.is_signed { -FAR * size.max(LEAST) } else { size / FAR }),
        maximum: Some(FAR * size.max(LEAST)),
        start: vec![value],
        meaning: shape.meaning.to_string(),
        ..blank()
    }
}

/// Largest ratio of a shape parameter to its start value.
const FAR: f64 = 100.0;

/// Smallest magnitude of a signed shape parameter whose start may be zero, SI: a centimetre, a hundredth of a radian.
const LEAST: f64 = 0.01;

fn blank() -> ParameterText {
    ParameterText {
        unit: String::new(),
        minimum: None,
        maximum: None,
        start: Vec::new(),
        value: None,
        known: false,
        meaning: String::new(),
    }
}

/// Rounds to four digits, which is enough for a start value.
pub(in crate::proposal) fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
