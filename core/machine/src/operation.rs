//! Operations as instructions; functions like `sin` are calls of the interpreter's.

use std::sync::LazyLock;

use cranelift_codegen::ir::{AbiParam, InstBuilder as _, SigRef, Signature, Type, Value, types};
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::FunctionBuilder;
use liestep_late::{Function, Operation, applied};

use crate::registers::Registers;

/// An address as a number, for code that is given it.
pub(crate) fn address<T>(pointer: *const T) -> i64 {
    pointer.expose_provenance().cast_signed() as i64
}

/// The function of [`function`], as code calls it.
pub(crate) struct Callee {
    signature: SigRef,
    pointer: Type,
}

impl Callee {
    pub(crate) fn new(builder: &mut FunctionBuilder, pointer: Type, convention: CallConv) -> Self {
        let mut signature = Signature::new(convention);
        signature.params.extend([AbiParam::new(types::I32), AbiParam::new(types::F64)]);
        signature.returns.push(AbiParam::new(types::F64));
        Self { signature: builder.import_signature(signature), pointer }
    }
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
