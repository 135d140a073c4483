//! P6: damping reduces the energy and reverses no turn, however strong it is compared with the inertia and the step.
//! Halves of a viscous torque at the two ends of a step, as the discrete Lagrange–d'Alembert principle has them at
//! first sight, multiply a spin by `(1 − x/2)/(1 + x/2)` with `x = c h/J`, and fail this from `x = 2` on.

use checks::random::Random;
use liestep::effects::{Drag, MagneticDamping, Torque};
use liestep::mechanics::Regular;
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};

const STEP: f64 = 0.05;

/// The strengths of damping: `c h` over a moment of inertia.
const STRENGTHS: [f64; 13] = [1e-3, 1e-2, 0.1, 0.5, 1.0, 1.9, 2.1, 5.0, 10.0, 1e2, 1e3, 1e4, 1e6];

/// A body of ordinary shape, nearly a plate, nearly a rod, and a sphere.
const BODIES: [[f64; 3]; 4] = [[2.0, 3.0, 4.5], [1.0, 2.0, 2.999], [1e-3, 1.0, 1.0004], [2.0, 2.0, 2.0]];

fn body(moments: [f64; 3]) -> PrincipalBody {
    PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap() }
}

fn drag(c: f64, moments: [f64; 3]) -> Drag {
    Drag { c, J: Inertia::from_principal_moments(moments.into()).unwrap() }
}

fn magnetic_damping(k: f64, field: Vector3<f64>, moments: [f64; 3]) -> MagneticDamping {
    MagneticDamping { k, field, J: Inertia::from_principal_moments(moments.into()).unwrap() }
}

/// The velocity below which squares of Newton's unknown underflow.
const NOTHING: f64 = 1e-140;

/// The velocities about one principal axis, from 1.5 rad/s down to underflow.
fn spins<L: Regular<Scalar = f64, Group = SO3>>(scene: L, axis: usize, count: usize) -> Vec<f64> {
    let stepper = Stepper::new(scene, STEP).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::ith(axis, 1.5)).unwrap();
    let mut spins = vec![1.5];
    for _ in 0..count {
        stepper.step(&mut state).unwrap();
        let velocity = stepper.velocity(&state);
        assert!((velocity - Vector3::ith(axis, velocity[axis])).norm() <= 1e-15 * velocity.norm());
        spins.push(velocity[axis]);
        if velocity[axis].abs() < NOTHING {
            break;
        }
    }
    spins
}

/// A spin decays without changing its sign, for `c h/J` over nine powers of ten on every axis of every body.
#[test]
fn p6_a_spin_decays_and_keeps_its_sign() {
    for moments in BODIES {
        for (axis, x) in (0..3).flat_map(|axis| STRENGTHS.map(|x| (axis, x))) {
            let c = x * moments[axis] / STEP;
            // The damping about an axis across the field is that of drag.
            let field = Vector3::ith((axis + 1) % 3, 2.0);
            let runs = [
                spins(body(moments) + drag(c, moments), axis, 2000),
                spins(body(moments) + magnetic_damping(c / 4.0, field, moments), axis, 2000),
            ];
            for spins in runs {
                for step in spins.windows(2) {
                    assert!(0.0 <= step[1] && step[1] < step[0], "{moments:?}, axis {axis}, {x}: {step:?}");
                }
            }
        }
    }
}

/// The largest rise of the energy in a step, relative to the energy.
fn rise<L: Regular<Scalar = f64, Group = SO3>>(scene: L, velocity: Vector3<f64>) -> f64 {
    let stepper = Stepper::new(scene, STEP).unwrap();
    let mut state = stepper.start(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.3, -0.2)), velocity).unwrap();
    let mut energy = stepper.energy(&state);
    let mut rise = f64::NEG_INFINITY;
    for _ in 0..200 {
        stepper.step(&mut state).unwrap();
        let after = stepper.energy(&state);
        if after < NOTHING * NOTHING {
            break;
        }
        rise = rise.max((after - energy) / energy);
        energy = after;
    }
    rise
}

/// The energy of a free body with drag falls in every step of less than 158°, in any turn and for every physical
/// inertia. In a field it stays where there is nothing left but a turn about that.
#[test]
fn p6_energy_falls() {
    let mut r = Random::new(6);
    for moments in BODIES {
        for x in STRENGTHS {
            for sample in 0..20 {
                // The velocity would turn the body by up to 60° a step without the damping.
                let velocity = r.direction() * (1.0 / STEP) * r.signed().abs();
                let c = x * moments[sample % 3] / STEP;
                let most = rise(body(moments) + drag(c, moments), velocity);
                assert!(most < 0.0, "{moments:?}, {x}, {velocity:?}: {most:e}");
                let field = r.direction() * 2.0;
                let most = rise(body(moments) + magnetic_damping(c / 4.0, field, moments), velocity);
                assert!(most < 1e-13, "{moments:?}, {x}, {velocity:?}, {field:?}: {most:e}");
            }
        }
    }
}

/// A constant torque against drag: the body ends up turning at the rate `τ/c`, by `sin θ = h τ/c` a step, at any
/// strength.
#[test]
fn p6_the_terminal_rate_is_exact() {
    let moments = [2.0, 3.0, 4.5];
    for x in STRENGTHS.into_iter().filter(|x| *x > 0.05) {
        let c = x * 4.5 / STEP;
        let torque = Vector3::new(0.0, 0.0, 0.2 * c);
        let stepper = Stepper::new(body(moments) + drag(c, moments) + Torque { torque }, STEP).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::zeros()).unwrap();
        for _ in 0..1000 {
            stepper.step(&mut state).unwrap();
        }
        let before = state.attitude().matrix();
        stepper.step(&mut state).unwrap();
        let turn = SO3::vee(&(before.transpose() * state.attitude().matrix()));
        assert!((turn.z - 0.2 * STEP).abs() < 1e-13, "{x}: {turn:?}");
    }
}

/// A field damps all but the momentum along itself, and leaves a turn about the major axis, which is then along the
/// field: the least energy for that momentum. A gain that no step resolves takes longer, as the field then holds the
/// body.
#[test]
fn p6_a_field_leaves_a_turn_about_the_major_axis() {
    let field = Vector3::new(0.0, 0.6, 0.8);
    let moments = [2.0, 3.0, 4.5];
    for (k, excess) in [(0.2, 1e-12), (20.0, 0.01), (2e6, 0.5)] {
        let stepper = Stepper::new(body(moments) + magnetic_damping(k, field, moments), STEP).unwrap();
        let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.3, -0.2));
        // The body turns nearly about its minor axis.
        let mut state = stepper.start(attitude, Vector3::new(2.0, 0.1, 0.1)).unwrap();
        let along = state.momentum_along(&field);
        let least = along * along / (2.0 * 4.5);
        for _ in 0..20_000 {
            stepper.step(&mut state).unwrap();
            assert!((state.momentum_along(&field) - along).abs() < 1e-12);
        }
        let left = stepper.energy(&state) / least - 1.0;
        println!("{k}: {left:e}");
        assert!(along.abs() > 0.5 && -1e-12 < left && left < excess, "{k}: {left:e}");
    }
}
