//! Straight-line code in a language.

use std::fmt::Write as _;

use liestep_derivation::{Array, Function, Operation, Program};

use crate::emitted::name;

/// A language, as far as its straight-line code differs from another's. In C a name of this package begins with `$`, in
/// whose place the declaration's name is put.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Language {
    Rust,
    C,
    JavaScript,
}

impl Language {
    /// The name of an array. `half` is a type of `OpenCL` C.
    pub(super) const fn array(self, array: Array) -> &'static str {
        match array {
            Array::Half if !matches!(self, Self::Rust) => "y",
            _ => name(array),
        }
    }

    /// A number of an array.
    fn entry(self, array: Array, at: usize) -> String {
        let inputs = if self == Self::C { "in->" } else { "" };
        let name = self.array(array);
        if array == Array::Step { format!("{inputs}{name}") } else { format!("{inputs}{name}[{at}]") }
    }

    fn applied(self, function: Function, value: u32) -> String {
        let own = if self == Self::C { "$" } else { "" };
        let name = match function {
            Function::Sqrt => "sqrt",
            Function::Ln if self == Self::Rust => "ln",
            Function::Ln => "log",
            Function::Exp => "exp",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Stumpff(k) if self == Self::Rust => return format!("stumpff::<_, {k}>(x{value})"),
            Function::LogRatio(k) if self == Self::Rust => return format!("log_ratio::<_, {k}>(x{value})"),
            Function::Stumpff(k) => return format!("{own}stumpff({k}, {own}stumpff_{k}, x{value})"),
            Function::LogRatio(k) => return format!("{own}log_ratio({k}, {own}log_ratio_{k}, x{value})"),
        };
        match self {
            Self::Rust => format!("x{value}.{name}()"),
            Self::C => format!("{name}(x{value})"),
            Self::JavaScript => format!("Math.{name}(x{value})"),
        }
    }

    /// The statements of a program, one a line.
    pub(super) fn body(self, program: &Program) -> String {
        let values = program.inputs.iter().map(|source| self.entry(source.array, source.at));
        let literals = program.literals.iter().map(|literal| format!("{literal:?}"));
        let operations = program.operations.iter().map(|&operation| match operation {
            Operation::Negate(a) => format!("-x{a}"),
            Operation::Add(a, b) => format!("x{a} + x{b}"),
            Operation::Subtract(a, b) => format!("x{a} - x{b}"),
            Operation::Multiply(a, b) => format!("x{a} * x{b}"),
            Operation::Divide(a, b) => format!("x{a} / x{b}"),
            Operation::Apply(function, a) => self.applied(function, a),
        });
        let named = values.chain(literals).chain(operations).enumerate();
        if self == Self::JavaScript {
            return in_few_letters(program, named.map(|(at, value)| format!("x{at}={}", value.replace(' ', ""))));
        }
        let declared = if self == Self::C { "const double" } else { "let" };
        let mut text = String::new();
        for (at, value) in named {
            let _ = writeln!(text, "    {declared} x{at} = {value};");
        }
        for (at, output) in program.outputs.iter().enumerate() {
            let _ = writeln!(text, "    outputs[{at}] = x{output};");
        }
        text
    }
}

/// The statements of a program as a page has them, whose weight is that of its programs.
fn in_few_letters(program: &Program, named: impl Iterator<Item = String>) -> String {
    let mut arrays: Vec<&str> = program.inputs.iter().map(|one| Language::JavaScript.array(one.array)).collect();
    arrays.sort_unstable();
    arrays.dedup();
    let named: Vec<String> = named.collect();
    let outputs = program.outputs.iter().enumerate().map(|(at, output)| format!("to[{at}]=x{output};"));
    let constants = if named.is_empty() { String::new() } else { format!("const {};\n", named.join(",\n")) };
    format!("const {{{}}}=given;\n{constants}{}\n", arrays.join(","), outputs.collect::<String>())
}

/// The functions of a program that no language has.
pub(super) fn own_functions(program: &Program) -> impl Iterator<Item = Function> {
    program.operations.iter().filter_map(|operation| match operation {
        Operation::Apply(function @ (Function::Stumpff(_) | Function::LogRatio(_)), _) => Some(*function),
        _ => None,
    })
}
