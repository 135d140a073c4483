//! The programs of (3.13), counted and run by hand.

use liestep_derivation::{Action, Array, Operation, Program, Refusal, StagedDeclaration, Variance, staged};

use crate::common::{HEAVY_TOP, top};

fn heavy_top() -> StagedDeclaration {
    let text = format!("#[lagrangian({HEAVY_TOP})] {}", top("NonstandardInertia"));
    staged(&text.parse().expect("tokens"), u64::MAX).expect("a declaration").0
}

/// The programs of (3.13) have the fields, the action and the inputs of the declaration.
#[test]
fn the_heavy_top_has_its_stages() {
    let top = heavy_top();
    assert_eq!((top.parts, top.denominators, top.has_kinetic), ([true; 3], 1, true));
    assert_eq!(
        top.carried.iter().map(|w| (w.field, w.action)).collect::<Vec<_>>(),
        [(Some(4), Action::Moved(Variance::Covector, 0))]
    );
    let names: Vec<&str> = top.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["J_d", "m", "g", "rho", "up"]);
    assert_eq!(top.programs.newton_system.outputs.len(), 12);
    assert!(
        top.programs
            .newton_system
            .inputs
            .iter()
            .all(|input| matches!(input.array, Array::Constants | Array::Target | Array::Half))
    );
    assert!(top.derivation.contains("(R_F)* δl_d/δF"));
}

/// Every register of a program is written before it is read.
#[test]
fn operations_follow_their_operands() {
    let Program { inputs, literals, operations, outputs } = heavy_top().programs.newton_system;
    let first = inputs.len() + literals.len();
    for (at, operation) in operations.iter().enumerate() {
        assert!(!matches!(operation, Operation::Apply(..)), "(3.13) has no functions");
        let read = operation.operands().into_iter().max().unwrap_or_default();
        assert!(read < first + at, "{operation:?}");
    }
    assert!(outputs.iter().all(|&output| (output as usize) < first + operations.len()));
}

#[test]
fn mistakes_keep_their_places() {
    let text = "#[lagrangian(group = SO3, l_d = m * F.trace() / h.powi(2))]\nstruct Top { m: f64 }";
    let Err(Refusal::Mistakes(mistakes)) = staged(&text.parse().expect("tokens"), u64::MAX) else {
        panic!("not a square")
    };
    assert!(!mistakes.is_empty() && !mistakes[0].message.contains("please report"), "{mistakes:?}");
    assert!(staged(&"struct Top { m: f64 }".parse().expect("tokens"), u64::MAX).is_err());
}

/// A derivation that runs out of work is refused, wherever that happens, and the next derivation isn't affected.
#[test]
fn work_is_bounded() {
    let text = format!("#[lagrangian({HEAVY_TOP})] {}", top("NonstandardInertia")).parse().expect("tokens");
    let (whole, work) = staged(&text, 1_000_000).expect("a declaration");
    assert!((100..100_000).contains(&work), "{work}");
    for part in (0..work).step_by(97) {
        assert!(matches!(staged(&text, part), Err(Refusal::TooMuchWork)), "{part} of {work}");
    }
    assert_eq!(staged(&text, u64::MAX).expect("a declaration").0, whole);
}
