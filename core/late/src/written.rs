//! Programs as text: the straight-line code in Rust, and a whole step in C.

use std::fmt::Write as _;

use liestep_derivation::whole::{MatrixFactor, Programs, WholeStep};
use liestep_derivation::{Array, Function, Operation, Program};

use crate::declaration::Declaration;
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
            (Self::Rust, Array::Step) => "h".to_owned(),
            (Self::C, Array::Step) => "in->h".to_owned(),
            (Self::Rust, array) => format!("{}[{}]", name(array), source.at),
            (Self::C, array) => format!("in->{}[{}]", name(array), source.at),
        });
        let literals = program.literals.iter().map(|literal| format!("{literal:?}"));
        let operations = program.operations.iter().map(|&operation| {
            Ok::<_, LateError>(match operation {
                Operation::Negate(a) => format!("-x{a}"),
                Operation::Add(a, b) => format!("x{a} + x{b}"),
                Operation::Subtract(a, b) => format!("x{a} - x{b}"),
                Operation::Multiply(a, b) => format!("x{a} * x{b}"),
                Operation::Divide(a, b) => format!("x{a} / x{b}"),
                Operation::Apply(function, a) => self.applied(function, a)?,
            })
        });
        let mut text = String::new();
        for (at, value) in values.chain(literals).map(Ok).chain(operations).enumerate() {
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
        Array::Attitude => "attitude",
        Array::Momentum => "momentum",
        Array::History => "history",
        Array::Factors => "factors",
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

/// A step as C99 that needs nothing but `math.h`, on any group: with `-ffp-contract=off` it has the bits of the whole step by
/// interpretation. A step that takes special care is refused in C: it returns 0 and changes nothing.
///
/// # Errors
///
/// [`LateError::Step`]: there is no step as programs, as of a force alone; [`LateError::Function`]: it needs functions that C
/// doesn't have.
pub fn c(declaration: &Declaration) -> Result<String, LateError> {
    let step = WholeStep::of(declaration)?;
    let mut text = HEAD.replace("NAME", &declaration.name).replace("GROUP", &declaration.group());
    let mut first = 0;
    for parameter in &declaration.parameters {
        let length = parameter.kind.len();
        let _ = writeln!(text, "   parameters[{first}..{}]: {}", first + length, parameter.name);
        first += length;
    }
    let (sizes, programs) = (&step.sizes, &step.programs);
    let constants = [
        ("PARAMETERS", first.max(1)),
        ("CONSTANTS", programs.constants.outputs.len().max(1)),
        ("ENTRIES", sizes.entries),
        ("N", sizes.n),
        ("CARRIED", sizes.carried),
        ("ADVECTED", sizes.carried.max(1)),
        ("DETS", sizes.dets),
        ("NEAR", sizes.near),
        ("ATTITUDES", sizes.attitudes),
        ("RESTORED", programs.restored.outputs.len().max(1)),
        ("IS_WHOLE", usize::from(step.factors.len() == 1)),
        ("VARIES", usize::from(programs.safe.is_some())),
    ];
    let constants: Vec<String> = constants.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let _ = writeln!(text, "*/\n#include <math.h>\n\nenum {{\n    {}\n}};\n", constants.join(",\n    "));
    let arrays: Vec<String> =
        Array::ALL.iter().filter(|&&array| array != Array::Step).map(|&array| format!("*{}", name(array))).collect();
    let _ = writeln!(text, "typedef struct {{\n    double h;\n    const double {};\n}} Inputs;\n", arrays.join(", "));
    for (name, program) in functions(programs) {
        let body = program.map_or(Ok(String::new()), |program| Language::C.body(program))?;
        let _ = writeln!(
            text,
            "static void {name}(const Inputs *in, double *outputs) {{\n    (void)in, (void)outputs;\n{body}}}\n"
        );
    }
    let identity = step.factors.iter().map(|factor| {
        let (first, rows) = (factor.entry, factor.size());
        format!("for (int i = 0; i < {rows}; i++) attitude[{first} + i * {}] = 1.0;", rows + 1)
    });
    let listed = |number: fn(&MatrixFactor) -> usize| {
        let restored = step.factors.iter().filter(|factor| factor.is_restored());
        restored.map(|factor| format!("{},", number(factor))).collect::<Vec<_>>().join(" ")
    };
    text += &STEP
        .replace("IDENTITY", &identity.collect::<Vec<_>>().join("\n    "))
        .replace("RESTORED_PLACES", &listed(|factor| factor.entry))
        .replace("RESTORED_ENTRIES", &listed(|factor| factor.size() * factor.size()));
    Ok(text)
}

/// The programs that a step in C calls.
fn functions(programs: &Programs) -> [(&'static str, Option<&Program>); 10] {
    [
        ("constants", Some(&programs.constants)),
        ("target", Some(&programs.target)),
        ("iterate", Some(&programs.iterate)),
        ("again", Some(&programs.again)),
        ("finish", Some(&programs.finish)),
        ("safe", programs.safe.as_ref()),
        ("seen", Some(&programs.seen)),
        ("restored", Some(&programs.restored)),
        ("defect", Some(&programs.defect)),
        ("rest", Some(&programs.rest)),
    ]
}

const HEAD: &str = include_str!("head.c");
const STEP: &str = include_str!("step.c");
