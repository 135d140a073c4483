//! `Coordinates` in all dimensions of groups: the solution of a linear system, and the result for a singular one.

use liestep::laws::samples::Random;
use liestep::numbers::{BlockDiagonal, Blocks, Bodies, Coordinates, Pattern};
use nalgebra::{SMatrix, SVector};

/// The sum of a symmetric positive definite matrix and a smaller one without symmetry, like a Jacobian at a finite
/// step.
fn jacobian<const D: usize>(random: &mut Random) -> SMatrix<f64, D, D> {
    let root: SMatrix<f64, D, D> = random.sample();
    let rest: SMatrix<f64, D, D> = random.sample();
    root.transpose() * root + SMatrix::identity() * 0.1 + rest * 0.1
}

fn assert_solves<const D: usize>() {
    let mut random = Random::new(41);
    for _ in 0..50 {
        let (a, b): (SMatrix<f64, D, D>, SVector<f64, D>) = (jacobian(&mut random), random.sample());
        let (z, _) = SVector::<f64, D>::solve(&a, &b);
        // Backward stability: the residual is a rounding of its products, whatever the condition of `A`.
        assert!((a * z - b).norm() <= 2e-14 * (a.norm() * z.norm() + b.norm()), "{D}");
        assert!((SVector::<f64, D>::trace(&a) - a.trace()).abs() < 1e-14);
        assert!(z.is_finite() && !Coordinates::is_finite(&(z * f64::NAN)) && !Coordinates::is_finite(&(z / 0.0)));
        assert!((Coordinates::dot(&z, &b) - b.dot(&z)).abs() <= 1e-13 * z.norm());
    }
}

/// Matrices that are singular without rounding: small integers, with the last row half of the first, or all zero.
fn assert_refuses<const D: usize>() {
    let mut random = Random::new(42);
    let (mut dependent, b): (SMatrix<f64, D, D>, SVector<f64, D>) = (jacobian(&mut random) * 16.0, random.sample());
    dependent.apply(|entry| *entry = entry.round());
    let row = if D == 1 { dependent.row(0) * 0.0 } else { dependent.row(0) * 0.5 };
    dependent.set_row(D - 1, &row);
    for (matrix, right_side) in [(dependent, b), (SMatrix::zeros(), b), (SMatrix::zeros(), SVector::zeros())] {
        let (z, det) = SVector::<f64, D>::solve(&matrix, &right_side);
        assert!(!Coordinates::is_finite(&z), "{D}: {z}");
        assert!(det == 0.0 || !det.is_finite(), "{D}: {det}");
    }
}

/// The determinant compared with that of a known triangular factorisation.
fn assert_determinant<const D: usize>() {
    let mut random = Random::new(43);
    let (mut lower, mut upper) = (SMatrix::<f64, D, D>::identity(), SMatrix::<f64, D, D>::identity());
    let mut expected = 1.0;
    for i in 0..D {
        for j in 0..i {
            (lower[(i, j)], upper[(j, i)]) = (random.signed(), random.signed());
        }
        upper[(i, i)] = 1.5 + random.signed();
        expected *= upper[(i, i)];
    }
    let (_, det) = SVector::<f64, D>::solve(&(lower * upper), &SVector::zeros());
    assert!((det / expected - 1.0).abs() < 1e-12, "{D}: {det} against {expected}");
}

/// Factors with every choice of block ends, solved separately or together: the inverse maps a right-hand side to its
/// solution, and isn't finite for a singular matrix.
fn assert_inverse_solves<const D: usize>() {
    type V<const D: usize> = SVector<f64, D>;
    type Three<const D: usize> = Bodies<V<D>, 3>;
    let mut random = Random::new(44);
    for ends in 0..1_u32 << (D - 1) {
        let is_end = |k: usize| ends >> (k - 1) & 1 == 1;
        let factors = (1..D).filter(|&k| is_end(k)).fold(Blocks::WHOLE, |blocks, k| blocks.then(k, Blocks::WHOLE));
        for is_apart in [false, true] {
            let pattern = Pattern { factors, apart: if is_apart { factors } else { Blocks::WHOLE } };
            let (mut a, b): (SMatrix<f64, D, D>, V<D>) = (jacobian(&mut random), random.sample());
            for (row, column) in (0..D).flat_map(|row| (0..D).map(move |column| (row, column))) {
                let is_between = (row.min(column) + 1..=row.max(column)).any(is_end);
                a[(row, column)] *= if is_apart && is_between { 0.0 } else { 1.0 };
            }
            let inverse_of = |a: &SMatrix<f64, D, D>| {
                let (made, det) = V::<D>::factorise_with(a, pattern);
                (V::<D>::inverse_with(&made, det, pattern), V::<D>::solve_again_with(&made, det, pattern, &b))
            };
            let (inverse, solution) = inverse_of(&a);
            assert!((inverse * b - solution).norm() <= 1e-13 * inverse.norm() * b.norm(), "{pattern:?}");
            let residual = (a * (inverse * b) - b).norm();
            assert!(residual <= 1e-13 * a.norm() * inverse.norm() * b.norm(), "{pattern:?}: {residual:e}");
            a.fill_row(D - 1, 0.0);
            assert!(inverse_of(&a).0.iter().any(|entry| !entry.is_finite()), "{pattern:?}");
        }
    }
    let pattern = Pattern { factors: Blocks::WHOLE, apart: Blocks::WHOLE };
    let a = BlockDiagonal([(); 3].map(|()| jacobian::<D>(&mut random)));
    let b = Bodies([(); 3].map(|()| random.sample::<SVector<f64, D>>()));
    let (made, det) = Three::<D>::factorise_with(&a, pattern);
    let inverse = Three::<D>::inverse_with(&made, det, pattern);
    let solution = Three::<D>::solve_again_with(&made, det, pattern, &b);
    for body in 0..3 {
        let difference = ((inverse * b).0[body] - solution.0[body]).norm();
        assert!(difference <= 1e-13 * inverse.0[body].norm() * b.0[body].norm(), "{D}: {difference:e}");
        let residual = (a.0[body] * solution.0[body] - b.0[body]).norm();
        assert!(residual <= 1e-13 * a.0[body].norm() * inverse.0[body].norm() * b.0[body].norm(), "{D}: {residual:e}");
    }
}

macro_rules! dimensions {
    ($($name:ident $dimension:literal)+) => {$(
        #[test]
        fn $name() {
            assert_solves::<$dimension>();
            assert_refuses::<$dimension>();
            assert_determinant::<$dimension>();
            assert_inverse_solves::<$dimension>();
        }
    )+};
}

dimensions! { one 1 two 2 three 3 four 4 five 5 six 6 eight 8 }

/// Another unit of length scales some rows and columns; a power of two doesn't change a digit of the solution.
#[test]
fn units_change_no_digit() {
    let mut random = Random::new(44);
    let unit = SVector::<f64, 6>::from_fn(|k, _| if k < 3 { 1.0 } else { f64::powi(2.0, -20) });
    let (a, b): (SMatrix<f64, 6, 6>, SVector<f64, 6>) = (jacobian(&mut random), random.sample());
    let scale = SMatrix::from_diagonal(&unit);
    let (z, _) = SVector::<f64, 6>::solve(&a, &b);
    let (scaled, _) = SVector::<f64, 6>::solve(&(scale * a * scale), &(scale * b));
    assert_eq!(scale * scaled, z);
}
