//! Continuous Lagrangians: the discretisations by `discretise`, and their equations compared with those by hand.

use checks::random::Random;
use checks::structure::System;
use declarations::{ContinuousTop, HeavyTop, RelativisticParticle, SlidingTop};
use liestep::effects::{Gravity, RigidBody, Rotor};
use liestep::groups::R3;
use liestep::mechanics::{
    ContinuousLagrangian, DiagonalNonstandardInertia, DiscreteLagrangian, Effect, Inertia, Legendre,
};
use liestep::methods::CotangentGauss;
use liestep::motion::RightHandSide;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, UnitQuaternion, Vector3, Vector4};
use num_dual::HyperDual64;
use workbench::runge_kutta;

use crate::dual_numbers::{assert_terms, by_hand};

fn moments() -> DiagonalNonstandardInertia {
    DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, 1.7, 1.0)).unwrap()
}

/// A thousand steps of the discretised `l` and of (3.13) have the same bits.
#[test]
fn the_trapezoidal_rule_makes_the_steps_of_the_heavy_top() {
    let (J_d, m, g, rho, up) = (moments(), 1.1, 9.81, Vector3::new(0.1, -0.2, 1.0), Vector3::z());
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, 0.0));
    let velocity = Vector3::new(0.5, 2.0, 12.0);
    let made = Stepper::new(ContinuousTop { J_d, m, g, rho, up }, 0.01).unwrap();
    let declared = Stepper::new(HeavyTop { J_d, m, g, rho, up }, 0.01).unwrap();
    let mut made_state = made.start(attitude, velocity).unwrap();
    let mut declared_state = declared.start(attitude, velocity).unwrap();
    for _ in 0..1000 {
        made.step(&mut made_state).unwrap();
        declared.step(&mut declared_state).unwrap();
        assert_eq!(made_state, declared_state);
    }
    assert_eq!(ContinuousTop::FACTS.operations, HeavyTop::FACTS.operations);
    const { assert!(ContinuousTop::FACTS.is_self_adjoint) };
}

macro_rules! discretised {
    ($($name:ident: $rule:ident$(($retraction:ident))?),+) => {$(
        #[lagrangian(
            group = SO3,
            velocity = Omega,
            advected(w = up),
            l = 0.5 * Omega.dot(&(J * Omega)) + s.dot(&Omega) - k * w.dot(&rho) - k * w.dot(&rho).powi(2),
            discretise = $rule$(($retraction))?,
        )]
        struct $name {
            J: Inertia,
            s: Vector3<f64>,
            k: f64,
            rho: Vector3<f64>,
            up: Vector3<f64>,
        }

        impl $name {
            fn new() -> Self {
                let J = Matrix3::new(3.0, 0.2, -0.1, 0.2, 2.5, 0.3, -0.1, 0.3, 4.0);
                let (s, rho) = (Vector3::new(0.3, -0.2, 0.5), Vector3::new(0.1, -0.2, 1.0));
                Self { J: Inertia::new(J).unwrap(), s, k: 1.7, rho, up: Vector3::z() }
            }
        }
    )+};
}

discretised! {
    Trapezoid: trapezoid, TrapezoidCayley: trapezoid(Cayley), TrapezoidExp: trapezoid(exp),
    MidpointExp: midpoint(exp), Chord: chord, ChordCayley: chord(Cayley), ChordExp: chord(exp)
}

/// The discrete `l_d` and its derived terms agree with those by hand, and a step back undoes a step.
fn assert_discretised<L: System<Group = SO3, Advected = Vector3<f64>>>(rule: &str, system: &L) {
    let Trapezoid { J, s, k, rho, .. } = Trapezoid::new();
    let [s, rho] = [s, rho].map(|vector| vector.map(HyperDual64::from));
    let l = |q: HyperDual64, xi: &Vector3<_>, w: &Vector3<_>| {
        let height = w.dot(&rho);
        q * 0.5 + s.dot(xi) - (height + height * height) * k
    };
    let h = 0.05;
    // In terms of the matrix (F − I)/h, `ξ·Jξ` is a difference of traces.
    let cancelling = if rule.contains('(') { 0.0 } else { J.to_nonstandard().as_matrix().trace() / h };
    assert_terms::<_, SO3<HyperDual64>, _>(
        rule,
        (system, h, cancelling),
        |f, w, h| by_hand(rule, J.as_matrix(), l, (f, w, h)),
        (17, 0.5),
    );
    const { assert!(L::FACTS.is_self_adjoint) };
}

#[test]
fn every_discretisation_is_what_it_says() {
    assert_discretised("trapezoid", &Trapezoid::new());
    assert_discretised("trapezoid(Cayley)", &TrapezoidCayley::new());
    assert_discretised("trapezoid(exp)", &TrapezoidExp::new());
    assert_discretised("midpoint(exp)", &MidpointExp::new());
    assert_discretised("chord", &Chord::new());
    assert_discretised("chord(Cayley)", &ChordCayley::new());
    assert_discretised("chord(exp)", &ChordExp::new());
}

/// Steps of each discretisation converge, at order two, to a solver's solution of the continuous equations.
#[test]
fn discretisations_converge_to_the_continuous_motion() {
    fn check<L>(make: impl Fn() -> L, name: &str)
    where
        L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>>
            + ContinuousLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>>
            + liestep::mechanics::Regular,
        L::Retraction: liestep::groups::Retraction<SO3>,
    {
        let continuous = RightHandSide::new(make()).unwrap();
        let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, 0.0));
        let momentum = Vector3::new(1.5, 4.0, 7.0);
        let mut state = continuous.state(&SO3::from(attitude), &momentum);
        runge_kutta::run(|y, rate| continuous.rate(y, rate).unwrap(), &mut state, 0.5, 400);
        let error = |steps: u32| {
            let stepper = Stepper::new(make(), 0.5 / f64::from(steps)).unwrap();
            let mut body = stepper.start_with_momentum(attitude, momentum).unwrap();
            stepper.run(&mut body, steps.into()).unwrap();
            let (attitude, momentum) = continuous.parts(&state);
            (body.attitude().as_matrix() - attitude.as_matrix()).norm() + (body.momentum() - momentum).norm()
        };
        let ratio = error(50) / error(100);
        println!("{name}: {ratio}");
        assert!((3.7..4.3).contains(&ratio), "{name}: {ratio}");
    }
    check(Trapezoid::new, "trapezoid");
    check(TrapezoidCayley::new, "trapezoid(Cayley)");
    check(TrapezoidExp::new, "trapezoid(exp)");
    check(MidpointExp::new, "midpoint(exp)");
    check(Chord::new, "chord");
    check(ChordCayley::new, "chord(Cayley)");
    check(ChordExp::new, "chord(exp)");
}

/// The equations of a sum are the sums of the terms' equations, and a rotor adds its bias: by hand,
/// `μ̇ = μ × Ω + m g w × ρ` with `μ = JΩ + s`.
#[test]
fn sums_have_continuous_equations() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.7, 1.0)).unwrap();
    let (m, g, rho, up) = (1.1_f64, 9.81, Vector3::new(0.1, -0.2, 1.0), Vector3::z());
    let spin = Vector3::new(0.0, 0.3, 2.0);
    let scene = RigidBody { J_d } + Gravity { m, g, rho, up } + Rotor { spin };
    let (velocity, w) = (Vector3::new(0.5, 2.0, 12.0), Vector3::new(0.1, 0.6, 0.7));
    let parameters = (((), w), ());
    let J = Matrix3::identity() * J_d.as_matrix().trace() - J_d.as_matrix();
    let momentum = J * velocity + spin;
    assert!((scene.momentum(&velocity, &parameters) - momentum).norm() < 1e-13);
    assert!((scene.velocity(&momentum, &parameters).unwrap() - velocity).norm() < 1e-13);
    let (torque, turn) = scene.lie_poisson(&momentum, &parameters).unwrap();
    assert!((torque - (momentum.cross(&velocity) + w.cross(&rho) * (m * g))).norm() < 1e-12);
    assert!((turn.0.1 - w.cross(&velocity)).norm() < 1e-14);
    let energy: f64 = 0.5 * velocity.dot(&(J * velocity)) + m * g * w.dot(&rho);
    assert!((scene.hamiltonian(&momentum, &parameters).unwrap() - energy).abs() < 1e-12);
}

/// A body without steps, and a pull on it.
#[lagrangian(group = SO3, velocity = Omega, l = 0.5 * Omega.dot(&(J * Omega)))]
#[derive(Clone, Copy)]
struct BodyWithoutSteps {
    J: Inertia,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l = -k * w.dot(&rho).powi(2) + Omega.dot(&w))]
#[derive(Clone, Copy)]
struct Pull {
    k: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// The torque of a scene, from the rate of the momentum.
fn torque<L>(scene: &L, velocity: &Vector3<f64>, w: &L::Advected) -> Vector3<f64>
where
    L: ContinuousLagrangian<Scalar = f64, Group = SO3>,
{
    scene.validate().unwrap();
    scene.lie_poisson(&scene.momentum(velocity, w), w).unwrap().0
}

/// Terms with and without steps add in any order; the sum has the common properties of both.
#[test]
fn terms_with_steps_and_without_add() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.7, 1.0)).unwrap();
    let turning = BodyWithoutSteps { J: J_d.to_inertia() };
    let pull = Pull { k: 0.7, rho: Vector3::new(0.1, -0.2, 1.0), up: Vector3::z() };
    let gravity = Gravity { m: 1.1, g: 9.81, rho: Vector3::new(0.3, 0.1, 0.5), up: Vector3::z() };
    let (velocity, w) = (Vector3::new(0.5, 2.0, -1.0), Vector3::new(0.1, 0.6, 0.7));
    let momentum = turning.J.as_matrix() * velocity + w;
    // The equations by hand: μ × Ω and w × (−∂l/∂w).
    let slope = pull.rho * (-2.0 * pull.k * w.dot(&pull.rho)) + velocity - gravity.rho * (gravity.m * gravity.g);
    let expected = momentum.cross(&velocity) - w.cross(&slope);
    let all = [
        torque(&(turning + pull + gravity), &velocity, &(((), w), w)),
        torque(&(turning + gravity + pull), &velocity, &(((), w), w)),
        torque(&(gravity + turning + pull), &velocity, &((w, ()), w)),
        torque(&(pull + (RigidBody { J_d } + gravity)), &velocity, &(w, ((), w))),
        torque(&(RigidBody { J_d } + pull + gravity), &velocity, &(((), w), w)),
    ];
    for found in all {
        assert!((found - expected).norm() < 1e-12, "{found} and {expected}");
    }
    let gauss = CotangentGauss::<_, 3, 3>::new(turning + pull + gravity, 0.05).unwrap();
    let (mut attitude, mut momentum) = (SO3::from(UnitQuaternion::identity()), Vector3::new(1.0, 4.0, 7.0));
    let energy = gauss.energy(&attitude, &momentum).unwrap();
    for _ in 0..20 {
        (attitude, momentum) = gauss.step(&attitude, &momentum).unwrap();
    }
    assert!((gauss.energy(&attitude, &momentum).unwrap() - energy).abs() < 1e-9 * energy.abs());
}

/// A particle in a uniform field: the momentum grows linearly, and the velocity stays below that of light.
#[test]
fn a_fast_particle() {
    let (m, c, q) = (2.0, 3.0, 0.5);
    let particle = RelativisticParticle { m, c, q, field: Vector4::new(0.4, -1.0, 0.2, 0.0) };
    let system = RightHandSide::new(particle.clone()).unwrap();
    let mut state = system.state(&R3::default_place(), &Vector3::zeros());
    runge_kutta::run(|y, rate| system.rate(y, rate).unwrap(), &mut state, 40.0, 2000);
    let (place, momentum) = system.parts(&state);
    let pull = Vector3::new(0.4, -1.0, 0.2) * q;
    assert!((momentum - pull * 40.0).norm() < 1e-11);
    // The energy is h = √(m²c⁴ + p²c²), and the position the integral of v = p c²/h.
    let energy = |p: f64| (m * m * c.powi(4) + p * p * c * c).sqrt();
    let distance = (energy(momentum.norm()) - m * c * c) / pull.norm();
    let place = place.as_matrix().fixed_view::<3, 1>(0, 3).into_owned();
    assert!((place - pull.normalize() * distance).norm() < 1e-8, "{place} and {distance}");
    let velocity = particle.velocity(&momentum, &Vector4::zeros()).unwrap();
    assert!((velocity - momentum * (c * c / energy(momentum.norm()))).norm() < 1e-13);
}

/// The identity of translations.
trait Place {
    fn default_place() -> Self;
}

impl Place for R3 {
    fn default_place() -> Self {
        liestep::groups::LieGroup::identity()
    }
}

/// The kinetic energy `c² (√(1 + ξ²/c²) − 1)` has momenta below `c` alone: larger ones are an error.
#[lagrangian(group = R3, velocity = v, l = (c * c) * (1.0 + v.norm_squared() / (c * c)).sqrt())]
struct BoundedParticle {
    c: f64,
}

#[test]
fn a_momentum_without_a_velocity_is_an_error() {
    let bounded = BoundedParticle { c: 2.0 };
    let velocity = bounded.velocity(&Vector3::new(1.9, 0.0, 0.0), &()).unwrap();
    assert!((velocity.x - 1.9 / (1.0_f64 - 1.9 * 1.9 / 4.0).sqrt()).abs() < 1e-9);
    let error = bounded.velocity(&Vector3::new(2.1, 0.0, 0.0), &()).unwrap_err();
    assert!(matches!(error, StepError::NotConverged { .. } | StepError::Singular), "{error}");
}

/// The momentum `v (1 + 10 v² − 20 v⁴)` decreases beyond `v = 0.575`.
#[lagrangian(
    group = R3,
    velocity = v,
    l = m * (0.5 * v.norm_squared() + 2.5 * v.norm_squared().powi(2) - (10.0 / 3.0) * v.norm_squared().powi(3)),
)]
struct FoldedParticle {
    m: f64,
}

/// Newton's iteration converges to `v = 0.7056` for this momentum, which isn't on the branch of rest.
#[test]
fn a_velocity_beyond_a_singularity_is_an_error() {
    let falling = FoldedParticle { m: 1.0 };
    let beyond = Vector3::new(0.705_6, 0.0, 0.0);
    assert!((falling.momentum(&beyond, &()).x - 0.72).abs() < 1e-3);
    let error = falling.velocity(&Vector3::new(0.72, 0.0, 0.0), &()).unwrap_err();
    assert!(matches!(error, StepError::Singular), "{error}");
}

/// The Lagrangian `BoundedParticle` with a momentum at rest, as of a charge in a vector potential.
#[lagrangian(group = R3, velocity = v, l = (c * c) * (1.0 + v.norm_squared() / (c * c)).sqrt() + s.dot(&v))]
#[derive(Clone)]
struct ChargedParticle {
    c: f64,
    s: Vector3<f64>,
}

/// The cancelling terms are as large as the momentum at rest, however small the momentum itself.
#[test]
fn a_momentum_that_is_small_beside_that_at_rest() {
    let charged = ChargedParticle { c: 2.0, s: Vector3::new(0.7, -30.0, 1.3) };
    for size in [0.0, 1e-300, 1e-9, 1e-4, 1.0] {
        let momentum = charged.s + Vector3::new(0.6, 0.0, -0.8) * size;
        let expected = (momentum - charged.s) / (1.0 - size * size / 4.0_f64).sqrt();
        let velocity = charged.velocity(&momentum, &()).unwrap();
        assert!((velocity - expected).norm() < 1e-14 * charged.s.norm(), "{size}: {velocity}");
        // The momentum is as far below c as the momentum at rest allows.
        let standing = ChargedParticle { c: 40.0, ..charged.clone() };
        let velocity = standing.velocity(&(momentum - charged.s), &()).unwrap();
        let kinetic = momentum - charged.s * 2.0;
        let expected = kinetic / (1.0 - kinetic.norm_squared() / 1600.0).sqrt();
        assert!((velocity - expected).norm() < 1e-13 * charged.s.norm(), "{size}: {velocity}");
    }
}

/// The kinetic part of a top whose tip slides, and a momentum at rest that depends on the attitude.
#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * m * w.dot(&Omega.cross(&rho)).powi(2)
        + Omega.dot(&(A * w)) - m * g * w.dot(&rho),
)]
#[derive(Clone)]
struct ContinuousSlidingTop {
    J: Inertia,
    A: Matrix3<f64>,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// Checks `μ = M(w) ξ + A w` and its consequences.
fn assert_sliding<L>(
    name: &str,
    system: &L,
    (J, A): (Matrix3<f64>, Matrix3<f64>),
    (m, g, rho): (f64, f64, Vector3<f64>),
) where
    L: ContinuousLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Clone,
{
    let mut random = Random::new(9);
    for _ in 0..20 {
        let (xi, w) = (random.vector() * 3.0, random.vector());
        let lever = rho.cross(&w);
        let inertia = J + lever * lever.transpose() * m;
        let momentum = inertia * xi + A * w;
        let slope = xi.cross(&rho) * (m * xi.dot(&lever)) + A.transpose() * xi - rho * (m * g);
        let torque = momentum.cross(&xi) + slope.cross(&w);
        let near = |what: &str, found: Vector3<f64>, expected: Vector3<f64>| {
            let error = (found - expected).norm();
            assert!(error <= 1e-13 * (1.0 + momentum.norm() + torque.norm()), "{name}, {what}: {found} {expected}");
        };
        near("momentum", system.momentum(&xi, &w), momentum);
        near("velocity", system.velocity(&momentum, &w).unwrap(), xi);
        let (rate, turn) = system.lie_poisson(&momentum, &w).unwrap();
        near("Lie–Poisson", rate, torque);
        near("ẇ", turn, w.cross(&xi));
        // The time derivative of M(w) ξ + A w.
        let (acceleration, turn) = system.euler_poincare(&xi, &w).unwrap();
        let carried = rho.cross(&turn);
        let change = (carried * lever.dot(&xi) + lever * carried.dot(&xi)) * m + A * turn;
        near("Euler–Poincaré", inertia * acceleration + change, torque);
        let energy = 0.5 * xi.dot(&(inertia * xi)) + m * g * w.dot(&rho);
        assert!((system.hamiltonian(&momentum, &w).unwrap() - energy).abs() <= 1e-13 * (1.0 + energy.abs()));
        // The right-hand side computes `w` from the attitude, here for a vector fixed in space.
        let numbers = RightHandSide::new(system.clone()).unwrap();
        let (_, rate) = numbers.rates(&SO3::identity(), &momentum).unwrap();
        near("for a solver", rate, system.lie_poisson(&momentum, &Vector3::z()).unwrap().0);
    }
}

/// The equations by hand with `M(w) = J + m (ρ × w)(ρ × w)ᵀ` and `s(w) = A w`: momentum, its closed inverse, the rates
/// of velocity and momentum, the energy; for a declared `l`, for the limit of a declared `l_d`, and for a solver.
#[test]
fn an_inertia_that_depends_on_what_is_advected() {
    let J = Matrix3::new(3.0, 0.2, -0.1, 0.2, 2.5, 0.3, -0.1, 0.3, 4.0);
    let A = Matrix3::new(0.4, -0.7, 0.1, 0.3, 0.2, -0.5, 0.6, 0.1, -0.3);
    let (m, g, rho) = (1.1, 9.81, Vector3::new(0.5, -0.2, 1.0));
    let sliding =
        |A: Matrix3<f64>, m: f64| ContinuousSlidingTop { J: Inertia::new(J).unwrap(), A, m, g, rho, up: Vector3::z() };
    let limit = SlidingTop { J_d: Inertia::new(J).unwrap().to_nonstandard(), m, g, rho, up: Vector3::z() };
    const { assert!(matches!(ContinuousSlidingTop::LEGENDRE, Legendre::Varying)) };
    const { assert!(matches!(SlidingTop::LEGENDRE, Legendre::Varying)) };

    assert_sliding("declared", &sliding(A, m), (J, A), (m, g, rho));
    assert_sliding("limit", &limit, (J, Matrix3::zeros()), (m, g, rho));

    // For a singular inertia no momentum has a unique velocity.
    let unit =
        ContinuousSlidingTop { J: Inertia::new(Matrix3::identity()).unwrap(), rho: Vector3::x(), ..sliding(A, -1.0) };
    let error = unit.velocity(&Vector3::new(1.0, 2.0, 3.0), &Vector3::z()).unwrap_err();
    assert!(matches!(error, StepError::Singular), "{error}");
    assert!(matches!(RightHandSide::new(unit), Err(SetupError::SingularKinetic { .. })));
}

/// The sum of a body and a sliding top is a sliding top with the inertias of both, in either order.
#[test]
fn a_sum_carries_the_momenta_of_both_terms() {
    let (m, g, rho, up, A) = (1.1, 9.81, Vector3::new(0.5, -0.2, 1.0), Vector3::z(), Matrix3::identity() * 0.4);
    let inertia = |moments: [f64; 3]| Inertia::from_principal_moments(moments.into()).unwrap();
    let sliding = |moments| ContinuousSlidingTop { J: inertia(moments), A, m, g, rho, up };
    let turning = BodyWithoutSteps { J: inertia([1.0, 1.5, 2.0]) };
    let (velocity, w) = (Vector3::new(0.5, 2.0, 1.2), Vector3::new(0.1, 0.6, 0.7));
    let (expected, _) = sliding([3.0, 4.0, 4.5]).euler_poincare(&velocity, &w).unwrap();
    let (second, _) = (turning + sliding([2.0, 2.5, 2.5])).euler_poincare(&velocity, &((), w)).unwrap();
    let (first, _) = (sliding([2.0, 2.5, 2.5]) + turning).euler_poincare(&velocity, &(w, ())).unwrap();
    assert!((first - expected).norm() < 1e-13 && (second - expected).norm() < 1e-13, "{first} {second} {expected}");
}

/// The conserved momenta: for a symmetric top those about the vertical and about its axis, for an asymmetric one the
/// first, for a free body all in space, for a free sphere all in the body too; a solver conserves them to its error.
#[test]
fn conserved_momenta() {
    let top = |J_d: Vector3<f64>, rho: Vector3<f64>| {
        let J_d = DiagonalNonstandardInertia::from_diagonal(J_d).unwrap();
        RightHandSide::new(HeavyTop { J_d, m: 1.0, g: 9.81, rho, up: Vector3::new(0.0, 0.6, 0.8) }).unwrap()
    };
    let symmetric = top(Vector3::new(2.0, 2.0, 1.0), Vector3::z());
    let axes = symmetric.right_symmetries();
    assert_eq!(axes.len(), 1);
    assert!((axes[0] - Vector3::z()).norm() < 1e-15);
    assert!((symmetric.left_symmetries()[0].cross(&Vector3::new(0.0, 0.6, 0.8))).norm() < 1e-15);
    assert_eq!(top(Vector3::new(2.0, 1.9, 1.0), Vector3::z()).right_symmetries().len(), 0);
    assert_eq!(top(Vector3::new(2.0, 2.0, 1.0), Vector3::x()).right_symmetries().len(), 0);
    let free = |moments: Vector3<f64>| {
        RightHandSide::new(RigidBody { J_d: NonstandardInertia::from_diagonal(moments).unwrap() }).unwrap()
    };
    assert_eq!(free(Vector3::new(2.0, 1.7, 1.0)).left_symmetries().len(), 3);
    assert_eq!(free(Vector3::new(2.0, 1.7, 1.0)).right_symmetries().len(), 0);
    assert_eq!(free(Vector3::new(1.0, 1.0, 1.0)).right_symmetries().len(), 3);

    let attitude = SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, 0.0)));
    let mut state = symmetric.state(&attitude, &Vector3::new(1.5, 6.0, 20.0));
    let kept = |state: &[f64]| {
        let (attitude, momentum) = symmetric.parts(state);
        let mut kept = symmetric.conserved(&attitude, &momentum);
        kept.push(symmetric.energy(&attitude, &momentum).unwrap());
        kept
    };
    let before = kept(&state);
    assert_eq!(before.len(), 3);
    runge_kutta::run(|y, rate| symmetric.rate(y, rate).unwrap(), &mut state, 1.0, 1000);
    for (before, after) in before.iter().zip(kept(&state)) {
        assert!((before - after).abs() < 1e-8 * (1.0 + before.abs()), "{before} and {after}");
    }
}

/// On SO(3) collocation on all matrices gives the same motion as collocation on quaternions.
#[test]
fn two_collocations_agree() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.7, 1.0)).unwrap();
    let gravity = Gravity { m: 1.1, g: 9.81, rho: Vector3::new(0.1, -0.2, 1.0), up: Vector3::z() };
    let scene = RigidBody { J_d } + gravity + Rotor { spin: Vector3::new(0.0, 0.3, 1.0) };
    let quaternions = Stepper::collocated::<4>(scene, 0.1).unwrap();
    let matrices = CotangentGauss::<_, 4, 3>::new(scene, 0.1).unwrap();
    let (attitude, momentum) =
        (UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, 0.0)), Vector3::new(1.0, 4.0, 7.0));
    let mut state = quaternions.start_with_momentum(attitude, momentum).unwrap();
    let (mut attitude, mut momentum) = (SO3::from(attitude), momentum);
    for _ in 0..20 {
        quaternions.step(&mut state).unwrap();
        (attitude, momentum) = matrices.step(&attitude, &momentum).unwrap();
    }
    assert!((state.momentum() - momentum).norm() < 1e-11);
    assert!((state.attitude().as_matrix() - attitude.as_matrix()).norm() < 1e-11);
    // Beyond the solvable range an iterate isn't finite, and the error isn't one of slow convergence.
    for h in [2.0, 50.0, 1e160] {
        let error = CotangentGauss::<_, 2, 3>::new(scene, h).unwrap().step(&attitude, &momentum).unwrap_err();
        assert!(matches!(error, StepError::NotConverged { .. } | StepError::Singular), "{error}");
        assert!(!error.to_string().contains("did not settle"), "{error}");
    }
}
