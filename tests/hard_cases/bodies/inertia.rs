//! The two inertias `J = tr(J_d) I − J_d` and `J_d = ½ tr(J) I − J`, and matrices that aren't the inertia of any body.

use checks::random::Random;
use declarations::{FreeBody, HeavyTop};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, InertiaError, inertia};
use liestep::{NonstandardInertia, SO3, SetupError, Stepper};
use nalgebra::{Matrix3, Vector3};
use workbench::measure::relative;

/// `∫ X Xᵀ dm` and `∫ (|X|² I − X Xᵀ) dm` of point masses.
fn integrals(random: &mut Random) -> (Matrix3<f64>, Matrix3<f64>) {
    let (mut nonstandard, mut ordinary) = (Matrix3::zeros(), Matrix3::zeros());
    for _ in 0..10 {
        let (x, mass) = (random.vector(), 1.5 + random.signed());
        nonstandard += x * x.transpose() * mass;
        ordinary += (Matrix3::from_diagonal_element(x.norm_squared()) - x * x.transpose()) * mass;
    }
    (nonstandard, ordinary)
}

#[test]
fn conversions_agree_with_the_integrals() {
    let mut random = Random::new(41);
    for _ in 0..100 {
        let (nonstandard, ordinary) = integrals(&mut random);
        let (j_d, j) = (NonstandardInertia::new(nonstandard).unwrap(), Inertia::new(ordinary).unwrap());
        // The bound is the rounding of sums of ten terms.
        assert!(relative(j_d.to_inertia().as_matrix(), &ordinary) < 1e-15);
        assert!(relative(j.to_nonstandard().as_matrix(), &nonstandard) < 2e-15);
        assert!(relative(j_d.to_inertia().to_nonstandard().as_matrix(), &nonstandard) < 2e-15);
        assert!(relative(&inertia(&FreeBody { J_d: j_d }, &()), &ordinary) < 1e-15);
    }
}

/// Diagonals of `J_d` and principal moments construct the thesis' body, read as in case A.
#[test]
fn diagonals_and_principal_moments() {
    let (diagonal, moments) = (Vector3::new(2.0, 2.0, 1.0), Vector3::new(3.0, 3.0, 4.0));
    let full = NonstandardInertia::from_diagonal(diagonal).unwrap();
    let principal = DiagonalNonstandardInertia::from_diagonal(diagonal).unwrap();
    assert_eq!(full.as_matrix().diagonal(), diagonal);
    assert_eq!(full, NonstandardInertia::from_principal_moments(moments).unwrap());
    assert_eq!(full, principal.into());
    assert_eq!(principal, DiagonalNonstandardInertia::from_principal_moments(moments).unwrap());
    assert_eq!(full.to_inertia(), Inertia::from_principal_moments(moments).unwrap());
    assert_eq!(full.to_inertia().as_matrix().diagonal(), moments);
}

/// The velocity of a free body after a time, by Runge–Kutta steps of Euler's equations.
fn by_euler(moments: &Vector3<f64>, velocity: Vector3<f64>, time: f64) -> Vector3<f64> {
    let rate = |w: Vector3<f64>| moments.component_mul(&w).cross(&w).component_div(moments);
    let h = time / 2000.0;
    (0..2000).fold(velocity, |w, _| {
        let a = rate(w);
        let b = rate(w + a * (h / 2.0));
        let c = rate(w + b * (h / 2.0));
        w + (a + (b + c) * 2.0 + rate(w + c * h)) * (h / 6.0)
    })
}

/// Moments of a space agency's demonstration, which no rigid body has: refused, and of order two where they are effective.
#[test]
fn b13_an_effective_inertia_is_that_of_no_rigid_body() {
    let (moments, start) = (Vector3::new(5174.0, 3593.0, 245.4), Vector3::new(0.02, 0.5, 0.03));
    assert!(Inertia::from_principal_moments(moments).is_err());
    let J = Inertia::effective(Matrix3::from_diagonal(&moments)).unwrap();
    let principal = DiagonalNonstandardInertia::effective(moments).unwrap();
    assert_eq!(principal.to_matrix(), *J.to_nonstandard().as_matrix());
    let error = |steps: u32| {
        let stepper = Stepper::new(FreeBody { J_d: J.to_nonstandard() }, 10.0 / f64::from(steps)).unwrap();
        let mut state = stepper.start(SO3::identity(), start).unwrap();
        stepper.run(&mut state, steps.into()).unwrap();
        (stepper.velocity(&state) - by_euler(&moments, start, 10.0)).norm()
    };
    let order = (error(500) / error(1000)).log2();
    assert!((order - 2.0).abs() < 0.01, "{order}");
    for impossible in [Vector3::new(5.0, 3.0, 0.0), Vector3::new(5.0, -3.0, 1.0), Vector3::new(f64::NAN, 1.0, 1.0)] {
        assert!(Inertia::effective(Matrix3::from_diagonal(&impossible)).is_err(), "{impossible}");
        assert!(DiagonalNonstandardInertia::effective(impossible).is_err(), "{impossible}");
    }
}

fn nonstandard(diagonal: [f64; 3]) -> Result<Vector3<f64>, InertiaError> {
    let diagonal = Vector3::from(diagonal);
    let principal = DiagonalNonstandardInertia::from_diagonal(diagonal).map(|j_d| *j_d.diagonal());
    let full = NonstandardInertia::from_diagonal(diagonal).map(|j_d| j_d.as_matrix().diagonal());
    // Texts are compared, as NaN differs from itself.
    assert_eq!(format!("{principal:?}"), format!("{full:?}"), "both types check alike");
    principal
}

#[test]
fn b6_a_negative_entry_violates_the_triangle_inequality() {
    for diagonal in [[2.0, 2.0, -1.0], [-1e-6, 1.0, 1.0], [1.0, -1e-13, 1.0]] {
        let error = nonstandard(diagonal).unwrap_err();
        let InertiaError::TriangleInequality { smallest } = error else { panic!("{diagonal:?}: {error:?}") };
        // The eigenvalues of a diagonal matrix are its entries, without a rounding worth mentioning.
        assert!(diagonal.iter().any(|&entry| (entry / smallest - 1.0).abs() < 1e-9));
        assert!(error.to_string().contains("J_d"), "{error}");
    }
    let moments = Vector3::new(1.0, 2.0, 3.1);
    let error = Inertia::from_principal_moments(moments).unwrap_err();
    assert!(matches!(error, InertiaError::TriangleInequality { smallest } if (smallest + 0.05).abs() < 1e-15));
    assert_eq!(DiagonalNonstandardInertia::from_principal_moments(moments).unwrap_err(), error);
    assert_eq!(NonstandardInertia::from_principal_moments(moments).unwrap_err(), error);
    // A flat body is accepted, even when its zero is a rounded result.
    assert!(nonstandard([0.1 + 0.2 - 0.3, 1.0, 2.0]).is_ok());
    assert!(nonstandard([0.3 - (0.1 + 0.2), 1.0, 2.0]).is_ok());
}

#[test]
fn b6_rods_points_and_nothing_are_singular() {
    for diagonal in [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [1e-17, 0.0, 1.0]] {
        let error = nonstandard(diagonal).unwrap_err();
        assert!(matches!(error, InertiaError::Singular { .. }), "{diagonal:?}: {error:?}");
        assert!(error.to_string().contains("principal moment"), "{error}");
    }
    assert!(matches!(Inertia::<f64>::new(Matrix3::zeros()), Err(InertiaError::Singular { .. })));
}

#[test]
fn b6_what_is_not_symmetric() {
    let symmetric = Matrix3::new(2.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 1.0);
    assert!(NonstandardInertia::new(symmetric).is_ok() && Inertia::new(symmetric).is_ok());
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        let mut matrix = symmetric;
        matrix[(row, column)] += 1e-3;
        for error in [NonstandardInertia::new(matrix).unwrap_err(), Inertia::new(matrix).unwrap_err()] {
            assert!(matches!(error, InertiaError::NotSymmetric { defect } if (defect - 1e-3).abs() < 1e-15));
        }
        // An asymmetry from printing fifteen digits is accepted, and removed.
        matrix[(row, column)] = symmetric[(row, column)] * (1.0 + 1e-15);
        let repaired = NonstandardInertia::new(matrix).unwrap();
        assert_eq!(repaired.as_matrix(), &repaired.as_matrix().transpose());
    }
}

#[test]
fn b6_what_is_not_finite_or_out_of_range() {
    for entry in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..3 {
            let mut diagonal = [2.0, 2.0, 1.0];
            diagonal[place] = entry;
            assert_eq!(nonstandard(diagonal).unwrap_err(), InertiaError::NotFinite);
        }
        let mut matrix = Matrix3::identity();
        matrix[(0, 2)] = entry;
        assert_eq!(NonstandardInertia::new(matrix).unwrap_err(), InertiaError::NotFinite);
        assert_eq!(Inertia::new(matrix).unwrap_err(), InertiaError::NotFinite);
    }
    for scale in [1e150, 1e-150] {
        let error = nonstandard([2.0 * scale, 2.0 * scale, scale]).unwrap_err();
        assert!(matches!(error, InertiaError::OutOfRange { .. }), "{scale:e}: {error:?}");
        assert!(Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0) * scale).is_err());
    }
    for scale in [1e60, 1e-60] {
        assert!(nonstandard([2.0 * scale, 2.0 * scale, scale]).is_ok());
    }
}

#[test]
fn b6_other_parameters_are_named() {
    for bad in [f64::NAN, f64::INFINITY] {
        let thesis = HeavyTop::thesis;
        let tops = [
            ("m", HeavyTop { m: bad, ..thesis() }),
            ("g", HeavyTop { g: bad, ..thesis() }),
            ("rho", HeavyTop { rho: Vector3::new(0.0, bad, 0.0), ..thesis() }),
            ("up", HeavyTop { up: Vector3::new(bad, 0.0, 0.0), ..thesis() }),
        ];
        for (name, top) in tops {
            let error = Stepper::new(top, 0.01).unwrap_err();
            assert!(matches!(error, SetupError::Parameter { field, .. } if field == name), "{name}: {error:?}");
            assert!(error.to_string().contains(&format!("`{name}`")), "{error}");
        }
        assert!(matches!(Stepper::new(thesis(), bad), Err(SetupError::InvalidStep { .. })));
    }
    assert!(matches!(Stepper::new(HeavyTop::thesis(), 1e-310), Err(SetupError::InvalidStep { .. })));
}
