//! A whole step in C99, and in the text that C99, `OpenCL` C and CUDA share.
//!
//! In the templates `$name` and `@NAME` have the declaration's name in front, so that the texts of several declarations may
//! stand in one unit.

use std::fmt::Write as _;

use liestep_derivation::Array;

use super::language::Language;
use super::parts::{Parts, Sums};
use crate::declaration::Declaration;
use crate::error::LateError;
use crate::whole::Whole;

/// A dialect of C, as far as its text differs from another's.
struct Dialect {
    /// The inclusion of functions of mathematics.
    mathematics: &'static str,
    /// Words before a function of the text, and before one that others call.
    functions: [&'static str; 2],
    /// Words before a table of constants, and the type of a pointer to it.
    tables: [&'static str; 2],
    /// The type of a number of steps.
    count: &'static str,
}

const C99: Dialect = Dialect {
    mathematics: "#include <math.h>\n",
    functions: ["static", ""],
    tables: ["static const", "const double *"],
    count: "unsigned long long",
};

const DEVICE: Dialect = Dialect {
    mathematics: include_str!("gpu/head.c"),
    functions: ["LIESTEP_FUNCTION", "LIESTEP_FUNCTION "],
    tables: ["LIESTEP_TABLE", "LIESTEP_POINTER "],
    count: "liestep_count",
};

impl Dialect {
    /// A template in this dialect, with the declaration's name in front of its own names.
    fn text(&self, template: &str, parts: &Parts<'_>) -> String {
        let prefix = prefix(parts.declaration);
        lines(template, parts.sums)
            .replace("FUNCTION ", &format!("{} ", self.functions[0]))
            .replace("EXPORTED ", self.functions[1])
            .replace("TABLE ", &format!("{} ", self.tables[0]))
            .replace("POINTER ", self.tables[1])
            .replace("COUNT ", &format!("{} ", self.count))
            .replace('$', &format!("{prefix}_"))
            .replace('@', &format!("{}_", prefix.to_uppercase()))
            .replace("MATHEMATICS\n", self.mathematics)
    }
}

/// The lines of a template for sums of this kind. Lines of one kind alone have a word in front.
fn lines(template: &str, sums: Sums) -> String {
    let (own, others) = match sums {
        Sums::Rounded => ("PLAIN ", "COMPENSATED "),
        Sums::Compensated => ("COMPENSATED ", "PLAIN "),
    };
    let lines = template.split_inclusive('\n').filter(|line| !line.starts_with(others));
    lines.map(|line| line.strip_prefix(own).unwrap_or(line)).collect()
}

/// The words of a declaration's name in small letters: `heavy`, `top` of `HeavyTop`.
pub(super) fn words(declaration: &Declaration) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for letter in declaration.name.chars() {
        let begins = letter.is_ascii_uppercase() && !before.is_ascii_uppercase() || !before.is_ascii_alphanumeric();
        if begins && words.last().is_some_and(|word| !word.is_empty()) {
            words.push(String::new());
        }
        if letter.is_ascii_alphanumeric() {
            words.iter_mut().last().into_iter().for_each(|word| word.push(letter.to_ascii_lowercase()));
        }
        before = letter;
    }
    words
}

/// The name in front of all names of a declaration's text in C, `heavy_top` of `HeavyTop`.
#[must_use]
pub fn prefix(declaration: &Declaration) -> String {
    let words = words(declaration).join("_");
    // Letters of other alphabets are left out, which may leave nothing, or a digit in front.
    if words.starts_with(|letter: char| letter.is_ascii_lowercase()) { words } else { format!("step_{words}") }
}

/// A step as C99 that needs nothing but `math.h`, on any group: with `-ffp-contract=off` it has the bits of the whole step by
/// interpretation. A step that takes special care is refused in C: it returns 0 and changes nothing. A step that is self-adjoint
/// has a function for symmetric compositions of it, too; a continuous limit that is quadratic has the energy and the velocity of
/// a momentum. With compensated sums its bits are those of the method `step, compensated`. All names begin with the [`prefix`].
///
/// # Errors
///
/// [`LateError::Step`]: there is no step as programs, as of a force alone; [`LateError::Compensated`].
pub fn c(declaration: &Declaration, sums: Sums) -> Result<String, LateError> {
    Ok(written(&Parts::of(declaration, sums)?, &C99))
}

/// The part of [`c`] that a unit includes to call the step of another.
///
/// # Errors
///
/// The errors of [`c`].
pub fn header(declaration: &Declaration, sums: Sums) -> Result<String, LateError> {
    let parts = Parts::of(declaration, sums)?;
    let (head, _) = HEAD.split_once("#ifndef @ITERATIONS").unwrap_or((HEAD, ""));
    Ok(C99.text(&filled(&parts, head), &parts))
}

/// The texts that follow [`header`] and [`c`] where the numbers are known: the stepper of each stage as a constant, which needs no
/// memory that is written, and functions for the start, at an attitude with a momentum and the velocity that it determines, and
/// for a step.
///
/// # Errors
///
/// The errors of [`c`].
pub fn numbered(whole: &Whole, start: [&[f64]; 3], sums: Sums) -> Result<[String; 2], LateError> {
    let parts = Parts::of(whole.declaration(), sums)?;
    // A bound may be infinite.
    let number = |number: f64| if number.is_finite() { format!("{number:?}") } else { "INFINITY".to_owned() };
    let list = |numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(|one| number(*one)).collect();
        if numbers.is_empty() { "0.0".to_owned() } else { numbers.join(", ") }
    };
    let (mut steppers, mut gammas) = (Vec::new(), Vec::new());
    for (gamma, bounds, constants) in whole.stage_numbers() {
        steppers.push(format!(
            "{{{}, {{{}}}, {{{}}}}}",
            list(&bounds),
            list(whole.numbers()),
            list(&parts.constants(constants))
        ));
        gammas.push(gamma);
    }
    let [attitude, momentum, velocity] = start.map(list);
    let next = if gammas.len() == 1 { "$step($stages, state)" } else { "$compose($stages, $gamma, @STAGES, state)" };
    Ok([NUMBERED_HEAD, NUMBERED].map(|text| {
        let text = text.replace("STEPPERS", &steppers.join(",\n    ")).replace("GAMMAS", &list(&gammas));
        let text = text.replace("STAGE_COUNT", &gammas.len().to_string()).replace("NEXT", next);
        let text = text.replace("ATTITUDE", &attitude).replace("MOMENTUM", &momentum).replace("VELOCITY", &velocity);
        C99.text(&text, &parts)
    }))
}

/// A step of many members as one text in `OpenCL` C, CUDA and C99, with two kernels: the start and so many steps.
///
/// # Errors
///
/// The errors of [`c`].
pub fn gpu(declaration: &Declaration, sums: Sums) -> Result<String, LateError> {
    let parts = Parts::of(declaration, sums)?;
    Ok(written(&parts, &DEVICE) + &DEVICE.text(KERNELS, &parts))
}

/// The head of a text with everything that a declaration decides.
fn filled(parts: &Parts<'_>, head: &str) -> String {
    let declaration = parts.declaration;
    let (mut places, mut first) = (String::new(), 0);
    for parameter in &declaration.parameters {
        let length = parameter.kind.len();
        let _ = writeln!(places, "   parameters[{first}..{}]: {}", first + length, parameter.name);
        first += length;
    }
    let sizes: Vec<String> = parts.sizes().iter().map(|(name, size)| format!("@{name} = {size}")).collect();
    let inputs = Array::ALL.iter().filter(|&&array| array != Array::Step);
    let inputs: Vec<String> = inputs.map(|&array| format!("*{}", Language::C.array(array))).collect();
    let composed = if declaration.is_self_adjoint { [COMPOSED, COMPOSED_PROTOTYPE] } else { [""; 2] };
    let limited = if parts.has_limit() { [LIMITED, LIMITED_PROTOTYPES] } else { [""; 2] };
    head.replace("COMPOSED", composed[0])
        .replace("LIMITED", limited[0])
        .replace("SIZES", &sizes.join(",\n    "))
        .replace("PROTOTYPES\n", &[PROTOTYPES, composed[1], limited[1]].concat())
        .replace("INPUTS", &inputs.join(", "))
        .replace("NAME", &declaration.name)
        .replace("GROUP", &declaration.group())
        .replace("PARAMETER_PLACES\n", &places)
}

fn written(parts: &Parts<'_>, dialect: &Dialect) -> String {
    let mut text = filled(parts, HEAD);
    text += &series(parts);
    for (name, program) in parts.programs() {
        let body = program.map_or(String::new(), |program| Language::C.body(program));
        let _ = writeln!(
            text,
            "FUNCTION void ${name}(const $inputs *in, double *outputs) {{\n    (void)in, (void)outputs;\n{body}}}\n"
        );
    }
    let identity = parts.step.factors.iter().map(|factor| {
        let (first, rows) = (factor.entry, factor.size());
        format!("for (int i = 0; i < {rows}; i++) attitude[{first} + i * {}] = 1.0;", rows + 1)
    });
    let listed = |numbers: Vec<String>| numbers.iter().map(|one| format!("{one},")).collect::<Vec<_>>().join(" ");
    text += &STEP
        .replace("IDENTITY", &identity.collect::<Vec<_>>().join("\n    "))
        .replace("RESTORED_PLACES", &listed(parts.restored(|factor| factor.entry)))
        .replace("RESTORED_ENTRIES", &listed(parts.restored(|factor| factor.size() * factor.size())));
    if parts.declaration.is_self_adjoint {
        text += COMPOSITION;
    }
    if parts.has_limit() {
        text += LIMIT;
    }
    dialect.text(&text, parts)
}

/// The functions of the exponential and the logarithm, those that the programs have, with the coefficients of their series.
fn series(parts: &Parts<'_>) -> String {
    let series = parts.series();
    if series.is_empty() {
        return String::new();
    }
    let has = |function: &str| series.iter().any(|(name, ..)| *name == function);
    let of = |function: &str, text| if has(function) { text } else { "" };
    let mut text = [POLYNOMIAL, of("stumpff", STUMPFF), of("log_ratio", LOG_RATIO)].concat();
    for (name, k, coefficients) in series {
        let _ = write!(text, "\nTABLE double ${name}_{k}[] = {{{coefficients}}};\n");
    }
    text + "\n"
}

const HEAD: &str = include_str!("c/head.c");
const POLYNOMIAL: &str = include_str!("c/polynomial.c");
const STUMPFF: &str = include_str!("c/stumpff.c");
const LOG_RATIO: &str = include_str!("c/log_ratio.c");
const STEP: &str = include_str!("c/step.c");
const COMPOSITION: &str = include_str!("c/composition.c");
const LIMIT: &str = include_str!("c/limit.c");
const NUMBERED: &str = include_str!("c/numbered.c");
const NUMBERED_HEAD: &str = include_str!("c/numbered.h");
const KERNELS: &str = include_str!("gpu/kernels.c");
const COMPOSED: &str = "   int $compose(const $stepper *stages, const double *gamma, int count, $state *);
       a step h of a symmetric composition: `stages[k]` is made for gamma[k] h, and a start with the first
";
const LIMITED: &str =
    "   void $velocity(const $stepper *, const double *attitude, const double *momentum, double *velocity);
   void $momentum(const $stepper *, const double *attitude, const double *velocity, double *momentum);
       the velocity of a momentum, and the momentum of a velocity
   double $energy(const $stepper *, const $state *);
";
const PROTOTYPES: &str = "EXPORTED int $make($stepper *stepper, const double *parameters, double h);
EXPORTED void $start(const $stepper *stepper, $state *state, const double *attitude, const double *momentum, const double *velocity);
EXPORTED int $step(const $stepper *stepper, $state *state);
EXPORTED int $give($stepper *stepper, $state *state, const double *parameters);
EXPORTED double $defect(const $state *state);
";
const COMPOSED_PROTOTYPE: &str =
    "EXPORTED int $compose(const $stepper *stages, const double *gamma, int count, $state *state);\n";
const LIMITED_PROTOTYPES: &str =
    "EXPORTED void $velocity(const $stepper *stepper, const double *attitude, const double *momentum, double *velocity);
EXPORTED void $momentum(const $stepper *stepper, const double *attitude, const double *velocity, double *momentum);
EXPORTED double $energy(const $stepper *stepper, const $state *state);
";
