//! The unreduced discrete system of every declaration: theorems 1.4.1 and 2.2.1 with their properties 1 and 2 of
//! section 1.4, from `L̃_d(g_1, g_2) = l_d(g_1⁻¹g_2, g_1⁻¹·a_0)` and nothing else that is derived.

use checks::structure::symmetry::symmetries;
use checks::structure::{System, axis, step};
use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::{Random, along, derivative};
use liestep::motion::DiscreteLiePoisson;
use nalgebra::{DMatrix, DVector, SVector};

use crate::samples::every_system;

const H: f64 = 0.05;

/// What six-point differences leave of momenta, relative to `J/h`.
const DIFFERENCES: f64 = 1e-10;

/// `L̃_d`.
fn unreduced<L: System<N, D>, const N: usize, const D: usize>(l: &L, first: &L::Group, second: &L::Group) -> f64 {
    l.l_d(&first.inverse().compose(second).matrix(), &l.advected().seen_from(first), H)
}

/// `g exp(ξ̂)`.
fn moved<L: System<N, D>, const N: usize, const D: usize>(g: &L::Group, xi: &SVector<f64, D>) -> L::Group {
    g.compose(&along::<L::Group, N, D>(xi, 1.0))
}

/// `−D₁L̃_d` and `D₂L̃_d`, (1.19), pulled back to the identity from the left.
fn legendre_transforms<L: System<N, D>, const N: usize, const D: usize>(
    l: &L,
    first: &L::Group,
    second: &L::Group,
) -> [SVector<f64, D>; 2] {
    [
        SVector::from_fn(|k, _| {
            -derivative(|s| unreduced::<L, N, D>(l, &moved::<L, N, D>(first, &axis(k, s)), second))
        }),
        SVector::from_fn(|k, _| derivative(|s| unreduced::<L, N, D>(l, first, &moved::<L, N, D>(second, &axis(k, s))))),
    ]
}

/// One step on `T*G`, left-trivialised.
fn map<L: System<N, D>, const N: usize, const D: usize>(
    flow: &DiscreteLiePoisson<L>,
    g: &L::Group,
    momentum: &SVector<f64, D>,
) -> (L::Group, SVector<f64, D>) {
    let step = step(flow, momentum, &flow.scene().advected().seen_from(g));
    (g.advance(&step.increment), step.momentum)
}

fn assert_variational<L: System<N, D> + Clone, const N: usize, const D: usize>(l: &L, name: &str) {
    let mut random = Random::new(14);
    let flow = DiscreteLiePoisson::new(l.clone(), H).unwrap();
    let scale = l.inertia(&l.advected()).norm() / H;
    let close = |what: &str, a: SVector<f64, D>, b: SVector<f64, D>| {
        let error = (a - b).norm() / scale;
        assert!(error < DIFFERENCES, "{name}: {what}: off by {error:e}");
    };
    let place = along::<L::Group, N, D>(&random.sample(), 0.3);
    let velocity: SVector<f64, D> = random.sample();
    let increment = along::<L::Group, N, D>(&velocity, H).matrix();
    let mut path = vec![(place, l.legendre_minus(&increment, &l.advected().seen_from(&place), H))];
    for _ in 0..4 {
        let (g, momentum) = path.last().unwrap();
        path.push(map(&flow, g, momentum));
    }

    for pair in path.windows(2) {
        let [(first, before), (second, after)] = pair else { unreachable!() };
        let [minus, plus] = legendre_transforms(l, first, second);
        close("(1.19), −D₁L̃_d is the momentum before", minus, *before);
        close("(1.19), D₂L̃_d is the momentum after", plus, *after);
        // (1.21): both give the momentum along a symmetry `g ↦ exp(sη) g`, which is that of the start.
        for eta in symmetries(l) {
            let carried = |g: &L::Group, s: f64| along::<L::Group, N, D>(&eta, s).compose(g);
            let by_first = -derivative(|s| unreduced::<L, N, D>(l, &carried(first, s), second));
            let by_second = derivative(|s| unreduced::<L, N, D>(l, first, &carried(second, s)));
            let map = path[0].0.inverse().adjoint_transpose(&path[0].1).dot(&eta);
            let error = (by_first - map).abs().max((by_second - map).abs()) / scale;
            assert!(error < DIFFERENCES, "{name}: (1.21): off by {error:e}");
        }
    }

    // The action, by its points one after the other; the ends aren't stationary.
    let action = |i: usize, xi: &SVector<f64, D>| {
        let mut points: Vec<L::Group> = path.iter().map(|(g, _)| *g).collect();
        points[i] = moved::<L, N, D>(&points[i], xi);
        points.windows(2).map(|pair| unreduced::<L, N, D>(l, &pair[0], &pair[1])).sum::<f64>()
    };
    let slope = |i: usize| SVector::<f64, D>::from_fn(|k, _| derivative(|s| action(i, &axis(k, s))));
    for i in 1..path.len() - 1 {
        close("stationary action", slope(i), SVector::zeros());
    }
    assert!(slope(0).norm() > 1e4 * DIFFERENCES * scale, "{name}: the start is stationary too");

    assert_symplectic(&flow, &path[1], name);
}

/// Property 1: `Φ*ω = ω` for `ω((η, ν), (η', ν')) = ⟨ν', η⟩ − ⟨ν, η'⟩ + ⟨μ, [η, η']⟩`.
fn assert_symplectic<L: System<N, D>, const N: usize, const D: usize>(
    flow: &DiscreteLiePoisson<L>,
    (g, momentum): &(L::Group, SVector<f64, D>),
    name: &str,
) {
    let (next, after) = map(flow, g, momentum);
    let back = next.inverse();
    let mut tangent = DMatrix::zeros(2 * D, 2 * D);
    for k in 0..2 * D {
        let column = derivative(|s| {
            let (turn, push) = if k < D { (axis(k, s), axis(k, 0.0)) } else { (axis(k, 0.0), axis(k - D, s)) };
            let (h, nu) = map(flow, &moved::<L, N, D>(g, &turn), &(momentum + push));
            // To first order g exp(ξ̂) is g + g ξ̂.
            let xi = L::Group::vee(&back.compose(&h).increment());
            DVector::from_iterator(2 * D, xi.iter().chain(nu.iter()).copied())
        });
        tangent.set_column(k, &column);
    }
    let form = |momentum: &SVector<f64, D>, sign: f64| {
        DMatrix::from_fn(2 * D, 2 * D, |i, j| match (i < D, j < D) {
            (true, true) => sign * momentum.dot(&L::Group::lie_bracket(&axis(i, 1.0), &axis(j, 1.0))),
            (true, false) => f64::from(u8::from(i + D == j)),
            (false, true) => -f64::from(u8::from(j + D == i)),
            (false, false) => 0.0,
        })
    };
    let defect = |sign| (tangent.transpose() * form(&after, sign) * &tangent - form(momentum, sign)).amax();
    let scale = tangent.amax().max(1.0).powi(2) * momentum.norm().max(1.0);
    println!("{name}: defect {:.1e}, with the other sign of the bracket {:.1e}", defect(1.0), defect(-1.0));
    assert!(defect(1.0) < 1e-9 * scale, "{name}: symplectic up to {:e}", defect(1.0));
    assert!(defect(-1.0) > 1e-6 * scale, "{name}: the form doesn't tell");
}

every_system!(assert_variational);
