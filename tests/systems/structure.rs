//! The structure of every declared system, at random states: its momenta, Poisson tensor, both flows, and reversal.

use checks::random::Random;
use checks::structure::poisson::{self, tensor};
use checks::structure::{System, momenta, placed, reversal, stages, two_flows};
use liestep::SO3;
use liestep::groups::Retraction;
use liestep::mechanics::Group;
use nalgebra::DMatrix;

use checks::samples::every_system;

fn assert_structure<L: System + Clone>(system: &L, name: &str)
where
    L::Retraction: Retraction<[Group<L>; 2]>,
{
    placed::assert_placed(system, 49);
    p1(system, name);
    p2(system);
    p5(system, name);
    s5(system, name);
}

/// The step is a Poisson map. With `z = (μ, w)` the tensor of a top is `B = [[μ̂, ŵ], [ŵ, 0]]`, and `B = μ̂` without
/// advected parameters.
fn p1<L: System + Clone>(system: &L, name: &str) {
    print!("{name}: ");
    poisson::assert_poisson(system, &[0.01, 0.1, 0.3], 41);
}

/// The momenta of a declared `l_d` are its derivatives, satisfy the relations of the theory, and agree with the step in
/// stages.
fn p2<L: System + Clone>(system: &L) {
    momenta::assert_momenta(system, 42);
    stages::assert_stages(system, 43);
    stages::assert_step(system, &[1e-3, 0.1, 0.3], 48);
}

/// The flow on increments and the flow on momenta are one motion.
fn p5<L: System + Clone>(system: &L, name: &str) {
    let parting = two_flows::parting(system, 0.01, 30, 44);
    println!("{name}: the flows (2.5) and (2.8) part by {parting:.1e}");
    // The bound is for 30 steps; the worst error is 1.5e-14.
    assert!(parting < 1e-13, "{name}: the flows (2.5) and (2.8) part by {parting:e}");
}

/// The step of `−h` undoes that of `h`, except for the declaration with its potential at one end, which isn't
/// self-adjoint.
fn s5<L: System + Clone>(system: &L, name: &str) {
    let error = reversal::error_of_return(system, 0.1, 44);
    println!("{name}: back to {error:.1e}");
    // The bound is some products of small matrices, both ways.
    assert!(if name == "log_trace_top" { error > 1e-3 } else { error < 1e-14 }, "{name}: {error:e}");
}

every_system!(assert_structure);

/// The tensor in these claims is that of the thesis.
#[test]
fn tensor_of_so3() {
    let mut random = Random::new(16);
    let (momentum, w) = (random.vector(), random.vector());
    let mut expected = DMatrix::zeros(6, 6);
    expected.view_mut((0, 0), (3, 3)).copy_from(&momentum.cross_matrix());
    expected.view_mut((0, 3), (3, 3)).copy_from(&w.cross_matrix());
    expected.view_mut((3, 0), (3, 3)).copy_from(&w.cross_matrix());
    assert!((tensor::<SO3, _>(&momentum, &w) - expected).amax() < 1e-12);
    assert!((tensor::<SO3, _>(&momentum, &()) - momentum.cross_matrix()).amax() < 1e-12);
}
