//! The rows of the table, one file for each kind.

mod boxes;
mod chaos;
mod closed_forms;
mod damping;
mod euler_angles;
mod flips;
mod flows;
mod folds;
mod long_run;
mod modified_energy;
mod momenta;
mod newton_tolerance;
mod orders;
mod passage;
mod precession;
mod refused;
mod rest;
mod reversal;
mod round_off;
mod saved;
mod shapes;
mod single_precision;
mod sleeping;
mod structure;
mod tiny_step;
mod traps;
mod units;
mod unlimited;
mod weightless;

use crate::row::{Effort, Failure, Row};

/// A function that measures a row.
pub type Measure = fn(Effort) -> Result<Row, Failure>;

/// Rows that take more than a second, whose tests are in `tests/long`.
pub const LONG: [&str; 10] = ["S5", "T1", "T3", "T4", "T7", "P8", "R1", "R2", "R3", "R4"];

/// All rows in the order of the table: folds and branches of the step, bodies, tops, structure, round-off.
pub const ALL: [(&str, Measure); 38] = [
    ("S1", folds::s1),
    ("S2", folds::s2),
    ("S3", traps::s3),
    ("S4", rest::s4),
    ("S5", reversal::s5),
    ("S6", unlimited::s6),
    ("B1", boxes::b1),
    ("B2", boxes::b2),
    ("B3", shapes::b3),
    ("B4", shapes::b4),
    ("B5", shapes::b5),
    ("B6", refused::b6),
    ("B7", flips::b7),
    ("B8", closed_forms::b8),
    ("T1", orders::t1),
    ("T2", modified_energy::t2),
    ("T3", long_run::t3),
    ("T4", tiny_step::t4),
    ("T5", sleeping::t5),
    ("T6", passage::t6),
    ("T7", chaos::t7),
    ("T8", weightless::t8),
    ("T9", units::t9),
    ("T10", euler_angles::t10),
    ("T11", precession::t11),
    ("T12", precession::t12),
    ("P1", structure::p1),
    ("P2", momenta::p2),
    ("P3", momenta::p3),
    ("P4", newton_tolerance::p4),
    ("P5", flows::p5),
    ("P6", damping::p6),
    ("P7", saved::p7),
    ("P8", single_precision::p8),
    ("R1", round_off::r1),
    ("R2", round_off::r2),
    ("R3", round_off::r3),
    ("R4", round_off::r4),
];
