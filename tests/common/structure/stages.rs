//! P2: the step in stages agrees with the equations: the Newton system vanishes if `𝔽l_d⁻ = μ`, its Jacobian is its
//! derivative, and a step ends at `𝔽l_d⁺`.

use liestep::groups::{Advected, LieGroup as _, Retraction as _};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::{DiscreteLagrangian, inertia};
use liestep::motion::DiscreteLiePoisson;
use liestep::numbers::Coordinates as _;

use super::numbers::{from_numbers, numbers};
use super::{Group, System, Vector, axis, norm, norm_of_map, random_advected, step};

/// Products of small matrices that cancel in part, relative to the entries of the momenta.
const ROUNDING: f64 = 1e-13;
/// The error of six-point differences for a system that is curved on the scale of one.
const DIFFERENCES: f64 = 1e-10;

pub fn assert_stages<L: DiscreteLagrangian<Scalar = f64, Group: Group>>(l: &L, seed: u64) {
    let dimension = L::Group::DIMENSION;
    let mut random = Random::new(seed);
    let h = 0.05;
    let constants = l.constants(h);
    for size in [0.0, 1e-8, 0.1, 0.5, 0.5] {
        let xi = random.sample::<Vector<L>>() * size;
        let element = L::Retraction::retract(&xi);
        let (f, w) = (element.matrix(), random_advected(l, &mut random));
        let scale = norm(&l.right_momentum(&f, &w, h))
            + norm(&l.left_momentum(&f, &w, h))
            + norm(&l.diamond(&f, &w, h))
            + norm_of_map::<L>(&l.momentum_jacobian(&f, &w, h));
        let a = l.legendre_minus(&f, &w, h) + L::kick_before(&constants, &w);
        let offset = random.sample::<Vector<L>>() * scale;
        let terms = L::step_terms(&constants, &(a + offset), &w);
        let system = |half| L::newton_system(&constants, &terms, &half);
        let half = xi * 0.5;
        let (residual, jacobian) = system(half);
        // The system is that multiple of `U(F, w) − a`, and here that is `−offset`, which may be small by chance.
        let (target, most) = multiplied::<L>(&offset, &half, h);
        let missed = norm(&(residual + target));
        assert!(missed <= ROUNDING * most * scale.max(norm(&offset)), "{residual:?} along {offset:?} of {scale:e}");
        for j in 0..dimension {
            let column = derivative(|s| system(half + axis(j, s)).0);
            let error = norm(&(Vector::<L>::column(&jacobian, j) - column));
            let allowed = DIFFERENCES * norm_of_map::<L>(&jacobian);
            assert!(error <= allowed, "column {j} is off by {error:e} at {size}");
        }
        let increment = element.increment();
        let next = Advected::<L::Group>::advect(&w, &increment);
        let after = element.adjoint_transpose(&a) + L::kick_after(&constants, &increment, &next);
        let error = norm(&(after - l.legendre_plus(&f, &w, h)));
        assert!(error <= ROUNDING * (scale + norm(&after)), "after: off by {error:e}");
    }
}

/// `(h/2) (1 + |y|²)ⁿ` times these components, each with the `y` of its own body, and the largest of these factors.
fn multiplied<L: DiscreteLagrangian<Scalar = f64, Group: Group>>(
    components: &Vector<L>,
    half: &Vector<L>,
    h: f64,
) -> (Vector<L>, f64) {
    let of_body = L::Group::DIMENSION / L::Group::BODIES.max(1);
    let (components, half) = (numbers(components), numbers(half));
    let factors: Vec<f64> = half
        .as_slice()
        .chunks(of_body)
        .flat_map(|y| {
            let denominator = 1.0 + y.iter().map(|y| y * y).sum::<f64>();
            std::iter::repeat_n(0.5 * h * denominator.powi(L::FACTS.denominators.cast_signed()), of_body)
        })
        .collect();
    let most = factors.iter().copied().fold(0.0, f64::max);
    (from_numbers(components.iter().zip(factors).map(|(component, factor)| component * factor)), most)
}

/// A step solves `𝔽l_d⁻(F, w) = μ` and ends at `μ⁺ = 𝔽l_d⁺(F, w)`, `w⁺ = F⁻¹ · w`, for an `F` of the group.
pub fn assert_step<L: System + Clone>(l: &L, steps: &[f64], seed: u64) {
    let mut random = Random::new(seed);
    for &h in steps {
        let flow = DiscreteLiePoisson::new(l.clone(), h).unwrap();
        for _ in 0..10 {
            let w = random_advected(l, &mut random);
            let increment = L::Group::along(&random.sample(), h).matrix();
            let momentum = l.legendre_minus(&increment, &w, h);
            let step = step(&flow, &momentum, &w);
            let inertia = norm_of_map::<L>(&inertia(l, &l.advected()));
            let (f, scale) = (step.element(), inertia / h + norm(&momentum));
            let solved = norm(&(l.legendre_minus(&f.matrix(), &w, h) - momentum));
            assert!(solved <= ROUNDING * scale, "μ: off by {solved:e} of {scale:e}");
            let after = norm(&(l.legendre_plus(&f.matrix(), &w, h) - step.momentum));
            assert!(after <= ROUNDING * scale, "μ⁺: off by {after:e} of {scale:e}");
            let (carried, seen) = (numbers(&step.advected), numbers(&w.seen_from(&f)));
            assert!((&carried - &seen).norm() <= ROUNDING * (1.0 + seen.norm()), "w⁺: {carried} {seen}");
            assert!(f.defect() < ROUNDING, "{:e}", f.defect());
        }
    }
}
