//! The programs of a declaration with the directions of space for its advected parameters: whatever these are, they are seen
//! from the attitude, whose rows are the directions.

use super::StepRefusal;
use super::actions::at_attitude;
use super::matrix::Matrix;
use super::values::{Value, Words};
use super::writer::Writer;
use crate::staged::{Array, Program, Source, StagedDeclaration, Stages};

/// The programs of the stages, in which the arrays of what is advected have the entries of the attitude, row by row.
///
/// # Errors
///
/// The errors of [`WholeStep::of`](super::WholeStep::of).
pub fn in_directions(staged: &StagedDeclaration) -> Result<Stages<Program>, StepRefusal> {
    let writer = Writer::of(staged)?;
    staged.programs.try_map(|program| Ok(writer.in_directions(program)))
}

impl Writer<'_> {
    fn in_directions(&self, program: &Program) -> Program {
        let mut words = Words::default();
        let is_read = |array| program.inputs.iter().any(|source| source.array == array);
        let mut seen = |array| if is_read(array) { self.seen_from(&mut words, array) } else { Vec::new() };
        let (before, after) = (seen(Array::Advected), seen(Array::Next));
        let outputs = words.append(program, |source: Source| match source.array {
            Array::Advected => before[source.at],
            Array::Next => after[source.at],
            _ => Value::Input(source),
        });
        words.program(&outputs)
    }

    /// The advected parameters, seen from the attitude in an array.
    fn seen_from(&self, words: &mut Words, array: Array) -> Vec<Value> {
        let g: Vec<Matrix> = self.factors.iter().map(|factor| factor.read(array)).collect();
        let mut all = Vec::new();
        for (at, one) in self.staged.carried.iter().enumerate() {
            let inverse = &|words: &mut Words, k: usize| self.factors[k].inverse(words, &g[k]);
            all.extend(at_attitude(words, one.action, &self.in_space(at), &g, inverse).entries);
        }
        all
    }
}
