//! P7: a fixed run has the same bits in each build, in debug and release, for the generic and the native target.
//!
//! ```text
//! cargo run -p liestep-hard-cases --example hard-cases -- --row P7
//! RUSTFLAGS="-C target-cpu=native" cargo run --release --target-dir target/native --example hard-cases -- --row P7
//! ```
//!
//! A Cayley step consists of additions, multiplications, divisions and square roots, each rounded by IEEE 754 and in
//! the order of the expansion; nothing is fused or reordered. A change of the derivation that changes rounding changes
//! the digest, which belongs in the same commit.

use declarations::{FreeBody, HeavyTop, Motion};
use liestep::mechanics::DiscreteLagrangian;
use liestep::motion::Plan;
use liestep::numbers::{Digest, Entries as _};
use liestep::{SO3, Stepper};
use nalgebra::Vector3;

use crate::row::{Effort, Failure, Row};

/// The digest of the states of a thousand steps.
fn digest<L, P>(stepper: &Stepper<L, P>, attitude: SO3, velocity: Vector3<f64>) -> Result<u64, Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3>,
    P: Plan<L>,
{
    let (mut state, mut digest) = (stepper.start(attitude, velocity)?, Digest::default());
    for _ in 0..1000 {
        stepper.step(&mut state)?;
        let mut number = |number: f64| digest.number(number.to_bits());
        state.attitude().as_matrix().iter().chain(&state.momentum()).for_each(|entry| number(*entry));
        state.advected().each(&mut number);
    }
    Ok(digest.value())
}

/// The initial values are read from files and multiplied, so they don't depend on library functions.
pub(crate) fn p7(_: Effort) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 0.01)?;
    let looping = || digest(&stepper, motion.attitude, motion.velocity);
    let (level, velocity) = (SO3::identity(), Vector3::new(0.5, 2.0, 3.0));
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    let mut row = Row::new("P7", "the same run again", "identical bytes");
    row = row.holds("the same run twice", looping()? == looping()?);
    let compensated = digest(&stepper.clone().compensated(), motion.attitude, motion.velocity)?;
    let asymmetric = Stepper::new(HeavyTop::asymmetric(), 0.02)?;
    let free = Stepper::new(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.02)?;
    let committed = [
        ("looping top", looping()?, 0x9c10_0b19_5563_0e0c),
        ("looping top, compensated", compensated, 0x37af_7c6e_8cc1_b7f4),
        ("asymmetric top", digest(&asymmetric, level, velocity)?, 0x6fce_7211_8ba0_3d78),
        ("free body", digest(&free, level, velocity)?, 0x970e_625c_5c93_dae5),
    ];
    for (name, found, digest) in committed {
        let what = format!("{name}: the committed digest {digest:016x}, in this {build} build, is {found:016x}");
        row = row.holds(&what, found == digest);
    }
    Ok(row.shows("saved (JSON, binary) and resumed at random steps: tests/robustness/checkpoints.rs"))
}
