//! The sizes of chunks: functions of the plan and the chunk's number, and not of the number of members.

use crate::section::LANES;

/// The numbers of members of chunks: `least` in the first ones, twice as many after each [`FEW`](Self::FEW) chunks of one
/// size, from a part of a second's work on after [`SOME`](Self::SOME), from a second's on after [`MANY`](Self::MANY), and
/// `most` in the end.
///
/// A member's chunk is the same in each ensemble that has the member, so that more members extend a folder. All workers
/// have some chunks, though an estimate of the work is too low, and very many members go to a few thousand files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sizes {
    pub(crate) least: u64,
    /// The members of a second's work of one core.
    pub(crate) second: u64,
    pub(crate) most: u64,
}

impl Sizes {
    const FEW: u64 = 16;
    const SOME: u64 = 64;
    const MANY: u64 = 1024;
    /// Parts of a second: one is a work beside which writing a file is cheap.
    const PARTS: u64 = 32;

    /// One size of all chunks.
    pub(crate) fn all_of(members: u64) -> Self {
        Self { least: members, second: members, most: members }
    }

    /// The sizes for members of which a core moves `second` in a second, and of which one file has `most` at most. Chunks
    /// of lanes fill them if they have enough members.
    pub(crate) fn of_work(second: u64, most: u64, has_lanes: bool) -> Self {
        let lanes = if has_lanes { LANES as u64 } else { 1 };
        let most = if most >= lanes { most - most % lanes } else { most.max(1) };
        Self { least: lanes.min(most), second, most }
    }

    /// The sizes in order, each with the number of its chunks.
    fn classes(self) -> impl Iterator<Item = (u64, u64)> {
        let mut next = Some(self.least);
        core::iter::from_fn(move || {
            let size = next?;
            if size >= self.most {
                next = None;
                return Some((size, u64::MAX));
            }
            next = Some((2 * size).min(self.most));
            let count = match size {
                size if size < self.second / Self::PARTS => Self::FEW,
                size if size < self.second => Self::SOME,
                _ => Self::MANY,
            };
            Some((size, count))
        })
    }

    /// The first member of a chunk.
    pub(crate) fn first(self, chunk: u64) -> u64 {
        let (mut first, mut left) = (0_u64, chunk);
        for (size, count) in self.classes() {
            first = first.saturating_add(size.saturating_mul(left.min(count)));
            left -= left.min(count);
            if left == 0 {
                break;
            }
        }
        first
    }

    /// The number of chunks of so many members.
    pub(crate) fn chunks(self, members: u64) -> u64 {
        let (mut chunks, mut left) = (0, members);
        for (size, count) in self.classes() {
            let needed = left.div_ceil(size).min(count);
            chunks += needed;
            left = left.saturating_sub(size.saturating_mul(needed));
            if left == 0 {
                break;
            }
        }
        chunks
    }
}

#[cfg(test)]
mod tests {
    use super::Sizes;

    /// Chunks follow one another without gaps, and their number is that of the first members below the number of members:
    /// counted one by one, without the sums.
    #[test]
    fn chunks_follow_one_another() {
        for sizes in [Sizes::all_of(7), Sizes::of_work(3000, 4096, true), Sizes::of_work(20, 31, false)] {
            let mut firsts = vec![0];
            for chunk in 1..2500 {
                let (before, first) = (firsts[chunk - 1], sizes.first(chunk as u64));
                assert!(first > before && first - before <= sizes.most, "{sizes:?}, {chunk}");
                firsts.push(first);
            }
            let sizes_of: Vec<u64> = firsts.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(sizes_of.is_sorted() && sizes_of[0] == sizes.least && sizes_of.last() == Some(&sizes.most));
            for members in 0..4_000 {
                let begun = firsts.iter().filter(|first| **first < members).count();
                assert_eq!(sizes.chunks(members), begun as u64, "{sizes:?}, {members}");
            }
        }
        assert_eq!(Sizes::all_of(1 << 40).first(u64::MAX), u64::MAX);
    }

    /// Chunks of lanes are whole lanes, or fewer members than lanes.
    #[test]
    fn chunks_of_lanes_are_whole() {
        for (second, most) in [(1, 1 << 20), (0, 5), (3000, 4097), (1 << 25, 1 << 20)] {
            let Sizes { least, most, .. } = Sizes::of_work(second, most, true);
            assert!(least <= most && [least, most].iter().all(|size| size % 8 == 0 || *size < 8), "{least}, {most}");
        }
    }
}
