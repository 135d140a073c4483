//! The laws of `LieGroup`.

use nalgebra::{SMatrix, SVector};

use super::samples::{
    DIFFERENCE, MatrixLieGroup, NESTED_DIFFERENCE, ROUNDING, Random, along, assert_close, assert_small, condition,
    derivative, eliminated_inverse,
};

roots!();

/// The axioms of a group: closure, associativity, neutral and inverse elements.
pub fn group_axioms<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(1);
    let identity = SMatrix::<f64, N, N>::identity();
    assert_close(&G::identity().matrix(), &identity, 0.0, "e = I");
    for f in random.elements::<G, N, D>() {
        let (g, h) = (random.element::<G, N, D>(), random.element::<G, N, D>());
        let allowed = ROUNDING * condition(&f) * condition(&g);
        assert_small(f.defect(), allowed, "exp ξ̂ is in the group");
        assert_small(f.compose(&g).defect(), allowed, "F G is in the group");
        assert_small(f.inverse().defect(), allowed, "F⁻¹ is in the group");
        assert_close(&f.compose(&f.inverse()).matrix(), &identity, allowed, "F F⁻¹ = I");
        assert_close(&f.inverse().compose(&f).matrix(), &identity, allowed, "F⁻¹ F = I");
        assert_close(&f.compose(&g).matrix(), &(f.matrix() * g.matrix()), allowed, "the product is that of matrices");
        assert_close(&f.compose(&G::identity()).matrix(), &f.matrix(), 0.0, "F e = F");
        let (left, right) = (f.compose(&g).compose(&h), f.compose(&g.compose(&h)));
        assert_close(&left.matrix(), &right.matrix(), allowed * condition(&h), "(F G) H = F (G H)");
    }
}

/// The linear hat and its inverse, `ξ̂^∨ = ξ`.
pub fn hat_and_vee<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(2);
    assert_small(f64::from(u8::from(G::DIMENSION != D)), 0.0, "the dimension is that of the vectors");
    for _ in 0..20 {
        let (xi, eta): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        assert_close(&G::vee(&G::hat(&xi)), &xi, ROUNDING, "ξ̂^∨ = ξ");
        let sum = G::hat(&xi) * 2.0 + G::hat(&eta);
        assert_close(&G::hat(&(xi * 2.0 + eta)), &sum, ROUNDING, "the hat is linear");
    }
}

/// The bracket is the commutator, `ad_ξ η = (ξ̂η̂ − η̂ξ̂)^∨`.
pub fn brackets<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(3);
    for _ in 0..20 {
        let (x, y, z): (SVector<f64, D>, SVector<f64, D>, SVector<f64, D>) =
            (random.sample(), random.sample(), random.sample());
        let commutator = G::hat(&x) * G::hat(&y) - G::hat(&y) * G::hat(&x);
        assert_close(&G::hat(&G::lie_bracket(&x, &y)), &commutator, ROUNDING, "[ξ, η]^ = ξ̂η̂ − η̂ξ̂");
        assert_close(&G::lie_bracket(&x, &y), &-G::lie_bracket(&y, &x), ROUNDING, "[ξ, η] = −[η, ξ]");
        let jacobi = G::lie_bracket(&x, &G::lie_bracket(&y, &z))
            + G::lie_bracket(&y, &G::lie_bracket(&z, &x))
            + G::lie_bracket(&z, &G::lie_bracket(&x, &y));
        assert_close(&jacobi, &SVector::zeros(), ROUNDING, "Jacobi's identity");
    }
}

/// The adjoint action is the conjugation, `Ad_F ξ = (F ξ̂ F⁻¹)^∨`.
pub fn adjoint_action<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(4);
    for f in random.elements::<G, N, D>() {
        let (xi, eta): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        let g = random.element::<G, N, D>();
        let allowed = ROUNDING * condition(&f) * condition(&g);
        let conjugated = f.matrix() * G::hat(&xi) * eliminated_inverse(&f);
        assert_close(&G::hat(&f.adjoint(&xi)), &conjugated, allowed, "(Ad_F ξ)^ = F ξ̂ F⁻¹");
        assert_close(&(f.adjoint_matrix() * xi), &f.adjoint(&xi), allowed, "the matrix of Ad_F maps ξ to Ad_F ξ");
        let twice = f.adjoint(&g.adjoint(&xi));
        assert_close(&f.compose(&g).adjoint(&xi), &twice, allowed, "Ad_FG = Ad_F Ad_G");
        let moved = G::lie_bracket(&f.adjoint(&xi), &f.adjoint(&eta));
        let allowed = allowed * condition(&f);
        assert_close(&f.adjoint(&G::lie_bracket(&xi, &eta)), &moved, allowed, "Ad_F [ξ, η] = [Ad_F ξ, Ad_F η]");
    }
}

/// `Ad*` and `ad*` are the transposes of `Ad` and `ad`.
pub fn pairings<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(5);
    for f in random.elements::<G, N, D>() {
        let (xi, eta): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        let momentum: SVector<f64, D> = random.sample();
        let difference = f.adjoint_transpose(&momentum).dot(&xi) - momentum.dot(&f.adjoint(&xi));
        assert_small(difference.abs(), ROUNDING * condition(&f), "⟨Ad*_F μ, ξ⟩ = ⟨μ, Ad_F ξ⟩");
        let paired = G::lie_bracket_transpose(&xi, &momentum).dot(&eta);
        let difference = paired - momentum.dot(&G::lie_bracket(&xi, &eta));
        assert_small(difference.abs(), ROUNDING, "⟨ad*_ξ μ, η⟩ = ⟨μ, ad_ξ η⟩");
    }
}

/// `ad` and `ad*` are the derivatives of `Ad_{exp tξ}` and `Ad*_{exp tξ}` at `t = 0`.
pub fn brackets_are_derivatives<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(6);
    for _ in 0..20 {
        let (xi, eta): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        let rate = derivative(|t| along::<G, N, D>(&xi, t).adjoint(&eta));
        assert_close(&rate, &G::lie_bracket(&xi, &eta), DIFFERENCE, "ad is the derivative of Ad");
        let rate = derivative(|t| along::<G, N, D>(&xi, t).adjoint_transpose(&eta));
        assert_close(&rate, &G::lie_bracket_transpose(&xi, &eta), DIFFERENCE, "ad* is the derivative of Ad*");
    }
}

/// The velocity's variation `δξ = η' + ad_ξ η` for `g(ε, t) = g(t) exp(ε η(t))`, \[RDAE, (1.3), (1.6)\].
pub fn variations<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(9);
    for _ in 0..20 {
        let (xi, rate): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        let (eta, eta_rate): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        // The velocity of this path at t = 0 is ξ.
        let path = |t: f64| along::<G, N, D>(&(xi + rate * (0.5 * t)), t).matrix();
        let varied = |epsilon: f64, t: f64| path(t) * along::<G, N, D>(&(eta + eta_rate * t), epsilon).matrix();
        let velocity = |epsilon: f64| {
            let here = eliminated_inverse(&G::from_matrix_unchecked(varied(epsilon, 0.0)));
            G::vee(&(here * derivative(|t| varied(epsilon, t))))
        };
        assert_close(&velocity(0.0), &xi, DIFFERENCE, "ξ = g⁻¹ g'");
        let expected = eta_rate + G::lie_bracket(&xi, &eta);
        assert_close(&derivative(velocity), &expected, NESTED_DIFFERENCE, "δξ = η' + ad_ξ η");
    }
}

/// The bracket `{f, k}(μ) = −⟨μ, ad_{δf/δμ} δk/δμ⟩`, \[RDAE, (1.11)\], is a Poisson bracket, and `Ad*_F` preserves it.
pub fn lie_poisson_brackets<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(10);
    for f in random.elements::<G, N, D>() {
        // Three functions `½ μ·Aμ + a·μ`, by their derivatives.
        let functions: [(SMatrix<f64, D, D>, SVector<f64, D>); 3] = core::array::from_fn(|_| {
            let matrix: SMatrix<f64, D, D> = random.sample();
            (matrix + matrix.transpose(), random.sample())
        });
        let slope = |i: usize, momentum: &SVector<f64, D>| functions[i].0 * momentum + functions[i].1;
        let bracket = |momentum: &SVector<f64, D>, i: usize, j: usize| {
            G::lie_poisson_bracket(momentum, &slope(i, momentum), &slope(j, momentum))
        };
        let momentum: SVector<f64, D> = random.sample();
        let antisymmetry = bracket(&momentum, 0, 1) + bracket(&momentum, 1, 0);
        assert_small(antisymmetry.abs(), ROUNDING, "{f, k} = −{k, f}");
        let by_rate = slope(0, &momentum).dot(&G::lie_bracket_transpose(&slope(1, &momentum), &momentum));
        assert_small((bracket(&momentum, 0, 1) - by_rate).abs(), ROUNDING, "{f, h} = ⟨δf/δμ, ad*_{δh/δμ} μ⟩, (1.12)");

        let jacobi = |i: usize, j: usize, k: usize| {
            // The bracket is cubic in μ, so that six points leave rounding alone.
            let inner = SVector::from_fn(|axis, _| derivative(|t| bracket(&(momentum + unit(axis) * t), j, k)));
            G::lie_poisson_bracket(&momentum, &slope(i, &momentum), &inner)
        };
        let sum: f64 = jacobi(0, 1, 2) + jacobi(1, 2, 0) + jacobi(2, 0, 1);
        let allowed = DIFFERENCE * 100.0;
        assert_small(sum.abs(), allowed, "{f, {k, l}} + {k, {l, f}} + {l, {f, k}} = 0");

        // The derivative of k(Ad*_F μ) is Ad_F of that of k.
        let moved = f.adjoint_transpose(&momentum);
        let pulled = |i: usize| f.adjoint(&slope(i, &moved));
        let difference = G::lie_poisson_bracket(&momentum, &pulled(0), &pulled(1)) - bracket(&moved, 0, 1);
        let allowed = ROUNDING * condition(&f).powi(4) * moved.norm().max(1.0).powi(3);
        assert_small(difference.abs(), allowed, "{f∘Ad*, k∘Ad*} = {f, k}∘Ad*");
    }
}

fn unit<const D: usize>(axis: usize) -> SVector<f64, D> {
    SVector::from_fn(|i, _| if i == axis { 1.0 } else { 0.0 })
}

/// Increments `D` act as the elements `F = I + D`.
pub fn increments<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(7);
    for f in random.elements::<G, N, D>() {
        let (g, d) = (random.element::<G, N, D>(), f.increment());
        let momentum: SVector<f64, D> = random.sample();
        let allowed = ROUNDING * condition(&f) * condition(&g);
        assert_close(&G::from_increment(&d).matrix(), &f.matrix(), allowed, "I + D = F");
        assert_close(&g.advance(&d).matrix(), &(g.matrix() * f.matrix()), allowed, "g + g D = g F");
        let change = f.adjoint_transpose(&momentum) - momentum;
        let by_increment = G::adjoint_transpose_increment(&d, &momentum);
        assert_close(&by_increment, &change, allowed, "Ad*_F μ − μ from D");
        let inverse = G::from_increment(&G::inverse_increment(&d));
        assert_close(&inverse.matrix(), &f.inverse().matrix(), allowed, "I + E = F⁻¹");
    }
    // The second order is 10⁻²⁴ for `‖D‖ = 10⁻¹²`, and a subtraction of one would leave 10⁻¹⁶.
    for _ in 0..20 {
        let (xi, momentum): (SVector<f64, D>, SVector<f64, D>) =
            (random.sample::<SVector<f64, D>>() * 1e-12, random.sample());
        let change = G::adjoint_transpose_increment(&G::hat(&xi), &momentum);
        let expected = G::lie_bracket_transpose(&xi, &momentum);
        assert_close(&change, &expected, 1e-22, "Ad*_F μ − μ loses no digit of a small D");
    }
}

/// The defect of the relation is zero for elements only.
pub fn the_relation_tells<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(8);
    if D == N * N {
        return;
    }
    for f in random.elements::<G, N, D>() {
        let matrix: SMatrix<f64, N, N> = random.sample();
        let off = (matrix - G::hat(&G::vee(&matrix))).normalize() * 1e-3;
        let defect = G::from_increment(&(f.increment() + f.matrix() * off)).defect();
        // An element moved by 10⁻³ across the group violates the relation by about as much.
        assert_small(1e-6 / defect.abs(), 1.0, "a matrix off the group has a defect");
    }
}
