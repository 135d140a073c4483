//! The macro's derivations compared with independent results: dual numbers, finite differences, formulas by hand, data.

mod continuous;
mod discretised;
mod dual_numbers;
mod equations;
mod exact_lagrangian;
mod golden_steps;
mod lanes;
mod other_groups;
mod self_adjoint;
mod sensitivities;
mod several_bodies;
mod terms;
mod thesis;
mod translated_bodies;
