//! Declarations read at run time against compiled ones: to the bit, and by all methods.

mod bits;
mod methods;
mod same;
mod slopes;
