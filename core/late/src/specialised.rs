//! Programs with all numbers known.

use liestep_derivation::whole::{Value, Words};
use liestep_derivation::{Array, Program, Source, Stages};

use crate::code::applied;

/// The programs of a step with these constants, those of the parameters and `h`, as literals: products with zero and
/// one, sums with zero and equal operations are removed, and divisions by a number are products. The bits may differ
/// from those of the general programs by rounding.
#[must_use]
pub fn specialised(programs: &Stages<Program>, constants: &[f64]) -> Stages<Program> {
    let of_input = |source: Source| match constants.get(source.at) {
        Some(&number) if source.array == Array::Constants => Value::of(number),
        _ => Value::Input(source),
    };
    let Ok(folded) = programs.try_map(|program| {
        let mut words = Words::rounded(applied::<f64>);
        let outputs = words.append(program, of_input);
        Ok::<_, std::convert::Infallible>(words.program(&outputs))
    });
    folded
}
