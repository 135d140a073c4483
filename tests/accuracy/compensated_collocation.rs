//! Compensated sums of collocation.

use liestep::effects::{Gravity, RigidBody};
use liestep::methods::CotangentGauss;
use liestep::motion::Integrator;
use liestep::prelude::*;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Collocation with compensated sums: the defects of orthogonality and of the vertical momentum are several times smaller
/// than those of the same steps without.
#[test]
fn sums_of_cotangent_collocation_are_compensated() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.7, 1.0)).unwrap();
    let gravity = Gravity { m: 1.1, g: 9.81, rho: Vector3::new(0.1, -0.2, 1.0), up: Vector3::z() };
    let gauss = CotangentGauss::<_, 1, 3>::new(RigidBody { J_d } + gravity, 1e-4).unwrap();
    let velocity = Vector3::new(0.5, 1.2, 2.0);
    let mut state = gauss.start(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, 0.0)), velocity).unwrap();
    let (mut attitude, mut momentum) = (state.attitude(), state.momentum());
    let vertical = |attitude: &SO3, momentum: &Vector3<f64>| (attitude.as_matrix() * momentum).z;
    let start = vertical(&attitude, &momentum);
    let missed = |attitude: &SO3, momentum: &Vector3<f64>| {
        let r = attitude.as_matrix();
        let defect = (r.transpose() * r - Matrix3::identity()).norm();
        [defect, (vertical(attitude, momentum) - start).abs() / start.abs()]
    };
    let mut worst = [[0.0_f64; 2]; 2];
    for _ in 0..50_000 {
        Integrator::step(&gauss, &mut state).unwrap();
        (attitude, momentum) = gauss.step(&attitude, &momentum).unwrap();
        for (worst, now) in
            worst.iter_mut().zip([missed(&state.attitude(), &state.momentum()), missed(&attitude, &momentum)])
        {
            *worst = [worst[0].max(now[0]), worst[1].max(now[1])];
        }
    }
    println!("off the group and the momentum: compensated {:?}, plain {:?}", worst[0], worst[1]);
    assert!(worst[0].iter().all(|&missed| missed < 2e-15), "{worst:?}");
    assert!(worst[0].iter().zip(worst[1]).all(|(with, without)| 5.0 * with < without), "{worst:?}");
}
