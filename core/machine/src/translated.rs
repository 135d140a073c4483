//! Programs as code of Cranelift, operation by operation.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use cranelift_codegen::ir::{AbiParam, FuncRef, InstBuilder as _, MemFlagsData, types};
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable as _};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module as _, default_libcall_names};
use liestep_late::{Array, Function, Operation, Program, applied};

/// The machine that this runs on.
pub(crate) fn isa() -> Result<OwnedTargetIsa, String> {
    static ISA: LazyLock<Result<OwnedTargetIsa, String>> = LazyLock::new(|| {
        let mut flags = settings::builder();
        for (name, value) in [("opt_level", "speed"), ("enable_verifier", "false")] {
            flags.set(name, value).map_err(|error| error.to_string())?;
        }
        cranelift_native::builder()?.finish(settings::Flags::new(flags)).map_err(|error| error.to_string())
    });
    ISA.clone()
}

/// The code of a program, a function of its constants, of the arrays of its other inputs and of the place of its outputs: for one
/// number at each place, or for two of several lanes.
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
    let mut context = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut own.func, &mut context);
    write(&mut builder, (program, lanes), called, pointer)?;
    builder.finalize(module.target_config());
    module.define_function(id, &mut own).map_err(|error| error.to_string())?;
    module.finalize_definitions().map_err(|error| error.to_string())?;
    Ok((module, id))
}

/// The place of a number in bytes.
fn offset(at: usize, lanes: usize) -> Result<i32, String> {
    i32::try_from(8 * at * lanes).map_err(|_| "an array is too long".to_owned())
}

fn write(
    builder: &mut FunctionBuilder,
    (program, lanes): (&Program, usize),
    called: FuncRef,
    pointer: types::Type,
) -> Result<(), String> {
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    let [constants, arrays, outputs] = [0, 1, 2].map(|at| builder.block_params(block)[at]);
    // The caller has looked whether they are long enough. What is read doesn't change, so it is read where it is needed.
    let written = MemFlagsData::new().with_notrap();
    let trusted = written.with_readonly().with_can_move();
    let number = if lanes > 1 { types::F64X2 } else { types::F64 };
    let mut begins = BTreeMap::from([(Array::Constants, constants)]);
    for (array, _) in least(program).into_iter().filter(|(array, _)| *array != Array::Constants) {
        begins.insert(array, builder.ins().load(pointer, trusted, arrays, offset(array as usize, 1)?));
    }
    let mut values = Vec::new();
    for source in &program.inputs {
        values.push(builder.ins().load(number, trusted, begins[&source.array], offset(source.at, lanes)?));
    }
    for &literal in &program.literals {
        let one = builder.ins().f64const(literal);
        values.push(if lanes > 1 { builder.ins().splat(number, one) } else { one });
    }
    for &operation in &program.operations {
        let [a, b] = operation.operands().map(|at| values[at]);
        values.push(match operation {
            Operation::Negate(_) => builder.ins().fneg(a),
            Operation::Add(..) => builder.ins().fadd(a, b),
            Operation::Subtract(..) => builder.ins().fsub(a, b),
            Operation::Multiply(..) => builder.ins().fmul(a, b),
            Operation::Divide(..) => builder.ins().fdiv(a, b),
            Operation::Apply(Function::Sqrt, _) => builder.ins().sqrt(a),
            Operation::Apply(function, _) => {
                let code = builder.ins().iconst(types::I32, i64::from(code(function)));
                let apply = |builder: &mut FunctionBuilder, a| {
                    let call = builder.ins().call(called, &[code, a]);
                    builder.inst_results(call)[0]
                };
                if lanes == 1 {
                    apply(builder, a)
                } else {
                    let [first, second] = [0, 1].map(|lane| builder.ins().extractlane(a, lane));
                    let [first, second] = [first, second].map(|a| apply(builder, a));
                    let both = builder.ins().splat(number, first);
                    builder.ins().insertlane(both, second, 1)
                }
            }
        });
    }
    for (at, &output) in program.outputs.iter().enumerate() {
        builder.ins().store(written, values[output as usize], outputs, offset(at, lanes)?);
    }
    builder.ins().return_(&[]);
    Ok(())
}

/// How many numbers a program reads at least of each array that it reads.
pub(crate) fn least(program: &Program) -> Vec<(Array, usize)> {
    let mut least = BTreeMap::new();
    for source in &program.inputs {
        let count = least.entry(source.array).or_insert(0);
        *count = source.at.saturating_add(1).max(*count);
    }
    least.into_iter().collect()
}

/// The symbol of what applies a function.
const FUNCTION: &str = "liestep_function";

/// A function as a number, for [`function`].
const fn code(function: Function) -> u32 {
    match function {
        Function::Sqrt => 0,
        Function::Ln => 1,
        Function::Exp => 2,
        Function::Sin => 3,
        Function::Cos => 4,
        Function::Stumpff(order) => 0x100 + order as u32,
        Function::LogRatio(order) => 0x200 + order as u32,
    }
}

/// A function of a number: the interpreter's.
extern "C" fn function(code: u32, a: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation)] // the order is the last byte
    let order = code as u8;
    let function = match (code >> 8, order) {
        (0, 0) => Function::Sqrt,
        (0, 1) => Function::Ln,
        (0, 2) => Function::Exp,
        (0, 3) => Function::Sin,
        (0, _) => Function::Cos,
        (1, order) => Function::Stumpff(order),
        (_, order) => Function::LogRatio(order),
    };
    applied(function, a)
}
