//! Names as the compiler compares them: by their letters and by their hygiene.

use proc_macro2::Ident;
use syn::ext::IdentExt as _;

/// The name of a `let`, or one that may be meant by it.
///
/// A name that comes into a `macro_rules!` from outside isn't the same as one that is written within, though they are
/// spelt alike: a `let` of the one can't hide the other.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spelling {
    pub letters: String,
    /// What tells expansions apart, where it is known.
    site: Option<u32>,
}

impl Spelling {
    pub fn of(ident: &Ident) -> Self {
        Self { letters: ident.unraw().to_string(), site: site(&format!("{:?}", ident.span())) }
    }
}

/// The `7` of `#7 bytes(10..12)`.
///
/// On a stable compiler nothing else tells. From another compiler, whose spans look otherwise, all names have one site.
pub fn site(span: &str) -> Option<u32> {
    span.strip_prefix('#')?.split_once(' ')?.0.parse().ok()
}
