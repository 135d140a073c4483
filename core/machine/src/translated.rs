//! Programs as code of Cranelift, operation by operation.

use std::sync::LazyLock;

use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::{AbiParam, InstBuilder as _, MemFlagsData, SigRef, Signature, Type, Value, types};
use cranelift_codegen::isa::{OwnedTargetIsa, TargetIsa};
use cranelift_codegen::settings::{self, Configurable as _};
use cranelift_codegen::{CompiledCode, Context};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use liestep_late::{Array, Function, Operation, Program, applied};

use crate::piece::Piece;
use crate::registers::{Frame, Registers};

/// The instruction set of this machine.
pub(crate) fn isa() -> Result<OwnedTargetIsa, String> {
    static ISA: LazyLock<Result<OwnedTargetIsa, String>> = LazyLock::new(|| {
        let mut flags = settings::builder();
        // The program is optimised already, and `Registers` allocates registers. A frame of more than a page touches each
        // of its pages in order, so that one too large for the stack ends at the guard page.
        let options = [("opt_level", "none"), ("enable_verifier", "false")];
        for (name, value) in
            options.into_iter().chain([("enable_probestack", "true"), ("probestack_strategy", "inline")])
        {
            flags.set(name, value).map_err(|error| error.to_string())?;
        }
        cranelift_native::builder()?.finish(settings::Flags::new(flags)).map_err(|error| error.to_string())
    });
    ISA.clone()
}

/// Numbers in memory, at the alignment of two.
#[derive(Debug)]
pub(crate) struct Literals(#[allow(dead_code)] Box<[Pair]>);

#[derive(Debug)]
#[repr(C, align(16))]
struct Pair([f64; 2]);

impl Literals {
    pub(crate) fn of(numbers: &[f64]) -> Self {
        Self(numbers.chunks(2).map(|pair| Pair([pair[0], pair.get(1).copied().unwrap_or(0.0)])).collect())
    }

    /// The address of the first.
    pub(crate) fn start(&self, builder: &mut FunctionBuilder, pointer: Type) -> Value {
        builder.ins().iconst(pointer, address(self.0.as_ptr()))
    }
}

fn address<T>(pointer: *const T) -> i64 {
    pointer.expose_provenance().cast_signed() as i64
}

/// The function of [`function`], as code calls it.
pub(crate) struct Callee {
    signature: SigRef,
    pointer: Type,
}

/// The machine code of a function of pointers, which may return an integer.
pub(crate) fn code(
    pointers: usize,
    returned: Option<Type>,
    write: impl FnOnce(&mut FunctionBuilder, Type, &Callee) -> Result<(), String>,
) -> Result<Vec<u8>, String> {
    let isa = isa()?;
    let (pointer, convention) = (isa.pointer_type(), isa.default_call_conv());
    let mut own = Context::new();
    own.func.signature.call_conv = convention;
    own.func.signature.params.extend((0..pointers).map(|_| AbiParam::new(pointer)));
    own.func.signature.returns.extend(returned.map(AbiParam::new));
    let mut context = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut own.func, &mut context);
    let mut signature = Signature::new(convention);
    signature.params.extend([AbiParam::new(types::I32), AbiParam::new(types::F64)]);
    signature.returns.push(AbiParam::new(types::F64));
    let callee = Callee { signature: builder.import_signature(signature), pointer };
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    write(&mut builder, pointer, &callee)?;
    builder.seal_all_blocks();
    builder.finalize(isa.frontend_config());
    let code = compiled(&mut own, &*isa)?;
    if !code.buffer.relocs().is_empty() {
        return Err("code has addresses to be filled in".to_owned());
    }
    Ok(code.code_buffer().to_vec())
}

/// The machine code of a function, without the passes that [`Context::compile`] runs before: one would remove the block
/// parameters that [`Registers`] adds.
fn compiled(context: &mut Context, isa: &dyn TargetIsa) -> Result<CompiledCode, String> {
    context.compute_cfg();
    context.compute_domtree();
    let (function, registers) = (&context.func, &mut regalloc2::Ctx::default());
    let code = isa.compile_function(function, &context.domtree, registers, false, &mut ControlPlane::default());
    Ok(code.map_err(|error| error.to_string())?.apply_params(&function.params))
}

/// The offset of a number in bytes.
pub(crate) fn offset(at: usize, lanes: usize) -> Result<i32, String> {
    i32::try_from(8 * at * lanes).map_err(|_| "an array is too long".to_owned())
}

/// The flags of all accesses: the caller has checked that arrays are long enough.
pub(crate) fn flags() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}

/// The result of an operation on these operands.
pub(crate) fn result(
    builder: &mut FunctionBuilder,
    registers: &mut Registers,
    operation: Operation<usize>,
    [a, b]: [Value; 2],
    callee: &Callee,
) -> Result<Value, String> {
    Ok(match operation {
        Operation::Negate(_) => builder.ins().fneg(a),
        Operation::Add(..) => builder.ins().fadd(a, b),
        Operation::Subtract(..) => builder.ins().fsub(a, b),
        Operation::Multiply(..) => builder.ins().fmul(a, b),
        Operation::Divide(..) => builder.ins().fdiv(a, b),
        Operation::Apply(Function::Sqrt, _) => builder.ins().sqrt(a),
        Operation::Apply(function, _) => {
            // A call may overwrite every register.
            registers.leave(builder, 0);
            let code = builder.ins().iconst(types::I32, number(function)?);
            let apply = |builder: &mut FunctionBuilder, a| {
                let place = builder.ins().iconst(callee.pointer, address(self::function as *const u8));
                let call = builder.ins().call_indirect(callee.signature, place, &[code, a]);
                builder.inst_results(call)[0]
            };
            if registers.number == types::F64 {
                return Ok(apply(builder, a));
            }
            let [first, second] = [0, 1].map(|lane| builder.ins().extractlane(a, lane));
            let [first, second] = [first, second].map(|a| apply(builder, a));
            both(builder, first, second)
        }
    })
}

/// Two numbers as one value.
pub(crate) fn both(builder: &mut FunctionBuilder, first: Value, second: Value) -> Value {
    let both = builder.ins().splat(types::F64X2, first);
    builder.ins().insertlane(both, second, 1)
}

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
    let input = |piece: &mut Piece, source: liestep_late::Source| {
        Ok(piece.given((begins[source.array as usize], offset(source.at, lanes)?)))
    };
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

static FUNCTIONS: LazyLock<Vec<Function>> = LazyLock::new(|| {
    let named = [Function::Sqrt, Function::Ln, Function::Exp, Function::Sin, Function::Cos];
    let families = (1..=10).map(Function::Stumpff).chain((0..=6).map(Function::LogRatio));
    named.into_iter().chain(families).collect()
});

/// The number of a function in the list, for [`function`].
fn number(function: Function) -> Result<i64, String> {
    let place = FUNCTIONS.iter().zip(0..).find(|(one, _)| **one == function);
    place.map(|(_, place)| place).ok_or_else(|| format!("{function:?} isn't among the functions"))
}

/// Applies a function of the interpreter to a number.
extern "C" fn function(code: u32, a: f64) -> f64 {
    FUNCTIONS.get(code as usize).map_or(f64::NAN, |&function| applied(function, a))
}
