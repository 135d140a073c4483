//! P2 for every declared system: the momenta of a declared `l_d` are its derivatives, hang together as the theory says, and
//! the step in stages says the same.

use checks::structure::{System, momenta, stages};

use crate::samples::every_system;

fn p2<L: System + Clone>(system: &L, _: &str) {
    momenta::assert_momenta(system, 42);
    stages::assert_stages(system, 43);
    stages::assert_step(system, &[1e-3, 0.1, 0.3], 48);
}

every_system!(p2);

#[test]
fn of_the_thesis() {
    p2(&declarations::HeavyTop::thesis(), "the thesis' top");
}
