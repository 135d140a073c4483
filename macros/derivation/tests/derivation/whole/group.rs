//! Increments, inverses, coadjoint actions and the actions on parameters for any group, and the form that its
//! generators imply.

use std::slice::from_ref;

use liestep_derivation::judged::verify::number::Number;
use liestep_derivation::judged::verify::residue::Residue;
use liestep_derivation::judged::verify::value::Value;
use liestep_derivation::whole::{Chart, Form, WholeStep};
use liestep_derivation::{Action, Array, Variance};

use crate::common::random::Random;

use super::common::{
    Generators, StepInputs, affine, are_equal, carried, declared, difference, exact, groups, named, sl3, so,
};

fn form_of(generators: &Generators) -> (Form, Chart) {
    let factor = WholeStep::of(&declared(from_ref(generators), Vec::new())).expect("a step").factors.remove(0);
    (factor.form, factor.chart)
}

#[test]
fn forms_are_those_of_the_generators() {
    let forms: Vec<(&str, Form, Chart)> =
        groups().iter().map(|(name, generators)| (*name, form_of(generators).0, form_of(generators).1)).collect();
    let expected = [
        ("SO2", Form::Orthogonal, Chart::Cayley),
        ("SO3", Form::Rotation, Chart::Cayley),
        ("SE2", Form::Rigid(2), Chart::Cayley),
        ("SE3", Form::Rigid(3), Chart::Cayley),
        ("SE23", Form::Rigid(3), Chart::Cayley),
        ("SU2", Form::Orthogonal, Chart::Cayley),
        ("SL2", Form::Unimodular, Chart::Cayley),
        ("Heisenberg", Form::General, Chart::Cayley),
        ("R3", Form::Translation, Chart::Cayley),
        ("SO(4)", Form::Orthogonal, Chart::Cayley),
        ("SL(3)", Form::General, Chart::Product),
        ("Sp(4)", Form::General, Chart::Cayley),
        ("planar affine", Form::General, Chart::Cayley),
        ("affine", Form::General, Chart::Cayley),
    ];
    assert_eq!(forms, expected);
    // The rotations in another basis than that of SO(3) have no closed form here.
    assert_eq!(form_of(&so(3)).0, Form::Orthogonal);
}

/// The relations of a group, typed by hand.
fn is_in_group(name: &str, g: &Value<Residue>) -> bool {
    let n = g.rows;
    let one = Value::identity(n);
    let is_form = |b: &Value<Residue>| are_equal(&g.transpose().times(b).times(g), b);
    let has_rows = |rows: usize| (rows..n).all(|i| (0..n).all(|j| g.at(i, j) == one.at(i, j)));
    let is_rigid = |rows: usize| {
        let r = Value::new(rows, rows, |i, j| g.at(i, j));
        has_rows(rows) && are_equal(&r.transpose().times(&r), &Value::identity(rows))
    };
    let symplectic = Value::new(4, 4, |i, j| match (i, j) {
        (0 | 1, _) if j == i + 2 => Residue::ONE,
        (2 | 3, _) if i == j + 2 => -Residue::ONE,
        _ => Residue::ZERO,
    });
    let is_unimodular = || are_equal(&g.times(&g.inverse()), &one) && determinant(g) == Residue::ONE;
    match name {
        "SO2" | "SO3" | "SU2" | "SO(4)" => is_form(&one) && is_unimodular(),
        "SE2" => is_rigid(2),
        "SE3" | "SE23" => is_rigid(3),
        "SL2" | "SL(3)" => is_unimodular(),
        "Sp(4)" => is_form(&symplectic),
        "R3" => has_rows(3) && (0..3).all(|i| (0..3).all(|j| g.at(i, j) == one.at(i, j))),
        "Heisenberg" => has_rows(2) && g.at(0, 0) == Residue::ONE && g.at(1, 1) == Residue::ONE && g.at(1, 0).is_zero(),
        _ => has_rows(n - 1),
    }
}

/// The determinant by the first row of the inverse: `det = 1/C` of a cofactor `C` over that entry. `det = 1/C` of a
/// cofactor `C` over that entry.
fn determinant(g: &Value<Residue>) -> Residue {
    let n = g.rows;
    let minor = Value::new(n - 1, n - 1, |i, j| g.at(i + 1, j + 1));
    let cofactor = if n == 2 { g.at(1, 1) } else { determinant(&minor) };
    cofactor / g.inverse().at(0, 0)
}

/// A step from a random element of the group, that element, and the element after the step.
fn moved(name: &str, generators: &Generators, seed: u64) -> (StepInputs<Residue>, Value<Residue>, Value<Residue>) {
    let mut next = Residue::stream(seed);
    let staged = declared(from_ref(generators), Vec::new());
    let start = StepInputs::of(&staged, &mut next);
    let g = start.finished()[..start.step.sizes.entries].to_vec();
    let moving = StepInputs::of(&staged, next).with(Array::Attitude, &g);
    let (g, f) = (moving.matrices(&g).remove(0), moving.increments().remove(0));
    assert!(!are_equal(&f, &Value::identity(f.rows)), "{name}");
    (moving, g, f)
}

#[test]
fn increments_are_in_the_group() {
    for (name, generators) in groups() {
        let (moving, g, f) = moved(name, &generators, 3);
        assert!(is_in_group(name, &f) && is_in_group(name, &g), "{name}");
        let after = moving.matrices(&moving.finished()).remove(0);
        assert!(are_equal(&after, &g.times(&f)), "{name}");
        assert!(is_in_group(name, &after), "{name}");
    }
}

/// `Ad*_F μ` has the components `⟨μ, F E_k F⁻¹⟩`, and steps of a free body leave the momentum in space alone.
#[test]
fn momentum_is_carried_by_the_coadjoint_action() {
    for (name, generators) in groups() {
        let (moving, g, f) = moved(name, &generators, 5);
        let (group, sizes) = (exact(&generators), moving.step.sizes.clone());
        let components = |m: &Value<Residue>| {
            let mut found = vec![Residue::ZERO; sizes.n];
            for (k, i, j, factor) in group.dual() {
                found[k] = found[k] + Residue::of(factor) * m.at(i, j);
            }
            found
        };
        let adjoint = |f: &Value<Residue>, mu: &[Residue]| -> Vec<Residue> {
            let moved = |e| components(&f.times(&Value::square(group.size, e)).times(&f.inverse()));
            let paired = |x: Vec<Residue>| x.iter().zip(mu).fold(Residue::ZERO, |sum, (&x, &mu)| sum + x * mu);
            group.generators.iter().map(|e| paired(moved(e))).collect()
        };
        // Without kicks the target is the momentum.
        let target = moving.numbers.run(&moving.step.programs.target)[..sizes.n].to_vec();
        let moving = moving.with(Array::Target, &target);
        let state = moving.finished();
        let after = &state[sizes.momentum()..sizes.advected()];
        assert_eq!(after, adjoint(&f, &target), "{name}");
        let in_space = |moving: &StepInputs<Residue>| moving.numbers.run(&moving.step.programs.spatial);
        let before = in_space(&moving);
        assert_eq!(before, adjoint(&g.inverse(), &target), "{name}");
        let end = state[..sizes.advected()].to_vec();
        let (attitude, momentum) = end.split_at(sizes.entries);
        let moving = moving.with(Array::Attitude, attitude).with(Array::Momentum, momentum);
        assert_eq!(in_space(&moving), before, "{name}");
    }
}

/// Each action on parameters in space, in the body frame at an attitude, and after an increment.
#[test]
fn nine_actions() {
    for first in [affine(2), named("SE2"), named("Heisenberg"), named("R2")] {
        are_as_by_hand(&[first, named("SE2"), sl3()], true);
    }
    for first in [named("SO3"), sl3()] {
        are_as_by_hand(&[first, affine(2), so(3)], false);
    }
}

fn are_as_by_hand(factors: &[Generators], has_points: bool) {
    let mut actions = vec![
        (Action::Moved(Variance::Covector, 0), (3, 1)),
        (Action::Moved(Variance::Vector, 0), (3, 1)),
        (Action::Point(0), (2, 1)),
        (Action::Moved(Variance::Contravariant, 0), (3, 3)),
        (Action::Moved(Variance::Covariant, 0), (3, 3)),
        (Action::Moved(Variance::Mixed, 0), (3, 3)),
        (Action::Relative { of: 1, from: 0 }, (3, 3)),
        (Action::Configuration(2), (3, 3)),
        (Action::Given, (2, 1)),
    ];
    actions.retain(|(action, _)| has_points || !matches!(action, Action::Point(_)));
    let staged = declared(factors, carried(&actions));
    let mut next = Residue::stream(7);
    let start = StepInputs::of(&staged, &mut next);
    let g = start.finished()[..start.step.sizes.entries].to_vec();
    let moving = StepInputs::of(&staged, next).with(Array::Attitude, &g);
    let g = moving.matrices(&g);
    let (parameters, seen) = (&moving.numbers, moving.numbers.run(&moving.step.programs.seen));
    let spatial = &parameters.0.iter().find(|(array, _)| *array == Array::Parameters).expect("parameters").1;
    let mut first = 0;
    for (action, (rows, columns)) in actions {
        let at = |from: &[Residue]| Value { rows, columns, entries: from[first..first + rows * columns].to_vec() };
        let (w, back) = (at(spatial), g[0].inverse());
        let expected = match action {
            Action::Moved(Variance::Covector, k) => g[k].transpose().times(&w),
            Action::Moved(Variance::Vector, _) => back.times(&w),
            Action::Point(_) => {
                let point = Value::new(3, 1, |i, _| if i < 2 { w.at(i, 0) } else { Residue::ONE });
                let seen = back.times(&point);
                Value::new(2, 1, |i, _| seen.at(i, 0))
            }
            Action::Moved(Variance::Contravariant, _) => back.times(&w).times(&back.transpose()),
            Action::Moved(Variance::Covariant, k) => g[k].transpose().times(&w).times(&g[k]),
            Action::Moved(Variance::Mixed, k) => back.times(&w).times(&g[k]),
            Action::Relative { of, .. } => back.times(&w).times(&g[of]),
            Action::Configuration(of) => w.times(&g[of]),
            Action::Given | Action::Moved(Variance::Fixed, _) => w,
        };
        assert!(are_equal(&at(&seen), &expected), "{action:?}");
        first += rows * columns;
    }
    // The advected parameters after a step are those at the attitude after it.
    let moving = moving.with(Array::Advected, &seen);
    let state = moving.finished();
    let sizes = moving.step.sizes.clone();
    let moving = moving.with(Array::Attitude, &state[..sizes.entries]);
    assert_eq!(moving.numbers.run(&moving.step.programs.seen), state[sizes.advected()..sizes.history()]);
}

/// The defect vanishes in the group, and doesn't if any entry of a matrix is changed.
#[test]
fn the_defect_is_that_of_the_relations() {
    for (name, generators) in groups() {
        let (moving, g, _) = moved(name, &generators, 11);
        let defect = |g: &[Residue]| moving.numbers.with(Array::Attitude, g).run(&moving.step.programs.defect)[0];
        assert!(defect(&g.entries).is_zero(), "{name}");
        for at in 0..g.entries.len() {
            let mut other = g.entries.clone();
            other[at] = other[at] + Residue::ONE;
            // Entries that are free in the group: all affine maps are in theirs.
            let is_free = name.contains("affine") && at / g.rows + 1 < g.rows || at % 4 == 3 && at < 12 && name == "R3";
            let is_free = is_free
                || name == "Heisenberg" && [1, 2, 5].contains(&at)
                || name.starts_with("SE") && is_translation(name, at);
            assert_eq!(defect(&other).is_zero(), is_free, "{name}, {at}");
        }
    }
}

fn is_translation(name: &str, at: usize) -> bool {
    let (rows, n) = match name {
        "SE2" => (2, 3),
        "SE3" => (3, 4),
        _ => (3, 5),
    };
    at / n < rows && at % n >= rows
}

/// A reflection is orthogonal, too, and has a defect.
#[test]
fn reflections_are_not_rotations() {
    for (name, generators) in groups().into_iter().filter(|(name, _)| name.starts_with("SO") || name.starts_with("SE"))
    {
        let mut random = Random::new(29);
        let moving = StepInputs::of(&declared(&[generators], Vec::new()), || 0.3 * random.signed());
        let mut g = moving.increments().remove(0);
        (0..g.rows).for_each(|j| g.entries[j] = -g.entries[j]);
        let defect = moving.numbers.with(Array::Attitude, &g.entries).run(&moving.step.programs.defect)[0];
        assert!(defect > 2.0 - 1e-14 && (defect < 2.0 + 1e-14 || name != "SO3"), "{name}: {defect}");
    }
}

/// A step of the polar decomposition, and of that of another bilinear form, squares the distance from the group.
#[test]
fn attitudes_are_restored() {
    let mut restored = Vec::new();
    for (name, generators) in groups() {
        let staged = declared(from_ref(&generators), Vec::new());
        let mut random = Random::new(13);
        let moving = StepInputs::of(&staged, || 0.3 * random.signed());
        let mut g = moving.increments().remove(0);
        let defect = |g: &Value| moving.numbers.with(Array::Attitude, &g.entries).run(&moving.step.programs.defect)[0];
        assert!(defect(&g) < 1e-14, "{name}");
        let (n, rows) = (
            g.rows,
            if name == "SE2" {
                2
            } else if name.starts_with("SE") {
                3
            } else {
                g.rows
            },
        );
        for at in (0..n * n).filter(|at| at / n < rows && at % n < rows) {
            g.entries[at] += 1e-5 * random.signed();
        }
        let found = moving.numbers.with(Array::Attitude, &g.entries).run(&moving.step.programs.restored);
        assert_eq!(found.is_empty(), !moving.step.factors[0].is_restored(), "{name}");
        if let Some((&distance, nearer)) = found.split_first() {
            let nearer = Value { rows: n, columns: n, entries: nearer.to_vec() };
            assert!(
                distance > 1e-6 && difference(&nearer, &g).entries.iter().all(|entry| entry.abs() < 1e-4),
                "{name}"
            );
            let again = moving.numbers.with(Array::Attitude, &nearer.entries).run(&moving.step.programs.restored)[0];
            assert!(again < 1e-9 && distance < 1e-4, "{name}: {distance:e}, {again:e}");
            restored.push(name);
        }
    }
    assert_eq!(restored, ["SO2", "SO3", "SU2", "SO(4)"]);
}
