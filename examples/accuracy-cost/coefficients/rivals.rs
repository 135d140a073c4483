//! The coefficients of the rivals satisfy the order conditions, one for each rooted tree, and what is timed has that order.

use accuracy_cost::rivals::dop853::Dop853;
use accuracy_cost::rivals::embedded::{Embedded, Tableau, integrate, step};
use accuracy_cost::rivals::rates::Rates;
use accuracy_cost::rivals::tsitouras::Tsitouras5;
use accuracy_cost::rivals::verner::Verner9;
use declarations::motions::End;
use workbench::top_equations::State;

/// A rooted tree: how many nodes it has, its density `γ`, and the trees at its root, each by its place among all.
struct Tree {
    nodes: usize,
    density: f64,
    branches: Vec<usize>,
}

/// All with up to so many nodes, those with fewer first.
fn trees(most: usize) -> Vec<Tree> {
    let mut all: Vec<Tree> = Vec::new();
    for nodes in 1..=most {
        let mut grown = Vec::new();
        grow(&all, nodes - 1, all.len(), &mut Vec::new(), &mut grown);
        let tree = |branches: Vec<usize>| {
            let density = branches.iter().map(|&branch| all[branch].density).product::<f64>();
            Tree { nodes, density: density * f64::from(u32::try_from(nodes).unwrap()), branches }
        };
        let grown: Vec<_> = grown.into_iter().map(tree).collect();
        all.extend(grown);
    }
    all
}

/// The ways to put trees together that have so many nodes, none behind the one before it.
fn grow(all: &[Tree], nodes: usize, behind: usize, chosen: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    if nodes == 0 {
        found.push(chosen.clone());
    }
    for branch in (0..behind).filter(|&branch| all[branch].nodes <= nodes) {
        chosen.push(branch);
        grow(all, nodes - all[branch].nodes, branch + 1, chosen, found);
        chosen.pop();
    }
}

/// The largest error of the conditions `Σ b_i Φ_i = 1/γ` of each order, or of `Σ b_i Φ_i = 0`.
fn errors(tableau: &Tableau, weights: &[(usize, f64)], order: u32, is_estimate: bool) -> Vec<f64> {
    let all = trees(usize::try_from(order).unwrap());
    let mut of_stages: Vec<Vec<f64>> = Vec::new();
    let mut errors = vec![0.0_f64; order as usize];
    for tree in &all {
        let at_stage = |row: &Vec<(usize, f64)>| {
            let of_branch = |&branch: &usize| row.iter().map(|&(j, a)| a * of_stages[branch][j]).sum::<f64>();
            tree.branches.iter().map(of_branch).product::<f64>()
        };
        let weighed: Vec<f64> = tableau.rows.iter().map(at_stage).collect();
        let expected = if is_estimate { 0.0 } else { tree.density.recip() };
        let error = weights.iter().map(|&(i, b)| b * weighed[i]).sum::<f64>() - expected;
        errors[tree.nodes - 1] = errors[tree.nodes - 1].max(error.abs());
        of_stages.push(weighed);
    }
    errors
}

fn assert_order(errors: &[f64], name: &str) {
    let (beyond, within) = errors.split_last().unwrap();
    // Sums of numbers of the size of a hundred.
    assert!(within.iter().all(|error| *error < 1e-13), "{name}: {errors:?}");
    assert!(*beyond > 1e-9, "{name}: {errors:?}");
}

fn assert_orders<M: Embedded>() {
    let tableau = M::tableau();
    assert_order(&errors(&tableau, &tableau.weights, tableau.order + 1, false), M::NAME);
    for (order, weights) in &tableau.estimates {
        assert_order(&errors(&tableau, weights, order + 1, true), M::NAME);
    }
}

#[test]
fn trees_are_counted() {
    let all = trees(9);
    let of_size = |nodes| all.iter().filter(|tree| tree.nodes == nodes).count();
    assert_eq!((1..=9).map(of_size).collect::<Vec<_>>(), [1, 1, 2, 4, 9, 20, 48, 115, 286]);
}

#[test]
fn rivals_have_their_orders() {
    assert_orders::<Tsitouras5>();
    assert_orders::<Dop853>();
    assert_orders::<Verner9>();
}

/// Equations whose motion is known, the first of them time's.
#[derive(Clone, Copy)]
struct Known;

impl Known {
    fn at(t: f64) -> State {
        let angle = 0.5 * t * t;
        [t, t.sin().exp(), angle.cos(), angle.sin(), (1.0 + t).recip(), 1.0 + t, (1.0 + t).sqrt().recip()]
    }

    fn largest_error(t: f64, found: &State) -> f64 {
        Self::at(t).iter().zip(found).fold(0.0, |worst, (exact, found)| worst.max((exact - found).abs()))
    }
}

impl Rates for Known {
    fn rate(&self, &[t, a, c, s, b, d, e]: &State) -> State {
        [1.0, a * t.cos(), -t * s, t * c, -b * b, b * d, -0.5 * e * e * e]
    }

    fn end(&self, _: &State) -> End {
        unreachable!("no body moves so")
    }
}

/// Of the functions that are timed: of twice the steps the error at the end, and the estimate of a step of half the length, are smaller
/// by the powers of two that the order says.
fn assert_measured<M: Embedded>(steps: u32) {
    let end = |steps: u32| {
        let y = (0..steps).fold(Known::at(0.0), |y, _| step::<M>(&Known, 2.0 / f64::from(steps), &y));
        Known::largest_error(2.0, &y)
    };
    let order = (end(steps) / end(2 * steps)).log2();
    let estimate = |h: f64| {
        let y = Known::at(0.5);
        let mut k = M::stages(&Known, h, &y, Known.rate(&y));
        let mean = M::mean(&k);
        let next = core::array::from_fn(|i| y[i] + h * mean[i]);
        let _ = M::complete(&Known, h, &y, &next, &mut k);
        h * M::error(&k, &mean, &[1.0; 7])
    };
    let h = 2.0 / f64::from(steps);
    let power = (estimate(h) / estimate(0.5 * h)).log2();
    println!("{}: order {order:.2} down to {:.1e}, estimate {power:.2}", M::NAME, end(2 * steps));
    // What the step leaves at the next order is small, so that it may seem one more.
    assert!(order > f64::from(M::tableau().order) - 0.5, "{}: {order}", M::NAME);
    assert!((power - f64::from(M::POWER)).abs() < 0.5, "{}: {power}", M::NAME);
    for tolerance in [1e-5, 1e-8, 1e-11] {
        let found = integrate::<M>(&Known, 2.0, tolerance, Known::at(0.0)).unwrap();
        let error = Known::largest_error(2.0, &found);
        assert!(error < 30.0 * tolerance, "{}: {error} with a tolerance of {tolerance}", M::NAME);
    }
}

#[test]
fn what_is_timed_has_its_order() {
    assert_measured::<Tsitouras5>(20);
    assert_measured::<Dop853>(8);
    assert_measured::<Verner9>(8);
}
