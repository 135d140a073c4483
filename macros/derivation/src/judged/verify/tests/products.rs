//! What is derived for several bodies, of random declarations: which bodies turn and which are translated, what each sees,
//! and all terms.

pub(super) mod random;

use std::collections::BTreeMap;

use super::{Declared, Sureness, with_one_sign_changed};
use crate::mathematics::derive::Derived;
use crate::mathematics::symbolic::Expression;
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

/// One wrong sign among the terms of each equation is seen.
#[test]
fn a_wrong_sign_is_seen() {
    type Equation = (&'static str, fn(&mut Derived) -> &mut Expression);
    let equations: [Equation; 9] = [
        ("right momentum", |d| &mut d.right_momentum),
        ("left momentum", |d| &mut d.left_momentum),
        ("diamond", |d| &mut d.diamond),
        ("momentum", |d| &mut d.momentum),
        ("Jacobian", |d| &mut d.jacobian),
        ("energy", |d| &mut d.energy),
        ("kick before", |d| &mut d.kick_before),
        ("kick after", |d| &mut d.kick_after),
        ("unknown", |d| &mut d.unknown),
    ];
    for seed in 0..6 {
        let (arguments, item) = Text::of(seed);
        let declared = Declared::new(&arguments, &item);
        for (name, of) in equations {
            if !of(&mut declared.derived.clone()).is_zero() {
                let found = declared.after(|derived| {
                    let term = of(derived);
                    *term = with_one_sign_changed(term);
                });
                assert!(found.is_err(), "{name} in {arguments}");
            }
        }
    }
}
