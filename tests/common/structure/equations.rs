//! The continuous equations of a Lagrangian, compared with dual numbers of the declared `l`.
//!
//! The gradient of `l` is by dual numbers, its change along a motion by hyper-dual ones; the brackets and the rates of
//! advected parameters are those of the library, which its laws test.

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::Random;
use liestep::mechanics::ContinuousLagrangian;
use liestep::motion::RightHandSide;
use liestep::numbers::Coordinates as _;
use num_dual::{Dual64, HyperDual64};

use super::numbers::{from_numbers, lifted, numbers, varied};
use super::{Group, Vector, axis, norm, norm_of_map, random_advected};

/// The bound is some dozens of roundings, relative to the size of the terms. The worst error of each Lagrangian is
/// printed by `cargo test -p liestep-long-tests --test random_lagrangians continuous -- --nocapture`.
const BOUND: f64 = 1e-14;

/// Checks momentum, diamond, Euler–Poincaré and Lie–Poisson equations and their inverse, at a random velocity.
pub fn assert_equations<L, D1, D2>(system: &L, dual: &D1, hyper: &D2, seed: u64)
where
    L: ContinuousLagrangian<Scalar = f64, Group: Group> + Clone,
    D1: ContinuousLagrangian<Scalar = Dual64>,
    D2: ContinuousLagrangian<Scalar = HyperDual64>,
{
    let mut random = Random::new(seed ^ 0xC0);
    let (xi, w): (Vector<L>, L::Advected) = (random.sample(), random_advected(system, &mut random));
    let mut worst = 0.0_f64;
    let mut near = |what: &str, found: Vector<L>, expected: Vector<L>, scale: f64| {
        let error = norm(&(found - expected)) / scale;
        assert!(error <= BOUND, "{what}: {error:e} of {scale:e}, {found:?} and {expected:?}");
        worst = worst.max(error);
    };
    let along_each = |value: &dyn Fn(Vector<L>) -> f64| -> Vector<L> {
        from_numbers((0..L::Group::DIMENSION).map(|k| value(axis(k, 1.0))))
    };
    // The variation δw along an element of the algebra, by the library's action.
    let carried = |eta: Vector<L>| w.rate(&L::Group::hat(&-eta));
    let none = carried(Vector::<L>::zero());
    let slope = |eta: Vector<L>, delta: L::Advected| {
        let epsilon = Dual64::new(0.0, 1.0);
        dual.l(&varied(&xi, &eta, epsilon), &varied(&w, &delta, epsilon)).eps
    };
    let momentum = along_each(&|unit| slope(unit, none));
    let diamond = along_each(&|unit| -slope(Vector::<L>::zero(), carried(unit)));
    let scale = 1.0 + norm(&momentum) * (1.0 + norm(&xi)) + norm(&diamond);
    near("momentum", system.momentum(&xi, &w), momentum, scale);
    near("diamond", system.diamond_rate(&xi, &w), diamond, scale);
    let rate = L::Group::lie_bracket_transpose(&xi, &momentum) + diamond;
    near("rate of the momentum", system.momentum_rate(&xi, &w), rate, scale);

    // Along the motion, ẇ = −ξ·w, the momentum changes by (1.4) and (2.2).
    let (acceleration, turn) = system.euler_poincare(&xi, &w).expect("regular");
    let (first, second) = (HyperDual64::new(0.0, 1.0, 0.0, 0.0), HyperDual64::new(0.0, 0.0, 1.0, 0.0));
    let change = along_each(&|unit| {
        let [along, across]: [Vector<D2>; 2] =
            [varied(&xi, &acceleration, first), varied(&Vector::<L>::zero(), &unit, second)];
        hyper.l(&(along + across), &varied(&w, &turn, first)).eps1eps2
    });
    let condition = norm_of_map::<L>(&system.velocity_hessian(&xi, &w));
    near("Euler–Poincaré", change, rate, scale + condition * norm(&acceleration));

    // The inverse Legendre transform, and Hamilton's equations in (μ, w).
    let found = system.velocity(&momentum, &w).expect("a convex kinetic energy");
    near("velocity of the momentum", found, xi, (1.0 + condition) * (1.0 + norm(&xi)));
    let (torque, again) = system.lie_poisson(&momentum, &w).expect("a convex kinetic energy");
    near("Lie–Poisson", torque, rate, scale);
    let allowed = 10.0 * BOUND * (1.0 + condition) * (1.0 + norm(&xi));
    for turn in [turn, again] {
        assert!((numbers(&turn) - numbers(&carried(-xi))).amax() <= allowed, "the rate of what is advected");
    }
    let energy = momentum.dot(&xi) - dual.l(&lifted(&xi), &lifted(&w)).re;
    let hamiltonian = system.hamiltonian(&momentum, &w).expect("a convex kinetic energy");
    assert!((hamiltonian - energy).abs() <= 10.0 * BOUND * (scale + energy.abs() + (momentum.dot(&xi)).abs()));

    // The right-hand side for a solver has the same numbers.
    let right_side = RightHandSide::new(system.clone()).expect("regular at rest");
    let expected = system.lie_poisson(&momentum, &system.advected()).expect("a convex kinetic energy").0;
    let state = right_side.state(&L::Group::identity(), &momentum);
    let mut rates = vec![0.0; state.len()];
    right_side.rate(&state, &mut rates).expect("a convex kinetic energy");
    let of_attitude = state.len() - L::Group::DIMENSION;
    near("numbers", from_numbers(rates.split_off(of_attitude)), expected, 1.0 + norm(&expected));
    println!("the worst error of a term is {worst:.1e} of its size");
}
