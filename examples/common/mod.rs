//! What the examples share: arguments, timed runs, tables, files and figures.

pub(crate) mod args;
pub(crate) mod csv;
pub(crate) mod output;
pub(crate) mod plot;
pub(crate) mod run;
pub(crate) mod table;
pub(crate) mod variational;
