//! Outcomes of members: of a chunk, of a folder of chunks, or of all.

use serde::{Deserialize, Serialize};

use crate::failure::MemberFailure;
use crate::reduce::{Moments, Summary};

/// The outcome of members: counts, failures and reductions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Members that completed their steps.
    pub finished: u64,
    /// Members that [left](crate::Section::until) before.
    pub left: u64,
    /// Members that failed on the way.
    pub stopped: u64,
    /// Members that couldn't be constructed.
    pub impossible: u64,
    /// The failures; of several chunks the first ten of each kind.
    pub failures: Vec<MemberFailure>,
    /// The crossings of each section by members that finished or left.
    pub passages: Vec<Passages>,
    /// The reductions of ends and crossings, in the order of the plan.
    pub reduced: Vec<Summary>,
}

/// The crossings of a surface by members.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Passages {
    /// The number of crossings.
    pub times: u64,
    /// The times of first crossings, s, of the members that crossed.
    pub first: Moments,
}

impl Outcome {
    /// Members that neither finished nor left.
    #[must_use]
    pub fn failed(&self) -> u64 {
        self.stopped + self.impossible
    }

    /// Adds another outcome of the same plan.
    pub(crate) fn merge(&mut self, other: &Self) {
        /// The shards have all failures.
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
