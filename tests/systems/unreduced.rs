//! The unreduced discrete system of every declaration: theorems 1.4.1 and 2.2.1 with their properties 1 and 2 of
//! section 1.4, from `L̃_d(g_1, g_2) = l_d(g_1⁻¹g_2, g_1⁻¹·a_0)` and without any other derived term.

use checks::structure::symmetry::symmetries;
use checks::structure::{Group as _, System, Vector, gradient, norm, norm_of_map, symplectic};
use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::inertia;
use liestep::motion::DiscreteLiePoisson;
use liestep::numbers::Coordinates as _;

use checks::samples::every_system;

const H: f64 = 0.05;

/// The error of six-point differences of momenta, relative to `J/h`.
const DIFFERENCES: f64 = 1e-10;

/// The unreduced Lagrangian `L̃_d`.
fn unreduced<L: System>(l: &L, first: &L::Group, second: &L::Group) -> f64 {
    l.l_d(&first.inverse().compose(second).matrix(), &l.advected().seen_from(first), H)
}

/// The momenta `−D₁L̃_d` and `D₂L̃_d`, (1.19), pulled back to the identity from the left.
fn legendre_transforms<L: System>(l: &L, first: &L::Group, second: &L::Group) -> [Vector<L>; 2] {
    let moved = |g: &L::Group, k, s| g.compose(&L::Group::turn(k, s));
    [
        gradient::<L>(&|k, s| -unreduced(l, &moved(first, k, s), second)),
        gradient::<L>(&|k, s| unreduced(l, first, &moved(second, k, s))),
    ]
}

fn assert_variational<L: System + Clone>(l: &L, name: &str) {
    let mut random = Random::new(14);
    let flow = DiscreteLiePoisson::new(l.clone(), H).unwrap();
    let scale = norm_of_map::<L>(&inertia(l, &l.advected())) / H;
    let close = |what: &str, a: Vector<L>, b: Vector<L>| {
        let error = norm(&(a - b)) / scale;
        assert!(error < DIFFERENCES, "{name}: {what}: off by {error:e}");
    };
    let place = L::Group::along(&random.sample(), 0.3);
    let increment = L::Group::along(&random.sample(), H).matrix();
    let mut path = vec![(place, l.legendre_minus(&increment, &l.advected().seen_from(&place), H))];
    for _ in 0..4 {
        let (g, momentum) = path.last().unwrap();
        path.push(symplectic::map(&flow, g, momentum));
    }

    for pair in path.windows(2) {
        let [(first, before), (second, after)] = pair else { unreachable!() };
        let [minus, plus] = legendre_transforms(l, first, second);
        close("(1.19), −D₁L̃_d is the momentum before", minus, *before);
        close("(1.19), D₂L̃_d is the momentum after", plus, *after);
        // Both give the momentum (1.21) along a symmetry `g ↦ exp(sη) g`, which is that of the start.
        for eta in symmetries(l) {
            let carried = |g: &L::Group, s: f64| L::Group::along(&eta, s).compose(g);
            let by_first = -derivative(|s| unreduced(l, &carried(first, s), second));
            let by_second = derivative(|s| unreduced(l, first, &carried(second, s)));
            let map = path[0].0.inverse().adjoint_transpose(&path[0].1).dot(&eta);
            let error = (by_first - map).abs().max((by_second - map).abs()) / scale;
            assert!(error < DIFFERENCES, "{name}: (1.21): off by {error:e}");
        }
    }

    // The stationarity of the action, point by point; the ends aren't stationary.
    let action = |i: usize, k, s| {
        let mut points: Vec<L::Group> = path.iter().map(|(g, _)| *g).collect();
        points[i] = points[i].compose(&L::Group::turn(k, s));
        points.windows(2).map(|pair| unreduced(l, &pair[0], &pair[1])).sum::<f64>()
    };
    let slope = |i: usize| gradient::<L>(&|k, s| action(i, k, s));
    for i in 1..path.len() - 1 {
        close("stationary action", slope(i), Vector::<L>::zero());
    }
    assert!(norm(&slope(0)) > 1e4 * DIFFERENCES * scale, "{name}: the start is stationary too");

    let (g, momentum) = &path[1];
    let [defect, of_other_sign] = symplectic::defects(&flow, g, momentum).map(|of| of / norm(momentum).max(1.0));
    println!("{name}: defect {defect:.1e}, with the other sign of the bracket {of_other_sign:.1e}");
    assert!(defect < 1e-9, "{name}: symplectic up to {defect:e}");
    assert!(of_other_sign > 1e-6, "{name}: the form doesn't tell");
}

every_system!(assert_variational);
