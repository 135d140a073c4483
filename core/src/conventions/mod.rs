#![doc = include_str!("README.md")]

pub mod equations {
    #![doc = include_str!("equations.md")]
}
pub mod errata {
    #![doc = include_str!("errata.md")]
}
pub mod guarantees {
    #![doc = include_str!("guarantees.md")]
}
