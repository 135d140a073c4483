//! Names as the compiler compares them: by their letters and by their hygiene.

use proc_macro2::Ident;
use syn::ext::IdentExt as _;

/// A spelling: the name of a `let`, or a name that may refer to it.
///
/// A name passed into a `macro_rules!` differs from the same letters written within it: a `let` of the one can't hide
/// the other.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spelling {
    pub letters: String,
    /// The number of the expansion, if known.
    site: Option<u32>,
}

impl Spelling {
    pub fn of(ident: &Ident) -> Self {
        Self { letters: ident.unraw().to_string(), site: site(&format!("{:?}", ident.span())) }
    }
}

/// The `7` of `#7 bytes(10..12)`.
///
/// A stable compiler has no other source for it. If its spans look different, all names have one site.
pub fn site(span: &str) -> Option<u32> {
    span.strip_prefix('#')?.split_once(' ')?.0.parse().ok()
}
