//! Left and right, pairing, hat, frames, units, bibliography, errata.
