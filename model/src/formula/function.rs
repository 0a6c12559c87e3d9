//! The functions that a formula may call.

/// A function of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Function {
    Abs,
    Sign,
    Sqrt,
    Root,
    Exp,
    Ln,
    Log10,
    Sin,
    Cos,
    Tan,
    Tanh,
    Atan,
    Min,
    Max,
    Clamp,
    Step,
    Smoothstep,
}

/// All functions of numbers, by their names in formulas. `table` and `if` have their own syntax.
pub(super) const FUNCTIONS: [(&str, Function); 17] = [
    ("abs", Function::Abs),
    ("sign", Function::Sign),
    ("sqrt", Function::Sqrt),
    ("root", Function::Root),
    ("exp", Function::Exp),
    ("ln", Function::Ln),
    ("log10", Function::Log10),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("tanh", Function::Tanh),
    ("atan", Function::Atan),
    ("min", Function::Min),
    ("max", Function::Max),
    ("clamp", Function::Clamp),
    ("step", Function::Step),
    ("smoothstep", Function::Smoothstep),
];

impl Function {
    /// Its name in formulas.
    pub fn name(self) -> &'static str {
        FUNCTIONS.iter().find(|(_, function)| *function == self).map_or("", |(name, _)| name)
    }

    /// Description of its number of arguments, and whether `count` is valid.
    pub fn takes(self, count: usize) -> (&'static str, bool) {
        match self {
            Function::Min | Function::Max => ("two arguments or more", count >= 2),
            Function::Clamp => ("three arguments (x, lowest, highest)", count == 3),
            Function::Smoothstep => ("three arguments (x, begin, end)", count == 3),
            _ => ("one argument", count == 1),
        }
    }
}
