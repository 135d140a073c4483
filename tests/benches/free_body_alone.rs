//! A free body in a program without other effects; its steps must cost as much as in a program with all effects.
//!
//! ```text
//! cargo bench --bench free-body-alone                  times a step
//! cargo bench --bench free-body-alone -- count body 1000   runs 1000 steps and nothing else
//! cargo bench --bench scenes -- zero-cost              compares the counts
//! ```

mod stepping;

use liestep::effects::PrincipalBody;
use liestep::mechanics::DiagonalNonstandardInertia;
use nalgebra::Vector3;

use stepping::{Count, Time, Visit};

fn visit_all(visit: &mut impl Visit) {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    visit.visit("body", PrincipalBody { J_d });
}

fn main() {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.as_slice() {
        [word, wanted, steps] if word == "count" => {
            let mut count = Count::new(wanted, steps.parse().expect("a number of steps"));
            visit_all(&mut count);
            assert!(count.found, "there is no scene `{wanted}`");
        }
        _ => visit_all(&mut Time),
    }
}
