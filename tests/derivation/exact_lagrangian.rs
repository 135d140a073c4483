//! (1.18) and property 3 of section 1.4: the distance of `l_d` from the action of a step, and its consequences.

use declarations::{FourthOrderTop, HeavyTop, LogTop, SixthOrderTop, Top};
use liestep::mechanics::{DiscreteLagrangian, Inertia};
use liestep::prelude::*;
use nalgebra::{Matrix3, Matrix3x4, UnitQuaternion, Vector3};
use workbench::measure::{four_halvings, order};
use workbench::runge_kutta;

/// The action `∫₀ʰ l dt` along the motion that begins with a velocity and a vertical, and the increment of that motion,
/// by the classical Runge–Kutta method and Simpson's rule.
fn exact(top: &HeavyTop, velocity: Vector3<f64>, w: Vector3<f64>, h: f64) -> (f64, Matrix3<f64>) {
    const STEPS: u32 = 64;
    let moments = top.moments();
    let seen = |f: &Matrix3<f64>| f.transpose() * w;
    // The attitude and the velocity side by side.
    let joined = |f: Matrix3<f64>, o: Vector3<f64>| Matrix3x4::from_fn(|i, j| if j < 3 { f[(i, j)] } else { o[i] });
    let apart = |z: &Matrix3x4<f64>| (z.fixed_columns::<3>(0).into_owned(), z.column(3).into_owned());
    let l = |z: &Matrix3x4<f64>| {
        let (f, o) = apart(z);
        0.5 * o.dot(&moments.component_mul(&o)) - top.m * top.g * seen(&f).dot(&top.rho)
    };
    let rate = |z: Matrix3x4<f64>| {
        let (f, o) = apart(&z);
        let torque = moments.component_mul(&o).cross(&o) + seen(&f).cross(&top.rho) * (top.m * top.g);
        joined(f * o.cross_matrix(), torque.component_div(&moments))
    };
    let t = h / f64::from(STEPS);
    let (mut z, mut action) = (joined(Matrix3::identity(), velocity), 0.0);
    for i in 0..STEPS {
        action += l(&z) * if i == 0 { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        z += runge_kutta::change(z, t, rate);
    }
    ((action + l(&z)) * t / 3.0, apart(&z).0)
}

/// A Lagrangian of order `r` differs from the action of a step by `O(h^{r+1})`: [MW01], theorem 2.3.1.
#[test]
fn order_of_the_action() {
    let top = HeavyTop::asymmetric();
    let (velocity, w) = (Vector3::new(0.5, 1.0, -1.5), Vector3::new(0.3, 0.5, 0.8).normalize());
    let measured = |l_d: &dyn Fn(&Matrix3<f64>, f64) -> f64, coarsest: f64| {
        let errors = four_halvings(coarsest).map(|h| {
            let (action, f) = exact(&top, velocity, w, h);
            (h, (l_d(&f, h) - action).abs())
        });
        order(&errors, 1e-14)
    };
    let (fourth, sixth) = (FourthOrderTop::of(&top), SixthOrderTop::of(&top));
    let second = measured(&|f, h| top.l_d(f, &w, h), 0.02);
    let fourth = measured(&|f, h| fourth.l_d(f, &w, h), 0.1);
    let sixth = measured(&|f, h| sixth.l_d(f, &w, h), 0.4);
    println!("orders of the action: {second:.3}, {fourth:.3}, {sixth:.3}");
    assert!((second - 3.0).abs() < 0.05, "{second}");
    assert!((fourth - 5.0).abs() < 0.1, "{fourth}");
    assert!((sixth - 7.0).abs() < 0.2, "{sixth}");
}

/// `ξ·Jξ/(2h)` with `ξ = log F` is the action of a free sphere, so the points of its path are those of the motion, for
/// any step.
#[test]
fn a_free_sphere_turns_exactly() {
    let sphere = Inertia::from_principal_moments(Vector3::repeat(0.7)).unwrap();
    let velocity = Vector3::new(0.4, -1.1, 0.7);
    let start = UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.9, -0.5));
    let turned = |t: f64| SO3::from(start * UnitQuaternion::from_scaled_axis(velocity * t));
    let missed = |end: &SO3, t: f64| (end.as_matrix() - turned(t).as_matrix()).norm();
    for h in [0.01, 0.3, 1.0, 2.0] {
        let free = LogTop { J: sphere, weight: 0.0, rho: Vector3::zeros(), up: Vector3::z() };
        let stepper = Stepper::new(free, h).unwrap();
        let mut state = stepper.start(start, velocity).unwrap();
        for i in 1..=100 {
            stepper.step(&mut state).unwrap();
            let error = missed(&state.attitude(), h * f64::from(i));
            assert!(error < 1e-13 * f64::from(i), "h = {h}: off by {error:e} after {i} steps");
        }
    }
    // (3.13) isn't that action: its phase has a relative error of (hΩ)²/6.
    let J_d = DiagonalNonstandardInertia::from_diagonal(Vector3::repeat(0.35)).unwrap();
    let stepper = Stepper::new(PrincipalBody { J_d }, 0.3).unwrap();
    let mut state = stepper.start(start, velocity).unwrap();
    stepper.run(&mut state, 10).unwrap();
    assert!(missed(&state.attitude(), 3.0) > 1e-2, "{:e}", missed(&state.attitude(), 3.0));
}
