//! A crate without a declaration, for comparison with the other crates' times.

use liestep::SO3;

const EDIT: u32 = 0;

fn main() {
    let attitude: SO3 = liestep::groups::LieGroup::identity();
    println!("{EDIT} {attitude:?}");
}
