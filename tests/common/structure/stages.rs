//! P2: the step in stages says the same as the equations: the Newton system vanishes where `𝔽l_d⁻ = μ`, its Jacobian is
//! its derivative, and a step ends at `𝔽l_d⁺`.

use liestep::groups::{Advected, LieGroup as _, Retraction as _};
use liestep::laws::samples::derivative;
use liestep::laws::samples::{Random, along};
use liestep::motion::DiscreteLiePoisson;
use liestep::numbers::Coordinates;
use nalgebra::{DVector, SMatrix, SVector};

use super::numbers::Numbers as _;
use super::{System, axis, random_advected, step};

/// Products of small matrices that cancel in part, relative to the entries of the momenta.
const ROUNDING: f64 = 1e-13;
/// What six-point differences leave of a system that is curved on the scale of one.
const DIFFERENCES: f64 = 1e-9;

pub fn assert_stages<L, const N: usize, const D: usize>(l: &L, seed: u64)
where
    L: System<N, D>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let mut random = Random::new(seed);
    let h = 0.05;
    let constants = l.constants(h);
    for size in [0.0, 1e-8, 0.1, 0.5, 0.5] {
        let xi: SVector<f64, D> = random.sample::<SVector<f64, D>>() * size;
        let element = L::Retraction::retract(&xi);
        let (f, w) = (element.matrix(), random_advected(l, &mut random));
        let scale = l.right_momentum(&f, &w, h).norm()
            + l.left_momentum(&f, &w, h).norm()
            + l.diamond(&f, &w, h).norm()
            + l.momentum_jacobian(&f, &w, h).norm();
        let a = l.legendre_minus(&f, &w, h) + L::kick_before(&constants, &w);
        let offset: SVector<f64, D> = random.sample::<SVector<f64, D>>() * scale;
        let terms = L::step_terms(&constants, &(a + offset), &w);
        let system = |half: SVector<f64, D>| L::newton_system(&constants, &terms, &half);
        let half = xi * 0.5;
        let (residual, jacobian) = system(half);
        // The system is that multiple of `U(F, w) − a`, and here that is `−offset`.
        let factor = 0.5 * h * (1.0 + half.norm_squared()).powi(L::DENOMINATORS.cast_signed());
        assert!((residual + offset * factor).norm() <= ROUNDING * residual.norm(), "{residual} along {offset}");
        for j in 0..D {
            let column = derivative(|s| system(half + axis(j, s)).0);
            let error = (jacobian.column(j) - column).norm();
            assert!(error <= DIFFERENCES * jacobian.norm(), "column {j} is off by {error:e} at {size}");
        }
        let increment = element.increment();
        let next = Advected::<L::Group>::advect(&w, &increment);
        let after = element.adjoint_transpose(&a) + L::kick_after(&constants, &increment, &next);
        let error = (after - l.legendre_plus(&f, &w, h)).norm();
        assert!(error <= ROUNDING * (scale + after.norm()), "after: off by {error:e}");
    }
}

/// A step solves `𝔽l_d⁻(F, w) = μ` and ends at `μ⁺ = 𝔽l_d⁺(F, w)`, `w⁺ = F⁻¹ · w`, for an `F` of the group.
pub fn assert_step<L: System<N, D> + Clone, const N: usize, const D: usize>(l: &L, steps: &[f64], seed: u64) {
    let mut random = Random::new(seed);
    for &h in steps {
        let flow = DiscreteLiePoisson::new(l.clone(), h).unwrap();
        for _ in 0..10 {
            let w = random_advected(l, &mut random);
            let velocity: SVector<f64, D> = random.sample();
            let increment = along::<L::Group, N, D>(&velocity, h).matrix();
            let momentum = l.legendre_minus(&increment, &w, h);
            let step = step(&flow, &momentum, &w);
            let (f, scale) = (step.element(), l.inertia(&l.advected()).norm() / h + momentum.norm());
            let solved = (l.legendre_minus(&f.matrix(), &w, h) - momentum).norm();
            assert!(solved <= ROUNDING * scale, "μ: off by {solved:e} of {scale:e}");
            let after = (l.legendre_plus(&f.matrix(), &w, h) - step.momentum).norm();
            assert!(after <= ROUNDING * scale, "μ⁺: off by {after:e} of {scale:e}");
            let (carried, seen) = (step.advected.numbers(), w.seen_from(&f).numbers());
            let (carried, seen) = (DVector::from_vec(carried), DVector::from_vec(seen));
            assert!((&carried - &seen).norm() <= ROUNDING * (1.0 + seen.norm()), "w⁺: {carried} {seen}");
            assert!(f.defect() < ROUNDING, "{:e}", f.defect());
        }
    }
}
