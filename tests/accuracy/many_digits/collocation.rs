//! Gauss collocation in the plain form of its tableau.
//!
//! The library computes in sums and differences over pairs of stages, from the stages of the step before; here the
//! nodes, weights and `a_ij` are those of the definition and the stages are solved without a guess.

use nalgebra::Vector3;
use num_traits::{One as _, Zero as _};

use super::heavy_top::of_quaternion;
use super::motion::Motion;
use super::{DoubleDouble, Matrix, Vector, long};

/// Nodes, weights and `a_ij = ∫₀^{c_i} ℓ_j` on the unit interval.
pub(crate) struct Tableau {
    pub(super) weights: Vec<DoubleDouble>,
    pub(super) a: Vec<Vec<DoubleDouble>>,
}

fn index(n: usize) -> DoubleDouble {
    long(u32::try_from(n).unwrap().into())
}

/// `P_n(x)` and its derivative, in `[−1, 1]`.
fn legendre(n: usize, x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let (mut value, mut before) = (DoubleDouble::one(), DoubleDouble::zero());
    for m in 0..n {
        (value, before) = ((index(2 * m + 1) * x * value - index(m) * before) / index(m + 1), value);
    }
    (value, index(n) * (before - x * value) / (DoubleDouble::one() - x * x))
}

impl Tableau {
    pub(crate) fn new(stages: usize) -> Self {
        let (half, one) = (long(0.5), DoubleDouble::one());
        let nodes: Vec<DoubleDouble> = (0..stages)
            .map(|k| {
                let angle = core::f64::consts::PI * (index(k).rounded() + 0.75) / (index(stages).rounded() + 0.5);
                let mut x = long(-angle.cos());
                for _ in 0..6 {
                    let (value, slope) = legendre(stages, x);
                    x -= value / slope;
                }
                (x + one) * half
            })
            .collect();
        let weight = |c: DoubleDouble| {
            let x = c + c - one;
            let (_, slope) = legendre(stages, x);
            one / ((one - x * x) * slope * slope)
        };
        let weights: Vec<_> = nodes.iter().map(|node| weight(*node)).collect();
        // The Lagrange polynomial, which is one at a node and zero at the others.
        let lagrange = |j: usize, x: DoubleDouble| {
            let others = (0..stages).filter(|k| *k != j);
            others.fold(one, |product, k| product * (x - nodes[k]) / (nodes[j] - nodes[k]))
        };
        // The integral ∫₀ᶜ is exact by the quadrature rule; expanded powers would lose digits.
        let integral = |c: DoubleDouble, j: usize| {
            let sum = nodes.iter().zip(&weights).map(|(node, weight)| *weight * lagrange(j, c * *node));
            c * sum.fold(DoubleDouble::zero(), |sum, term| sum + term)
        };
        let a = nodes.iter().map(|node| (0..stages).map(|j| integral(*node, j)).collect()).collect();
        Self { weights, a }
    }
}

/// The quaternion and the conjugate momentum, each as a real and an imaginary part.
type Place = [(DoubleDouble, Vector); 2];

fn sum(a: &Place, b: &Place, factor: DoubleDouble) -> Place {
    core::array::from_fn(|k| (a[k].0 + b[k].0 * factor, a[k].1 + b[k].1 * factor))
}

/// The product of a quaternion and an imaginary quaternion.
fn times((real, imaginary): &(DoubleDouble, Vector), v: &Vector) -> (DoubleDouble, Vector) {
    (-imaginary.dot(v), v * *real + imaginary.cross(v))
}

/// The momentum `Π = ½ Im(q̄ p)`.
fn momentum([q, p]: &Place) -> Vector {
    (p.1 * q.0 - q.1 * p.0 - q.1.cross(&p.1)) * long(0.5)
}

fn squared(q: &(DoubleDouble, Vector)) -> DoubleDouble {
    q.0 * q.0 + q.1.dot(&q.1)
}

/// The attitude of `q/|q|`.
fn attitude(q: &(DoubleDouble, Vector)) -> Matrix {
    let length = squared(q).sqrt();
    of_quaternion(q.0 / length, &q.1.map(|component| component / length))
}

/// The rates `q' = ½ q Ω`, `p' = ½ p Ω + 2 q τ(w)/|q|²` with `Ω = J⁻¹ Π` and `w = R(q)ᵀ a_0`.
fn rate(motion: &Motion, place: &Place) -> Place {
    let [q, p] = place;
    let half: Vector = motion.velocity_of(&momentum(place)) * long(0.5);
    let torque = motion.torque(&(attitude(q).transpose() * motion.up));
    let kick = times(q, &(torque * (long(2.0) / squared(q))));
    let (real, imaginary) = times(p, &half);
    [times(q, &half), (real + kick.0, imaginary + kick.1)]
}

/// The attitude and body velocity after this number of steps.
pub(crate) fn end(tableau: &Tableau, motion: &Motion, h: DoubleDouble, steps: u32) -> (Matrix, Vector) {
    let q = quaternion(&motion.attitude);
    let mut place = [q, times(&q, &(motion.momentum() * long(2.0)))];
    for _ in 0..steps {
        place = step(tableau, motion, h, &place);
    }
    (attitude(&place[0]), motion.velocity_of(&momentum(&place)))
}

/// One step by fixed-point iteration until the last digit.
fn step(tableau: &Tableau, motion: &Motion, h: DoubleDouble, place: &Place) -> Place {
    let mut rates = vec![rate(motion, place); tableau.weights.len()];
    for _ in 0..200 {
        let next: Vec<_> = tableau
            .a
            .iter()
            .map(|row| rate(motion, &row.iter().zip(&rates).fold(*place, |at, (a, rate)| sum(&at, rate, h * *a))))
            .collect();
        let has_settled = rates.iter().zip(&next).all(|(old, new)| distance(old, new) < 1e-28);
        rates = next;
        if has_settled {
            let all = tableau.weights.iter().zip(&rates);
            return all.fold(*place, |at, (weight, rate)| sum(&at, rate, h * *weight));
        }
    }
    panic!("the stages don't converge");
}

fn distance(a: &Place, b: &Place) -> f64 {
    let of = |k: usize| (a[k].0 - b[k].0).rounded().hypot((a[k].1 - b[k].1).map(DoubleDouble::rounded).norm());
    of(0).max(of(1))
}

/// The quaternion of a rotation by less than half a turn.
fn quaternion(r: &Matrix) -> (DoubleDouble, Vector) {
    let real = (DoubleDouble::one() + r.trace()).sqrt() * long(0.5);
    let skew = Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
    (real, skew.map(|component| component / (real * long(4.0))))
}
