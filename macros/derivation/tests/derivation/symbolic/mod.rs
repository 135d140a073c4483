//! Every rule of the symbolic expressions against numbers.

mod rational;
mod rewrites;
mod variations;
