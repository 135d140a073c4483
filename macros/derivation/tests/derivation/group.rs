//! Generators of groups.

use liestep_derivation::mathematics::group::{Defect, Group, NAMES, built_in};
use liestep_derivation::mathematics::symbolic::Rational;

fn defect(generators: &[[i128; 4]]) -> Option<Defect> {
    let exact = |entries: &[i128; 4]| entries.iter().map(|&entry| Rational::integer(entry)).collect();
    Group::declared(2, generators.iter().map(exact).collect()).defect()
}

#[test]
fn a_basis_of_a_lie_algebra() {
    for name in NAMES {
        assert_eq!(built_in(name).and_then(|group| group.defect()), None, "{name}");
    }
    assert_eq!(defect(&[[1, 0, 0, 0], [0, 1, 0, 0]]), None);
    assert_eq!(defect(&[[1, 0, 0, 0], [0, 0, 0, 0]]), Some(Defect::Zero(1)));
    assert_eq!(defect(&[[1, 0, 0, 1], [0, 1, 0, 0], [3, 2, 0, 3]]), Some(Defect::Dependent(2)));
    assert_eq!(defect(&[[1, 0, 0, 0], [0, 1, 1, 0]]), Some(Defect::Open(0, 1)));
}

#[test]
fn a_bracket_that_is_nearly_a_combination() {
    let tiny = Rational::new(1, 10_i128.pow(13));
    let [zero, one] = [Rational::ZERO, Rational::ONE];
    let group = |entry| Group::declared(2, vec![vec![zero, one, entry, zero], vec![one, zero, zero, zero]]);
    assert_eq!(group(zero).defect(), None);
    assert_eq!(group(tiny).defect(), Some(Defect::Open(0, 1)));
}
