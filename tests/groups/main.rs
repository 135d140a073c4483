//! The laws of groups, of their retractions and of advected parameters, for the groups of the crate and a user's own.

mod built_in_groups;
mod laws;
mod laws_can_fail;
mod points;
mod products;
mod retraction_laws;
mod so3_laws;
mod special_linear;
mod user_group;
