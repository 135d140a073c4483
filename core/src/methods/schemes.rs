//! Tables of coefficients.

/// Constants of a type, the list of all of them, and the functions `name` and `order`.
macro_rules! schemes {
    ($($(#[$doc:meta])* $name:ident = $scheme:expr;)+) => {
        $($(#[$doc])* pub const $name: Self = $scheme;)+

        /// All of these.
        pub const ALL: [Self; [$(stringify!($name)),+].len()] = [$(Self::$name),+];

        /// What it is called in tables.
        #[must_use]
        pub fn name(&self) -> &'static str {
            self.name
        }

        /// The order in the step of the whole method; of a composition, where the composed method has the order `base`.
        #[must_use]
        pub fn order(&self) -> u32 {
            self.order
        }
    };
}
