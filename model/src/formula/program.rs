//! A formula as a list of operations, evaluated with any number type.

use super::corner::Corner;
use super::power::{fixed_power, power};
use super::symbol::Symbol;
use super::table::Table;
use super::variable::Variable;
use crate::equations::smooth::{orifice_root, rounded_sign, rounded_step};
use crate::equations::{Piston, Situation};
use crate::machine::{Machine, Mechanism, Supply};
use crate::scalar::Scalar;

/// One operation. Its result is stored in the register with its own index; its arguments are earlier registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operation {
    /// A number.
    Number(f64),
    /// The input with this index.
    Input(u16),
    Add(u16, u16),
    Subtract(u16, u16),
    Multiply(u16, u16),
    Divide(u16, u16),
    Negate(u16),
    /// A register times a number.
    Scale(u16, f64),
    /// An integer power.
    WholePower(u16, i32),
    /// A power with a constant exponent.
    FixedPower(u16, f64, Corner),
    Power(u16, u16),
    Abs(u16),
    Sign(u16, Corner),
    Sqrt(u16, Corner),
    Root(u16, Corner),
    Exp(u16),
    Ln(u16),
    Log10(u16),
    Sin(u16),
    Cos(u16),
    Tan(u16),
    Tanh(u16),
    Atan(u16),
    Min(u16, u16),
    Max(u16, u16),
    Step(u16, Corner),
    /// `3x² - 2x³` of a number between zero and one, clamped outside.
    Smooth(u16),
    Table(u16, u16),
    /// The second register if the first is one, the third if it is zero, a mixture in between.
    Choose(u16, u16, u16),
}

/// A compiled formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Program {
    pub operations: Vec<Operation>,
    pub inputs: Vec<Symbol>,
    pub tables: Vec<Table>,
}

/// Values for the evaluation of a formula.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment<'a, 'm, T> {
    pub parameters: &'a [T],
    pub states: &'a [T],
    pub now: &'a Situation<'m, T>,
    /// The effect's own cylinder; `None` at the pump line.
    pub cylinder: Option<usize>,
    /// The value of `u` while openings are being computed; otherwise that of the situation.
    pub opening: Option<T>,
}

/// Number of registers that fit on the stack; enough for a law of usual size.
const SMALL: usize = 24;

impl Program {
    /// A program without any operation.
    pub fn empty() -> Self {
        Program { operations: Vec::new(), inputs: Vec::new(), tables: Vec::new() }
    }

    /// Evaluates the formula.
    pub fn evaluate<T: Scalar>(&self, moment: &Moment<'_, '_, T>) -> T {
        let zero = T::from(0.0);
        if self.operations.len() <= SMALL {
            self.run(moment, &mut [zero; SMALL])
        } else {
            self.run(moment, &mut vec![zero; self.operations.len()])
        }
    }

    /// Evaluates a formula of parameters alone.
    pub fn of_parameters<T: Scalar>(&self, parameters: &[T]) -> T {
        let machine = nowhere();
        let now = Situation::empty(&machine);
        self.evaluate(&Moment { parameters, states: &[], now: &now, cylinder: None, opening: None })
    }

    fn run<T: Scalar>(&self, moment: &Moment<'_, '_, T>, registers: &mut [T]) -> T {
        let mut last = T::from(0.0);
        for (number, operation) in self.operations.iter().enumerate() {
            last = self.step(*operation, moment, registers);
            registers[number] = last;
        }
        last
    }

    #[inline]
    fn step<T: Scalar>(&self, operation: Operation, moment: &Moment<'_, '_, T>, registers: &[T]) -> T {
        let at = |register: u16| registers[usize::from(register)];
        match operation {
            Operation::Number(value) => T::from(value),
            Operation::Input(number) => moment.input(&self.inputs[usize::from(number)]),
            Operation::Add(a, b) => at(a) + at(b),
            Operation::Subtract(a, b) => at(a) - at(b),
            Operation::Multiply(a, b) => at(a) * at(b),
            Operation::Divide(a, b) => at(a) / at(b),
            Operation::Negate(a) => -at(a),
            Operation::Scale(a, factor) => at(a) * factor,
            Operation::WholePower(a, power) => at(a).powi(power),
            Operation::FixedPower(a, power, corner) => {
                fixed_power(at(a), power, corner.width(moment.now, moment.cylinder))
            }
            Operation::Power(a, b) => power(at(a), at(b)),
            Operation::Abs(a) => at(a).abs(),
            Operation::Sign(a, corner) => self.sign(at(a), corner, moment),
            Operation::Sqrt(a, corner) => fixed_power(at(a), 0.5, corner.width(moment.now, moment.cylinder)),
            Operation::Root(a, corner) => self.root(at(a), corner, moment),
            Operation::Exp(a) => at(a).exp(),
            Operation::Ln(a) => at(a).ln(),
            Operation::Log10(a) => at(a).log10(),
            Operation::Sin(a) => at(a).sin(),
            Operation::Cos(a) => at(a).cos(),
            Operation::Tan(a) => at(a).tan(),
            Operation::Tanh(a) => rounded_sign(at(a)),
            Operation::Atan(a) => at(a).atan(),
            Operation::Min(a, b) => {
                if at(b).value() < at(a).value() {
                    at(b)
                } else {
                    at(a)
                }
            }
            Operation::Max(a, b) => {
                if at(b).value() > at(a).value() {
                    at(b)
                } else {
                    at(a)
                }
            }
            Operation::Step(a, corner) => match corner.width(moment.now, moment.cylinder) {
                width if width.value() > 0.0 => rounded_step(at(a) / width),
                _ => T::from(f64::from(u8::from(at(a).value() > 0.0))),
            },
            Operation::Smooth(a) => smooth(at(a)),
            Operation::Table(a, table) => self.tables[usize::from(table)].at(at(a)),
            Operation::Choose(share, then, otherwise) => choose(at(share), at(then), at(otherwise)),
        }
    }

    fn sign<T: Scalar>(&self, argument: T, corner: Corner, moment: &Moment<'_, '_, T>) -> T {
        let piston = moment.cylinder.map(|cylinder| &moment.now.pistons[cylinder]);
        if let (Corner::Speed, Some(piston)) = (corner, piston) {
            return piston.rounding.sign(argument);
        }
        let width = corner.width(moment.now, moment.cylinder);
        if width.value() > 0.0 { rounded_sign(argument / width) } else { T::from(sharp_sign(argument.value())) }
    }

    fn root<T: Scalar>(&self, argument: T, corner: Corner, moment: &Moment<'_, '_, T>) -> T {
        let width = corner.width(moment.now, moment.cylinder);
        if width.value() > 0.0 {
            return orifice_root(argument, width);
        }
        if argument.value() == 0.0 {
            return T::from(0.0);
        }
        argument.abs().sqrt() * sharp_sign(argument.value())
    }
}

/// A machine without cylinders, for formulas of parameters alone.
pub(super) fn nowhere() -> Machine {
    Machine {
        name: String::new(),
        description: String::new(),
        gravity: 0.0,
        mechanism: Mechanism::LinearLoad,
        cylinders: Vec::new(),
        supply: Supply::None,
    }
}

fn sharp_sign(value: f64) -> f64 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}

fn smooth<T: Scalar>(x: T) -> T {
    if x.value() <= 0.0 {
        T::from(0.0)
    } else if x.value() >= 1.0 {
        T::from(1.0)
    } else {
        x * x * (x * -2.0 + 3.0)
    }
}

/// A side with zero weight is ignored, even if it is not a number.
fn choose<T: Scalar>(share: T, then: T, otherwise: T) -> T {
    if share.value() == 1.0 {
        then
    } else if share.value() == 0.0 {
        otherwise
    } else {
        otherwise + share * (then - otherwise)
    }
}

impl<T: Scalar> Moment<'_, '_, T> {
    fn input(&self, symbol: &Symbol) -> T {
        match symbol {
            Symbol::Parameter(number) => self.parameters[*number],
            Symbol::State(number) => self.states[*number],
            Symbol::Variable(variable, None) => self.variable(*variable, self.cylinder),
            Symbol::Variable(variable, Some(name)) => self.variable(*variable, self.now.machine.cylinder_index(name)),
        }
    }

    fn variable(&self, variable: Variable, cylinder: Option<usize>) -> T {
        let now = self.now;
        match variable {
            Variable::PumpPressure => return now.pump_pressure,
            Variable::TankPressure => return now.tank_pressure,
            Variable::Time => return now.time,
            Variable::Temperature => return now.oil_temperature,
            _ => {}
        }
        let Some(piston) = cylinder.and_then(|cylinder| now.pistons.get(cylinder)) else { return T::from(f64::NAN) };
        match variable {
            Variable::Opening if cylinder == self.cylinder => self.opening.unwrap_or(piston.opening),
            Variable::LargestOpening | Variable::CapArea | Variable::RodArea | Variable::Stroke => {
                T::from(constant(variable, now, cylinder))
            }
            _ => of_piston(variable, piston),
        }
    }
}

fn of_piston<T: Scalar>(variable: Variable, piston: &Piston<T>) -> T {
    match variable {
        Variable::Displacement => piston.displacement,
        Variable::Velocity => piston.velocity,
        Variable::Joint => piston.joint,
        Variable::Rate => piston.rate,
        Variable::Lever => piston.lever,
        Variable::CapPressure => piston.cap_pressure,
        Variable::RodPressure => piston.rod_pressure,
        Variable::Opening => piston.opening,
        Variable::Command => piston.command,
        Variable::CapFlow => piston.cap_flow,
        Variable::RodFlow => piston.rod_flow,
        Variable::RodForce => piston.rod_force,
        _ => T::from(f64::NAN),
    }
}

/// Constants of the machine, in SI units.
fn constant<T>(variable: Variable, now: &Situation<'_, T>, cylinder: Option<usize>) -> f64 {
    let Some(own) = cylinder.and_then(|cylinder| now.machine.cylinders.get(cylinder)) else { return f64::NAN };
    let areas = match (&own.chambers, &own.imposed_motion) {
        (Some(chambers), _) => [chambers.cap_area, chambers.rod_area],
        (None, Some(imposed)) => [imposed.cap_area, imposed.rod_area],
        (None, None) => [f64::NAN; 2],
    };
    match variable {
        Variable::CapArea => areas[0],
        Variable::RodArea => areas[1],
        Variable::Stroke => own.stroke,
        Variable::LargestOpening => own.chambers.as_ref().map_or(f64::NAN, |oil| oil.full_command()),
        _ => f64::NAN,
    }
}
