//! The attribute macro of liestep.
use proc_macro::TokenStream;
/// Derives an integrator.
#[proc_macro_attribute]
pub fn lagrangian(_attribute: TokenStream, item: TokenStream) -> TokenStream {
    item
}
