//! Tables of coefficients.

/// Constants of a type, and the list of all of them.
macro_rules! schemes {
    ($($(#[$doc:meta])* $name:ident = $scheme:expr;)+) => {
        $($(#[$doc])* pub const $name: Self = $scheme;)+

        /// All of these.
        pub const ALL: [Self; [$(stringify!($name)),+].len()] = [$(Self::$name),+];
    };
}
