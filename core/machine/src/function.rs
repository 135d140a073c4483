//! The machine code of one function, and the numbers that it reads.

use std::sync::LazyLock;

use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::{AbiParam, InstBuilder as _, MemFlagsData, Type, Value};
use cranelift_codegen::isa::{OwnedTargetIsa, TargetIsa};
use cranelift_codegen::settings::{self, Configurable as _};
use cranelift_codegen::{CompiledCode, Context};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};

use crate::operation::{Callee, address};

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
    let callee = Callee::new(&mut builder, pointer, convention);
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
/// parameters that [`Registers`](crate::registers::Registers) adds.
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
