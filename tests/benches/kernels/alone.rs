//! A free body in a program without other effects; its steps must cost as much as in a program with all effects:
//! `cargo bench -p liestep-benches -- zero-cost` compares the counts.

mod kernel;
mod stepping;

use liestep::effects::PrincipalBody;
use liestep::mechanics::DiagonalNonstandardInertia;
use nalgebra::Vector3;

use kernel::{Failure, Group, arguments, measure};

fn main() -> Result<(), Failure> {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    let group = Group::new("", stepping::EFFORT, [stepping::scene("body", PrincipalBody { J_d })]);
    let words = arguments();
    measure(&[], vec![group], &words.iter().map(String::as_str).collect::<Vec<_>>())
}
