//! A parameter in `V*` moves by `ρ(f)ᵀ`, not by `ρ(f)⁻¹`, [RDAE, theorem 2.2.1] as corrected: the two agree on
//! orthogonal matrices only.

use liestep::SO3;
use liestep::groups::{Advected, ContravariantVector, Heisenberg, SE2, SE3, SL2, SO2, SU2};
use liestep::laws::samples::{MatrixLieGroup, Random, eliminated_inverse};
use nalgebra::SVector;

/// The largest changes of `⟨w, v⟩` over some elements: with `Fᵀ w`, and with the product `F⁻¹ w` in its place.
fn changes<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() -> (f64, f64) {
    let mut random = Random::new(31);
    let (mut right, mut naive) = (0.0_f64, 0.0_f64);
    for _ in 0..20 {
        let f: G = random.element();
        let (w, v): (SVector<f64, N>, ContravariantVector<f64, N>) = (random.sample(), random.sample());
        let moved = Advected::<G>::advect(&v, &f.increment()).0;
        right = right.max((w.seen_from(&f).dot(&moved) - w.dot(&v.0)).abs());
        naive = naive.max(((eliminated_inverse(&f) * w).dot(&moved) - w.dot(&v.0)).abs());
    }
    (right, naive)
}

#[test]
fn p3_the_naive_product_is_wrong_where_matrices_are_not_orthogonal() {
    let groups = [
        ("SE(2)", changes::<SE2, _, _>()),
        ("SE(3)", changes::<SE3, _, _>()),
        ("SL(2)", changes::<SL2, _, _>()),
        ("Heisenberg", changes::<Heisenberg, _, _>()),
    ];
    for (name, (right, naive)) in groups {
        assert!(right < 1e-13, "{name}: {right:e}");
        assert!(naive > 0.1, "{name}: {naive:e}");
    }
}

#[test]
fn p3_it_is_the_same_where_they_are() {
    for (right, naive) in [changes::<SO2, _, _>(), changes::<SO3, _, _>(), changes::<SU2, _, _>()] {
        assert!(right < 1e-13 && naive < 1e-13, "{right:e}, {naive:e}");
    }
}
