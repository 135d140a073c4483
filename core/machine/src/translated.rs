//! Programs as code of Cranelift, operation by operation.

use std::ops::Range;
use std::sync::LazyLock;

use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::{AbiParam, FuncRef, GlobalValue, InstBuilder as _, MemFlagsData, Type, Value, types};
use cranelift_codegen::isa::{OwnedTargetIsa, TargetIsa};
use cranelift_codegen::settings::{self, Configurable as _};
use cranelift_codegen::{CompiledCode, Context};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{DataDescription, FuncId, Linkage, Module as _, ModuleReloc, default_libcall_names};
use liestep_late::{Array, Function, Operation, Program, applied};

use crate::registers::Registers;

/// The instruction set of this machine.
pub(crate) fn isa() -> Result<OwnedTargetIsa, String> {
    static ISA: LazyLock<Result<OwnedTargetIsa, String>> = LazyLock::new(|| {
        let mut flags = settings::builder();
        // The program is optimised already, and `Registers` allocates registers.
        for (name, value) in [("opt_level", "none"), ("enable_verifier", "false")] {
            flags.set(name, value).map_err(|error| error.to_string())?;
        }
        cranelift_native::builder()?.finish(settings::Flags::new(flags)).map_err(|error| error.to_string())
    });
    ISA.clone()
}

/// Compiles a program to a function of its constants, of the arrays of its other inputs and of the array of its
/// outputs: for one number at each place, or for two of several lanes.
pub(crate) fn module(program: &Program, lanes: usize) -> Result<(JITModule, FuncId), String> {
    let mut builder = JITBuilder::with_isa(isa()?, default_libcall_names());
    builder.symbol(FUNCTION, function as *const u8);
    let mut module = JITModule::new(builder);
    let pointer = module.target_config().pointer_type();
    let mut signature = module.make_signature();
    signature.params.extend([AbiParam::new(types::I32), AbiParam::new(types::F64)]);
    signature.returns.push(AbiParam::new(types::F64));
    let shared = module.declare_function(FUNCTION, Linkage::Import, &signature).map_err(|error| error.to_string())?;
    let mut own = module.make_context();
    own.func.signature.params.extend([AbiParam::new(pointer); 3]);
    let id = module.declare_anonymous_function(&own.func.signature).map_err(|error| error.to_string())?;
    let called = module.declare_func_in_func(shared, &mut own.func);
    let literals = module.declare_anonymous_data(false, false).map_err(|error| error.to_string())?;
    let mut data = DataDescription::new();
    data.set_align(16);
    data.define(program.literals.iter().flat_map(|one| one.to_ne_bytes().repeat(lanes.min(2))).collect());
    module.define_data(literals, &data).map_err(|error| error.to_string())?;
    let literals = module.declare_data_in_func(literals, &mut own.func);
    let mut context = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut own.func, &mut context);
    write(&mut builder, (program, lanes), (called, literals), pointer)?;
    builder.finalize(module.target_config());
    let code = compiled(&mut own, module.isa())?;
    let relocations: Vec<_> =
        code.buffer.relocs().iter().map(|one| ModuleReloc::from_mach_reloc(one, &own.func, id)).collect();
    let defined = module.define_function_bytes(id, u64::from(code.buffer.alignment), code.code_buffer(), &relocations);
    defined.map_err(|error| error.to_string())?;
    module.finalize_definitions().map_err(|error| error.to_string())?;
    Ok((module, id))
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
fn offset(at: usize, lanes: usize) -> Result<i32, String> {
    i32::try_from(8 * at * lanes).map_err(|_| "an array is too long".to_owned())
}

/// A part of the generated code.
enum Part {
    Operation(usize),
    /// The store of one output, or of two.
    Outputs(Range<usize>),
}

impl Part {
    /// The values that the part reads; a single one twice.
    fn operands(&self, program: &Program) -> [usize; 2] {
        match self {
            Self::Operation(at) => program.operations[*at].operands(),
            Self::Outputs(places) => [places.start, places.end - 1].map(|place| program.outputs[place] as usize),
        }
    }

    fn commutes(&self, program: &Program) -> bool {
        let Self::Operation(at) = self else { return false };
        matches!(program.operations[*at], Operation::Add(..) | Operation::Multiply(..))
    }
}

/// The parts of a program in the order of its machine code.
///
/// A caller loads a vector, and the Jacobian after it, two numbers at a time: it would wait for stores of another
/// width.
fn parts(program: &Program, lanes: usize) -> Vec<Part> {
    let (count, size) = (program.outputs.len(), program.outputs.len().isqrt());
    let vector = if size * (size + 1) == count { size } else { count };
    let (most, fixed) = (if lanes > 1 { 1 } else { 2 }, program.inputs.len() + program.literals.len());
    let (mut parts, mut made, mut at) = (Vec::new(), 0, 0);
    while at < count {
        let end = if at < vector { vector } else { count }.min(at + most);
        for &output in &program.outputs[at..end] {
            let missing = (output as usize + 1).saturating_sub(fixed);
            parts.extend((made..missing).map(Part::Operation));
            made = made.max(missing);
        }
        parts.push(Part::Outputs(at..end));
        at = end;
    }
    parts
}

fn result(
    builder: &mut FunctionBuilder,
    registers: &mut Registers,
    operation: Operation,
    [a, b]: [Value; 2],
    called: FuncRef,
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
            let code = builder.ins().iconst(types::I32, code(function)?);
            let apply = |builder: &mut FunctionBuilder, a| {
                let call = builder.ins().call(called, &[code, a]);
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

fn both(builder: &mut FunctionBuilder, first: Value, second: Value) -> Value {
    let both = builder.ins().splat(types::F64X2, first);
    builder.ins().insertlane(both, second, 1)
}

fn write(
    builder: &mut FunctionBuilder,
    (program, lanes): (&Program, usize),
    (called, literals): (FuncRef, GlobalValue),
    pointer: Type,
) -> Result<(), String> {
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    let [constants, arrays, outputs] = [0, 1, 2].map(|at| builder.block_params(block)[at]);
    // The caller has checked that the arrays are long enough.
    let flags = MemFlagsData::new().with_notrap();
    let mut begins = [constants; Array::COUNT];
    for array in given(&least(program)) {
        let place = offset(array as usize, 1)?;
        begins[array as usize] = builder.ins().load(pointer, flags.with_readonly(), arrays, place);
    }
    let number = if lanes > 1 { types::F64X2 } else { types::F64 };
    let literals = builder.ins().symbol_value(pointer, literals);
    let mut given = Vec::new();
    for source in &program.inputs {
        given.push((begins[source.array as usize], offset(source.at, lanes)?));
    }
    for at in 0..program.literals.len() {
        given.push((literals, offset(at, lanes.min(2))?));
    }
    let (parts, results) = (parts(program, lanes), given.len());
    let mut reads = vec![Vec::new(); results + program.operations.len()];
    for (time, part) in parts.iter().enumerate().rev() {
        let [first, second] = part.operands(program);
        reads[first].push(time);
        if second != first {
            reads[second].push(time);
        }
    }
    let mut registers = Registers::new(builder, (number, pointer), flags, given, reads);
    for part in parts {
        let values = registers.read(builder, part.operands(program), part.commutes(program))?;
        match part {
            Part::Operation(at) => {
                let value = result(builder, &mut registers, program.operations[at], values, called)?;
                registers.compute(builder, results + at, value);
            }
            Part::Outputs(places) => {
                let written = if places.len() > 1 { both(builder, values[0], values[1]) } else { values[0] };
                builder.ins().store(flags, written, outputs, offset(places.start, lanes)?);
            }
        }
    }
    builder.ins().return_(&[]);
    Ok(())
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

/// The symbol of `function`.
const FUNCTION: &str = "liestep_function";

static FUNCTIONS: LazyLock<Vec<Function>> = LazyLock::new(|| {
    let named = [Function::Sqrt, Function::Ln, Function::Exp, Function::Sin, Function::Cos];
    let families = (1..=10).map(Function::Stumpff).chain((0..=6).map(Function::LogRatio));
    named.into_iter().chain(families).collect()
});

/// The number of a function in the list, for [`function`].
fn code(function: Function) -> Result<i64, String> {
    let place = FUNCTIONS.iter().zip(0..).find(|(one, _)| **one == function);
    place.map(|(_, place)| place).ok_or_else(|| format!("{function:?} isn't among the functions"))
}

/// Applies a function of the interpreter to a number.
extern "C" fn function(code: u32, a: f64) -> f64 {
    FUNCTIONS.get(code as usize).map_or(f64::NAN, |&function| applied(function, a))
}
