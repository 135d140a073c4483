//! Names as the compiler compares them: by their letters and by their hygiene.

use proc_macro2::Ident;
use syn::ext::IdentExt as _;

/// A spelling: the name of a `let`, or a name that may refer to it.
///
/// A name passed into a `macro_rules!` differs from the same letters written within it: a `let` of the one can't hide
/// the other.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Spelling {
    pub(crate) letters: String,
    /// The number of the expansion, if known.
    site: Option<u32>,
}

impl Spelling {
    pub(crate) fn of(ident: &Ident) -> Self {
        Self { letters: ident.unraw().to_string(), site: site(&format!("{:?}", ident.span())) }
    }
}

/// The `7` of `#7 bytes(10..12)`.
///
/// A stable compiler has no other source for it. If its spans look different, all names have one site.
fn site(span: &str) -> Option<u32> {
    span.strip_prefix('#')?.split_once(' ')?.0.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::site;

    #[test]
    fn the_site_of_a_span() {
        assert_eq!(site("#7 bytes(10..12)"), Some(7));
        assert_eq!(site("bytes(10..12)"), None);
        assert_eq!(site("Span"), None);
        assert_eq!(site("#seven bytes(10..12)"), None);
    }
}
