//! A state moves from one scene to another, and invariants of both scenes are conserved throughout.

use liestep::Stepper;
use liestep::effects::{Dipole, Rotor};
use nalgebra::Vector3;

use super::{body, gravity, started};

/// A body is free, then heavy, then free again: the vertical component of the spatial momentum is conserved in all
/// three scenes.
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
    // Gravity has changed the momentum, or the test would show nothing.
    assert!((falling.spatial_momentum() - floating.spatial_momentum()).norm() > 1.0);
    let mut floating = free.adopt(&falling);
    let momentum = free.spatial_momentum(&floating);
    for _ in 0..1000 {
        free.step(&mut floating).unwrap();
        assert!((free.spatial_momentum(&floating) - momentum).norm() < 1e-12);
    }
    assert!((floating.spatial_momentum().z - vertical).abs() < 1e-12);
}

/// Adopting a motion isn't a step: there and back at once changes nothing, and neither does a detour by the same scene.
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
    // Newton's iteration starts from another guess, and advected parameters are computed from the attitude: both round
    // differently.
    assert!((moved.attitude().as_matrix() - state.attitude().as_matrix()).norm() < 1e-13);
    assert!((moved.momentum() - state.momentum()).norm() < 1e-12);
}
