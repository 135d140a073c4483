//! Programs as text: the straight-line code in Rust, and a whole step in C.

use std::fmt::Write as _;

use liestep_derivation::{Action, Array, Function, Operation, Program};

use crate::declaration::{Declaration, InSpace};
use crate::error::LateError;

/// A language, as far as its straight-line code differs from another's.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Language {
    Rust,
    C,
}

impl Language {
    fn applied(self, function: Function, value: u32) -> Result<String, LateError> {
        let name = match function {
            Function::Sqrt => "sqrt",
            Function::Ln if self == Self::C => "log",
            Function::Ln => "ln",
            Function::Exp => "exp",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Stumpff(k) if self == Self::Rust => return Ok(format!("stumpff::<_, {k}>(x{value})")),
            Function::LogRatio(k) if self == Self::Rust => return Ok(format!("log_ratio::<_, {k}>(x{value})")),
            other => return Err(LateError::Function(format!("{other:?} in C"))),
        };
        Ok(if self == Self::C { format!("{name}(x{value})") } else { format!("x{value}.{name}()") })
    }

    /// The statements of a program, one a line.
    fn body(self, program: &Program) -> Result<String, LateError> {
        let declared = if self == Self::C { "const double" } else { "let" };
        let values = program.inputs.iter().map(|source| match (self, source.array) {
            (_, Array::Step) => Ok("h".to_owned()),
            (_, array) => Ok(format!("{}[{}]", name(array), source.at)),
        });
        let literals = program.literals.iter().map(|literal| Ok(format!("{literal:?}")));
        let operations = program.operations.iter().map(|&operation| {
            Ok(match operation {
                Operation::Negate(a) => format!("-x{a}"),
                Operation::Add(a, b) => format!("x{a} + x{b}"),
                Operation::Subtract(a, b) => format!("x{a} - x{b}"),
                Operation::Multiply(a, b) => format!("x{a} * x{b}"),
                Operation::Divide(a, b) => format!("x{a} / x{b}"),
                Operation::Apply(function, a) => self.applied(function, a)?,
            })
        });
        let mut text = String::new();
        for (at, value) in values.chain(literals).chain(operations).enumerate() {
            let _ = writeln!(text, "    {declared} x{at} = {};", value?);
        }
        for (at, output) in program.outputs.iter().enumerate() {
            let _ = writeln!(text, "    outputs[{at}] = x{output};");
        }
        Ok(text)
    }
}

const fn name(array: Array) -> &'static str {
    match array {
        Array::Step => "h",
        Array::Parameters => "parameters",
        Array::Constants => "constants",
        Array::Advected => "advected",
        Array::Next => "next",
        Array::Element => "element",
        Array::Increment => "increment",
        Array::Inverse => "inverse",
        Array::InverseIncrement => "inverse_increment",
        Array::Half => "half",
        Array::Velocity => "velocity",
        Array::Target => "target",
    }
}

fn arrays(program: &Program) -> Vec<Array> {
    let mut arrays: Vec<Array> = program.inputs.iter().map(|source| source.array).collect();
    arrays.sort_unstable();
    arrays.dedup();
    arrays
}

fn stages(declaration: &Declaration) -> [(&'static str, &Program); 5] {
    let programs = &declaration.programs;
    [
        ("constants", &programs.constants),
        ("kick_before", &programs.kick_before),
        ("newton_system", &programs.newton_system),
        ("newton_residual", &programs.newton_residual),
        ("kick_after", &programs.kick_after),
    ]
}

/// The straight-line code of a step in Rust, as the macro passes it to the compiler: a function for each stage. Each
/// iteration has what the macro computes before a solve.
///
/// # Errors
///
/// None for Rust; the type is that of [`c`].
pub fn rust(declaration: &Declaration) -> Result<String, LateError> {
    let mut text = format!("//! The stages of a step of `{}`.\n", declaration.name);
    if stages(declaration).iter().any(|(_, program)| has_own_functions(program)) {
        text += "\nuse liestep::__private::{log_ratio, stumpff};\n";
    }
    for (stage, program) in stages(declaration) {
        let parameter = |&array: &Array| match array {
            Array::Step => "h: f64".to_owned(),
            array => format!("{}: &[f64]", name(array)),
        };
        let parameters: Vec<String> = arrays(program).iter().map(parameter).collect();
        let (count, body) = (program.outputs.len(), Language::Rust.body(program)?);
        let _ = write!(
            text,
            "\npub fn {stage}({}) -> [f64; {count}] {{\n    let mut outputs = [0.0; {count}];\n{body}    outputs\n}}\n",
            parameters.join(", ")
        );
    }
    Ok(text)
}

fn has_own_functions(program: &Program) -> bool {
    let is_own =
        |operation: &Operation| matches!(operation, Operation::Apply(Function::Stumpff(_) | Function::LogRatio(_), _));
    program.operations.iter().any(is_own)
}

/// A step on SO(3) as C99 that needs nothing but `math.h`: with `-ffp-contract=off` it has the bits of the library's
/// step. A step that takes the library's special care is refused in C: it returns 0 and changes nothing.
///
/// # Errors
///
/// [`LateError::C`]: the declaration is a force, on another group, advects other things than covectors, or has no
/// kinetic part; [`LateError::Function`]: it needs functions that C doesn't have.
pub fn c(declaration: &Declaration) -> Result<String, LateError> {
    let is_so3 = declaration.group() == "SO3" && !declaration.in_increment;
    let moves_simply = |action| matches!(action, Action::Covector(_) | Action::Given);
    if !is_so3 || !declaration.carried.iter().all(|carried| moves_simply(carried.action)) {
        return Err(LateError::C("a step is written in C on `SO3`, with vectors that are advected or given"));
    }
    if !declaration.has_kinetic {
        return Err(LateError::C("a step is written in C of a Lagrangian with a kinetic part"));
    }
    let mut text = HEAD.replace("NAME", &declaration.name);
    let parameters = declaration.parameters.iter().map(|parameter| (parameter.name.as_str(), parameter.kind.len()));
    let mut first = 0;
    for (name, length) in parameters {
        let _ = writeln!(text, "   parameters[{first}..{}]: {name}", first + length);
        first += length;
    }
    let carried: usize = declaration.carried.iter().map(|carried| carried.shape.0 * carried.shape.1).sum();
    let constants = declaration.programs.constants.outputs.len().max(1);
    let _ = writeln!(text, "*/\n#include <math.h>\n");
    let _ =
        writeln!(text, "enum {{ PARAMETERS = {first}, CONSTANTS = {constants}, ADVECTED = {} }};\n", carried.max(1));
    for (stage, program) in stages(declaration) {
        let parameter = |array: &Array| match array {
            Array::Step => "double h".to_owned(),
            array => format!("const double *{}", name(*array)),
        };
        let of_stage: &[Array] = match stage {
            "constants" => &[Array::Step, Array::Parameters],
            "kick_before" => &[Array::Constants, Array::Advected],
            "kick_after" => &[Array::Constants, Array::Increment, Array::Next],
            _ => &[Array::Constants, Array::Half, Array::Target, Array::Advected],
        };
        if arrays(program).iter().any(|array| !of_stage.contains(array)) {
            return Err(LateError::C("a step is written in C where it needs no inverse of the increment"));
        }
        let list: Vec<String> = of_stage.iter().map(parameter).collect();
        let unused = of_stage.iter().fold(String::new(), |text, &array| text + "    (void)" + name(array) + ";\n");
        let body = Language::C.body(program)?;
        let _ = writeln!(text, "static void {stage}({}, double *outputs) {{\n{unused}{body}}}\n", list.join(", "));
    }
    let mut places = (String::new(), String::new());
    let mut at = 0;
    for (carried, value) in declaration.in_space() {
        let length = carried.shape.0 * carried.shape.1;
        let value = match value {
            InSpace::Parameter(field) => format!("parameters[{} + i]", declaration.place(field).0),
            InSpace::Direction(number) => format!("i == {number}"),
            InSpace::Identity => format!("i / {0} == i % {0}", carried.shape.0),
        };
        let _ = writeln!(places.0, "    for (int i = 0; i < {length}; i++) spatial[{at} + i] = {value};");
        if matches!(carried.action, Action::Covector(_)) {
            let _ = writeln!(places.1, "    turned(matrix, from + {at}, to + {at}, is_change);");
        } else {
            let _ = writeln!(places.1, "    for (int i = 0; i < {length}; i++) to[{at} + i] = from[{at} + i];");
        }
        at += length;
    }
    let parts = declaration.parts;
    let [before, after] = [parts.kick_before, parts.kick_after].map(|is_there| u8::from(is_there).to_string());
    let step = STEP.replace("SPATIAL_VALUES", &places.0).replace("TURNED_VALUES", &places.1);
    text += &step.replace("HAS_KICK_BEFORE", &before).replace("HAS_KICK_AFTER", &after);
    Ok(text)
}

const HEAD: &str = include_str!("head.c");
const STEP: &str = include_str!("step.c");
