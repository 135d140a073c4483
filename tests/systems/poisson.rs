//! P1 for every declared system.

use checks::structure::{System, poisson};

use crate::samples::every_system;

fn p1<L: System<N, D> + Clone, const N: usize, const D: usize>(system: &L, name: &str) {
    print!("{name}: ");
    poisson::assert_poisson(system, &[0.01, 0.1, 0.3], 41);
}

every_system!(p1);
