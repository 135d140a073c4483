//! Scenes are sums: a sum is the same integrator as the Lagrangian written in one piece, at the cost of its terms.

use checks::random::Random;
use checks::structure::stages::assert_stages;
use declarations::{FreeBody, FullTop, HeavyTop};
use liestep::effects::{Dipole, Gravity, GravityGradient, PrincipalBody, RigidBody, Rotor, SixthOrderBody, Spring};
use liestep::groups::{Advected as _, LieGroup as _};
use liestep::mechanics::{DiscreteLagrangian, Effect, Inertia, Parts, Term as _, derivation, inertia};
use liestep::{NonstandardInertia, SO3, State, StateOf, lagrangian};
use nalgebra::Vector3;
use workbench::measure::relative;

use super::{apart, moved};

/// A kinetic term with a part of fourth order: its Newton system has the square of the Cayley denominator.
#[lagrangian(
    group = SO3,
    l_d = k * (((F - I) * (F - I).transpose()).trace() + ((F - I) * (F - I).transpose()).trace().powi(2)) / h,
)]
#[derive(Clone, Copy, Debug)]
struct Quartic {
    k: f64,
}

/// The kinetic energy of a ball, in half angles: its Newton system has no cleared denominator.
#[lagrangian(group = SO3, l_d = -(2.0 * k / h) * (0.25 + 0.25 * F.trace()).ln())]
#[derive(Clone, Copy, Debug)]
struct Ball {
    k: f64,
}

/// The sum of all effects used in these tests, in one declaration.
#[lagrangian(
    group = SO3,
    advected(w = up, n = direction, b = field, a = anchor),
    l_d = {
        let after = F.transpose() * n;
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
            + k_4 * (((F - I) * (F - I).transpose()).trace() + ((F - I) * (F - I).transpose()).trace().powi(2)) / h
            - (2.0 * k_b / h) * (0.25 + 0.25 * F.trace()).ln()
            + spin.dot(&vee(F))
            - 0.5 * h * m * g * w.dot(&(rho + F * rho))
            - 0.75 * h * GM / r.powi(3) * (n.dot(&(J * n)) + after.dot(&(J * after)))
            + 0.5 * h * b.dot(&(moment + F * moment))
            - 0.25 * h * k * (((at - a).norm() - length).powi(2) + ((F * at - a).norm() - length).powi(2))
    },
)]
#[derive(Clone, Copy, Debug)]
struct AllTerms {
    J_d: NonstandardInertia,
    k_4: f64,
    k_b: f64,
    spin: Vector3<f64>,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
    GM: f64,
    r: f64,
    J: Inertia,
    direction: Vector3<f64>,
    moment: Vector3<f64>,
    field: Vector3<f64>,
    k: f64,
    length: f64,
    at: Vector3<f64>,
    anchor: Vector3<f64>,
}

impl AllTerms {
    fn random(r: &mut Random) -> Self {
        let axes = *r.rotation().as_matrix();
        let inertia = nalgebra::Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 0.7));
        let J_d = NonstandardInertia::new(axes * inertia * axes.transpose()).unwrap();
        Self {
            J_d,
            k_4: 0.1 * r.signed(),
            k_b: 0.5 + 0.2 * r.signed(),
            spin: r.vector(),
            m: 1.0 + r.signed(),
            g: 9.81,
            rho: r.vector() * 0.3,
            up: r.direction(),
            GM: 3.0 + r.signed(),
            r: 1.2,
            J: J_d.to_inertia(),
            direction: r.direction(),
            moment: r.vector(),
            field: r.vector(),
            k: 2.0 + r.signed(),
            length: 0.4,
            at: r.vector() * 0.3,
            anchor: r.direction() * 2.0,
        }
    }

    #[allow(clippy::type_complexity)] // a list of terms
    fn terms(&self) -> (RigidBody, Quartic, Ball, Rotor, Gravity, GravityGradient, Dipole, Spring) {
        let Self { J_d, k_4, k_b, spin, m, g, rho, up, GM, r, J, direction, moment, field, k, length, at, anchor } =
            *self;
        (
            RigidBody { J_d },
            Quartic { k: k_4 },
            Ball { k: k_b },
            Rotor { spin },
            Gravity { m, g, rho, up },
            GravityGradient { GM, r, J, direction },
            Dipole { moment, field },
            Spring { k, length, at, anchor },
        )
    }
}

fn gravity(top: &HeavyTop) -> Gravity {
    Gravity { m: top.m, g: top.g, rho: top.rho, up: top.up }
}

/// A body plus gravity is the heavy top, asymmetric and with the centre of mass off the axes; the second inertia isn't
/// diagonal.
#[test]
fn body_and_gravity_are_the_heavy_top() {
    let top = HeavyTop::asymmetric();
    let (one, sum) =
        (moved(top.clone(), 0.01, 10_000), moved(PrincipalBody { J_d: top.J_d } + gravity(&top), 0.01, 10_000));
    // The steps agree to the bit, as the operations are the same.
    assert_eq!((one.attitude(), one.momentum()), (sum.attitude(), sum.momentum()));
    let full = FullTop::in_axes(&top, Random::new(4).rotation().as_matrix());
    let weight = Gravity { m: full.m, g: full.g, rho: full.rho, up: full.up };
    let (one, sum) = (moved(full.clone(), 0.01, 10_000), moved(weight + RigidBody { J_d: full.J_d }, 0.01, 10_000));
    assert_eq!((one.attitude(), one.momentum()), (sum.attitude(), sum.momentum()));
}

/// The derivation of a sum is the texts of its terms, in their order.
#[test]
fn derivations_add() {
    let (body, _, _, rotor, gravity, ..) = AllTerms::random(&mut Random::new(2)).terms();
    let alone = [derivation(&body), derivation(&gravity), derivation(&rotor)];
    assert_eq!(alone, [RigidBody::<f64>::DERIVATION, Gravity::<f64>::DERIVATION, Rotor::<f64>::DERIVATION]);
    assert_eq!(derivation(&(body + gravity + rotor)), alone.join("\n"));
}

/// Every momentum map, the Jacobian, the limit and the energy of a sum agree with the declaration in one piece.
#[test]
fn derived_terms_add() {
    let mut r = Random::new(1);
    for _ in 0..20 {
        let one = AllTerms::random(&mut r);
        let (body, quartic, ball, rotor, gravity, gradient, dipole, spring) = one.terms();
        let sum = body + quartic + ball + rotor + gravity + gradient + dipole + spring;
        let (f, h) = (r.rotation_by(0.4).matrix(), 0.1);
        let attitude = r.rotation();
        let w = one.advected().seen_from(&attitude);
        let v = sum.advected().seen_from(&attitude);
        let close =
            |a: Vector3<f64>, b: Vector3<f64>| assert!((a - b).norm() < 1e-13 * (1.0 + b.norm()) / h, "{a} {b}");
        close(sum.right_momentum(&f, &v, h), one.right_momentum(&f, &w, h));
        close(sum.left_momentum(&f, &v, h), one.left_momentum(&f, &w, h));
        close(sum.diamond(&f, &v, h), one.diamond(&f, &w, h));
        close(sum.legendre_minus(&f, &v, h), one.legendre_minus(&f, &w, h));
        close(sum.legendre_plus(&f, &v, h), one.legendre_plus(&f, &w, h));
        close(sum.limit(None, &v).momentum, one.limit(None, &w).momentum);
        assert!(relative(&sum.momentum_jacobian(&f, &v, h), &one.momentum_jacobian(&f, &w, h)) < 1e-13);
        assert!(relative(&inertia(&sum, &sum.advected()), &inertia(&one, &one.advected())) < 1e-14);
        let scalars = [
            (sum.l_d(&f, &v, h), one.l_d(&f, &w, h)),
            (sum.discrete_energy(&f, &v, h), one.discrete_energy(&f, &w, h)),
            (sum.limit(None, &v).l, one.limit(None, &w).l),
        ];
        assert!(scalars.iter().all(|(a, b)| (a - b).abs() < 1e-13 * (1.0 + b.abs()) / h), "{scalars:?}");
    }
}

/// The Newton system of a sum is the declared multiple of its equation, and its Jacobian the derivative.
#[test]
fn newton_systems_of_three_scales_add() {
    assert_eq!(
        [Ball::FACTS.denominators, RigidBody::<f64>::FACTS.denominators, Quartic::FACTS.denominators],
        [0, 1, 2]
    );
    let mut r = Random::new(3);
    for seed in 0..5 {
        let (body, quartic, ball, rotor, gravity, ..) = AllTerms::random(&mut r).terms();
        assert_stages(&(body + rotor), seed);
        assert_stages(&(ball + gravity + body), seed);
        assert_stages(&(ball + quartic), seed);
        assert_stages(&(gravity + (quartic + (body + rotor))), seed);
    }
}

/// Sums of terms whose Newton systems have three scales, in five orders, differ by rounding.
#[test]
fn the_order_of_terms_only_rounds_differently() {
    let mut r = Random::new(2);
    for _ in 0..5 {
        let everything = AllTerms::random(&mut r);
        let (body, quartic, ball, rotor, gravity, gradient, dipole, spring) = everything.terms();
        let one = moved(everything, 0.02, 200);
        let distances = [
            apart(&moved(body + quartic + ball + rotor + gravity + gradient + dipole + spring, 0.02, 200), &one),
            apart(&moved(spring + dipole + gradient + gravity + rotor + ball + quartic + body, 0.02, 200), &one),
            apart(
                &moved((gravity + ball) + (quartic + spring) + (body + (dipole + rotor)) + gradient, 0.02, 200),
                &one,
            ),
            apart(
                &moved(rotor + (gravity + (body + (quartic + (gradient + (ball + (spring + dipole)))))), 0.02, 200),
                &one,
            ),
            apart(&moved(quartic + body + rotor + ball + (spring + (gravity + gradient) + dipole), 0.02, 200), &one),
        ];
        println!("{distances:?}");
        assert!(distances.iter().all(|&distance| distance < 2e-13), "{distances:?}");
    }
}

/// The size of a scene's state is known when the crate is built.
#[test]
fn a_scene_holds_what_its_terms_name() {
    const fn size<E: Effect<Group = SO3>>() -> usize {
        size_of::<State<SO3, E::Advected>>()
    }
    const fn size_of_sum<A: Effect<Group = SO3>, B: Effect<Group = SO3>>() -> usize {
        size_of::<State<SO3, (A::Advected, B::Advected)>>()
    }
    const VECTOR: usize = 3 * size_of::<f64>();
    // The size of the time of steps of other lengths, and of its rounding error.
    const ELAPSED: usize = 2 * size_of::<f64>();
    const {
        assert!(size::<RigidBody>() == size_of::<[f64; 9]>() + 4 * VECTOR + size_of::<u64>() + ELAPSED);
        assert!(size_of::<StateOf<RigidBody>>() == size::<RigidBody>());
        assert!(size_of::<StateOf<SixthOrderBody>>() == size::<RigidBody>());
        assert!(size_of_sum::<RigidBody, Rotor>() == size::<RigidBody>());
        assert!(size_of_sum::<RigidBody, Gravity>() == size::<RigidBody>() + VECTOR);
        assert!(size_of_sum::<RigidBody, Gravity>() == size::<FullTop>());
        assert!(size_of_sum::<Gravity, Dipole>() == size::<RigidBody>() + 2 * VECTOR);
        // Potentials have kicks and no part in the Newton system; a rotor has a part in it and no kick.
        let kicks = [<Gravity>::FACTS, <GravityGradient>::FACTS, <Dipole>::FACTS, <Spring>::FACTS];
        let mut index = 0;
        while index < kicks.len() {
            let Parts { unknown, kick_before, kick_after } = kicks[index].parts;
            assert!(!unknown && kick_before && kick_after);
            index += 1;
        }
        let coupled = [<RigidBody>::FACTS, <PrincipalBody>::FACTS, <Rotor>::FACTS, Quartic::FACTS];
        let mut index = 0;
        while index < coupled.len() {
            let Parts { unknown, kick_before, kick_after } = coupled[index].parts;
            assert!(unknown && !kick_before && !kick_after);
            index += 1;
        }
    }
}

/// Other effects in the same program change no bit of a free body.
#[test]
fn a_free_body_is_alone() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let (own, library) = (moved(FreeBody { J_d }, 0.01, 10_000), moved(RigidBody { J_d }, 0.01, 10_000));
    assert_eq!(own, library);
}
