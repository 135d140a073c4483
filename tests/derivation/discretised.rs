//! Discretisations of an `l` that isn't quadratic in the velocity, on groups with and without a bi-invariant metric:
//! the derived terms compared with hyper-dual numbers, order two with collocation, the coadjoint orbit, and a step
//! back.

use checks::affine::Affine;
use checks::random::Random;
use checks::structure::{System, poisson, stages, symmetry};
use liestep::effects::Gravity;
use liestep::groups::{CovariantTensor, LieGroup, R3, SE3, SL2, SO3};
use liestep::laws::samples::MatrixLieGroup;
use liestep::mechanics::{ContinuousLagrangian, Inertia};
use liestep::methods::{CotangentGauss, ExactBody, SplittingScheme};
use liestep::motion::Moment;
use liestep::numbers::{Lanes as _, Real};
use liestep::recording::{Event, RunError};
use liestep::{NonstandardInertia, SetupError, StepError, Stepper, lagrangian};
use nalgebra::{
    ComplexField, Matrix2, Matrix3, Matrix4, RealField, SMatrix, SVector, SimdValue as _, Vector2, Vector3, Vector4,
    convert,
};
use num_dual::HyperDual64;
use simba::simd::WideF64x4;

use crate::dual_numbers::{assert_terms, by_cayley, by_hand};
use crate::other_groups::{column, tensor};

macro_rules! quartic {
    ($name:ident: $group:ident, $vector:ident, $matrix:ident, $rule:ident$(($retraction:ident))? $(, $($own:tt)*)?) => {
        #[lagrangian(
            group = $group,
            $($($own)*)?
            velocity = xi,
            advected(w = covector),
            l = {
                let x = hat(xi);
                let quadratic = (x * J * x.transpose()).trace();
                0.5 * quadratic + k * quadratic.powi(2) + w.dot(&(x * r)) - w.dot(&r).powi(2)
            },
            discretise = $rule$(($retraction))?,
        )]
        #[derive(Clone, Debug)]
        struct $name<T: RealField + Copy = f64> {
            J: $matrix<T>,
            k: T,
            r: $vector<T>,
            covector: $vector<T>,
        }

        impl<T: RealField + Copy> $name<T> {
            fn new() -> Self {
                let mut random = Random::new(11);
                let J: $matrix<f64> = tensor(&mut random);
                let [r, covector]: [$vector<f64>; 2] = [(); 2].map(|()| column(&mut random));
                Self { J: J.map(convert), k: convert(0.1), r: r.map(convert), covector: covector.map(convert) }
            }
        }
    };
}

quartic!(OnSo3: SO3, Vector3, Matrix3, trapezoid(Cayley));
quartic!(OnSo3Halfway: SO3, Vector3, Matrix3, midpoint(exp));
quartic!(OnSl2: SL2, Vector2, Matrix2, trapezoid(Cayley));
quartic!(OnSe3: SE3, Vector4, Matrix4, chord(Cayley));
quartic!(
    OnAffine: Affine, Vector2, Matrix2, trapezoid(Cayley),
    generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]],
);

/// A Lagrangian in the ambient matrix, and its sum with a term of the library.
#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = covector),
    l = 0.5 * Omega.dot(&(J * Omega)) + k * Omega.dot(&(J * Omega)).powi(2) - w.dot(&r).powi(2),
    discretise = trapezoid,
)]
#[derive(Clone, Debug)]
struct QuarticBody {
    J: Inertia,
    k: f64,
    r: Vector3<f64>,
    covector: Vector3<f64>,
}

impl QuarticBody {
    fn new() -> Self {
        let J = Inertia::from_principal_moments(Vector3::new(0.4, 0.6, 0.9)).unwrap();
        Self { J, k: 0.1, r: Vector3::new(0.1, -0.2, 0.9), covector: Vector3::new(0.3, -0.8, 0.5) }
    }
}

/// Checks all claims about a discretisation except those about its terms.
fn assert_discretised<L, const N: usize, const D: usize>(system: &L, name: &str)
where
    L: System<Group: MatrixLieGroup<N, D>> + ContinuousLagrangian + Clone,
{
    const { assert!(L::FACTS.is_self_adjoint && !L::FACTS.is_quadratic) };
    stages::assert_stages(system, 6);
    let (_, defect) = poisson::worst(system, &[0.02, 0.1], 7);
    assert!(defect < 1e-11, "{name}: Poisson {defect:e}");
    let mut random = Random::new(8);
    let (attitude, velocity): (_, SVector<f64, D>) = (L::Group::identity(), column(&mut random));
    let stepper = Stepper::new(system.clone(), 0.02).unwrap();
    let state = stepper.start(attitude, velocity).unwrap();
    let (momentum, parameters) = symmetry::drift(&stepper.flow(), (attitude, state.momentum()), 500);
    assert!(momentum < 1e-12 && parameters < 1e-12, "{name}: drift {momentum:e}, {parameters:e}");

    // The continuous momentum, velocity and energy are those of the declared `l`.
    let w = state.advected();
    let expected = system.momentum(&velocity, &w);
    assert!((state.momentum() - expected).norm() <= 1e-14 * expected.norm(), "{name}: the momentum of a velocity");
    assert!((stepper.velocity(&state) - velocity).norm() <= 1e-12 * velocity.norm(), "{name}: and back");
    let energy = system.hamiltonian(&expected, &w).unwrap();
    assert!((stepper.energy(&state) - energy).abs() <= 1e-12 * (1.0 + energy.abs()), "{name}: the energy");
    let swing = |h: f64| {
        let stepper = Stepper::new(system.clone(), h).unwrap();
        let states = stepper.steps(stepper.start(attitude, velocity).unwrap());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundreds
        let errors = states.take((1.0 / h).round() as usize).map(|state| stepper.energy(&state.unwrap()) - energy);
        errors.fold(0.0, |most: f64, error| most.max(error.abs()))
    };
    let swings = [0.01, 0.005].map(swing);
    let quarter = swings[0] / swings[1];
    println!("{name}: energy {energy}, swings {swings:?}, {quarter:.3} times");
    assert!((quarter - 4.0).abs() < 0.2, "{name}: the energy's swings {swings:?}");
    // The bound is twice the largest error, that of the sum, whose gravity accelerates a small body to 7 rad/s.
    assert!(swings[0] < 4e-3 * (1.0 + energy.abs()), "{name}: the energy's swing {swings:?} of {energy}");

    let time = 0.5;
    let gauss = CotangentGauss::<L, 3, N>::new(system.clone(), time / 20.0).unwrap();
    let mut exact = (attitude, expected);
    for _ in 0..20 {
        exact = gauss.step(&exact.0, &exact.1).unwrap();
    }
    let error = |steps: u32| {
        let stepper = Stepper::new(system.clone(), time / f64::from(steps)).unwrap();
        let mut state = stepper.start(attitude, velocity).unwrap();
        stepper.run(&mut state, steps.into()).unwrap();
        (state.attitude().matrix() - exact.0.matrix()).norm() + (state.momentum() - exact.1).norm()
    };
    let order = (error(50) / error(100)).log2();
    println!("{name}: order {order}, Poisson {defect:.1e}");
    assert!((order - 2.0).abs() < 0.05, "{name}: order {order}");

    let back = stepper.inverse().unwrap();
    let mut there = stepper.start(attitude, velocity).unwrap();
    stepper.run(&mut there, 50).unwrap();
    back.run(&mut there, 50).unwrap();
    assert!((there.momentum() - expected).norm() < 1e-11 * expected.norm(), "{name}: back");
}

/// A top with nearly the velocity of light, declared as an `l_d`: the limit is `−√(1 − ξ·Jξ) − k w·r`.
#[lagrangian(
    group = SO3,
    advected(w = covector),
    l_d = -h * (1.0 - ((F - I) * J_d * (F - I).transpose()).trace() / (h * h)).sqrt()
        - 0.5 * h * k * w.dot(&(r + F * r)),
)]
#[derive(Clone, Debug)]
struct RelativisticBody {
    J_d: NonstandardInertia,
    k: f64,
    r: Vector3<f64>,
    covector: Vector3<f64>,
}

/// The momentum is `Jξ/√(1 − ξ·Jξ)`.
#[test]
fn of_any_degree_as_typed() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(0.1, 0.12, 0.08)).unwrap();
    let top = RelativisticBody { J_d, k: 0.2, r: Vector3::new(0.1, -0.2, 0.9), covector: Vector3::new(0.3, -0.8, 0.5) };
    let J = *top.J_d.to_inertia().as_matrix();
    let (xi, w) = (Vector3::new(0.9, -0.7, 0.8), top.covector);
    let root = (1.0 - xi.dot(&(J * xi))).sqrt();
    assert!((top.momentum(&xi, &w) - J * xi / root).norm() < 1e-14);
    assert!((top.l(&xi, &w) + root + top.k * w.dot(&top.r)).abs() < 1e-14);
    let typed = |f: &Matrix3<HyperDual64>, w: &Vector3<HyperDual64>, h: HyperDual64| {
        let (small, r) = (f - Matrix3::identity(), top.r.map(HyperDual64::from));
        let J_d = top.J_d.as_matrix().map(HyperDual64::from);
        let squared = (small * J_d * small.transpose()).trace() / (h * h);
        -h * ComplexField::sqrt(HyperDual64::from(1.0) - squared) - h * (0.5 * top.k) * w.dot(&(r + f * r))
    };
    assert_terms::<_, SO3<HyperDual64>, _>("SO(3), typed", (&top, 0.6, 0.0), typed, (5, 0.5));
    let stepper = Stepper::new(top, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), xi).unwrap();
    let energy = stepper.energy(&state);
    stepper.run(&mut state, 500).unwrap();
    assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs());
    // The estimate by the inertia at rest is beyond the singularity of the root, so the initial guess of a solve isn't
    // finite.
    let axis = Vector3::new(0.0, 1.0, 0.0);
    let fastest = 1.0 / axis.dot(&(J * axis)).sqrt();
    for share in [0.7, 0.72, 0.9, 0.99] {
        let mut state = stepper.start(SO3::identity(), axis * (share * fastest)).unwrap();
        assert!(stepper.max_step(&state) > 0.009_999, "{share}: {}", stepper.max_step(&state));
        stepper.step(&mut state).unwrap();
    }
    // The velocity is by a factor of 1e4 more sensitive to rounding than the momentum.
    let state = stepper.start_with_momentum(SO3::identity(), axis * 30.0).unwrap();
    let speed = stepper.velocity(&state).y;
    let momentum = J[(1, 1)] * speed / (1.0 - J[(1, 1)] * speed * speed).sqrt();
    assert!((momentum / 30.0 - 1.0).abs() < 1e-9, "{momentum}");
}

/// The declared `l` as a function of `ξ̂` and `w`.
fn quartic<T: RealField + Copy, const N: usize>(
    (J, k, r): (SMatrix<T, N, N>, T, SVector<T, N>),
) -> impl Fn(&SMatrix<T, N, N>, &SVector<T, N>) -> T {
    move |x, w| {
        let quadratic = (x * J * x.transpose()).trace();
        let linear = w.dot(&(x * r)) - w.dot(&r).powi(2);
        quadratic * convert(0.5) + k * quadratic.powi(2) + linear
    }
}

#[test]
fn on_so3() {
    type LongNumbers = OnSo3<HyperDual64>;
    let LongNumbers { J, k, r, .. } = LongNumbers::new();
    let of_matrix = quartic((J, k, r));
    let l = |_: HyperDual64, xi: &Vector3<_>, w: &Vector3<_>| of_matrix(&xi.cross_matrix(), w);
    let any = Matrix3::identity();
    let trapezoid = |f: &_, w: &_, h| by_hand("trapezoid(Cayley)", &any, l, (f, w, h));
    assert_terms::<_, SO3<HyperDual64>, _>("SO(3), trapezoid(Cayley)", (&OnSo3::new(), 0.05, 0.0), trapezoid, (5, 0.5));
    let midpoint = |f: &_, w: &_, h| by_hand("midpoint(exp)", &any, l, (f, w, h));
    assert_terms::<_, SO3<HyperDual64>, _>(
        "SO(3), midpoint(exp)",
        (&OnSo3Halfway::new(), 0.05, 0.0),
        midpoint,
        (5, 0.5),
    );
    assert_discretised(&OnSo3::new(), "SO(3), trapezoid(Cayley)");
    assert_discretised(&OnSo3Halfway::new(), "SO(3), midpoint(exp)");
}

#[test]
fn on_so3_in_the_ambient_matrix() {
    let (body, gravity) =
        (QuarticBody::new(), Gravity { m: 1.1, g: 9.81, rho: Vector3::new(0.1, -0.2, 1.0), up: Vector3::z() });
    let (J, k) = (body.J.as_matrix(), HyperDual64::from(body.k));
    let [r, rho] = [body.r, gravity.rho].map(|vector| vector.map(HyperDual64::from));
    let alone = |f: &_, w: &Vector3<HyperDual64>, h| {
        let l = |q: HyperDual64, _: &_, w: &Vector3<_>| q * 0.5 + k * q * q - w.dot(&r) * w.dot(&r);
        by_hand("trapezoid", J, l, (f, w, h))
    };
    let sum = |f: &Matrix3<_>, (w, up): &(Vector3<_>, Vector3<_>), h| {
        alone(f, w, h) - h * (0.5 * gravity.m * gravity.g) * up.dot(&(rho + f * rho))
    };
    let both = body.clone() + gravity;
    for h in [0.5, 0.05] {
        // `(ξ·Jξ)²` is the square of a difference of traces of J_d/h², which are this large.
        let cancelling = 4.0 * body.k * body.J.to_nonstandard().as_matrix().trace().powi(2) / (h * h * h);
        assert_terms::<_, SO3<HyperDual64>, _>("SO(3), trapezoid", (&body, h, cancelling), alone, (5, 0.5));
        assert_terms::<_, SO3<HyperDual64>, _>("SO(3), a sum", (&both, h, cancelling), sum, (5, 0.5));
    }
    assert_discretised(&body, "SO(3), trapezoid");
    assert_discretised(&(body + gravity), "SO(3), a sum");
}

#[test]
fn on_sl2() {
    let OnSl2 { J, k, r, .. } = OnSl2::<HyperDual64>::new();
    let rule = |f: &_, w: &_, h| by_cayley("trapezoid(Cayley)", quartic((J, k, r)), (f, w, h));
    assert_terms::<_, SL2<HyperDual64>, _>("SL(2), trapezoid(Cayley)", (&OnSl2::new(), 0.05, 0.0), rule, (5, 0.5));
    assert_discretised(&OnSl2::new(), "SL(2), trapezoid(Cayley)");
}

/// A bilinear form, which is advected to `Fᵀ B F`.
#[lagrangian(
    group = SL2,
    velocity = xi,
    advected(B = form),
    l = 0.5 * xi.dot(&(M * xi)) - r.dot(&(B * r)),
    discretise = trapezoid(Cayley),
)]
struct FormOnSL2 {
    M: Matrix3<f64>,
    r: Vector2<f64>,
    form: CovariantTensor<f64, 2>,
}

#[test]
fn a_form_is_carried_forwards() {
    let mut random = Random::new(11);
    let (M, r): (Matrix3<f64>, Vector2<f64>) = (tensor(&mut random), column(&mut random));
    let form = CovariantTensor(tensor(&mut random));
    let (long_m, long_r) = (M.map(HyperDual64::from), r.map(HyperDual64::from));
    let rule = |f: &Matrix2<HyperDual64>, form: &CovariantTensor<HyperDual64, 2>, h: HyperDual64| {
        let inverse: Matrix2<HyperDual64> =
            (f + Matrix2::identity()).try_inverse().expect("an increment that isn't large");
        let xi = SL2::<HyperDual64>::vee(&((f - Matrix2::identity()) * inverse)) * (HyperDual64::from(2.0) / h);
        let l = |form: &Matrix2<HyperDual64>| xi.dot(&(long_m * xi)) * 0.5 - long_r.dot(&(form * long_r));
        (l(&form.0) + l(&(f.transpose() * form.0 * f))) * h * 0.5
    };
    assert_terms::<_, SL2<HyperDual64>, _>("SL(2), a form", (&FormOnSL2 { M, r, form }, 0.05, 0.0), rule, (5, 0.5));
}

#[test]
fn on_se3() {
    let OnSe3 { J, k, r, .. } = OnSe3::<HyperDual64>::new();
    let rule = |f: &_, w: &_, h| by_cayley("chord(Cayley)", quartic((J, k, r)), (f, w, h));
    assert_terms::<_, SE3<HyperDual64>, _>("SE(3), chord(Cayley)", (&OnSe3::new(), 0.05, 0.0), rule, (5, 0.5));
    assert_discretised(&OnSe3::new(), "SE(3), chord(Cayley)");
}

#[test]
fn on_affine_maps() {
    let OnAffine { J, k, r, .. } = OnAffine::<HyperDual64>::new();
    let rule = |f: &_, w: &_, h| by_cayley("trapezoid(Cayley)", quartic((J, k, r)), (f, w, h));
    assert_terms::<_, Affine<HyperDual64>, _>(
        "affine maps, trapezoid(Cayley)",
        (&OnAffine::new(), 0.05, 0.0),
        rule,
        (5, 0.5),
    );
    assert_discretised(&OnAffine::new(), "affine maps, trapezoid(Cayley)");
}

/// Methods that contain the motion of one free body require a constant inertia.
#[test]
fn methods_for_a_quadratic_kinetic_energy_refuse_another() {
    let body = ExactBody::new(&QuarticBody::new().J);
    let split = Stepper::split(QuarticBody::new(), 0.1, body, SplittingScheme::STRANG);
    assert!(matches!(split, Err(SetupError::VaryingInertia)));
    assert!(matches!(Stepper::collocated::<2>(QuarticBody::new(), 0.1), Err(SetupError::VaryingInertia)));
}

/// A relativistic particle, whose momenta are those of velocities below that of light.
#[lagrangian(
    group = R3,
    velocity = v,
    advected(w = field),
    l = -(m * c * c) * (1.0 - v.norm_squared() / (c * c)).sqrt() + q * w.dot(&origin),
    discretise = trapezoid(exp),
)]
#[derive(Clone, Debug)]
struct ParticleInField {
    m: f64,
    c: f64,
    q: f64,
    origin: Vector4<f64>,
    field: Vector4<f64>,
}

/// In a uniform field the discrete momentum is exact, and each displacement is that of the middle momentum.
#[test]
fn a_fast_particle() {
    let (m, c, q, h) = (2.0, 3.0, 0.5, 0.1);
    let field = Vector4::new(0.4, -1.0, 0.2, 0.0);
    let stepper = Stepper::new(ParticleInField { m, c, q, origin: Vector4::w(), field }, h).unwrap();
    let mut state = stepper.start(R3::identity(), Vector3::new(0.3, 0.1, -2.8)).unwrap();
    let (mut momentum, mut place) = (state.momentum(), Vector3::zeros());
    assert!(momentum.norm() > 2.0 * m * 2.8, "{momentum}");
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
        let pull = field.xyz() * (q * h);
        let middle: Vector3<f64> = momentum + pull * 0.5;
        place += middle * (c * h / (m * m * c * c + middle.norm_squared()).sqrt());
        momentum += pull;
    }
    assert!((state.momentum() - momentum).norm() < 1e-11 * momentum.norm());
    let reached = state.attitude().matrix().fixed_view::<3, 1>(0, 3).into_owned();
    assert!((reached - place).norm() < 1e-11 * place.norm(), "{reached} and {place}");
    assert!(stepper.velocity(&state).norm() < c);
    let error = stepper.start(R3::identity(), Vector3::new(0.0, 0.0, 3.1)).unwrap_err();
    assert!(matches!(error, SetupError::AmbiguousVelocity { difference } if difference.is_nan()), "{error}");
}

/// A momentum with a fold, `∂l/∂ξ = (1 − k |ξ|²) ξ`: it decreases beyond `|ξ| = 1/√(3k)`.
#[lagrangian(
    group = SO3,
    velocity = xi,
    l = 0.5 * xi.norm_squared() - 0.25 * k * xi.norm_squared().powi(2),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct FoldedBody<T: Real> {
    k: T,
}

/// Beyond the fold, and for a momentum of a velocity in the opposite direction, a start would have another velocity.
#[test]
fn a_velocity_beyond_the_fold_of_its_momentum() {
    let folded = FoldedBody { k: 1.0 };
    let (stepper, fold) = (Stepper::new(folded, 0.01).unwrap(), 1.0 / 3.0_f64.sqrt());
    let gauss = CotangentGauss::<_, 2, 3>::new(folded, 0.01).unwrap();
    let along = |size: f64| Vector3::new(0.6, 0.0, -0.8) * size;
    for size in [0.0, 1e-200, 1e-9, 0.3, fold * 0.99, fold * (1.0 - 1e-4)] {
        let state = stepper.start(SO3::identity(), along(size)).unwrap();
        assert!((stepper.velocity(&state) - along(size)).norm() <= 1e-9 * size, "{size}");
        assert_eq!(gauss.start(SO3::identity(), along(size)).unwrap().momentum(), state.momentum());
    }
    for size in [fold * (1.0 + 1e-4), fold * 1.01, 0.9, 1.1, 30.0] {
        for error in [
            stepper.start(SO3::identity(), along(size)).unwrap_err(),
            gauss.start(SO3::identity(), along(size)).unwrap_err(),
        ] {
            assert!(matches!(error, SetupError::AmbiguousVelocity { .. }), "{size}: {error}");
        }
    }
    let highest = fold * (1.0 - fold * fold);
    assert!(stepper.start_with_momentum(SO3::identity(), along(highest * 0.999)).is_ok());
    let error = stepper.start_with_momentum(SO3::identity(), along(highest * 1.001)).unwrap_err();
    assert_eq!(error, SetupError::NoVelocity);
    let error = gauss.start(SO3::identity(), along(f64::NAN)).unwrap_err();
    assert_eq!(error, SetupError::NonFinite { what: "velocity" });
}

/// For a momentum beyond the fold the scene returns the error that no velocity has it. A control force and an event
/// that depend on the velocity are refused, and the state stays. A step needs no velocity.
#[test]
fn a_momentum_that_no_velocity_has() {
    let (near, beyond) =
        (Stepper::new(FoldedBody { k: 0.01_f64 }, 1.0).unwrap(), Stepper::new(FoldedBody { k: 1.0_f64 }, 1.0).unwrap());
    // The largest momentum of a velocity is 0.3849; the discrete one, `(1 + h²ξ²/4) (1 − ξ²) ξ`, reaches 0.418.
    let momentum = Vector3::new(0.6, 0.0, -0.8) * 0.395;
    let mut state = beyond.adopt(&near.start_with_momentum(SO3::identity(), momentum).unwrap());
    assert!(beyond.velocity(&state).iter().all(|entry| entry.is_nan()) && beyond.energy(&state).is_nan());
    let error = beyond.scene().velocity(&momentum, &()).unwrap_err();
    assert!(matches!(error, StepError::NotConverged { .. } | StepError::Singular), "{error}");
    assert_eq!(beyond.scene().hamiltonian(&momentum, &()).unwrap_err(), error);
    let (before, force) = (state, beyond.velocity(&state) * -2.0);
    let error = beyond.step_forced(&mut state, &force).unwrap_err();
    assert!(matches!(error, StepError::NonFinite { what: "control force" }), "{error}");
    assert_eq!(state, before);
    let event = |now: &Moment<'_, Stepper<FoldedBody<f64>>>| beyond.velocity(now).x;
    let error = beyond.observed(&mut state).event(Event::rising(), event, |_| ()).steps(1).unwrap_err();
    assert!(matches!(error, RunError::NotANumber { event: 0, .. }), "{error}");
    assert_eq!(state, before);
    beyond.step(&mut state).unwrap();
    assert!((state.momentum() - momentum).norm() < 1e-14, "{}", state.momentum());
    let xi = 2.0 * (0.5 * state.attitude().log().norm()).tan();
    assert!((xi * (1.0 - xi * xi) * (1.0 + 0.25 * xi * xi) - 0.395).abs() < 1e-13, "{xi}");
}

/// Each lane has the velocity of a single body, to the bit; a lane whose momentum is that of no velocity is NaN.
#[test]
fn a_lane_without_a_velocity_spoils_no_other() {
    type Four = WideF64x4;
    let momenta: [Vector3<f64>; 4] = [0.0, 0.3, 0.5, 0.38].map(|size| Vector3::new(0.6, 0.0, -0.8) * size);
    let four = |k: f64| Stepper::new(FoldedBody { k: Four::from([k; 4]) }, Four::from([0.01; 4])).unwrap();
    let one = |k: f64| Stepper::new(FoldedBody { k }, 0.01).unwrap();
    // The fold of this Lagrangian is far away, so all lanes may start.
    let (stepper, alone, place) = (four(1.0), one(1.0), SO3::<Four>::identity());
    let gathered = Vector3::gathered(&momenta).unwrap();
    let together = stepper.adopt(&four(0.01).start_with_momentum(place, gathered).unwrap());
    let (velocities, energies) = (stepper.velocity(&together), stepper.energy(&together));
    for (k, momentum) in momenta.into_iter().enumerate() {
        let single = alone.adopt(&one(0.01).start_with_momentum(SO3::identity(), momentum).unwrap());
        let (velocity, energy) = (alone.velocity(&single), alone.energy(&single));
        let found = velocities.map(|entry| entry.extract(k));
        assert_eq!((velocity.norm().is_nan(), energy.is_nan()), (k == 2, k == 2), "lane {k}: {velocity}");
        assert_eq!((found.norm().is_nan(), energies.extract(k).is_nan()), (k == 2, k == 2), "lane {k}: {found}");
        if k != 2 {
            assert_eq!((found, energies.extract(k)), (velocity, energy), "lane {k}");
        }
    }
    assert_eq!(stepper.start_with_momentum(place, gathered).unwrap_err(), SetupError::NoVelocity);
}
