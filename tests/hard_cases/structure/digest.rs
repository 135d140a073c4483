//! A fixed run has fixed bytes: from one build to the next, from debug to release, from the generic to the native
//! target.
//!
//! ```text
//! cargo test --test hard_cases digest
//! cargo test --release --test hard_cases digest
//! RUSTFLAGS="-C target-cpu=native" cargo test --release --test hard_cases --target-dir target/native digest
//! ```
//!
//! A Cayley step has additions, multiplications, divisions and square roots only, each rounded as IEEE 754 says and in
//! the order that the expansion wrote; nothing is fused or reordered. A change of the derivation that changes roundings
//! changes the digest, and belongs in the history with it.

use declarations::Motion;
use declarations::{FreeBody, HeavyTop};
use liestep::groups::LieGroup as _;
use liestep::mechanics::Effect;
use liestep::motion::Motion as Moving;
use liestep::{SO3, State, Stepper};
use nalgebra::Vector3;

const STEPS: u32 = 1000;

/// FNV-1a, 64 bits.
struct Digest(u64);

impl Digest {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, number: f64) {
        for byte in number.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn add_state<A: liestep::groups::Advected<SO3>>(&mut self, state: &Moving<SO3, A>) {
        state.attitude().as_matrix().iter().chain(&state.momentum()).for_each(|&number| self.add(number));
        liestep::numbers::Entries::<f64>::each(&state.advected(), &mut |number| self.add(number));
    }
}

fn of_steps<L: Effect<Scalar = f64, Group = SO3>>(stepper: &Stepper<L>, start: State<SO3, L::Advected>) -> u64 {
    let (mut state, mut digest) = (start, Digest::new());
    for _ in 0..STEPS {
        stepper.step(&mut state).unwrap();
        digest.add_state(&state);
    }
    digest.0
}

/// The looping top of the thesis, (3.13), `h = 0.01`. The start is read from a file and multiplied, so no library
/// function has a part in it.
#[test]
fn p7_heavy_top() {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 0.01).unwrap();
    let start = stepper.start(motion.attitude, motion.velocity).unwrap();
    assert_eq!(of_steps(&stepper, start), 0x9c10_0b19_5563_0e0c);

    let carrying = stepper.compensated();
    let (mut state, mut digest) = (carrying.adopt(&start), Digest::new());
    for _ in 0..STEPS {
        carrying.step(&mut state).unwrap();
        digest.add_state(&state);
    }
    assert_eq!(digest.0, 0x37af_7c6e_8cc1_b7f4);
}

#[test]
fn p7_asymmetric_top_and_free_body() {
    let top = Stepper::new(HeavyTop::asymmetric(), 0.02).unwrap();
    let found = of_steps(&top, top.start(SO3::identity(), Vector3::new(0.5, 2.0, 3.0)).unwrap());
    assert_eq!(found, 0x6fce_7211_8ba0_3d78);
    let body = Stepper::new(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.02).unwrap();
    let found = of_steps(&body, body.start(SO3::identity(), Vector3::new(0.5, 2.0, 3.0)).unwrap());
    assert_eq!(found, 0x970e_625c_5c93_dae5);
}
