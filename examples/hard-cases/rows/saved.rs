//! P7: a fixed run has fixed bytes: from one build to the next, from debug to release, from the generic to the native
//! target.
//!
//! ```text
//! cargo run --example hard-cases -- --row P7
//! RUSTFLAGS="-C target-cpu=native" cargo run --release --target-dir target/native --example hard-cases -- --row P7
//! ```
//!
//! A Cayley step has additions, multiplications, divisions and square roots only, each rounded as IEEE 754 says and in
//! the order that the expansion wrote; nothing is fused or reordered. A change of the derivation that changes roundings
//! changes the digest, and belongs in the history with it.

use declarations::{FreeBody, HeavyTop, Motion};
use liestep::groups::Advected;
use liestep::mechanics::Regular;
use liestep::motion;
use liestep::{SO3, Stepper};
use nalgebra::Vector3;

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};

/// FNV-1a, 64 bits, of the states of a run.
struct Digest(u64);

impl Digest {
    const EMPTY: Self = Self(0xcbf2_9ce4_8422_2325);

    fn add<A: Advected<SO3>>(&mut self, state: &motion::Motion<SO3, A>) {
        let mut number = |number: f64| {
            for byte in number.to_bits().to_le_bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        };
        state.attitude().as_matrix().iter().chain(&state.momentum()).for_each(|entry| number(*entry));
        state.advected().each(&mut number);
    }
}

/// Of a thousand steps.
fn digest<L: Regular<Scalar = f64, Group = SO3>>(
    lagrangian: L,
    h: f64,
    attitude: SO3,
    velocity: Vector3<f64>,
) -> Result<u64, Failure> {
    let stepper = Stepper::new(lagrangian, h)?;
    let (mut state, mut digest) = (stepper.start(attitude, velocity)?, Digest::EMPTY);
    for _ in 0..1000 {
        stepper.step(&mut state)?;
        digest.add(&state);
    }
    Ok(digest.0)
}

/// The same with compensated sums.
fn compensated_digest(motion: &Motion) -> Result<u64, Failure> {
    let stepper = Stepper::new(motion.top.clone(), 0.01)?.compensated();
    let (mut state, mut digest) = (stepper.start(motion.attitude, motion.velocity)?, Digest::EMPTY);
    for _ in 0..1000 {
        stepper.step(&mut state)?;
        digest.add(&state);
    }
    Ok(digest.0)
}

/// The starts are read from files and multiplied, so no library function has a part in them.
pub(crate) fn p7(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let looping = || digest(motion.top.clone(), 0.01, motion.attitude, motion.velocity);
    let (level, velocity) = (SO3::identity(), Vector3::new(0.5, 2.0, 3.0));
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    let mut row = Row::new("P7", "the same run again", "identical bytes");
    row = row.holds("the same run twice", looping()? == looping()?);
    let committed = [
        ("looping top", looping()?, 0x9c10_0b19_5563_0e0c),
        ("looping top, compensated", compensated_digest(&motion)?, 0x37af_7c6e_8cc1_b7f4),
        ("asymmetric top", digest(HeavyTop::asymmetric(), 0.02, level, velocity)?, 0x6fce_7211_8ba0_3d78),
        ("free body", digest(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.02, level, velocity)?, 0x970e_625c_5c93_dae5),
    ];
    for (name, found, digest) in committed {
        let what = format!("{name}: the committed digest {digest:016x}, in this {build} build, is {found:016x}");
        row = row.holds(&what, found == digest);
    }
    Ok(row.shows("saved (JSON, binary) and resumed at random steps: tests/robustness/checkpoints.rs"))
}
