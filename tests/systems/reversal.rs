//! S5 for every declared system: the step of `−h` undoes that of `h`, if the declaration is self-adjoint.

use checks::structure::{System, reversal};

use crate::samples::{self, every_system};

/// Some products of small matrices, both ways.
const ROUNDING: f64 = 1e-14;

fn reverses<L: System + Clone>(system: &L, name: &str) {
    let error = reversal::error_of_return(system, 0.1, 44);
    println!("{name}: {error:.1e}");
    assert!(error < ROUNDING, "{error:e}");
}

every_system! {
    reverses: heavy_top full_top free_body cayley_top log_top fourth_order_top sixth_order_top fourth_order_body
    satellite orbiting_body spring sliding_top magnet underwater_body tethered_plate elastic_flow
}

/// A potential at one end of the step isn't self-adjoint.
#[test]
fn log_trace_top_does_not_reverse() {
    assert!(reversal::error_of_return(&samples::log_trace_top(), 0.1, 45) > 1e-3);
}
