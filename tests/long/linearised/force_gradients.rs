//! Kicks with force gradients, and processed splittings, which contain them.

use liestep::effects::{Dipole, PrincipalBody, RigidBody};
use liestep::groups::{Advected, LieGroup as _};
use liestep::laws::samples::{Random, along};
use liestep::mechanics::{
    DiagonalNonstandardInertia, DiscreteLagrangian, Inertia, Regular, SecondDerivatives, Sum, Term as _,
};
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme};
use liestep::numbers::Entries as _;
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, RealField, Rotation3, Vector3};
use num_dual::{Dual64, HyperHyperDual64};

use super::dual::{STEP, assert_linearised};
use super::scenes::{MOMENTS, Numbers, SpringTop, exact_flow, gravity, heavy, held, unit};

type SpringAndDipole<T> = Sum<SpringTop<T>, Dipole<T>>;

/// The parameters of the scene below; those of the body are the first nine.
const PARAMETERS: usize = 45;

/// Potentials that are linear in the advected parameters, quadratic, and a root.
fn several<T: RealField + Copy>(varied: Option<(usize, T)>) -> SpringAndDipole<T> {
    let mut n = Numbers::new(varied);
    let held = held(&mut n);
    let dipole = Dipole { moment: n.vector(0.7, -0.4, 0.2), field: n.vector(0.3, 0.9, -0.5) };
    held + dipole
}

fn body<T: RealField + Copy>(scene: SpringAndDipole<T>) -> RigidBody<T> {
    scene.first.first.first.first
}

/// The number `⟨u, D_v τ⟩ + ⟨r, τ − J u⟩` by the declared Lagrangians, because `l_d` without a turn is `−V`, and `J`
/// its second derivative there: along a displacement `ζ`, or with respect to a parameter.
fn by_dual_numbers(
    attitude: &Matrix3<f64>,
    [u, v, r]: [&Vector3<f64>; 3],
    displaced: &Vector3<f64>,
    number: Option<usize>,
) -> f64 {
    let units = [1, 2, 3].map(|k| HyperHyperDual64::new(0.0, ones(k, 1), ones(k, 2), ones(k, 3), 0.0, 0.0, 0.0, 0.0));
    let lift = |matrix: &Matrix3<f64>| matrix.map(HyperHyperDual64::from);
    let turned = |v: &Vector3<f64>, k: usize| Matrix3::identity() + lift(&v.cross_matrix()) * units[k];
    let scene = several(number.map(|number| (number, units[2])));
    let (one, start) = (HyperHyperDual64::from(1.0), lift(attitude) * turned(displaced, 2));
    let seen = |matrix| scene.advected().seen_from(&SO3::from_matrix_unchecked(matrix));
    let still = |matrix| scene.l_d(&Matrix3::identity(), &seen(matrix), one);
    let change = still(start * turned(v, 1) * turned(u, 0)).eps1eps2eps3;
    let torque = still(start * turned(r, 0)).eps1eps3;
    // The increment exp(ε₁ r̂ + ε₂ û).
    let [r, u] = [r, u].map(|v| lift(&v.cross_matrix()));
    let second = (r * u + u * r) * (units[0] * units[1] * HyperHyperDual64::from(0.5));
    let f = Matrix3::identity() + r * units[0] + u * units[1] + second;
    change + torque - body(scene).l_d(&f, &(), one).eps1eps2eps3
}

fn ones(k: usize, place: usize) -> f64 {
    if k == place { 1.0 } else { 0.0 }
}

/// The derivatives along displacements of the body and with respect to each parameter, including advected ones.
#[test]
fn the_gradient_of_a_kick() {
    let scene = several::<f64>(None);
    for seed in 0..5 {
        let mut random = Random::new(seed);
        let attitude: SO3 = along::<SO3, 3, 3>(&random.sample(), 1.0);
        let [u, v, r]: [Vector3<f64>; 3] = [random.sample(), random.sample(), random.sample()];
        let mut by_parameters = vec![0.0; PARAMETERS];
        let seen = scene.advected().seen_from(&attitude);
        let found = scene.kick_gradient(&seen, &v, [&u, &r], &mut |number, share| by_parameters[number] += share);
        let (by_place, by_seen) = found.expect("it is derived");
        let mut by_carried = Vec::new();
        Advected::<SO3>::pulled_back(&by_seen, &attitude).each(&mut |entry| by_carried.push(entry));
        SpringAndDipole::<f64>::carried_parameters(&mut |place, number| by_parameters[number] += by_carried[place]);
        let at = attitude.matrix();
        let place = |k: usize| by_dual_numbers(&at, [&u, &v, &r], &Matrix3::identity().column(k).into(), None);
        let parameter = |number| by_dual_numbers(&at, [&u, &v, &r], &Vector3::zeros(), Some(number));
        let expected: Vec<f64> = (0..3).map(place).chain((0..PARAMETERS).map(parameter)).collect();
        let size = expected.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
        assert!(expected.iter().filter(|entry| entry.abs() > 1e-3 * size).count() > 30, "{expected:?}");
        for (k, (found, expected)) in by_place.iter().chain(&by_parameters).zip(&expected).enumerate() {
            assert!((found - expected).abs() < 1e-14 * size, "{seed}, {k}: {found}, not {expected}");
        }
    }
}

/// Splittings with a declared flow, whose kicks contain all of these potentials.
#[test]
fn a_splitting_with_force_gradients() {
    for scheme in [SplittingScheme::FORCE_GRADIENT_2, SplittingScheme::FORCE_GRADIENT_5] {
        let split = |number: Option<usize>| {
            let of_flow = number.filter(|&number| number >= PARAMETERS).map(|number| number - PARAMETERS);
            let scene = several(unit(number.filter(|&number| number < PARAMETERS)));
            Stepper::split(scene, (5.0 * STEP).into(), body(several(unit(of_flow))), scheme).expect("a stepper")
        };
        let scene = several::<f64>(None);
        let stepper = Stepper::split(scene, 5.0 * STEP, body(scene), scheme).expect("a stepper");
        assert_linearised(&stepper, split);
    }
}

/// Schemes that begin with a kick or a drift; forwards and back in time.
#[test]
fn a_processed_splitting() {
    let axes = Rotation3::new(Vector3::new(0.4, -0.3, 0.7)).into_inner();
    let schemes = [
        ProcessedScheme::SIX_A,
        ProcessedScheme::SIX_B,
        ProcessedScheme::SIX_C,
        ProcessedScheme::FOUR_A,
        ProcessedScheme::FOUR_C,
    ];
    for (scheme, h) in schemes.into_iter().zip([0.1, -0.2, 0.1, 0.05, 0.1]) {
        let processed = |number: Option<usize>| {
            let of_flow = number.filter(|&number| number >= 17).map(|number| number - 17);
            let scene = heavy(MOMENTS, &axes, 9.81, unit(number.filter(|&number| number < 17)));
            let flow = exact_flow::<Dual64>(MOMENTS, &axes, unit(of_flow));
            Stepper::processed(scene, h.into(), flow, scheme).expect("a stepper")
        };
        let scene = heavy(MOMENTS, &axes, 9.81, None);
        let stepper = Stepper::processed(scene, h, exact_flow(MOMENTS, &axes, None), scheme).expect("a stepper");
        assert_linearised(&stepper, processed);
    }
}

/// A kinetic term of fourth order, after `let`s that stay closed.
#[lagrangian(
    group = SO3,
    gradients,
    l_d = {
        let xi = log(F);
        let a = inverse(J) * (J * xi).cross(&xi);
        (xi.dot(&(J * xi)) / 2.0 - a.dot(&(J * a)) / 24.0) / h
    },
)]
#[derive(Clone)]
struct FourthOrderTerm {
    J: Inertia,
}

const MOMENTS_OF_TERM: Vector3<f64> = Vector3::new(2.5, 3.0, 3.5);

/// The term contributes only its inertia to a kick: `−⟨r, J u⟩`.
#[test]
fn the_kick_of_a_closed_kinetic_term() {
    let J = Inertia::from_principal_moments(MOMENTS_OF_TERM).expect("a body");
    let (body, mut random) = (FourthOrderTerm { J }, Random::new(1));
    let [u, v, r]: [Vector3<f64>; 3] = [random.sample(), random.sample(), random.sample()];
    let mut by_inertia = [0.0; 9];
    let (by_place, ()) =
        body.kick_gradient(&(), &v, [&u, &r], &mut |number, share| by_inertia[number] += share).expect("it is zero");
    assert_eq!(by_place, Vector3::zeros());
    // For a symmetric change, an off-diagonal derivative may be in one entry, or half in each of the two.
    for row in 0..3 {
        for column in 0..3 {
            let found = by_inertia[3 * row + column] + by_inertia[3 * column + row];
            let expected = -(r[row] * u[column] + r[column] * u[row]);
            assert!((found - expected).abs() < 1e-15, "{row}, {column}: {found}, not {expected}");
        }
    }
}

/// A splitting takes only the potential and the inertia from the scene, so the form of the kinetic term doesn't matter.
#[test]
fn a_splitting_of_a_closed_kinetic_term() {
    let J = Inertia::from_principal_moments(MOMENTS_OF_TERM).expect("a body");
    let J_d = DiagonalNonstandardInertia::from_principal_moments(MOMENTS_OF_TERM).expect("a body");
    let gravity = gravity(&mut Numbers::<f64>::new(None));
    let found = transition(FourthOrderTerm { J } + gravity);
    let expected = transition(PrincipalBody { J_d } + gravity);
    for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
        assert!((found - expected).amax() < 1e-13 * expected.amax(), "{found} is not {expected}");
    }
}

fn transition<S>(scene: S) -> [[Matrix3<f64>; 2]; 2]
where
    S: DiscreteLagrangian<Scalar = f64, Group = SO3> + SecondDerivatives + Regular,
{
    let flow = ExactBody::new(&Inertia::from_principal_moments(MOMENTS_OF_TERM).expect("a body"));
    let stepper = Stepper::split(scene, 0.1, flow, SplittingScheme::FORCE_GRADIENT_4).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    let mut state = stepper.start_with_momentum(SO3::identity(), Vector3::new(0.5, 2.0, 3.0)).expect("a start");
    let mut tangent = linear.tangent(&[]);
    for _ in 0..10 {
        linear.step(&mut state, &mut tangent).expect("a step");
    }
    tangent.transition()
}
