//! P7: the same bits again.

use liestep::laws::samples::Random;
use liestep::{Checkpoint, Stepper};

use crate::curves::Curves;
use crate::measure::steps_in;
use crate::motion::Motion;
use crate::row::{Effort, Failure, Row};
use crate::walk::TopState;

/// FNV-1a of the numbers of a state, 64 bits.
fn digest(mut hash: u64, state: &TopState) -> u64 {
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
    let motion = Motion::looping()?;
    let (first, second) = (thousand_steps(&motion)?, thousand_steps(&motion)?);
    let stepper = Stepper::new(motion.top.clone(), 0.01)?;
    let mut state = stepper.start(motion.attitude, motion.velocity)?;
    let (mut random, mut resumed_alike) = (Random::new(7), true);
    for _ in 0..20 {
        for _ in 0..steps_in(random.signed().abs(), 0.001) {
            stepper.step(&mut state)?;
        }
        let saved = stepper.checkpoint(&state);
        let text: Checkpoint<f64> = serde_json::from_str(&serde_json::to_string(&saved)?)?;
        let binary: Checkpoint<f64> = postcard::from_bytes(&postcard::to_stdvec(&saved)?)?;
        for stored in [text, binary] {
            let (mut on, mut resumed) = (state, stepper.resume(&stored)?);
            for _ in 0..100 {
                stepper.step(&mut on)?;
                stepper.step(&mut resumed)?;
                resumed_alike &= digest(0, &on) == digest(0, &resumed);
            }
        }
    }
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    let row = Row::new("P7", "the same run again, and from a file", "identical bytes")
        .holds("the same run twice", first == second)
        .holds(&format!("the committed digest {COMMITTED:016x}, in this {build} build"), first == COMMITTED)
        .holds("saved (JSON, binary) and resumed at 20 random steps", resumed_alike)
        .shows("debug and release, generic and native: tests/hard_cases/structure/digest.rs");
    Ok(row)
}
