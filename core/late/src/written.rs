//! Programs as text: the straight-line code in Rust, and a whole step in C.

use std::fmt::Write as _;

use liestep::__private::{log_ratio_series, stumpff_series};
use liestep_derivation::whole::{MatrixFactor, WholeStep};
use liestep_derivation::{Array, Function, Operation, Program};

use crate::declaration::Declaration;
use crate::emitted::{Emitted, emitted, name};
use crate::error::LateError;

/// A language, as far as its straight-line code differs from another's.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Language {
    Rust,
    C,
}

impl Language {
    fn applied(self, function: Function, value: u32) -> String {
        let name = match function {
            Function::Sqrt => "sqrt",
            Function::Ln if self == Self::C => "log",
            Function::Ln => "ln",
            Function::Exp => "exp",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Stumpff(k) if self == Self::Rust => return format!("stumpff::<_, {k}>(x{value})"),
            Function::LogRatio(k) if self == Self::Rust => return format!("log_ratio::<_, {k}>(x{value})"),
            Function::Stumpff(k) => return format!("stumpff({k}, stumpff_{k}, x{value})"),
            Function::LogRatio(k) => return format!("log_ratio({k}, log_ratio_{k}, x{value})"),
        };
        if self == Self::C { format!("{name}(x{value})") } else { format!("x{value}.{name}()") }
    }

    /// The statements of a program, one a line.
    fn body(self, program: &Program) -> String {
        let declared = if self == Self::C { "const double" } else { "let" };
        let values = program.inputs.iter().map(|source| match (self, source.array) {
            (Self::Rust, Array::Step) => "h".to_owned(),
            (Self::C, Array::Step) => "in->h".to_owned(),
            (Self::Rust, array) => format!("{}[{}]", name(array), source.at),
            (Self::C, array) => format!("in->{}[{}]", name(array), source.at),
        });
        let literals = program.literals.iter().map(|literal| format!("{literal:?}"));
        let operations = program.operations.iter().map(|&operation| match operation {
            Operation::Negate(a) => format!("-x{a}"),
            Operation::Add(a, b) => format!("x{a} + x{b}"),
            Operation::Subtract(a, b) => format!("x{a} - x{b}"),
            Operation::Multiply(a, b) => format!("x{a} * x{b}"),
            Operation::Divide(a, b) => format!("x{a} / x{b}"),
            Operation::Apply(function, a) => self.applied(function, a),
        });
        let mut text = String::new();
        for (at, value) in values.chain(literals).chain(operations).enumerate() {
            let _ = writeln!(text, "    {declared} x{at} = {value};");
        }
        for (at, output) in program.outputs.iter().enumerate() {
            let _ = writeln!(text, "    outputs[{at}] = x{output};");
        }
        text
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
#[must_use]
pub fn rust(declaration: &Declaration) -> String {
    let mut text = format!("//! The stages of a step of `{}`.\n", declaration.name);
    if stages(declaration).iter().any(|(_, program)| own_functions(program).next().is_some()) {
        text += "\nuse liestep::__private::{log_ratio, stumpff};\n";
    }
    for (stage, program) in stages(declaration) {
        let parameter = |&array: &Array| match array {
            Array::Step => "h: f64".to_owned(),
            array => format!("{}: &[f64]", name(array)),
        };
        let parameters: Vec<String> = arrays(program).iter().map(parameter).collect();
        let (count, body) = (program.outputs.len(), Language::Rust.body(program));
        let _ = write!(
            text,
            "\npub fn {stage}({}) -> [f64; {count}] {{\n    let mut outputs = [0.0; {count}];\n{body}    outputs\n}}\n",
            parameters.join(", ")
        );
    }
    text
}

/// The functions of a program that no language has.
fn own_functions(program: &Program) -> impl Iterator<Item = Function> {
    program.operations.iter().filter_map(|operation| match operation {
        Operation::Apply(function @ (Function::Stumpff(_) | Function::LogRatio(_)), _) => Some(*function),
        _ => None,
    })
}

/// The functions of the exponential and the logarithm in C, those that the programs have, with the coefficients of their series.
fn functions_in_c(programs: &Emitted) -> String {
    let programs = programs.iter().filter_map(|(_, program)| program.as_ref());
    let mut used: Vec<Function> = programs.flat_map(own_functions).collect();
    used.sort_unstable();
    used.dedup();
    if used.is_empty() {
        return String::new();
    }
    let of = |is: fn(&Function) -> bool, text| if used.iter().any(is) { text } else { "" };
    let mut text = [
        POLYNOMIAL,
        of(|function| matches!(function, Function::Stumpff(_)), STUMPFF),
        of(|function| matches!(function, Function::LogRatio(_)), LOG_RATIO),
    ]
    .concat();
    for function in used {
        let (name, k, series) = match function {
            Function::Stumpff(k) => ("stumpff", k, stumpff_series(k.into())),
            Function::LogRatio(k) => ("log_ratio", k, log_ratio_series(k.into())),
            _ => continue,
        };
        let series: Vec<String> = series.iter().map(|coefficient| format!("{coefficient:?}")).collect();
        let _ = write!(text, "\nstatic const double {name}_{k}[] = {{{}}};\n", series.join(", "));
    }
    text + "\n"
}

/// A step as C99 that needs nothing but `math.h`, on any group: with `-ffp-contract=off` it has the bits of the whole step by
/// interpretation. A step that takes special care is refused in C: it returns 0 and changes nothing. A step that is self-adjoint
/// has a function for symmetric compositions of it, too.
///
/// # Errors
///
/// [`LateError::Step`]: there is no step as programs, as of a force alone.
pub fn c(declaration: &Declaration) -> Result<String, LateError> {
    let step = WholeStep::of(declaration)?;
    let (declared, composition) = if declaration.is_self_adjoint { (COMPOSED, COMPOSITION) } else { ("", "") };
    let text = HEAD.replace("NAME", &declaration.name).replace("GROUP", &declaration.group());
    let mut text = text.replace("COMPOSED", declared);
    let mut first = 0;
    for parameter in &declaration.parameters {
        let length = parameter.kind.len();
        let _ = writeln!(text, "   parameters[{first}..{}]: {}", first + length, parameter.name);
        first += length;
    }
    let (sizes, mut programs) = (&step.sizes, emitted(&step));
    // The system for a solve with care, which a step in C doesn't have.
    programs.retain(|(name, _)| *name != "newton");
    let outputs = |name| {
        programs
            .iter()
            .find(|one| one.0 == name)
            .and_then(|one| one.1.as_ref())
            .map_or(0, |program| program.outputs.len())
    };
    let constants = [
        ("PARAMETERS", first.max(1)),
        ("CONSTANTS", outputs("constants").max(1)),
        ("ENTRIES", sizes.entries),
        ("N", sizes.n),
        ("CARRIED", sizes.carried),
        ("ADVECTED", sizes.carried.max(1)),
        ("DETS", sizes.dets),
        ("NEAR", sizes.near),
        ("ATTITUDES", sizes.attitudes),
        ("RESTORED", outputs("restored").max(1)),
        ("IS_WHOLE", usize::from(step.factors.len() == 1)),
        ("VARIES", usize::from(step.programs.safe.is_some())),
    ];
    let constants: Vec<String> = constants.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let _ = writeln!(text, "*/\n#include <math.h>\n\nenum {{\n    {}\n}};\n", constants.join(",\n    "));
    let arrays: Vec<String> =
        Array::ALL.iter().filter(|&&array| array != Array::Step).map(|&array| format!("*{}", name(array))).collect();
    let _ = writeln!(text, "typedef struct {{\n    double h;\n    const double {};\n}} Inputs;\n", arrays.join(", "));
    text += &functions_in_c(&programs);
    for (name, program) in &programs {
        let body = program.as_ref().map_or(String::new(), |program| Language::C.body(program));
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
    let step = STEP
        .replace("IDENTITY", &identity.collect::<Vec<_>>().join("\n    "))
        .replace("RESTORED_PLACES", &listed(|factor| factor.entry))
        .replace("RESTORED_ENTRIES", &listed(|factor| factor.size() * factor.size()));
    Ok(text + &step + composition)
}

const HEAD: &str = include_str!("head.c");
const POLYNOMIAL: &str = include_str!("polynomial.c");
const STUMPFF: &str = include_str!("stumpff.c");
const LOG_RATIO: &str = include_str!("log_ratio.c");
const STEP: &str = include_str!("step.c");
const COMPOSITION: &str = include_str!("composition.c");
const COMPOSED: &str = "   int liestep_compose(const Stepper *stages, const double *gamma, int count, State *);
                        a step h of a symmetric composition: `stages[k]` is made for gamma[k] h, and a start with the first
";
