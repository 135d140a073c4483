//! Chapters to read in order. This is documentation only, and every listing is a test.
//!
//! | chapter | for whom |
//! |---|---|
//! | [`thesis`] | who has the thesis *Reduced Discrete Advected Equations* in hand, or knows geometric mechanics |

pub mod thesis;
