//! Where the blocks of a matrix of several bodies end, and which unknowns solve together.

/// Where the blocks on the diagonal of a matrix end: the unknowns of a body are in one block. Of at most
/// [`MOST`](Self::MOST) unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks(u64);

impl Blocks {
    /// The most unknowns that several blocks may have. A product of groups with more doesn't compile.
    pub const MOST: usize = 64;

    /// One block.
    pub const WHOLE: Self = Self(0);

    /// Blocks of `size` unknowns, and behind them others.
    #[must_use]
    pub const fn then(self, size: usize, behind: Self) -> Self {
        Self(self.0 | 1 << size | behind.0 << size)
    }

    /// The finest blocks that have no end within a block of either: those of a sum of two matrices.
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

    /// Where the block that begins with the unknown `start` ends, of `dimension` in all.
    pub(super) const fn end(self, start: usize, dimension: usize) -> usize {
        let mut end = start + 1;
        while end < dimension && !self.end_at(end) {
            end += 1;
        }
        end
    }
}

/// What is known of a Newton matrix before it is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// The unknowns of each factor of the group.
    pub factors: Blocks,
    /// The unknowns that solve together; between these blocks the matrix is zero. They end where factors end.
    pub apart: Blocks,
}

impl Pattern {
    /// Nothing is known: all unknowns are one block.
    pub const WHOLE: Self = Self { factors: Blocks::WHOLE, apart: Blocks::WHOLE };
}
