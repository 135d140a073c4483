//! Programs as functions of arrays.

use cranelift_codegen::ir::{InstBuilder as _, Type, types};
use cranelift_frontend::FunctionBuilder;
use liestep_late::{Array, Program, Source};

use crate::function::{Literals, code, flags, offset};
use crate::operation::Callee;
use crate::piece::Piece;
use crate::registers::{Frame, Registers};

/// The machine code of a program as a function of its constants, of the arrays of its other inputs and of the array of its
/// outputs: for one number at each place, or for two of several lanes.
pub(crate) fn program(program: &Program, lanes: usize) -> Result<(Vec<u8>, Literals), String> {
    let repeated: Vec<f64> = program.literals.iter().flat_map(|&one| vec![one; lanes.min(2)]).collect();
    let literals = Literals::of(&repeated);
    let code = code(3, None, |builder, pointer, callee| write(builder, (program, lanes), &literals, pointer, callee))?;
    Ok((code, literals))
}

fn write(
    builder: &mut FunctionBuilder,
    (program, lanes): (&Program, usize),
    literals: &Literals,
    pointer: Type,
    callee: &Callee,
) -> Result<(), String> {
    let block = builder.current_block().ok_or("no block")?;
    let [constants, arrays, outputs] = [0, 1, 2].map(|at| builder.block_params(block)[at]);
    let mut begins = [constants; Array::COUNT];
    for array in given(&least(program)) {
        let place = offset(array as usize, 1)?;
        begins[array as usize] = builder.ins().load(pointer, flags().with_readonly(), arrays, place);
    }
    let literals = literals.start(builder, pointer);
    let mut piece = Piece::default();
    let input =
        |piece: &mut Piece, source: Source| Ok(piece.given((begins[source.array as usize], offset(source.at, lanes)?)));
    let values = piece.append(program, input, |at, _| Ok((literals, offset(at, lanes.min(2))?)))?;
    // A caller loads a vector, and the Jacobian after it, two numbers at a time: it would wait for stores of another width.
    let (count, size) = (values.len(), values.len().isqrt());
    let vector = if size * (size + 1) == count { size } else { count };
    let most = if lanes > 1 { 1 } else { 2 };
    let mut at = 0;
    while at < count {
        let end = if at < vector { vector } else { count }.min(at + most);
        values[at..end].iter().for_each(|&value| piece.need_up_to(value));
        piece.store(values[at], (end - at > 1).then(|| values[end - 1]), (outputs, offset(at, lanes)?));
        at = end;
    }
    piece.stop();
    let number = if lanes > 1 { types::F64X2 } else { types::F64 };
    let frame = Frame::new(builder, pointer, 0);
    let mut writing = piece.begin(|places, reads| Registers::new(number, flags(), (frame, 0), places, reads))?;
    writing.write(builder, callee)?;
    builder.ins().return_(&[]);
    frame.check(builder)
}

/// The least length of each array that a program reads.
pub(crate) fn least(program: &Program) -> [usize; Array::COUNT] {
    let mut least = [0; Array::COUNT];
    for source in &program.inputs {
        let count = &mut least[source.array as usize];
        *count = source.at.saturating_add(1).max(*count);
    }
    least
}

/// The arrays that a call has to pass: all that are read, except constants.
pub(crate) fn given(least: &[usize; Array::COUNT]) -> impl Iterator<Item = Array> {
    Array::ALL.into_iter().filter(|&array| array != Array::Constants && least[array as usize] > 0)
}
