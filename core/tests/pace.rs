//! A pace: steps of a transformed time.
use liestep::prelude::*;

#[lagrangian(
    group = SO3,
    advected(w = a),
    given(E_0 = energy),
    pace = {
        let u = w.norm_squared() - 2.0 * w.dot(&rho) + rho.norm_squared() + delta * delta;
        2.0 * u.sqrt() * u.sqrt().sqrt()
    },
    l_d = {
        let U = |w: Vector3<f64>| w.norm_squared() - 2.0 * w.dot(&rho) + rho.norm_squared() + delta * delta;
        let now = U(w);
        let next = U(F.transpose() * w);
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + 0.5 * h * (1.0 / now.sqrt() + 1.0 / next.sqrt())
    },
)]
#[derive(Clone, Copy, Debug)]
struct Needle {
    J_d: NonstandardInertia,
    a: Vector3<f64>,
    rho: Vector3<f64>,
    delta: f64,
    energy: f64,
}

/// The rewriting as it is in the documents, written by hand.
#[lagrangian(
    group = SO3,
    advected(w = a),
    given(E_0 = energy),
    l_d = {
        let U = |w: Vector3<f64>| w.norm_squared() - 2.0 * w.dot(&rho) + rho.norm_squared() + delta * delta;
        let now = U(w);
        let next = U(F.transpose() * w);
        let k = h * (now.sqrt() * now.sqrt().sqrt() + next.sqrt() * next.sqrt().sqrt());
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * k)
            + 0.5 * k * (1.0 / now.sqrt() + 1.0 / next.sqrt()) + k * E_0
    },
)]
#[derive(Clone, Copy, Debug)]
struct ByHand {
    J_d: NonstandardInertia,
    a: Vector3<f64>,
    rho: Vector3<f64>,
    delta: f64,
    energy: f64,
}

fn needle() -> Needle {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 1.4, 2.0)).unwrap();
    Needle { J_d, a: Vector3::new(0.0, 0.6, 0.8), rho: Vector3::z(), delta: 0.05, energy: 0.0 }
}

#[test]
fn by_hand() {
    let body = needle();
    println!("{}", liestep::mechanics::Effect::derivation(&body));
    let stepper = Stepper::new(body, 0.012).unwrap().paced().unwrap();
    let mut state = stepper.start_with_momentum(SO3::identity(), Vector3::new(0.9, 0.15, 0.3)).unwrap();
    println!("{}", stepper.energy(&state));
    for _ in 0..10 { println!("{:?} {} {}", stepper.step(&mut state), stepper.time(&state), stepper.energy(&state)); }
}
