//! Compiles a tree to a program: checks units, folds constants and merges common subexpressions.

use std::ops::Range;

use super::corner::Corner;
use super::dimension::Dimension;
use super::error::{FormulaError, Problem};
use super::expression::{Expression, Node, Operator};
use super::function::Function;
use super::program::{Operation, Program};
use super::symbol::Symbol;
use super::table::Table;

/// The unit of a part of a formula.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Unit {
    /// A literal zero, which fits everywhere.
    Any,
    Of(Dimension),
}

/// A part of a formula, compiled.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Part {
    value: Value,
    unit: Unit,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Value {
    Number(f64),
    Register(u16),
}

/// Compiles a formula whose value must have the unit of `row`: its name and dimension. `unit_of` returns the dimension of a name.
pub(super) fn compile(
    expression: &Expression,
    text: &str,
    unit_of: &dyn Fn(&Symbol) -> Dimension,
    row: (&str, Dimension),
) -> Result<Program, FormulaError> {
    let mut compiler =
        Compiler { text, unit_of, program: Program::empty(), numbers_have_units: false, is_sharp: false };
    let whole = compiler.part(expression)?;
    if let Unit::Of(found) = whole.unit
        && found != row.1
    {
        let problem = Problem::WrongRow { row: row.0.to_string(), wanted: row.1.text(), found: found.text() };
        return Err(compiler.error(problem, &expression.at));
    }
    Ok(compiler.finished(whole.value))
}

/// Compiles the difference of two expressions. Numbers take the SI unit that their context requires: a condition on a recording
/// is read only by its author and is not used elsewhere.
pub(super) fn compile_difference(
    [larger, smaller]: &[Expression; 2],
    text: &str,
    unit_of: &dyn Fn(&Symbol) -> Dimension,
) -> Result<Program, FormulaError> {
    let mut compiler = Compiler { text, unit_of, program: Program::empty(), numbers_have_units: true, is_sharp: false };
    let (one, other) = (compiler.part(larger)?, compiler.part(smaller)?);
    let at = larger.at.start.min(smaller.at.start)..larger.at.end.max(smaller.at.end);
    compiler.same("compare", one.unit, other.unit, &at)?;
    let difference = compiler.two(one.value, other.value, |a, b| a - b, Operation::Subtract);
    Ok(compiler.finished(difference))
}

/// Compiles a formula over numbers without units. Its corners are sharp, because the scale of a column is unknown.
pub(super) fn compile_plain(expression: &Expression, text: &str) -> Result<Program, FormulaError> {
    let unit_of = |_: &Symbol| Dimension::PURE;
    let mut compiler =
        Compiler { text, unit_of: &unit_of, program: Program::empty(), numbers_have_units: false, is_sharp: true };
    let whole = compiler.part(expression)?;
    Ok(compiler.finished(whole.value))
}

struct Compiler<'a> {
    text: &'a str,
    unit_of: &'a dyn Fn(&Symbol) -> Dimension,
    program: Program,
    /// Whether a number takes the unit that its context requires; otherwise it is a pure number.
    numbers_have_units: bool,
    /// Whether `sign`, `step`, `root` and `if` are sharp.
    is_sharp: bool,
}

impl Compiler<'_> {
    /// The program for this value: the value of its last register.
    fn finished(mut self, value: Value) -> Program {
        match value {
            Value::Register(register) if usize::from(register) + 1 == self.program.operations.len() => {}
            Value::Register(register) => self.program.operations.push(Operation::Scale(register, 1.0)),
            Value::Number(number) => self.program.operations.push(Operation::Number(number)),
        }
        self.program
    }

    fn error(&self, problem: Problem, at: &Range<usize>) -> FormulaError {
        FormulaError::new(problem, at.clone(), self.text)
    }

    fn corner(&self, unit: Unit) -> Corner {
        match unit {
            _ if self.is_sharp => Corner::Sharp,
            Unit::Of(dimension) => Corner::of(dimension),
            Unit::Any => Corner::of(Dimension::PURE),
        }
    }

    fn part(&mut self, expression: &Expression) -> Result<Part, FormulaError> {
        let pure = Unit::Of(Dimension::PURE);
        match &expression.node {
            Node::Number(value) => {
                let unit = if *value == 0.0 || self.numbers_have_units { Unit::Any } else { pure };
                Ok(Part { value: Value::Number(*value), unit })
            }
            Node::Name(symbol) => {
                let unit = Unit::Of((self.unit_of)(symbol));
                let number = self.input(symbol);
                Ok(Part { value: self.emit(Operation::Input(number)), unit })
            }
            Node::Negative(inner) => {
                let inner = self.part(inner)?;
                Ok(Part { value: self.unary(inner.value, |x| -x, Operation::Negate), unit: inner.unit })
            }
            Node::Binary(operator, left, right) => self.binary(*operator, left, right),
            Node::Call(function, arguments) => self.call(*function, arguments),
            Node::Table(x, knots, values) => {
                let x = self.part(x)?;
                let table = Table::new(knots.clone(), values.clone());
                let value = match x.value {
                    Value::Number(x) => Value::Number(table.at(x)),
                    Value::Register(x) => {
                        self.program.tables.push(table);
                        self.emit(Operation::Table(x, (self.program.tables.len() - 1) as u16))
                    }
                };
                Ok(Part { value, unit: pure })
            }
            Node::If { less, more, then, otherwise } => self.choice(less, more, then, otherwise),
        }
    }

    fn binary(&mut self, operator: Operator, left: &Expression, right: &Expression) -> Result<Part, FormulaError> {
        let (one, other) = (self.part(left)?, self.part(right)?);
        let at = left.at.start..right.at.end;
        let unit = match operator {
            Operator::Add => self.same("add", one.unit, other.unit, &at)?,
            Operator::Subtract => self.same("subtract", one.unit, other.unit, &at)?,
            Operator::Multiply => combined(one.unit, other.unit, Dimension::times),
            Operator::Divide => combined(one.unit, other.unit, Dimension::over),
            Operator::Power => return self.power(one, other, left, right),
        };
        let value = match operator {
            Operator::Add => self.two(one.value, other.value, |a, b| a + b, Operation::Add),
            Operator::Subtract => self.two(one.value, other.value, |a, b| a - b, Operation::Subtract),
            Operator::Multiply => match (one.value, other.value) {
                (Value::Number(factor), Value::Register(register))
                | (Value::Register(register), Value::Number(factor)) => self.emit(Operation::Scale(register, factor)),
                (one, other) => self.two(one, other, |a, b| a * b, Operation::Multiply),
            },
            Operator::Divide | Operator::Power => self.two(one.value, other.value, |a, b| a / b, Operation::Divide),
        };
        Ok(Part { value, unit })
    }

    fn power(
        &mut self,
        base: Part,
        exponent: Part,
        left: &Expression,
        right: &Expression,
    ) -> Result<Part, FormulaError> {
        self.pure(&exponent, || "the exponent".to_string(), &right.at)?;
        let unit = match (base.unit, exponent.value) {
            (Unit::Of(dimension), _) if dimension.is_pure() => base.unit,
            (Unit::Any, _) => Unit::Of(Dimension::PURE),
            (Unit::Of(dimension), Value::Number(exponent)) => {
                let error = || self.error(Problem::VariableExponent(dimension.text()), &left.at);
                Unit::Of(dimension.to_the(exponent).ok_or_else(error)?)
            }
            (Unit::Of(dimension), Value::Register(_)) => {
                return Err(self.error(Problem::VariableExponent(dimension.text()), &left.at));
            }
        };
        let value = match (base.value, exponent.value) {
            (Value::Number(base), Value::Number(exponent)) => Value::Number(base.powf(exponent)),
            (Value::Register(register), Value::Number(exponent)) => {
                self.emit(fixed_power(register, exponent, self.corner(base.unit)))
            }
            (base, exponent) => {
                let (base, exponent) = (self.register(base), self.register(exponent));
                self.emit(Operation::Power(base, exponent))
            }
        };
        Ok(Part { value, unit })
    }

    fn call(&mut self, function: Function, arguments: &[Expression]) -> Result<Part, FormulaError> {
        let parts: Vec<Part> = arguments.iter().map(|argument| self.part(argument)).collect::<Result<_, _>>()?;
        // The parser has checked their number.
        let (Some(first), Some(whole)) = (parts.first().copied(), span(arguments)) else {
            return Err(self.error(Problem::Expected("an argument"), &(0..0)));
        };
        let pure = Unit::Of(Dimension::PURE);
        let value = first.value;
        let corner = self.corner(first.unit);
        if let Some((fold, operation)) = of_pure_number(function) {
            self.pure(&first, || format!("the argument of {}", function.name()), &whole)?;
            return Ok(Part { value: self.unary(value, fold, operation), unit: pure });
        }
        match function {
            Function::Abs => Ok(Part { value: self.unary(value, f64::abs, Operation::Abs), unit: first.unit }),
            Function::Sign => {
                let register = self.register(value);
                Ok(Part { value: self.emit(Operation::Sign(register, corner)), unit: pure })
            }
            Function::Step => {
                let register = self.register(value);
                Ok(Part { value: self.emit(Operation::Step(register, corner)), unit: pure })
            }
            Function::Sqrt | Function::Root => {
                let unit = match first.unit {
                    Unit::Any => Unit::Any,
                    Unit::Of(dimension) => {
                        let error = || self.error(Problem::VariableExponent(dimension.text()), &whole);
                        Unit::Of(dimension.to_the(0.5).ok_or_else(error)?)
                    }
                };
                let register = self.register(value);
                let operation = match function {
                    Function::Sqrt => Operation::Sqrt(register, corner),
                    _ => Operation::Root(register, corner),
                };
                Ok(Part { value: self.emit(operation), unit })
            }
            _ => self.of_several(function, &parts, &whole),
        }
    }

    /// Functions of several arguments with the same unit.
    fn of_several(&mut self, function: Function, parts: &[Part], at: &Range<usize>) -> Result<Part, FormulaError> {
        let mut unit = parts[0].unit;
        for part in &parts[1..] {
            unit = self.same("choose between", unit, part.unit, at)?;
        }
        let least = |compiler: &mut Self, a, b| compiler.two(a, b, f64::min, Operation::Min);
        let most = |compiler: &mut Self, a, b| compiler.two(a, b, f64::max, Operation::Max);
        let mut values = parts.iter().map(|part| part.value);
        let first = values.next().unwrap_or(Value::Number(0.0));
        let value = match function {
            Function::Min => values.fold(first, |so_far, next| least(self, so_far, next)),
            Function::Max => values.fold(first, |so_far, next| most(self, so_far, next)),
            Function::Clamp => {
                let above = most(self, first, parts[1].value);
                least(self, above, parts[2].value)
            }
            // Smoothstep: the fraction of the way from begin to end.
            _ => {
                let (begin, end) = (parts[1].value, parts[2].value);
                let along = self.two(first, begin, |a, b| a - b, Operation::Subtract);
                let length = self.two(end, begin, |a, b| a - b, Operation::Subtract);
                let share = self.two(along, length, |a, b| a / b, Operation::Divide);
                let share = self.register(share);
                unit = Unit::Of(Dimension::PURE);
                self.emit(Operation::Smooth(share))
            }
        };
        Ok(Part { value, unit })
    }

    fn choice(
        &mut self,
        less: &Expression,
        more: &Expression,
        then: &Expression,
        otherwise: &Expression,
    ) -> Result<Part, FormulaError> {
        let (low, high) = (self.part(less)?, self.part(more)?);
        let condition = less.at.start.min(more.at.start)..less.at.end.max(more.at.end);
        let unit = self.same("compare", low.unit, high.unit, &condition)?;
        let corner = self.corner(unit);
        let difference = self.two(high.value, low.value, |a, b| a - b, Operation::Subtract);
        let difference = self.register(difference);
        let share = self.emit(Operation::Step(difference, corner));
        let (one, other) = (self.part(then)?, self.part(otherwise)?);
        let unit = self.same("choose between", one.unit, other.unit, &(then.at.start..otherwise.at.end))?;
        let registers = [share, one.value, other.value].map(|value| self.register(value));
        Ok(Part { value: self.emit(Operation::Choose(registers[0], registers[1], registers[2])), unit })
    }

    /// The common unit of two parts.
    fn same(&self, verb: &'static str, left: Unit, right: Unit, at: &Range<usize>) -> Result<Unit, FormulaError> {
        match (left, right) {
            (Unit::Any, other) | (other, Unit::Any) => Ok(other),
            (Unit::Of(one), Unit::Of(other)) if one == other => Ok(left),
            (Unit::Of(one), Unit::Of(other)) => {
                Err(self.error(Problem::Mismatch { verb, left: one.text(), right: other.text() }, at))
            }
        }
    }

    fn pure(&self, part: &Part, what: impl Fn() -> String, at: &Range<usize>) -> Result<(), FormulaError> {
        match part.unit {
            Unit::Of(dimension) if !dimension.is_pure() => {
                Err(self.error(Problem::NotPure { what: what(), found: dimension.text() }, at))
            }
            _ => Ok(()),
        }
    }

    fn input(&mut self, symbol: &Symbol) -> u16 {
        let inputs = &mut self.program.inputs;
        let known = inputs.iter().position(|input| input == symbol);
        known.unwrap_or_else(|| {
            inputs.push(symbol.clone());
            inputs.len() - 1
        }) as u16
    }

    fn unary(&mut self, value: Value, fold: fn(f64) -> f64, operation: fn(u16) -> Operation) -> Value {
        match value {
            Value::Number(number) => Value::Number(fold(number)),
            Value::Register(register) => self.emit(operation(register)),
        }
    }

    fn two(
        &mut self,
        one: Value,
        other: Value,
        fold: fn(f64, f64) -> f64,
        operation: fn(u16, u16) -> Operation,
    ) -> Value {
        if let (Value::Number(one), Value::Number(other)) = (one, other) {
            return Value::Number(fold(one, other));
        }
        let (one, other) = (self.register(one), self.register(other));
        self.emit(operation(one, other))
    }

    fn register(&mut self, value: Value) -> u16 {
        let value = match value {
            Value::Number(number) => self.emit(Operation::Number(number)),
            register => register,
        };
        match value {
            Value::Register(register) => register,
            Value::Number(_) => 0,
        }
    }

    /// The register of an operation: that of an identical earlier one, or a new one. The parser limits their number.
    fn emit(&mut self, operation: Operation) -> Value {
        let operations = &mut self.program.operations;
        let known = operations.iter().position(|known| *known == operation);
        Value::Register(known.unwrap_or_else(|| {
            operations.push(operation);
            operations.len() - 1
        }) as u16)
    }
}

fn combined(one: Unit, other: Unit, combine: fn(Dimension, Dimension) -> Dimension) -> Unit {
    match (one, other) {
        (Unit::Of(one), Unit::Of(other)) => Unit::Of(combine(one, other)),
        _ => Unit::Any,
    }
}

fn fixed_power(register: u16, exponent: f64, corner: Corner) -> Operation {
    if exponent == 0.5 {
        Operation::Sqrt(register, corner)
    } else if exponent.fract() == 0.0 && exponent.abs() <= LARGEST_WHOLE_POWER {
        Operation::WholePower(register, exponent as i32)
    } else {
        Operation::FixedPower(register, exponent, corner)
    }
}

/// Largest integer power that is computed by multiplication.
const LARGEST_WHOLE_POWER: f64 = 32.0;

type Fold = fn(f64) -> f64;
type Emit = fn(u16) -> Operation;

/// Functions of a pure number with a pure number as the result.
fn of_pure_number(function: Function) -> Option<(Fold, Emit)> {
    match function {
        Function::Exp => Some((f64::exp, Operation::Exp)),
        Function::Ln => Some((f64::ln, Operation::Ln)),
        Function::Log10 => Some((f64::log10, Operation::Log10)),
        Function::Sin => Some((f64::sin, Operation::Sin)),
        Function::Cos => Some((f64::cos, Operation::Cos)),
        Function::Tan => Some((f64::tan, Operation::Tan)),
        Function::Tanh => Some((f64::tanh, Operation::Tanh)),
        Function::Atan => Some((f64::atan, Operation::Atan)),
        _ => None,
    }
}

fn span(arguments: &[Expression]) -> Option<Range<usize>> {
    Some(arguments.first()?.at.start..arguments.last()?.at.end)
}
