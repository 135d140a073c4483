//! P1: the flow (2.8) is a Poisson map of the semidirect product, `DΦ B(z) DΦᵀ = B(Φ(z))` for `z = (μ, w)`.

use liestep::groups::{Advected, LieGroup as _};
use liestep::laws::samples::{Random, derivative};
use liestep::motion::DiscreteLiePoisson;
use nalgebra::{DMatrix, DVector};

use super::numbers::{from_numbers, numbers};
use super::{Group, System, Vector, axis, random_advected, step};

/// A function that differentiates a curve at zero.
type Derivative<'a> = &'a dyn Fn(&dyn Fn(f64) -> DVector<f64>) -> DVector<f64>;

/// The Poisson tensor `B(z)`, from the brackets of the group and the action on the parameters:
///
/// ```text
/// {μ_k, μ_l} = −⟨μ, [E_k, E_l]⟩,     {μ_k, w} = E_k · w,     {w, w} = 0
/// ```
pub fn tensor<G: Group, A: Advected<G>>(momentum: &G::Vector, w: &A) -> DMatrix<f64> {
    let (dimension, size) = (G::DIMENSION, G::DIMENSION + numbers(w).len());
    let mut tensor = DMatrix::zeros(size, size);
    for k in 0..dimension {
        for l in 0..dimension {
            tensor[(k, l)] = G::lie_poisson_bracket(momentum, &axis(k, 1.0), &axis(l, 1.0));
        }
        // In the frame of an attitude g the parameters are g⁻¹ · w.
        let moved = derivative(|s| numbers(&w.seen_from(&G::turn(k, -s))));
        for (j, rate) in moved.iter().enumerate() {
            tensor[(k, dimension + j)] = *rate;
            tensor[(dimension + j, k)] = -rate;
        }
    }
    tensor
}

/// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))` for a step of the flow, and its scale; see [`defect_of`].
pub fn defect<L: System>(flow: &DiscreteLiePoisson<L>, momentum: &Vector<L>, w: &L::Advected) -> (f64, f64) {
    let map = |momentum: &Vector<L>, w: &L::Advected| {
        let step = step(flow, momentum, w);
        (step.momentum, step.advected)
    };
    defect_of::<L::Group, L::Advected>(map, momentum, w, &|f| derivative(f))
}

/// The derivative at zero of a function that is smooth on the scale of one, by ten values at a spacing of 1/50: its
/// rounding error is a twentieth of that of [`derivative`], and its remainder has the eleventh derivative.
pub fn smooth_derivative(f: &dyn Fn(f64) -> DVector<f64>) -> DVector<f64> {
    let weights = [5.0 / 6.0, -5.0 / 21.0, 5.0 / 84.0, -5.0 / 504.0, 1.0 / 1260.0];
    let spacing = 0.02;
    let odd = |k: f64| f(k * spacing) - f(-k * spacing);
    let terms = weights.iter().zip([1.0, 2.0, 3.0, 4.0, 5.0]).map(|(weight, k)| odd(k) * (weight / spacing));
    terms.reduce(|sum, term| sum + term).expect("five terms")
}

/// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))` for a map of momentum and parameters, by these differences, and its
/// scale: the largest entry of `Φ(z)` times those of `B(z)` and `DΦ`, at least one, because the differences have errors
/// of the rounding of `Φ`.
pub fn defect_of<G: Group, A: Advected<G>>(
    map: impl Fn(&G::Vector, &A) -> (G::Vector, A),
    momentum: &G::Vector,
    w: &A,
    derivative: Derivative<'_>,
) -> (f64, f64) {
    let z = numbers(&(*momentum, *w));
    let mut tangent = DMatrix::zeros(z.len(), z.len());
    for k in 0..z.len() {
        let direction = DVector::from_fn(z.len(), |i, _| f64::from(u8::from(i == k)));
        let column = derivative(&|t| {
            let (momentum, w) = from_numbers((&z + &direction * t).iter().copied());
            numbers(&map(&momentum, &w))
        });
        tangent.set_column(k, &column);
    }
    let after = map(momentum, w);
    let (before, expected) = (tensor(momentum, w), tensor(&after.0, &after.1));
    let scale = numbers(&after).amax() * before.amax() * tangent.amax();
    ((&tangent * before * tangent.transpose() - expected).amax(), scale.max(1.0))
}

/// The largest defect at random states, and the largest relative to its scale.
///
/// The claim holds for any `w`, not only for those on the orbit of the declared one, and for large steps: at `h = 0.3`
/// the largest turn by some 60°.
pub fn worst<L: System + Clone>(lagrangian: &L, steps: &[f64], seed: u64) -> (f64, f64) {
    let mut random = Random::new(seed);
    let (mut absolute, mut relative) = (0.0_f64, 0.0_f64);
    for &h in steps {
        let flow = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
        for _ in 0..5 {
            let w = random_advected(lagrangian, &mut random);
            let velocity = random.sample::<Vector<L>>() * 2.0;
            let f = L::Group::along(&velocity, h).matrix();
            let (defect, scale) = defect(&flow, &lagrangian.legendre_minus(&f, &w, h), &w);
            (absolute, relative) = (absolute.max(defect), relative.max(defect / scale));
        }
    }
    println!("Poisson {absolute:.1e}, relative {relative:.1e}");
    (absolute, relative)
}

/// The bound for systems whose numbers are near one: the six-point differences then have errors of 10⁻¹².
pub const TOLERANCE: f64 = 1e-10;

/// Asserts the property for such systems.
pub fn assert_poisson<L: System + Clone>(lagrangian: &L, steps: &[f64], seed: u64) {
    let (defect, _) = worst(lagrangian, steps, seed);
    assert!(defect < TOLERANCE, "{defect:e}");
}
