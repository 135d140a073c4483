//! The settings in which a declaration must compile, a module each; the program runs them all.

mod continuous;
mod every_method;
mod everything_imported;
mod f32_scalar;
mod generic_scalar;
mod leading_blocks;
mod macro_rules_fragments;
mod no_implicit_prelude;
mod own_group;
mod private_in_a_function;
mod raw_identifiers;
mod several_bodies;
mod shadowed_constants;
mod shadowed_names;

fn main() {
    continuous::main();
    every_method::main();
    everything_imported::main();
    f32_scalar::main();
    generic_scalar::main();
    leading_blocks::main();
    macro_rules_fragments::main();
    no_implicit_prelude::main();
    own_group::main();
    private_in_a_function::main();
    raw_identifiers::main();
    several_bodies::main();
    shadowed_constants::main();
    shadowed_names::main();
}
