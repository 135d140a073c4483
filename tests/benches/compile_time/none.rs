//! No declaration: what the other crates' times are to be compared with.

use liestep::SO3;

const EDIT: u32 = 0;

fn main() {
    let attitude: SO3 = liestep::groups::LieGroup::identity();
    println!("{EDIT} {attitude:?}");
}
