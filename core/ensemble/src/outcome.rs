//! What has become of members: of a chunk, of a folder of chunks, of all.

use serde::{Deserialize, Serialize};

use crate::failure::MemberFailure;
use crate::reduce::{Moments, Summary};

/// What has become of members, and what was made of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// How many came to their ends.
    pub finished: u64,
    /// How many [left](crate::Section::until) before.
    pub left: u64,
    /// How many could be followed no further.
    pub stopped: u64,
    /// How many couldn't be made.
    pub impossible: u64,
    /// Those that stopped or couldn't be made; of several chunks the first ten of each kind.
    pub failures: Vec<MemberFailure>,
    /// How those that finished or left crossed each section.
    pub passages: Vec<Passages>,
    /// What ends and crossings were reduced to, in the order of the plan.
    pub reduced: Vec<Summary>,
}

/// How members crossed a surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Passages {
    /// How often.
    pub times: u64,
    /// The times of first crossings, s: one of each member that has crossed it.
    pub first: Moments,
}

impl Outcome {
    /// How many neither finished nor left.
    #[must_use]
    pub fn failed(&self) -> u64 {
        self.stopped + self.impossible
    }

    /// Both have to be of one plan.
    pub(crate) fn merge(&mut self, other: &Self) {
        /// All are in the chunks.
        const SHOWN: usize = 10;
        self.finished += other.finished;
        self.left += other.left;
        self.stopped += other.stopped;
        self.impossible += other.impossible;
        for failed in &other.failures {
            if self.failures.iter().filter(|own| own.was_made == failed.was_made).count() < SHOWN {
                self.failures.push(failed.clone());
            }
        }
        for (own, other) in self.passages.iter_mut().zip(&other.passages) {
            own.times += other.times;
            own.first.merge(&other.first);
        }
        self.reduced.iter_mut().zip(&other.reduced).for_each(|(own, other)| own.merge(other));
    }
}
