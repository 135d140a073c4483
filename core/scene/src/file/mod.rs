//! Scene files: the tables of a document as types, and the mistakes in them with their places.

pub(crate) mod body;
pub(crate) mod column;
pub(crate) mod document;
pub(crate) mod draws;
pub(crate) mod effects;
pub(crate) mod ensemble;
pub(crate) mod event;
pub(crate) mod key;
pub(crate) mod lagrangian;
pub(crate) mod method;
pub(crate) mod mistake;
pub(crate) mod orbit;
pub(crate) mod picture;
pub(crate) mod quantity;
pub(crate) mod read;
pub(crate) mod sample;
pub(crate) mod scene;
pub(crate) mod schedule;
pub(crate) mod start;
pub(crate) mod sweep;
pub(crate) mod system;
pub(crate) mod tables;
pub(crate) mod text;
