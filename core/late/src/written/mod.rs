//! Programs as text: the straight-line code in Rust, and a whole step in other languages.
//!
//! A language is a table, of its straight-line code, and a head with a driver: Newton's iteration, its end, and the
//! step that follows. All drivers have the decisions of the whole step by interpretation, in the same order.
//!
//! `javascript → c → parts → language`, `rust → language`.

mod c;
mod javascript;
mod language;
mod parts;
mod rust;

pub use c::{c, gpu, header, numbered, prefix};
pub use javascript::{constant, is_exact, javascript};
pub use parts::Sums;
pub use rust::rust;
