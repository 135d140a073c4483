//! A whole step in JavaScript.

use std::fmt::Write as _;

use liestep_derivation::{Function, Operation};

use super::c::words;
use super::language::Language;
use super::parts::{Parts, Sums};
use crate::declaration::Declaration;
use crate::error::LateError;

/// A step in JavaScript, with the functions of [`c`](super::c()): one constant, `heavyTopStep` of `HeavyTop`, which is also what
/// a module exports. The text loads nothing. A step without sine, cosine, exponential and logarithm, which are those of the
/// engine, has the bits of the library, and the first line of the text says so.
///
/// # Errors
///
/// [`LateError::Step`]: there is no step as programs, as of a force alone.
pub fn javascript(declaration: &Declaration) -> Result<String, LateError> {
    let parts = Parts::of(declaration, Sums::Rounded)?;
    let bits = if has_functions_of_the_engine(&parts) { "not to the bit" } else { "to the bit" };
    let name = constant(declaration);
    let mut text =
        format!("// A step of {} on {}, {bits} that of the library.\n", declaration.name, declaration.group());
    let sizes: Vec<String> = parts.sizes().iter().map(|(name, size)| format!("{name} = {size}")).collect();
    let _ = write!(text, "const {name} = (() => {{\n\"use strict\";\nconst {};\n", sizes.join(", "));
    let series = parts.series();
    if !series.is_empty() {
        text += FUNCTIONS;
    }
    for (name, k, coefficients) in series {
        let _ = writeln!(text, "const {name}_{k} = [{coefficients}];");
    }
    for (name, program) in parts.programs() {
        let body = program.map_or(String::new(), |program| Language::JavaScript.body(program));
        let _ = write!(text, "function {name}(given, to) {{\n{body}}}\n");
    }
    let matrices = parts.step.factors.iter().map(|factor| format!("[{}, {}]", factor.entry, factor.size()));
    text += &STEP
        .replace("OF_MATRICES", &matrices.collect::<Vec<_>>().join(", "))
        .replace("OF_PLACES", &parts.restored(|factor| factor.entry).join(", "))
        .replace("OF_SIZES", &parts.restored(|factor| factor.size() * factor.size()).join(", "));
    let mut exported = vec!["make", "start", "step", "give", "copy", "defect"];
    if declaration.is_self_adjoint {
        text += COMPOSITION;
        exported.push("compose");
    }
    if parts.has_limit() {
        text += LIMIT;
        exported.extend(["velocity", "momentum", "energy"]);
    }
    let _ = write!(
        text,
        "\nreturn {{ {} }};\n}})();\nif (typeof module !== \"undefined\") module.exports = {name};\n",
        exported.join(", ")
    );
    Ok(text)
}

/// Whether a step has the library's bits in every language: without sines, cosines, exponentials and logarithms, whose last bit
/// is the engine's or the device's.
///
/// # Errors
///
/// The errors of [`c`](super::c()).
pub fn is_exact(declaration: &Declaration) -> Result<bool, LateError> {
    Ok(!has_functions_of_the_engine(&Parts::of(declaration, Sums::Rounded)?))
}

/// The name of the constant of a declaration's step in JavaScript, `heavyTopStep` of `HeavyTop`: no word of the language.
#[must_use]
pub fn constant(declaration: &Declaration) -> String {
    let mut name = String::new();
    for (at, word) in words(declaration).iter().chain([&"step".to_owned()]).enumerate() {
        let (first, rest) = word.split_at(word.len().min(1));
        name += &if at == 0 { first.to_owned() } else { first.to_uppercase() };
        name += rest;
    }
    if name.starts_with(|letter: char| letter.is_ascii_digit()) { format!("the{name}") } else { name }
}

/// Whether a step has functions whose last bit an engine is free to choose.
fn has_functions_of_the_engine(parts: &Parts<'_>) -> bool {
    let programs = parts.programs();
    let mut operations = programs.filter_map(|(_, program)| program).flat_map(|program| &program.operations);
    operations.any(|operation| matches!(operation, Operation::Apply(function, _) if *function != Function::Sqrt))
}

const FUNCTIONS: &str = include_str!("javascript/functions.js");
const STEP: &str = include_str!("javascript/step.js");
const COMPOSITION: &str = include_str!("javascript/composition.js");
const LIMIT: &str = include_str!("javascript/limit.js");
