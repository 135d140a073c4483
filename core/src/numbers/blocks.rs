//! Block structure of a matrix of several bodies, and the unknowns that are solved together.

/// The ends of the blocks on the diagonal of a matrix, in which the unknowns of a body are in one block. It has at most
/// [`MOST`](Self::MOST) unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks(u64);

impl Blocks {
    /// Limit of the unknowns in several blocks. A product of groups with more doesn't compile.
    pub const MOST: usize = 64;

    /// All unknowns in one block.
    pub const WHOLE: Self = Self(0);

    /// The blocks of the first `size` unknowns, followed by other blocks.
    #[must_use]
    pub const fn then(self, size: usize, behind: Self) -> Self {
        Self(self.0 | 1 << size | behind.0 << size)
    }

    /// The finest blocks that contain both: those of a sum of two matrices.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Whether there is one block.
    #[must_use]
    pub const fn is_whole(self) -> bool {
        self.0 == 0
    }

    /// Whether a block ends before the unknown `k`.
    #[must_use]
    pub const fn end_at(self, k: usize) -> bool {
        self.0 >> k & 1 == 1
    }

    /// Whether the unknowns from `start` to `end` are in one block.
    pub(super) const fn are_one(self, start: usize, end: usize) -> bool {
        self.end(start, end) == end
    }

    /// End of the block that begins with the unknown `start`, in a matrix of `dimension` unknowns.
    pub(super) const fn end(self, start: usize, dimension: usize) -> usize {
        let mut end = start + 1;
        while end < dimension && !self.end_at(end) {
            end += 1;
        }
        end
    }
}

/// The sparsity of a Newton matrix, known before its entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// The unknowns of each factor of the group.
    pub factors: Blocks,
    /// The independent groups of unknowns: between these blocks the matrix is zero. They end where factors end.
    pub apart: Blocks,
}

impl Pattern {
    /// A full matrix: all unknowns are one block.
    pub const WHOLE: Self = Self { factors: Blocks::WHOLE, apart: Blocks::WHOLE };
}
