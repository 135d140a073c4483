//! The derived equations of declared Lagrangians, to read beside the paper.
//!
//! ```text
//! cargo run --example derive                 what there is
//! cargo run --example derive -- heavy-top    all equations of one
//! ```
//!
//! The same text stands in the documentation of the constant `DERIVATION` and, equation by equation, of each generated
//! method.

#[path = "common/free_body/lagrangian.rs"]
mod free_body;
#[path = "common/heavy_top/lagrangian.rs"]
mod heavy_top;

use std::io::{self, Write as _};

use clap::Parser;
use clap::builder::PossibleValuesParser;
use liestep::DiscreteLagrangian;

/// Prints what is derived from a declared Lagrangian.
#[derive(Parser)]
#[command(name = "derive")]
struct Arguments {
    /// Which one; all are listed if it is left away.
    #[arg(value_parser = PossibleValuesParser::new(LAGRANGIANS.map(|shown| shown.name)))]
    name: Option<String>,
}

/// A declaration that is shown.
struct Shown {
    name: &'static str,
    about: &'static str,
    derivation: &'static str,
    is_self_adjoint: bool,
}

const fn shown<L: DiscreteLagrangian>(name: &'static str, about: &'static str) -> Shown {
    Shown { name, about, derivation: L::DERIVATION, is_self_adjoint: L::SELF_ADJOINT }
}

/// All of them; a new one is one line.
const LAGRANGIANS: [Shown; 2] = [
    shown::<heavy_top::HeavyTop>("heavy-top", "the heavy top (3.13): μ is (3.17), (L_F)* δl_d/δF is (3.18)"),
    shown::<free_body::FreeBody>("free-rigid-body", "its kinetic part alone"),
];

fn main() -> io::Result<()> {
    let name = Arguments::parse().name;
    let mut out = io::stdout().lock();
    for lagrangian in LAGRANGIANS {
        let Shown { name: this, about, derivation, is_self_adjoint } = lagrangian;
        if name.is_none() {
            let adjoint = if is_self_adjoint { "self-adjoint" } else { "–" };
            writeln!(out, "{this:<20} {adjoint:<14} {about}")?;
        } else if name.as_deref() == Some(this) {
            writeln!(out, "{this}: {about}\n\n{derivation}")?;
        }
    }
    out.flush()
}
