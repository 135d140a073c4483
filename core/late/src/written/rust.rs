//! The stages of a step in Rust.

use std::fmt::Write as _;

use liestep_derivation::{Array, Program};

use super::language::{Language, own_functions};
use crate::declaration::Declaration;

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
            array => format!("{}: &[f64]", Language::Rust.array(array)),
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
