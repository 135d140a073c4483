//! What is derived for several bodies, of random declarations: which bodies turn and which are translated, what each sees,
//! and all terms.

pub(super) mod random;

use std::collections::BTreeMap;

use super::{Declared, Sureness};
use random::Text;

/// Every kind of term is in some of them: the text that shows it.
const KINDS: [(&str, &str); 12] = [
    ("a field that a body sees", ".dot(&w_"),
    ("a relative attitude in the kinetic energy", ".dot(&(Q_"),
    ("one between velocities by `vee`", "* vee(F_"),
    ("both ends of a relative attitude", ".transpose() * Q_"),
    ("an attitude in space", "(R_"),
    ("a place", "x_"),
    ("a place from another body", "r_"),
    ("a turn about an axis", "y_"),
    ("a velocity of translation with one of rotation", ".dot(&(R_"),
    ("an inertia that depends on what is seen", ").powi(2) / h"),
    ("a function that is called", "U("),
    ("a value that is named", "let z = y - "),
];

#[test]
fn random_declarations_on_products() {
    let mut missing = BTreeMap::from(KINDS);
    for seed in 0..40 {
        let (arguments, item) = Text::of(seed);
        // Of the one that fails.
        println!("{seed}: {arguments}\n{item}");
        missing.retain(|_, text| !arguments.contains(*text));
        assert!(matches!(Declared::new(&arguments, &item).sureness(), Sureness::Certified(100..)), "{seed}");
    }
    assert!(missing.is_empty(), "in no declaration: {:?}", missing.keys());
}
