//! The laws of `Advected`.

use alloc::vec::Vec;
use core::ops::{Add, Mul, Sub};

use nalgebra::{SMatrix, SVector};

use super::samples::{
    DIFFERENCE, MatrixLieGroup, ROUNDING, Random, along, assert_small, condition, derivative, eliminated_inverse,
};
use crate::groups::{Advected, ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
use crate::numbers::Entries;

roots!();

/// The laws of an action: `e · w = w`, `(gf)⁻¹ · w = f⁻¹ · (g⁻¹ · w)`, linear in `w`, and `−ξ·w` is the rate along
/// `exp(tξ)`.
pub fn parameter_is_acted_on<G, A, const N: usize, const D: usize>()
where
    G: MatrixLieGroup<N, D>,
    A: Advected<G>,
{
    let mut random = Random::new(21);
    for f in random.elements::<G, N, D>() {
        let g = random.element::<G, N, D>();
        let w: A = random.sample();
        // A tensor is multiplied by each element twice.
        let allowed = ROUNDING * (condition(&f) * condition(&g)).powi(2);
        assert_same(&w.seen_from(&G::identity()), &w, 0.0, "e · w = w");
        assert_same(&w.advect(&SMatrix::zeros()), &w, 0.0, "e⁻¹ · w = w");
        let (at_once, in_turn) = (w.seen_from(&g.compose(&f)), w.seen_from(&g).advect(&f.increment()));
        assert_same(&at_once, &in_turn, allowed, "(g f)⁻¹ · w = f⁻¹ · (g⁻¹ · w)");
        let back = w.advect(&f.increment()).advect(&f.inverse().increment());
        assert_same(&back, &w, allowed, "f · (f⁻¹ · w) = w");

        let through = w.seen_through(&f.matrix(), &eliminated_inverse(&f));
        assert_same(&through, &w.seen_from(&f), allowed, "an element is a matrix, too");
        let xi: SVector<f64, D> = random.sample();
        let differentiated = derivative(|t| List(entries(&w.seen_from(&along::<G, N, D>(&xi, t)))));
        for (rate, differentiated) in entries(&w.rate(&G::hat(&xi))).into_iter().zip(differentiated.0) {
            assert_small(rate - differentiated, DIFFERENCE, "the rate is −ξ·w");
        }

        // ⟨b, f⁻¹ · v⟩ = ⟨b pulled back, v⟩ for the part that is linear in v.
        let (v, by): (A, A) = (random.sample(), random.sample());
        let paired = |a: &A, b: &A| entries(a).iter().zip(entries(b)).map(|(a, b)| a * b).sum::<f64>();
        let nothing = A::from_entries(&mut || 0.0);
        let seen = paired(&by, &v.seen_from(&f)) - paired(&by, &nothing.seen_from(&f));
        assert_small(seen - paired(&by.pulled_back(&f), &v), allowed * 10.0, "pulled back is transposed");
        let sum = combined(&w, &v).advect(&f.increment());
        let expected = combined(&w.advect(&f.increment()), &v.advect(&f.increment()));
        assert_same(&sum, &expected, allowed, "the action is linear");
        assert_small(f64::from(u8::from(!w.is_finite())), 0.0, "finite entries are finite");
    }
    let lost = A::from_entries(&mut || f64::NAN).is_finite();
    assert_small(f64::from(u8::from(lost)), 0.0, "NaN isn't finite");
}

/// [`parameter_is_acted_on`] for the five kinds.
pub fn kinds_act<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    parameter_is_acted_on::<G, SVector<f64, N>, N, D>();
    parameter_is_acted_on::<G, ContravariantVector<f64, N>, N, D>();
    parameter_is_acted_on::<G, ContravariantTensor<f64, N>, N, D>();
    parameter_is_acted_on::<G, CovariantTensor<f64, N>, N, D>();
    parameter_is_acted_on::<G, MixedTensor<f64, N>, N, D>();
}

/// The action on each of the five kinds is the product that defines it.
pub fn kinds_move_as_declared<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(22);
    for f in random.elements::<G, N, D>() {
        let (w, s): (SVector<f64, N>, SMatrix<f64, N, N>) = (random.sample(), random.sample());
        let (matrix, inverse) = (f.matrix(), eliminated_inverse(&f));
        moves_as(&f, &w, &(matrix.transpose() * w), "V*: Fᵀ w");
        moves_as(&f, &ContravariantVector(w), &(inverse * w), "V: F⁻¹ v");
        moves_as(&f, &ContravariantTensor(s), &(inverse * s * inverse.transpose()), "V ⊗ V: F⁻¹ S F⁻ᵀ");
        moves_as(&f, &CovariantTensor(s), &(matrix.transpose() * s * matrix), "V* ⊗ V*: Fᵀ S F");
        moves_as(&f, &MixedTensor(s), &(inverse * s * matrix), "V ⊗ V*: F⁻¹ S F");
    }
}

fn moves_as<G, A, const N: usize, const D: usize>(f: &G, parameter: &A, expected: &impl Entries<f64>, law: &str)
where
    G: MatrixLieGroup<N, D>,
    A: Advected<G>,
{
    let allowed = ROUNDING * condition(f).powi(2);
    assert_same(&parameter.seen_from(f), expected, allowed, law);
    assert_same(&parameter.advect(&f.increment()), expected, allowed, law);
}

/// The entries of a parameter as a vector.
struct List(Vec<f64>);

impl Add for List {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.into_iter().zip(other.0).map(|(a, b)| a + b).collect())
    }
}

impl Sub for List {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for List {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0.into_iter().map(|a| a * factor).collect())
    }
}

/// The combination `2 w + v`.
fn combined<A: Entries<f64>>(w: &A, v: &A) -> A {
    w.zip(v, &mut |w, v| 2.0 * w + v)
}

#[track_caller]
fn assert_same(a: &impl Entries<f64>, b: &impl Entries<f64>, allowed: f64, law: &str) {
    let squared: f64 = entries(a).iter().zip(entries(b)).map(|(a, b)| (a - b).powi(2)).sum();
    assert_small(squared.sqrt(), allowed, law);
}

fn entries(of: &impl Entries<f64>) -> Vec<f64> {
    let mut entries = Vec::new();
    of.each(&mut |entry| entries.push(entry));
    entries
}
