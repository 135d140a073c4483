//! A user's group, declared once.

use crate::common::{expanded, is_refused, tokens};
use liestep_derivation::matrix_group;

const RELATION: &str = "fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T { m[(1, 0)].abs() }";

#[test]
fn a_type_its_generators_and_a_macro() {
    let group =
        format!("/// Maps.\n pub type Affine = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]]; {RELATION}");
    let items = matrix_group(tokens(&group));
    assert!(!is_refused(&items));
    let text = items.to_string();
    assert!(text.contains("pub type Affine < T = :: liestep :: __private :: core :: primitive :: f64 >"), "{text}");
    assert!(text.contains("MatrixGroup < AffineGenerators , T , 2 , 2 >"), "{text}");
    assert!(text.contains("macro_rules ! __liestep_Affine") && text.contains("as Affine ;"), "{text}");
    let moved = matrix_group(tokens(&format!("crate = crate::geometry; {group}"))).to_string();
    assert!(
        moved.contains("crate :: geometry :: __private :: MatrixGroup") && !moved.contains("liestep ::"),
        "{moved}"
    );
}

#[test]
fn its_mistakes() {
    for wrong in ["", "pub type A", "type A = [];", "type A = [[[1_u8, 0.0], [0.0, 0.0]]];", "type A = [[[1.0, 0.0]]];"]
    {
        assert!(is_refused(&matrix_group(tokens(wrong))), "{wrong}");
    }
    // Five thousand signs and two hundred brackets are refused without a stack overflow.
    let [signs, brackets] = [["-".repeat(5000), String::new()], ["[".repeat(200), "]".repeat(200)]];
    for [before, after] in [signs, brackets] {
        assert!(is_refused(&matrix_group(tokens(&format!("type A = [[[{before} 1.0 {after}]]]; {RELATION}")))));
    }
}

/// Brackets around an entry, or invisible ones of a `macro_rules!` fragment, change nothing.
#[test]
fn entries_in_brackets() {
    let group = format!("type Affine = [[[(1.0), 0.0], [0.0, (-0.0)]], ([[0.0, 1.0], [0.0, 0.0]])]; {RELATION}");
    assert!(!is_refused(&matrix_group(tokens(&group))));
}

/// A whole number is the decimal number of the same value, in the constant and for a declaration.
#[test]
fn whole_entries() {
    let items = |entries: &str| matrix_group(tokens(&format!("type Circle = {entries}; {RELATION}"))).to_string();
    let group = items("[[[0, -1], [0x1, 0]]]");
    assert_eq!(group, items("[[[0.0, -1.0], [1.0, 0.0]]]"));
    assert!(group.contains("[[[0.0 , - 1.0] , [1.0 , 0.0]]]"), "{group}");
    let body = |entries: &str| {
        let l_d = "((F - I) * A * (F - I).transpose()).trace() / (2.0 * h)";
        expanded(&format!("group = Own, generators = {entries}, l_d = {l_d}"), "struct Body { A: Matrix2<f64> }")
    };
    assert!(!is_refused(&body("[[[0, -1], [1, 0]]]")));
}

#[test]
fn a_declaration_asks_it() {
    let item = "pub struct Top { m: f64 }";
    let asked = expanded("advected(w = up), group = own::Affine!, l_d = m * !F, crate = here", item).to_string();
    let expected = "own :: Affine ! { { here :: __private :: lagrangian } \
                    { advected (w = up) , group = own :: Affine !, l_d = m * ! F , crate = here } \
                    pub struct Top { m : f64 } }";
    assert_eq!(asked, expected);
    let of_factor = expanded("group(F = SO3, Q = Affine!), l_d = m", item).to_string();
    assert!(of_factor.starts_with("Affine ! { { :: liestep :: __private :: lagrangian }"), "{of_factor}");
    // The name of a group without the mark `!` is unknown.
    assert!(is_refused(&expanded("group = Affine, l_d = m * F.trace()", item)));
}

/// A mistake in a group's generators is reported once, at the group.
#[test]
fn a_mistake_of_the_group_is_its_own() {
    let group = matrix_group(tokens("pub type Large = [[[1.0], [2.0]]];")).to_string();
    assert!(group.contains("macro_rules ! __liestep_Large") && group.contains("compile_error"), "{group}");
}
