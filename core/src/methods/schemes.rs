//! Tables of coefficients.

/// Constants of a type of coefficients, the list of all of them, and the functions `name` and `order`.
macro_rules! schemes {
    ($($(#[$doc:meta])* $name:ident = $scheme:expr;)+) => {
        $($(#[$doc])* pub const $name: Self = $scheme;)+

        /// All published sets of coefficients.
        pub const ALL: [Self; [$(stringify!($name)),+].len()] = [$(Self::$name),+];

        /// The name in tables.
        #[must_use]
        pub fn name(&self) -> &'static str {
            self.name
        }

        /// The order of the whole method in its step. For a composition this assumes that the composed method has the
        /// order `base`.
        #[must_use]
        pub fn order(&self) -> u32 {
            self.order
        }
    };
}
