//! A declaration that is read while a program runs, beside the one that is compiled: `cargo bench --bench late`.
//!
//! Times of a step in turns within one run, the fastest of all batches; and how long it takes from a text to the first step.

use std::hint::black_box;
use std::time::Instant;

use declarations::{FourthOrderTop, FullTop};
use liestep::mechanics::{Inertia, KineticPart, Regular, WithExpensiveKinetic, WithKinetic};
use liestep::prelude::*;
use liestep_late::Late;
use nalgebra::{Matrix3, Vector3};

const STEPS: u32 = 2_000;
const ROUNDS: usize = 300;

const FULL: &str = "#[lagrangian(group = SO3, advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho)))]
    struct Top { J_d: NonstandardInertia, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }";

const FOURTH: &str = "#[lagrangian(group = SO3, advected(w = up), l_d = {
        let xi = log(F);
        let x = 2.0 * vee(F) / (1.0 + F.trace()).sqrt();
        let next = F.transpose() * w;
        let f = (J * x).cross(&x) / h.powi(2) + 0.5 * weight * (w + next).cross(&rho);
        xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * (w + next).dot(&rho)
            + (h / 12.0) * weight * (next - w).cross(&x).dot(&rho)
            - (h.powi(3) / 24.0) * f.dot(&(inverse(J) * f))
    })]
    struct Top { J: Inertia, weight: f64, rho: Vector3<f64>, up: Vector3<f64> }";

fn main() {
    let (rho, up) = (Vector3::new(0.1, -0.2, 0.4), Vector3::z());
    let inertia = Inertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0)).expect("an inertia");
    let J_d = inertia.to_nonstandard();
    let full = FullTop { J_d, m: 1.5, g: 9.81, rho, up };
    compare("(3.13), any inertia", full, || {
        let top = top::<WithKinetic>(FULL, ("J_d", J_d.as_matrix()), rho)?;
        top.with("m", &[1.5])?.with("g", &[9.81])
    });
    let fourth = FourthOrderTop { J: inertia, weight: 1.5 * 9.81, rho, up };
    compare("of the fourth order", fourth, || {
        top::<WithExpensiveKinetic>(FOURTH, ("J", inertia.as_matrix()), rho)?.with("weight", &[1.5 * 9.81])
    });
}

type LateTop<K> = Late<SO3, Vector3<f64>, K>;

fn top<K: KineticPart>(
    text: &str,
    (name, inertia): (&str, &Matrix3<f64>),
    rho: Vector3<f64>,
) -> Result<LateTop<K>, liestep_late::LateError> {
    LateTop::parse(text)?.with(name, inertia.as_slice())?.with("rho", rho.as_slice())?.with("up", &[0.0, 0.0, 1.0])
}

fn compare<A, B>(name: &str, compiled: A, late: impl Fn() -> Result<B, liestep_late::LateError>)
where
    A: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
    B: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let clock = Instant::now();
    let other = Stepper::new(late().expect("a declaration"), 0.01).expect("a step");
    let mut second = start(&other);
    other.step(&mut second).expect("a step");
    let first_step = clock.elapsed().as_secs_f64() * 1e3;
    let one = Stepper::new(compiled, 0.01).expect("a step");
    let mut first = start(&one);
    one.step(&mut first).expect("a step");
    let mut least = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        least[0] = least[0].min(timed(&one, &mut first));
        least[1] = least[1].min(timed(&other, &mut second));
    }
    assert_eq!(first.momentum(), second.momentum(), "the same bits");
    let [compiled, read] = least;
    println!(
        "{name:24} compiled {compiled:6.0} ns a step, read {read:6.0} ns, {:.2} times; from the text to the first step {first_step:.1} ms",
        read / compiled
    );
}

fn start<S: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>>(stepper: &Stepper<S>) -> StateOf<S> {
    stepper.start(SO3::exp(Vector3::new(0.8, 0.0, 0.0)), Vector3::new(0.5, 2.0, 6.0)).expect("a start")
}

/// ns a step.
fn timed<S: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>>(
    stepper: &Stepper<S>,
    state: &mut StateOf<S>,
) -> f64 {
    let clock = Instant::now();
    for _ in 0..STEPS {
        stepper.step(state).expect("a step");
    }
    black_box(&state);
    clock.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS)
}
