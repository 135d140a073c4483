//! P7: the same bits again.

use declarations::Motion;
use liestep::Stepper;

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};
use crate::walk::TopMotion;

/// FNV-1a of the numbers of a state, 64 bits.
fn digest(mut hash: u64, state: &TopMotion) -> u64 {
    let attitude = state.attitude();
    let numbers = attitude.as_matrix().iter().chain(&state.momentum()).copied().collect::<Vec<_>>();
    for byte in numbers.iter().chain(&state.advected()).flat_map(|number| number.to_bits().to_le_bytes()) {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    hash
}

/// The digest of a thousand steps of the looping top that `tests/hard_cases/structure/digest.rs` has committed.
const COMMITTED: u64 = 0x9c10_0b19_5563_0e0c;

fn thousand_steps(motion: &Motion) -> Result<u64, Failure> {
    let stepper = Stepper::new(motion.top.clone(), 0.01)?;
    let mut state = stepper.start(motion.attitude, motion.velocity)?;
    let mut hash = 0xcbf2_9ce4_8422_2325;
    for _ in 0..1000 {
        stepper.step(&mut state)?;
        hash = digest(hash, &state);
    }
    Ok(hash)
}

pub(crate) fn p7(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let (first, second) = (thousand_steps(&motion)?, thousand_steps(&motion)?);
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    let row = Row::new("P7", "the same run again", "identical bytes")
        .holds("the same run twice", first == second)
        .holds(&format!("the committed digest {COMMITTED:016x}, in this {build} build"), first == COMMITTED)
        .shows("debug and release, generic and native: tests/hard_cases/structure/digest.rs")
        .shows("saved (JSON, binary) and resumed at random steps: tests/robustness/checkpoints.rs");
    Ok(row)
}
