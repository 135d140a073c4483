//! Any text as the declaration of a Lagrangian or of a force: the result is items or an error message, without a panic
//! or an endless loop. Run with `cargo fuzz run tokens`.

#![no_main]

use libfuzzer_sys::fuzz_target;
use liestep_derivation::{self as derivation, Role};
use proc_macro2::TokenStream;

/// Fields of every kind of declaration, so that names in the text exist.
const ITEM: &str = "struct Top { J_d: NonstandardInertia, A: Matrix3<f64>, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }";

fuzz_target!(|bytes: &[u8]| {
    let Some((kind, text)) = bytes.split_first() else { return };
    let Ok(text) = std::str::from_utf8(text) else { return };
    // A text that isn't a sequence of tokens never reaches a macro.
    let Ok(written) = text.parse::<TokenStream>() else { return };
    let item: TokenStream = ITEM.parse().expect("tokens");
    let expansion = match kind % 5 {
        0 => derivation::expand(Role::Lagrangian, written, &item),
        1 => {
            let arguments = format!("group = SO3, advected(w = up), l_d = {text}");
            let Ok(arguments) = arguments.parse() else { return };
            derivation::expand(Role::Lagrangian, arguments, &item)
        }
        2 => derivation::expand(Role::Force, written, &item),
        3 => derivation::expand(Role::Constraint, written, &item),
        _ => derivation::matrix_group(written),
    };
    let shown = expansion.to_string();
    assert!(
        shown.contains("compile_error") || syn::parse2::<syn::File>(expansion).is_ok(),
        "neither an error nor items: {shown}"
    );
});
