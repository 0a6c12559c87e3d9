//! Reads a formula effect from text.

use super::compile::compile;
use super::dimension::{Dimension, UnitError};
use super::error::{FormulaError, Problem};
use super::expression::Expression;
use super::law::{Law, StateLaw};
use super::linearity::linear_parameters;
use super::names::Names;
use super::parser::{is_reserved, is_word, parse};
use super::program::Program;
use super::row::{ROWS, Row};
use super::symbol::Symbol;
use super::text::{FormulaText, ParameterText, StateText};
use super::variable::Variable;
use crate::effects::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Start, Text, nearest};

/// An invalid formula effect.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("formula effect \"{name}\": {problem}")]
#[non_exhaustive]
pub struct LawError {
    /// Name of the effect.
    pub name: String,
    /// The error.
    pub problem: LawProblem,
}

/// An error in a formula effect.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawProblem {
    /// An invalid name.
    #[error("\"{0}\" cannot be a name: use letters, digits and _, at most 60, and begin with a letter")]
    Name(String),
    /// A name that is reserved by the language.
    #[error("\"{0}\" is a variable or function of formulas; give it another name")]
    Reserved(String),
    /// A row that does not exist.
    #[error("acts_on = \"{row}\" is unknown{}; it is one of {}", suggestion.as_ref().map_or(String::new(), |name| format!(" (did you mean \"{name}\"?)")), row_names())]
    Row {
        /// The requested row.
        row: String,
        /// The nearest existing row.
        suggestion: Option<String>,
    },
    /// An invalid formula.
    #[error("{what}: {error}")]
    Formula {
        /// Which: "formula", "rate of z", "start of z".
        what: String,
        /// The error.
        error: Box<FormulaError>,
    },
    /// An invalid unit.
    #[error("{what}: {error}")]
    Unit {
        /// The parameter or state.
        what: String,
        /// The error.
        error: UnitError,
    },
    /// A parameter or state that no formula uses.
    #[error("no formula uses {0}")]
    Unused(String),
    /// A parameter with inconsistent numbers.
    #[error("parameter {parameter}: {reason}")]
    Parameter {
        /// The parameter.
        parameter: String,
        /// What does not fit.
        reason: String,
    },
    /// Too many parameters or states.
    #[error("more than {0} parameters or states")]
    TooMany(usize),
}

fn row_names() -> String {
    ROWS.iter().map(|card| card.name).collect::<Vec<_>>().join(", ")
}

/// Largest number of parameters and states of a law together.
const MOST_NAMES: usize = 24;

/// Longest name.
const LONGEST_NAME: usize = 60;

impl Law {
    /// Parses a formula effect.
    ///
    /// # Errors
    /// [`LawError`] in one line with the position.
    pub fn read(text: &FormulaText) -> Result<Law, LawError> {
        Reader::new(text).and_then(|reader| reader.law()).map_err(|problem| {
            let name = text.name.chars().take(LONGEST_NAME).collect();
            LawError { name, problem }
        })
    }
}

struct Reader<'a> {
    text: &'a FormulaText,
    row: Row,
    parameters: Vec<String>,
    states: Vec<String>,
    parameter_units: Vec<Dimension>,
    state_units: Vec<Dimension>,
}

impl<'a> Reader<'a> {
    fn new(text: &'a FormulaText) -> Result<Self, LawProblem> {
        check_name(&text.name)?;
        let row = ROWS.iter().find(|card| card.name == text.acts_on).map(|card| card.row).ok_or_else(|| {
            let suggestion = nearest(&text.acts_on, ROWS.iter().map(|card| card.name));
            LawProblem::Row { row: text.acts_on.chars().take(LONGEST_NAME).collect(), suggestion }
        })?;
        let parameters: Vec<String> = text.parameters.keys().cloned().collect();
        let states: Vec<String> = text.states.keys().cloned().collect();
        if parameters.len() + states.len() > MOST_NAMES {
            return Err(LawProblem::TooMany(MOST_NAMES));
        }
        for name in parameters.iter().chain(&states) {
            check_name(name)?;
            if is_reserved(name) || states.contains(name) && parameters.contains(name) {
                return Err(LawProblem::Reserved(name.clone()));
            }
        }
        let unit = |what: &String, unit: &str| {
            Dimension::read(unit).map_err(|error| LawProblem::Unit { what: what.clone(), error })
        };
        let parameter_units =
            text.parameters.iter().map(|(name, one)| unit(name, &one.unit)).collect::<Result<_, _>>()?;
        let state_units = text.states.iter().map(|(name, one)| unit(name, &one.unit)).collect::<Result<_, _>>()?;
        Ok(Reader { text, row, parameters, states, parameter_units, state_units })
    }

    fn law(&self) -> Result<Law, LawProblem> {
        let card = self.row.card();
        let (tree, program) =
            self.formula("formula", &self.text.formula, &self.states, (card.name, self.row.dimension()))?;
        let mut states = Vec::new();
        let mut trees = vec![tree];
        for (number, (name, text)) in self.text.states.iter().enumerate() {
            let unit = self.state_units[number];
            let per_second = unit.over(Dimension::read("s").unwrap_or(Dimension::PURE));
            let (tree, rate) =
                self.formula(&format!("rate of {name}"), &text.rate, &self.states, (name, per_second))?;
            trees.push(tree);
            let (tree, start) = self.formula(&format!("start of {name}"), &text.start, &[], (name, unit))?;
            trees.push(tree);
            states.push(StateLaw { start, rate, scale: scale(name, text, unit)? });
        }
        let programs = || {
            let of_states = states.iter().flat_map(|state| [&state.start, &state.rate]);
            std::iter::once(&program).chain(of_states)
        };
        let inputs: Vec<&Symbol> = programs().flat_map(|program| &program.inputs).collect();
        self.check_use(&inputs)?;
        let parameters = self.parameter_cards(&trees)?;
        let mut others: Vec<String> = inputs.iter().filter_map(|input| other_cylinder(input)).collect();
        others.sort();
        others.dedup();
        let variables = || inputs.iter().filter_map(|input| variable(input));
        let reads_metering_flows = variables().any(Variable::is_a_metering_flow);
        let reads_temperature = variables().any(|variable| variable == Variable::Temperature);
        let card = self.card(variables().any(Variable::needs_oil), variables().any(Variable::needs_pressures));
        let text = self.text.clone();
        let row = self.row;
        Ok(Law { card, row, parameters, states, program, text, others, reads_metering_flows, reads_temperature })
    }

    fn formula(
        &self,
        what: &str,
        text: &str,
        states: &[String],
        row: (&str, Dimension),
    ) -> Result<(Expression, Program), LawProblem> {
        let problem = |error| LawProblem::Formula { what: what.to_string(), error: Box::new(error) };
        let names = Names { parameters: &self.parameters, states, rates: false };
        let tree = parse(text, &names).map_err(problem)?;
        self.check_variables(&tree, text).map_err(problem)?;
        let unit_of = |symbol: &Symbol| match symbol {
            Symbol::Parameter(number) => self.parameter_units[*number],
            Symbol::State(number) => self.state_units[*number],
            Symbol::Variable(variable, _) => variable.dimension(),
        };
        let program = compile(&tree, text, &unit_of, row).map_err(problem)?;
        Ok((tree, program))
    }

    /// Whether every parameter and state is used.
    fn check_use(&self, inputs: &[&Symbol]) -> Result<(), LawProblem> {
        let unused = |names: &[String], symbol: fn(usize) -> Symbol| {
            (0..names.len()).find(|&number| !inputs.contains(&&symbol(number))).map(|number| names[number].clone())
        };
        let unused = unused(&self.parameters, Symbol::Parameter).or_else(|| unused(&self.states, Symbol::State));
        unused.map_or(Ok(()), |name| Err(LawProblem::Unused(name)))
    }

    /// Whether every variable is available where the formula is evaluated.
    fn check_variables(&self, tree: &Expression, text: &str) -> Result<(), FormulaError> {
        let refused = |(symbol, at): (&Symbol, std::ops::Range<usize>)| {
            let (name, reason) = match symbol {
                Symbol::Parameter(_) => return None,
                Symbol::State(number) if self.row.is_an_opening() || self.row.is_a_reading() => {
                    (self.states[*number].clone(), "openings and readings have no states")
                }
                Symbol::State(_) => return None,
                Symbol::Variable(variable, other) => {
                    (variable.card().name.to_string(), self.why_not(*variable, other.is_some())?)
                }
            };
            Some(FormulaError::new(Problem::Unavailable { name, reason }, at, text))
        };
        tree.names().into_iter().find_map(refused).map_or(Ok(()), Err)
    }

    /// Why a variable, of another cylinder or of the effect's own, is not available in this row.
    fn why_not(&self, variable: Variable, of_another: bool) -> Option<&'static str> {
        let is_of_the_pump = self.row.acts_on() == ActsOn::PumpLine;
        if self.row.is_a_reading() {
            Some("what an instrument adds can depend on parameters only")
        } else if is_of_the_pump && variable.is_of_a_cylinder() && !of_another {
            Some("the pump line has no cylinder of its own; say whose, as in boom.v")
        } else if self.row.acts_on() == ActsOn::Valve && variable.is_a_metering_flow() {
            Some("it is the sum of what the valve's effects give, this one among them")
        } else if self.row == Row::Opening && variable == Variable::Opening && of_another {
            Some("openings are formed one after the other")
        } else {
            None
        }
    }

    fn parameter_cards(&self, trees: &[Expression]) -> Result<Vec<ParameterCard>, LawProblem> {
        let is_row = !self.row.is_an_opening() && !self.row.is_a_reading() && trees.len() == 1;
        let linear = if is_row {
            linear_parameters(&trees[0], self.parameters.len())
        } else {
            vec![false; self.parameters.len()]
        };
        self.text
            .parameters
            .iter()
            .zip(linear)
            .map(|((name, text), linear)| parameter_card(name, text, linear))
            .collect()
    }

    fn card(&self, needs_oil: bool, needs_pressures: bool) -> Card {
        let row = self.row.card();
        let or = |text: &str, other: &str| Text::Owned(if text.is_empty() { other } else { text }.to_string());
        let needs = match self.row.needs() {
            needs @ (Needs::Oil | Needs::Valve | Needs::Pump) => needs,
            _ if needs_oil => Needs::Oil,
            Needs::Pressures => Needs::Pressures,
            _ if needs_pressures => Needs::Pressures,
            Needs::Nothing => Needs::Nothing,
        };
        let mut equation = format!("{}: {}", row.name, self.text.formula.trim());
        for (name, state) in &self.text.states {
            equation += &format!("; d{name}/dt = {}", state.rate.trim());
        }
        Card {
            name: Text::Owned(self.text.name.clone()),
            acts_on: self.row.acts_on(),
            needs,
            family: Family::Candidate,
            summary: or(&self.text.summary, row.meaning),
            equation: Text::Owned(equation),
            source: or(&self.text.source, "a formula of the user"),
            shows: or(&self.text.shows, row.shows),
            experiment: or(
                &self.text.experiment,
                "A manoeuvre in which the variables of the formula change one at a time.",
            ),
            energy: Text::Borrowed(row.energy),
        }
    }
}

fn parameter_card(name: &str, text: &ParameterText, is_linear: bool) -> Result<ParameterCard, LawProblem> {
    let wrong = |reason: String| LawProblem::Parameter { parameter: name.to_string(), reason };
    let start = match (text.known, text.value, text.start.as_slice()) {
        (true, Some(value), []) => Start::Known(value),
        (true, None, _) => return Err(wrong("a known one needs a value".into())),
        (true, Some(_), _) => return Err(wrong("a known one has a value and no start".into())),
        (false, Some(value), []) => Start::At(vec![value].into()),
        (false, None, starts @ [_, ..]) => Start::At(starts.to_vec().into()),
        (false, Some(_), _) => return Err(wrong("give either value or start".into())),
        (false, None, []) => {
            return Err(wrong(
                "give a start, as in start = [1e-3], or a constant, as in value = 0.6, known = true".into(),
            ));
        }
    };
    let values: &[f64] = match &start {
        Start::Known(value) => std::slice::from_ref(value),
        Start::At(values) => values,
        _ => &[],
    };
    if !values.iter().all(|value| value.is_finite()) {
        return Err(wrong("its values must be finite numbers".into()));
    }
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let typical = if largest > 0.0 { largest } else { 1.0 };
    let maximum = text.maximum.unwrap_or(FAR * typical);
    let is_positive = values.iter().all(|value| *value >= 0.0);
    let minimum = text.minimum.unwrap_or(if is_positive { 0.0 } else { -maximum });
    if !(minimum.is_finite() && maximum.is_finite() && minimum < maximum) {
        return Err(wrong(format!("minimum {minimum} must be below maximum {maximum}, both finite")));
    }
    if let Some(outside) = values.iter().find(|value| !(minimum..=maximum).contains(*value)) {
        return Err(wrong(format!("{outside} is not between minimum {minimum} and maximum {maximum}")));
    }
    Ok(ParameterCard {
        name: Text::Owned(name.to_string()),
        symbol: Text::Owned(name.to_string()),
        unit: Text::Owned(text.unit.clone()),
        meaning: Text::Owned(text.meaning.clone()),
        kind: if is_linear { Kind::Linear } else { Kind::Shape },
        // User formulas are written for one machine and do not scale.
        growth: Growth::NONE,
        minimum,
        maximum,
        typical,
        start,
        prior: None,
    })
}

/// Default maximum as a multiple of the largest start value: no start is less certain than that.
const FAR: f64 = 1e6;

/// Order of magnitude of a state, in its unit.
fn scale(name: &str, text: &StateText, unit: Dimension) -> Result<f64, LawProblem> {
    if let Some(typical) = text.typical {
        return if typical.is_finite() && typical > 0.0 {
            Ok(typical)
        } else {
            Err(LawProblem::Parameter { parameter: name.to_string(), reason: "typical must be above zero".into() })
        };
    }
    // A bristle bends by a tenth of a millimetre, seals slip at a centimetre per second.
    let usual =
        [("m", 1e-4), ("m/s", 1e-2), ("Pa", 1e5), ("N", 1e3), ("m2", 1e-4), ("m3/s", 1e-5), ("m3", 1e-5), ("s", 1e-2)];
    let known = usual.iter().find(|(known, _)| Dimension::read(known).is_ok_and(|dimension| dimension == unit));
    Ok(known.map_or(1.0, |(_, scale)| *scale))
}

fn check_name(name: &str) -> Result<(), LawProblem> {
    let is_usable = is_word(name) && name.len() <= LONGEST_NAME;
    if is_usable { Ok(()) } else { Err(LawProblem::Name(name.chars().take(LONGEST_NAME).collect())) }
}

fn variable(input: &Symbol) -> Option<Variable> {
    match input {
        Symbol::Variable(variable, _) => Some(*variable),
        _ => None,
    }
}

fn other_cylinder(input: &Symbol) -> Option<String> {
    match input {
        Symbol::Variable(_, cylinder) => cylinder.clone(),
        _ => None,
    }
}
