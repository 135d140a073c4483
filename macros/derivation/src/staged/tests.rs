//! The programs of (3.13), counted and run by hand.

use super::{Action, Operation, Program, Source, staged};
use crate::expand::tests::{HEAVY_TOP, top};

fn heavy_top() -> super::Staged {
    let text = format!("#[lagrangian({HEAVY_TOP})] {}", top("NonstandardInertia"));
    staged(&text.parse().expect("tokens")).expect("a declaration")
}

/// As the macro counts it: what a Newton iteration of (3.13) does.
#[test]
fn the_heavy_top_has_its_stages() {
    let top = heavy_top();
    assert_eq!((top.parts, top.denominators, top.has_kinetic, top.is_expensive), ([true; 3], 1, true, false));
    assert_eq!(top.carried.iter().map(|w| (w.field, w.action)).collect::<Vec<_>>(), [(Some(4), Action::Covector(0))]);
    let names: Vec<&str> = top.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["J_d", "m", "g", "rho", "up"]);
    assert_eq!(top.newton_system.outputs.len(), 12);
    assert!(
        top.newton_system
            .inputs
            .iter()
            .all(|input| matches!(input, Source::Constant(_) | Source::Term(_) | Source::Half(_)))
    );
    assert!(top.derivation.contains("(R_F)* δl_d/δF"));
}

/// Every register is written before it is read.
#[test]
fn operations_follow_their_operands() {
    let Program { inputs, literals, operations, outputs } = heavy_top().newton_system;
    let first = inputs.len() + literals.len();
    for (at, operation) in operations.iter().enumerate() {
        let read = match *operation {
            Operation::Add(a, b) | Operation::Subtract(a, b) | Operation::Multiply(a, b) | Operation::Divide(a, b) => {
                a.max(b)
            }
            Operation::Negate(a) => a,
            _ => panic!("(3.13) has no functions"),
        };
        assert!(read < first + at, "{operation:?}");
    }
    assert!(outputs.iter().all(|&output| output < first + operations.len()));
}

#[test]
fn mistakes_keep_their_places() {
    let text = "#[lagrangian(group = SO3, l_d = m * F.trace() / h.powi(2))]\nstruct Top { m: f64 }";
    let mistakes = staged(&text.parse().expect("tokens")).expect_err("not a square");
    assert!(!mistakes.is_empty() && !mistakes[0].message.contains("please report"), "{mistakes:?}");
    assert!(staged(&"struct Top { m: f64 }".parse().expect("tokens")).is_err());
}
