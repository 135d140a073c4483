//! A state moves from one scene to another, and what both conserve is conserved throughout.

use liestep::Stepper;
use liestep::effects::{Dipole, Rotor};
use nalgebra::Vector3;

use super::{body, gravity, started};

/// Free, then heavy, then free again: the vertical component of the spatial momentum belongs to all three.
#[test]
fn gravity_comes_and_goes() {
    let (free, mut floating) = started(body(), 0.01);
    let heavy = Stepper::new(body() + gravity(), 0.01).unwrap();
    let vertical = floating.spatial_momentum().z;
    for _ in 0..1000 {
        free.step(&mut floating).unwrap();
    }
    let mut falling = heavy.adopt(&floating);
    assert_eq!((falling.attitude(), falling.momentum()), (floating.attitude(), floating.momentum()));
    assert_eq!(falling.steps(), 0);
    let energy = heavy.energy(&falling);
    for _ in 0..1000 {
        heavy.step(&mut falling).unwrap();
        assert!((heavy.momentum_along_advected(&falling) - vertical).abs() < 1e-12);
        assert!((heavy.energy(&falling) - energy).abs() < 2e-3 * energy);
    }
    // Gravity has turned the momentum, or the test would say nothing.
    assert!((falling.spatial_momentum() - floating.spatial_momentum()).norm() > 1.0);
    let mut floating = free.adopt(&falling);
    let momentum = free.spatial_momentum(&floating);
    for _ in 0..1000 {
        free.step(&mut floating).unwrap();
        assert!((free.spatial_momentum(&floating) - momentum).norm() < 1e-12);
    }
    assert!((floating.spatial_momentum().z - vertical).abs() < 1e-12);
}

/// The momentum belongs to a time: there and back at once changes nothing, and neither does a detour by the same scene.
#[test]
fn adopting_is_no_step() {
    let (heavy, mut state) = started(body() + gravity(), 0.01);
    let dipole = Dipole { moment: Vector3::x(), field: Vector3::new(0.0, 2.0, 1.0) };
    let magnetic = Stepper::new(body() + gravity() + dipole + Rotor { spin: Vector3::y() }, 0.002).unwrap();
    let mut moved = state;
    for _ in 0..100 {
        heavy.step(&mut state).unwrap();
        heavy.step(&mut moved).unwrap();
        moved = heavy.adopt(&magnetic.adopt(&moved));
    }
    // Newton starts from another guess, and what is advected is found from the attitude: both round differently.
    assert!((moved.attitude().as_matrix() - state.attitude().as_matrix()).norm() < 1e-13);
    assert!((moved.momentum() - state.momentum()).norm() < 1e-12);
}
