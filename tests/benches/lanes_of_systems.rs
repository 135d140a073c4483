//! Steps a second of eight scenes of several bodies on one core: one after another, and in SIMD lanes.
//!
//! ```text
//! cargo bench --bench lanes-of-systems
//! ```
//!
//! Each of the eight has its own initial state. Their steps alone and in lanes agree, which is asserted before the
//! timing; they take turns within one run, and the fastest batch of each counts, as in `lanes`.

use core::array::from_fn;
use core::fmt::Debug;
use core::hint::black_box;
use std::time::Instant;

use declarations::{Alike, DoublePendulum, TopOnCart, TwoBodies};
use liestep::effects::PrincipalBody;
use liestep::groups::{R2, R3};
use liestep::mechanics::{Along, DiagonalNonstandardInertia, Each};
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{SVector, Vector2, Vector3};
use simba::simd::AutoF64x8;

const SCENES: usize = 8;
const STEP: f64 = 0.01;

/// A small turn, different for each scene and body.
fn turn(scene: usize, body: usize) -> SO3 {
    #[allow(clippy::cast_precision_loss)] // small counts
    let (a, b) = (scene as f64, body as f64);
    SO3::exp(Vector3::new(0.5 + 0.05 * a, 0.1 * b, -0.3 + 0.02 * a * b))
}

/// Components of a velocity.
fn velocity<const D: usize>(scene: usize) -> SVector<f64, D> {
    #[allow(clippy::cast_precision_loss)] // small counts
    SVector::from_fn(|k, _| 0.5 - 0.3 * (k % 4) as f64 + 0.04 * scene as f64)
}

fn body() -> NonstandardInertia {
    NonstandardInertia::from_principal_moments(Vector3::new(0.5, 0.4, 1.0 / 3.0)).expect("a body")
}

/// Steps of each scene in a batch, and the number of batches.
const BATCH: u64 = 500;
const ROUNDS: usize = 200;

/// Times eight scenes one after another, and in lanes.
fn compare<M>(name: &str, scenes: [(M, M::State); SCENES])
where
    M: Batchable<AutoF64x8> + Integrator<State: PartialEq + Debug>,
{
    let mut batch = Batch::<AutoF64x8, M>::new(&scenes).expect("scenes that are alike");
    let mut alone = scenes;
    let run = |alone: &mut [(M, M::State); SCENES]| {
        for (stepper, state) in alone {
            stepper.run(state, BATCH).expect("solvable steps");
        }
    };
    run(&mut alone);
    batch.run(BATCH);
    for (number, (_, state)) in alone.iter().enumerate() {
        assert_eq!(&batch.state(number), state, "{name} {number}");
    }
    let (mut fast, mut slow) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        slow = slow.min(seconds(|| run(black_box(&mut alone))));
        fast = fast.min(seconds(|| black_box(&mut batch).run(BATCH)));
    }
    #[allow(clippy::cast_precision_loss)] // some thousand steps
    let made = (BATCH * SCENES as u64) as f64 / 1e6;
    println!("{name:<20}{:>12.2}{:>12.2}{:>12.2}", made / slow, made / fast, slow / fast);
}

fn seconds(run: impl FnOnce()) -> f64 {
    let start = Instant::now();
    run();
    start.elapsed().as_secs_f64()
}

/// A row of bodies with alignment potentials between neighbours.
fn row<const N: usize>() {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0)).expect("a body");
    let scene = Each::<N>::of([PrincipalBody { J_d }]) + Along::<N>::of([Alike { kappa: 2.0 }]);
    let started = |number: usize| {
        let stepper = Stepper::new(scene, STEP).expect("a usable step");
        let velocities = Bodies([velocity(number); N]);
        let state = stepper.start(from_fn::<_, N, _>(|body| turn(number, body)), velocities).expect("a usable start");
        (stepper, state)
    };
    compare(&format!("row of {N}"), from_fn(started));
}

fn main() {
    println!("{:<20}{:>12}{:>12}{:>12}", "10⁶ steps a second", "alone", "in lanes", "ratio");
    compare(
        "double pendulum",
        from_fn(|number| {
            let stepper = Stepper::new(DoublePendulum::asymmetric(), STEP).expect("a usable step");
            let state = stepper.start((turn(number, 0), turn(number, 1)), velocity(number)).expect("a usable start");
            (stepper, state)
        }),
    );
    compare(
        "top on a cart",
        from_fn(|number| {
            let top = TopOnCart { J_d: body(), s: Vector3::z() * 0.4, M: 2.0, g: 9.81 };
            let stepper = Stepper::new(top, STEP).expect("a usable step");
            let place = (turn(number, 0), R2::from(Vector2::zeros()));
            let state = stepper.start(place, velocity(number)).expect("a usable start");
            (stepper, state)
        }),
    );
    compare(
        "two-body problem",
        from_fn(|number| {
            let (K_1, K_2) = (body(), body());
            let (J_1, J_2) = (K_1.to_inertia(), K_2.to_inertia());
            let scene = TwoBodies { m_1: 1.0, m_2: 0.4, K_1, K_2, J_1, J_2, G: 1.0 };
            let stepper = Stepper::new(scene, STEP).expect("a usable step");
            let [near, far] = [0.0, 4.0].map(|x| R3::from(Vector3::x() * x));
            // The two bodies move side by side.
            let turning = velocity::<3>(number);
            let moving: SVector<f64, 12> =
                from_fn::<_, 12, _>(|k| if k % 6 < 3 { turning[k % 3] } else { 0.1 * turning[k % 3] }).into();
            let state = stepper.start((turn(number, 0), near, turn(number, 1), far), moving).expect("a usable start");
            (stepper, state)
        }),
    );
    row::<4>();
    row::<32>();
}
