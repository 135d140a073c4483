//! Hashes by which files are compared.

use core::fmt;

/// A hash by FNV-1a, 64 bits, of Fowler, Noll and Vo. A change of one byte always changes it, as each step is a
/// bijection. It is no protection against forgery.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Digest(u64);

impl Default for Digest {
    /// The offset basis.
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl From<u64> for Digest {
    fn from(value: u64) -> Self {
        Self(value)
    }
}

impl Digest {
    /// The hash of a sequence of bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> u64 {
        let mut digest = Self::default();
        digest.bytes(bytes);
        digest.0
    }

    /// The hash of a whole file, eight bytes at a time, so that it costs less than reading the file. Each step is a
    /// bijection here, too, and mixes the high bits into the low ones.
    #[must_use]
    pub fn of_file(bytes: &[u8]) -> u64 {
        let (words, rest) = bytes.as_chunks::<8>();
        let mut last = [0; 8];
        last[..rest.len()].copy_from_slice(rest);
        let step = |hash: u64, word: u64| {
            let mixed = (hash ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            mixed ^ mixed >> 32
        };
        let words = words.iter().chain([&last]).map(|word| u64::from_le_bytes(*word));
        words.chain([bytes.len() as u64]).fold(Self::default().0, step)
    }

    /// The hash.
    #[must_use]
    pub fn value(self) -> u64 {
        self.0
    }

    /// Adds the bytes of a number.
    pub fn number(&mut self, number: u64) {
        self.bytes(&number.to_le_bytes());
    }

    /// Adds a text after its length, so that the border of two texts counts.
    pub fn text(&mut self, text: &str) {
        self.number(text.len() as u64);
        self.bytes(text.as_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}
