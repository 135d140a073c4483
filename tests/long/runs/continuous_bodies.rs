//! Continuous Lagrangians of several bodies: their equations compared with dual numbers of the declared `l`, with the
//! advection written by hand, and the motion of two links compared with the limit of a declared `l_d`.

use checks::random::Random;
use checks::structure::equations::assert_equations;
use declarations::DoublePendulum;
use declarations::motions::{number, read, vector};
use liestep::groups::{Advected as _, Configuration, LieGroup as _, R1, R3, Relative, SeenFrom};
use liestep::mechanics::{ContinuousLagrangian, Effect, Inertia, Legendre, Term};
use liestep::motion::RightHandSide;
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{Matrix2, Matrix3, Matrix4, RealField, SVector, Vector3, Vector6, convert};
use num_dual::Dual64;
use workbench::runge_kutta;

/// Two rotating bodies, one that is translated in space and one on a line. The kinetic energy depends on all advected
/// parameters, and isn't quadratic.
#[lagrangian(
    group(F_1 = SO3, d = R3, F_2 = SO3, t = R1),
    velocity(Omega_1, v, Omega_2, u),
    advected(
        w = up.seen_from(F_2),
        Q = F_2.seen_from(F_1),
        R = F_1.seen_from(space),
        r = d.seen_from(space),
        x = t.seen_from(space),
    ),
    l = {
        let turning = Omega_1.dot(&(J_1 * Omega_1)) * (1.0 + x.powi(2)) + Omega_2.dot(&(J_2 * Omega_2));
        let moving = v.norm_squared() * (1.0 + w.dot(&s).powi(2)) + (u + s.dot(&Omega_1)).powi(2);
        let coupled = k * Omega_1.cross(&rho).dot(&(Q * Omega_2.cross(&s))) + k * v.dot(&(R * Omega_1.cross(&rho)));
        let bent = (1.0 + v.norm_squared() + u.powi(2) + Omega_2.norm_squared()).sqrt();
        let linear = u * w.dot(&rho) + v.dot(&(R * (A * s))) + (A * Q * hat(Omega_2)).trace();
        let potential = (1.0 + r.norm_squared()).sqrt() + x * r.dot(&(R * rho)) + (Q * A).trace() + k * w.dot(&s).sin();
        0.5 * (turning + moving) + coupled + bent + linear - potential
    },
    discretise = trapezoid(Cayley),
)]
#[derive(Clone)]
struct Bodies<T: RealField + Copy> {
    J_1: Inertia<T>,
    J_2: Inertia<T>,
    A: Matrix3<T>,
    k: T,
    rho: Vector3<T>,
    s: Vector3<T>,
    up: Vector3<T>,
}

/// Components of the velocities of all bodies.
const D: usize = 10;
type Components<T> = SVector<T, D>;
/// The parameters `w`, `Q`, `R`, `r` and `x`.
type Values = (Vector3<f64>, Matrix3<f64>, Matrix3<f64>, Vector3<f64>, f64);

/// The bodies of a seed; the coupling is small, so that the kinetic energy is convex.
fn bodies<T: RealField + Copy + Real>(seed: u64) -> Bodies<T> {
    let mut random = Random::new(seed);
    let mut inertia = || {
        let root = random.matrix();
        Inertia::new((Matrix3::identity() * 3.0 + (root * root.transpose()) * 0.2).map(convert)).unwrap()
    };
    let (J_1, J_2) = (inertia(), inertia());
    let A = random.matrix().map(convert);
    let mut vector = || random.vector().map(convert);
    Bodies { J_1, J_2, A, k: convert(0.1), rho: vector(), s: vector(), up: vector() }
}

/// The parameters advected to first order, `w + η·w`, along any matrices for the rotating bodies and changes of the
/// positions of the translated ones.
fn seen_along<T: RealField + Copy + Real>(
    (w, q, r, place, x): &Values,
    [first, second]: [Matrix3<T>; 2],
    (shift, along): (Vector3<T>, T),
) -> <Bodies<T> as Term>::Advected {
    let (w, q, r) = (w.map(convert::<f64, T>), q.map(convert::<f64, T>), r.map(convert::<f64, T>));
    let mut there = Matrix4::identity();
    there.fixed_view_mut::<3, 1>(0, 3).copy_from(&(place.map(convert::<f64, T>) - shift));
    let on_line = Matrix2::new(T::one(), convert::<f64, T>(*x) - along, T::zero(), T::one());
    (
        SeenFrom(w - second.transpose() * w),
        Relative(q + first * q - q * second),
        Configuration(r - r * first),
        Configuration(there),
        Configuration(on_line),
    )
}

/// Checks momentum, diamond, (1.4) with (2.2), (1.12), the inverse of (1.14), and (1.16).
#[test]
fn bodies_that_feel_each_other() {
    const { assert!(matches!(<Bodies<f64> as ContinuousLagrangian>::LEGENDRE, Legendre::Nonlinear)) };
    for seed in 0..20 {
        assert_equations(&bodies::<f64>(seed), &bodies(seed), &bodies(seed), seed);
    }
}

/// The diamond along all matrices of each body, `−⟨∂l/∂w, e_ij·w⟩`: for rotations all nine entries, for translations
/// the last column.
#[test]
fn the_diamond_along_all_matrices_of_each_body() {
    for seed in 0..5 {
        let (system, dual) = (bodies::<f64>(seed), bodies::<Dual64>(seed));
        let mut random = Random::new(200 + seed);
        let rotation = |random: &mut Random| *random.rotation().as_matrix();
        let values = (random.vector(), rotation(&mut random), rotation(&mut random), random.vector(), random.signed());
        let xi = Components::from_fn(|_, _| random.signed());
        let slope = |turns: [Matrix3<f64>; 2], (shift, along): (Vector3<f64>, f64)| {
            let epsilon = Dual64::new(0.0, 1.0);
            let turns = turns.map(|turn| turn.map(Dual64::from) * epsilon);
            let moved = (shift.map(Dual64::from) * epsilon, epsilon * along);
            -dual.l(&xi.map(Dual64::from), &seen_along(&values, turns, moved)).eps
        };
        let (still, stays) = (Matrix3::zeros(), (Vector3::zeros(), 0.0));
        let (first, moved, second, turned) = system.diamond_matrix(&xi, &seen_along(&values, [still; 2], stays));
        let unit = |i: usize, j: usize| Matrix3::from_fn(|a, b| if (a, b) == (i, j) { 1.0 } else { 0.0 });
        let of_first = Matrix3::from_fn(|i, j| slope([unit(i, j), still], stays));
        let of_second = Matrix3::from_fn(|i, j| slope([still, unit(i, j)], stays));
        let of_place = Vector3::from_fn(|i, _| slope([still; 2], (Vector3::ith(i, 1.0), 0.0)));
        let on_line = slope([still; 2], (Vector3::zeros(), 1.0));
        let tiny = 1e-13 * (1.0 + of_first.norm() + of_second.norm() + of_place.norm());
        assert!((first - of_first).norm() < tiny, "{first} and {of_first}");
        assert!((second - of_second).norm() < tiny, "{second} and {of_second}");
        assert!((moved.fixed_view::<3, 1>(0, 3) - of_place).norm() < tiny, "{moved} and {of_place}");
        assert!((turned[(0, 1)] - on_line).abs() < tiny, "{turned} and {on_line}");
        assert!(of_first.norm() > 0.1 && of_second.norm() > 0.1 && of_place.norm() > 0.1);
        // Parts of the inertia that vanish for rotations alone are tested, too.
        assert!((of_first + of_first.transpose()).norm() > 0.1);
    }
}

/// The discretised `l` of coupled bodies converges, at order two, to a solver's solution of the continuous equations.
#[test]
fn steps_of_bodies_that_feel_each_other() {
    let system = bodies::<f64>(3);
    const { assert!(<Bodies<f64> as Effect>::FACTS.is_self_adjoint) };
    let mut random = Random::new(31);
    let attitude = (random.rotation(), R3::identity(), random.rotation(), R1::identity());
    let velocity = Components::from_fn(|_, _| random.signed());
    let continuous = RightHandSide::new(system.clone()).unwrap();
    let momentum = system.momentum(&velocity, &system.advected().seen_from(&attitude));
    let (time, mut state) = (0.5, continuous.state(&attitude, &momentum));
    runge_kutta::run(|y, rate| continuous.rate(y, rate).unwrap(), &mut state, time, 1000);
    let error = |steps: u32| {
        let stepper = Stepper::new(system.clone(), time / f64::from(steps)).unwrap();
        let mut moved = stepper.start(attitude, velocity).unwrap();
        stepper.run(&mut moved, steps.into()).unwrap();
        let found = continuous.state(&moved.attitude(), &moved.momentum());
        found.iter().zip(&state).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let ratio = error(50) / error(100);
    println!("off by {:e}, and by {ratio} times that at the double step", error(100));
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
}

/// The double pendulum by its velocities.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
    l = 0.5 * (hat(Omega_1) * J_1 * hat(Omega_1).transpose()).trace()
        + 0.5 * (hat(Omega_2) * J_2 * hat(Omega_2).transpose()).trace()
        + Omega_1.cross(&rho).dot(&(Q * Omega_2.cross(&s_2)))
        - g * (w_1.dot(&s_1) + w_2.dot(&s_2)),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone)]
struct Links {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    rho: Vector3<f64>,
    s_1: Vector3<f64>,
    s_2: Vector3<f64>,
    g: f64,
    up: Vector3<f64>,
}

impl Links {
    fn of(pendulum: &DoublePendulum) -> Self {
        let DoublePendulum { J_1, J_2, rho, s_1, s_2, g, up } = pendulum.clone();
        Self { J_1, J_2, rho, s_1, s_2, g, up }
    }
}

/// The terms derived from the declared `l` agree with those of the limit of the declared `l_d`, and with the formula by
/// hand, `μ_1 = J_1 Ω_1 + ρ × Q (Ω_2 × s_2)` and `μ_2 = J_2 Ω_2 + s_2 × Qᵀ(Ω_1 × ρ)`.
#[test]
fn two_links_are_the_limit_of_their_steps() {
    let pendulum = DoublePendulum::asymmetric();
    let links = Links::of(&pendulum);
    const { assert!(<Links as Effect>::FACTS.is_self_adjoint && matches!(Links::LEGENDRE, Legendre::Varying)) };
    let mut random = Random::new(7);
    for _ in 0..20 {
        let attitudes = (random.rotation(), random.rotation());
        let (first, second) = (*attitudes.0.as_matrix(), *attitudes.1.as_matrix());
        let q = first.transpose() * second;
        let [w_1, w_2] = [first, second].map(|r| r.transpose() * Vector3::z());
        let w = (SeenFrom(w_1), SeenFrom(w_2), Relative(q));
        let xi = Vector6::from_fn(|_, _| 3.0 * random.signed());
        let (o_1, o_2) = (xi.fixed_rows::<3>(0).into_owned(), xi.fixed_rows::<3>(3).into_owned());
        let [j_1, j_2] = [&pendulum.J_1, &pendulum.J_2].map(|j| *j.to_inertia().as_matrix());
        let (u_1, u_2) = (o_1.cross(&pendulum.rho), q * o_2.cross(&pendulum.s_2));
        let mu_1 = j_1 * o_1 + pendulum.rho.cross(&u_2);
        let mu_2 = j_2 * o_2 + pendulum.s_2.cross(&(q.transpose() * u_1));
        let momentum = Vector6::from_iterator(mu_1.iter().chain(&mu_2).copied());
        let scale = 1.0 + momentum.norm() * (1.0 + xi.norm());
        let near = |what: &str, found: Vector6<f64>, expected: Vector6<f64>| {
            assert!((found - expected).norm() <= 1e-13 * scale, "{what}: {found} and {expected}");
        };
        near("momentum", links.momentum(&xi, &w), momentum);
        near("momentum of the limit", pendulum.momentum(&xi, &w), momentum);
        near("velocity", links.velocity(&momentum, &w).unwrap(), xi);
        near("diamond", links.diamond_rate(&xi, &w), pendulum.diamond_rate(&xi, &w));
        near("advection", links.momentum_advection(&xi, &w), pendulum.momentum_advection(&xi, &w));
        let [here, there] = [&links.lie_poisson(&momentum, &w), &pendulum.lie_poisson(&momentum, &w)]
            .map(|rates| rates.as_ref().unwrap().0);
        near("Lie–Poisson", here, there);
        let energy = 0.5 * momentum.dot(&xi) + pendulum.g * (w_1.dot(&pendulum.s_1) + w_2.dot(&pendulum.s_2));
        assert!((links.hamiltonian(&momentum, &w).unwrap() - energy).abs() <= 1e-13 * (scale + energy.abs()));
        // The equation by hand, in space: the only torque on both about the pivot is that of the weight.
        let spatial = first * here.fixed_rows::<3>(0) + second * here.fixed_rows::<3>(3);
        let turned = first * o_1.cross(&mu_1) + second * o_2.cross(&mu_2);
        let weight = Vector3::z().cross(&(first * pendulum.s_1 + second * pendulum.s_2)) * pendulum.g;
        assert!((spatial + turned - weight).norm() <= 1e-13 * scale, "the moment of the weight");
    }
}

/// Two point masses on rods, whose reference contains only directions. A solver of the continuous equations ends at
/// these directions, and conserves the energy and the momentum along the vertical. Steps of the discretised `l`
/// converge to them at order two.
#[test]
fn two_links_move_as_a_double_spherical_pendulum() {
    let data = &read("several bodies")["double_spherical_pendulum"];
    let (start, end) = (&data["states"][0], &data["states"][1]);
    let (links, e) = (Links::of(&DoublePendulum::spherical(0.01)), Vector3::z());
    let direction = |value: &serde_json::Value, k: usize| vector(&value["q"][k]);
    let [first, second] = [(0, links.J_1), (1, links.J_2)]
        .map(|(k, inertia)| inertia.pointing(&e, &direction(start, k), &vector(&start["omega"][k])).unwrap());
    let attitude = (first.0, second.0);
    let velocity = Vector6::from_iterator(first.1.iter().chain(&second.1).copied());
    let missed = |end_at: &(SO3, SO3)| {
        let [first, second] = [end_at.0, end_at.1].map(|attitude| attitude.as_matrix() * e);
        (first - direction(end, 0)).amax().max((second - direction(end, 1)).amax())
    };
    let time = 2.0;
    let continuous = RightHandSide::new(links.clone()).unwrap();
    let w = links.advected().seen_from(&attitude);
    let momentum = links.momentum(&velocity, &w);
    let mut state = continuous.state(&attitude, &momentum);
    let energy = continuous.energy(&attitude, &momentum).unwrap();
    assert!((energy - number(&start["energy"])).abs() < 1e-13, "{energy}");
    let kept = continuous.conserved(&attitude, &momentum);
    assert_eq!(continuous.left_symmetries().len(), 1, "the momentum along the vertical");
    runge_kutta::run(|y, rate| continuous.rate(y, rate).unwrap(), &mut state, time, 4000);
    let (there, after) = continuous.parts(&state);
    println!("by a solver off by {:.1e}", missed(&there));
    assert!(missed(&there) < 1e-9, "{:e}", missed(&there));
    assert!((continuous.energy(&there, &after).unwrap() - energy).abs() < 1e-9);
    for (before, after) in kept.iter().zip(continuous.conserved(&there, &after)) {
        assert!((before - after).abs() < 1e-9, "{before} and {after}");
    }
    let errors = [200_u32, 400, 800].map(|steps| {
        let stepper = Stepper::new(links.clone(), time / f64::from(steps)).unwrap();
        let mut state = stepper.start(attitude, velocity).unwrap();
        stepper.run(&mut state, steps.into()).unwrap();
        missed(&state.attitude())
    });
    println!("steps are off by {errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "{errors:?}");
    }
}
