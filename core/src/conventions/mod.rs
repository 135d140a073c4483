#![doc = include_str!("README.md")]
#![allow(clippy::doc_markdown)] // names of authors and of libraries are not code

pub mod equations {
    #![doc = include_str!("equations.md")]
}
pub mod errata {
    #![doc = include_str!("errata.md")]
}
pub mod guarantees {
    #![doc = include_str!("guarantees.md")]
}
