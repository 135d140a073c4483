//! Sums of effects in all orders and bracketings, with random parameters: of the library's effects and of terms
//! declared here, whose fields and vectors have the same names.
//!
//! A term that a value switches off is there all the same: what is solved for, and where, is known by types.

use checks::in_all_orders;
use checks::random::Random;
use declarations::Alike;
use liestep::effects::{Dipole, FourthOrderBody, GeodesicBody, Gravity, RigidBody, Thrust, Torque};
use liestep::groups::LieGroup;
use liestep::mechanics::{Between, Each, Inertia, On, Regular};
use liestep::numbers::{Bodies, Coordinates as _, Entries as _};
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::{DVector, Vector3, Vector6};

/// A potential `½ m (w·ρ)²` at both ends of a step: kicks alone.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = -0.25 * h * m * (w.dot(&rho).powi(2) + w.dot(&(F * rho)).powi(2)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct EndPotential {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// A potential `½ m (w·ρ)²` of the middle of a step: an unknown part without a kinetic one.
#[lagrangian(group = SO3, advected(w = up), l_d = -0.125 * h * m * w.dot(&(rho + F * rho)).powi(2))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct MidpointPotential {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// A kinetic term with a part of fourth order, whose Newton system has the square of the Cayley denominator.
#[lagrangian(
    group = SO3,
    l_d = m * (((F - I) * (F - I).transpose()).trace() + ((F - I) * (F - I).transpose()).trace().powi(2)) / h,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quartic {
    m: f64,
}

/// A torque `m w × ρ` and one against the velocity.
#[force(
    group = SO3,
    advected(w = up),
    work = 0.5 * h * m * (w.cross(&rho).dot(&eta) + (F.transpose() * w).cross(&rho).dot(&eta_next))
        - 0.5 * m * vee(F).dot(&(eta + eta_next)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Push {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// All terms of two bodies but forces, in one declaration.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(
        u_1 = up_1.seen_from(F_1),
        v_1 = leaning_up.seen_from(F_1),
        u_2 = up_2.seen_from(F_2),
        v_2 = middle_up.seen_from(F_2),
        Q = F_2.seen_from(F_1),
    ),
    l_d = {
        let xi = log(F_2);
        ((F_1 - I) * J_d * (F_1 - I).transpose()).trace() / (2.0 * h)
            + xi.dot(&(J * xi)) / (2.0 * h)
            + k_1 * (((F_1 - I) * (F_1 - I).transpose()).trace() + ((F_1 - I) * (F_1 - I).transpose()).trace().powi(2)) / h
            + k_2 * (((F_2 - I) * (F_2 - I).transpose()).trace() + ((F_2 - I) * (F_2 - I).transpose()).trace().powi(2)) / h
            - 0.5 * h * m_1 * g * u_1.dot(&(rho_1 + F_1 * rho_1))
            - 0.5 * h * m_2 * g * u_2.dot(&(rho_2 + F_2 * rho_2))
            - 0.25 * h * leaning * (v_1.dot(&leaning_rho).powi(2) + v_1.dot(&(F_1 * leaning_rho)).powi(2))
            - 0.125 * h * middle * v_2.dot(&(middle_rho + F_2 * middle_rho)).powi(2)
            + 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace())
    },
)]
#[derive(Clone, Copy, Debug)]
struct TwoBodies {
    J_d: NonstandardInertia,
    J: Inertia,
    k_1: f64,
    k_2: f64,
    m_1: f64,
    m_2: f64,
    g: f64,
    rho_1: Vector3<f64>,
    rho_2: Vector3<f64>,
    up_1: Vector3<f64>,
    up_2: Vector3<f64>,
    leaning: f64,
    leaning_rho: Vector3<f64>,
    leaning_up: Vector3<f64>,
    middle: f64,
    middle_rho: Vector3<f64>,
    middle_up: Vector3<f64>,
    kappa: f64,
}

/// A [`Push`] on each of two bodies.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    displacement(eta_1, eta_2),
    advected(w_1 = up_1.seen_from(F_1), w_2 = up_2.seen_from(F_2)),
    work = 0.5 * h * m_1 * (w_1.cross(&rho_1).dot(&eta_1) + (F_1.transpose() * w_1).cross(&rho_1).dot(&eta_1_next))
        - 0.5 * m_1 * vee(F_1).dot(&(eta_1 + eta_1_next))
        + 0.5 * h * m_2 * (w_2.cross(&rho_2).dot(&eta_2) + (F_2.transpose() * w_2).cross(&rho_2).dot(&eta_2_next))
        - 0.5 * m_2 * vee(F_2).dot(&(eta_2 + eta_2_next)),
)]
#[derive(Clone, Copy, Debug)]
struct Pushes {
    m_1: f64,
    m_2: f64,
    rho_1: Vector3<f64>,
    rho_2: Vector3<f64>,
    up_1: Vector3<f64>,
    up_2: Vector3<f64>,
}

/// A size between zero and one, or zero for a term without effect.
fn switched(r: &mut Random) -> f64 {
    let size = r.signed();
    if size < -0.3 { 0.0 } else { size.abs() }
}

fn inertia(r: &mut Random) -> Inertia {
    let axes = *r.rotation().as_matrix();
    let extent = Vector3::repeat(1.0) + r.vector() * 0.8;
    NonstandardInertia::new(axes * nalgebra::Matrix3::from_diagonal(&extent) * axes.transpose()).unwrap().to_inertia()
}

fn leaning(r: &mut Random) -> EndPotential {
    EndPotential { m: switched(r), rho: r.vector(), up: r.direction() }
}

fn middle(r: &mut Random) -> MidpointPotential {
    MidpointPotential { m: switched(r), rho: r.vector(), up: r.direction() }
}

fn push(r: &mut Random) -> Push {
    Push { m: switched(r), rho: r.vector(), up: r.direction() }
}

fn weight(r: &mut Random) -> Gravity {
    Gravity { m: switched(r), g: 9.81, rho: r.vector() * 0.3, up: r.direction() }
}

/// Attitude, momentum, velocity and energy after a few steps.
fn after<L: Regular<Scalar = f64>>(scene: L, attitude: L::Group, momentum: <L::Group as LieGroup>::Vector) -> Vec<f64> {
    let stepper = Stepper::new(scene, 0.05).unwrap();
    let mut state = stepper.start_with_momentum(attitude, momentum).unwrap();
    stepper.run(&mut state, 4).unwrap();
    let mut numbers = vec![stepper.energy(&state)];
    for part in [state.momentum(), stepper.velocity(&state)] {
        (0..L::Group::DIMENSION).for_each(|k| numbers.push(part.dot(&<L::Group as LieGroup>::Vector::axis(k))));
    }
    state.attitude().matrix().each(&mut |entry| numbers.push(entry));
    numbers
}

/// The largest difference of two lists of numbers, relative to the longer.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let [a, b] = [a, b].map(DVector::from_row_slice);
    (&a - &b).amax() / (1.0 + a.amax().max(b.amax()))
}

/// Asserts that all lists are equal to rounding.
fn assert_alike(seed: u64, all: &[Vec<f64>]) {
    for (place, other) in all.iter().enumerate() {
        let distance = apart(&all[0], other);
        assert!(distance < 1e-12, "values {seed}: the sum {place} differs from the first by {distance:e}");
    }
}

/// Terms on bodies have the same steps placed one by one and together, as a system of many in all orders, and as one
/// product.
#[test]
fn terms_at_bodies_add_in_all_orders() {
    for seed in 0..500 {
        let mut r = Random::new(seed);
        let (J_1, J_2) = (inertia(&mut r).to_nonstandard(), inertia(&mut r));
        let (lean, midway, alike) = (leaning(&mut r), middle(&mut r), Alike { kappa: switched(&mut r) });
        let [(k_1, weight_1, push_1), (k_2, weight_2, push_2)] =
            [(); 2].map(|()| (switched(&mut r), weight(&mut r), push(&mut r)));
        let attitude = [r.rotation(), r.rotation()];
        let (first, second) = (r.vector() * 2.0, r.vector() * 2.0);
        let of_each = [Quartic { m: k_1 } + weight_1 + push_1, Quartic { m: k_2 } + weight_2 + push_2];
        let mut all = in_all_orders!(after(
            On::<0, 2>::of([RigidBody { J_d: J_1 } + lean]),
            Each::<2>::of(of_each) + Between::<0, 1, 2>::of([alike]),
            On::<1, 2>::of([midway + GeodesicBody { J: J_2 }]);
            attitude; Bodies([first, second])
        ))
        .to_vec();
        let whole = TwoBodies {
            J_d: J_1,
            J: J_2,
            k_1,
            k_2,
            m_1: weight_1.m,
            m_2: weight_2.m,
            g: weight_1.g,
            rho_1: weight_1.rho,
            rho_2: weight_2.rho,
            up_1: weight_1.up,
            up_2: weight_2.up,
            leaning: lean.m,
            leaning_rho: lean.rho,
            leaning_up: lean.up,
            middle: midway.m,
            middle_rho: midway.rho,
            middle_up: midway.up,
            kappa: alike.kappa,
        };
        let pushes = Pushes {
            m_1: push_1.m,
            m_2: push_2.m,
            rho_1: push_1.rho,
            rho_2: push_2.rho,
            up_1: push_1.up,
            up_2: push_2.up,
        };
        let both = Vector6::from_fn(|k, _| if k < 3 { first[k] } else { second[k - 3] });
        all.push(after(whole + pushes, (attitude[0], attitude[1]), both));
        assert_alike(seed, &all);
    }
}

#[test]
fn terms_of_a_body_of_fourth_order_add() {
    for seed in 0..500 {
        let mut r = Random::new(seed);
        let (J, attitude, momentum) = (inertia(&mut r), r.rotation(), r.vector() * 2.0);
        let body = FourthOrderBody { J } + Dipole { moment: r.vector() * switched(&mut r), field: r.vector() };
        let potentials = weight(&mut r) + leaning(&mut r);
        let forces = Torque { torque: r.vector() * switched(&mut r) }
            + Thrust { at: r.vector() * switched(&mut r), thrust: r.vector() };
        // The body is the first term, the last and in the middle, in brackets of either kind.
        let all = [
            after((body + potentials) + forces, attitude, momentum),
            after(body + (forces + potentials), attitude, momentum),
            after((potentials + body) + forces, attitude, momentum),
            after(forces + (potentials + body), attitude, momentum),
        ];
        assert_alike(seed, &all);
    }
}
