//! Bodies with translations: a top on a cart, two bodies that attract each other, a spacecraft with wheels.

use checks::drift::tenths;
use checks::solvers::InaccurateSolver;
use declarations::motions::{number, read, vector};
use declarations::{FloatingBody, Gyrostat, PointSpring, TopOnCart, TwoBodies};
use liestep::groups::{LieGroup, R1, R2, R3};
use liestep::mechanics::{DiscreteLagrangian, Each, Effect, Inertia, Pairs, Regular};
use liestep::methods::CompositionScheme;
use liestep::numbers::{Bodies, Entries};
use liestep::recording::RunError;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper};
use nalgebra::{Matrix3, Matrix3x4, SVector, Vector1, Vector2, Vector3};
use serde_json::Value;
use workbench::runge_kutta;

use super::{apart, attitudes_of, check_derived, check_symplectic, order, part, solved, started};

fn moments(values: &Value) -> Vector3<f64> {
    Vector3::from_fn(|k, _| values[k].as_f64().unwrap())
}

fn attitude(body: &Value) -> SO3 {
    attitudes_of(&Value::Array(vec![body["R"].clone()]))[0]
}

/// The top on a cart of the reference: the nonstandard inertia about the pivot is that about the centre of mass plus
/// `m c cᵀ`.
fn top_on_cart(parameters: &Value) -> TopOnCart {
    let (top, c) = (&parameters["top"], moments(&parameters["top"]["c"]));
    let m = top["m"].as_f64().unwrap();
    let about_centre = NonstandardInertia::from_principal_moments(moments(&top["J_cm"])).unwrap();
    TopOnCart {
        J_d: NonstandardInertia::new(about_centre.as_matrix() + c * c.transpose() * m).unwrap(),
        s: c * m,
        M: m + parameters["M"].as_f64().unwrap(),
        g: parameters["g"].as_f64().unwrap(),
    }
}

type OnCart = (SO3, R2);

fn on_cart(state: &Value) -> (OnCart, SVector<f64, 5>) {
    let (cart, top) = (&state["bodies"][0], &state["bodies"][1]);
    let (place, velocity, turning) = (vector(&cart["x_cm"]), vector(&cart["velocity_cm"]), vector(&top["Omega_body"]));
    let velocity = SVector::from_iterator(turning.iter().copied().chain([velocity.x, velocity.y]));
    ((attitude(top), R2::from(Vector2::new(place.x, place.y))), velocity)
}

#[test]
fn a_top_on_a_cart() {
    let data = &read("several bodies")["top_on_cart"];
    let system = top_on_cart(&data["parameters"]);
    let (start, velocity) = on_cart(&data["states"][0]);
    let (end, end_velocity) = on_cart(&data["states"][1]);
    let error = |g: &OnCart| apart(&[g.0], &[end.0]).max((g.1.translation() - end.1.translation()).amax());
    let errors = [(0.005, 400_u64), (0.0025, 800), (0.00125, 1600)].map(|(h, steps)| {
        let (stepper, mut state) = started(system.clone(), h, (start, velocity));
        // Heights in the reference are relative to the plane of the pivot.
        assert!((stepper.energy(&state) - number(&data["states"][0]["energy"])).abs() < 1e-13 * 20.0);
        stepper.run(&mut state, steps).unwrap();
        error(&state.attitude())
    });
    order(&errors);
    let (there, after) = solved(&system, (start, velocity), (2.0, 4000));
    assert!(error(&there) < 1e-9 && (after - end_velocity).amax() < 1e-8, "by a solver: {:.1e}", error(&there));
    let composed = Stepper::composed(system, 0.01, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut state = composed.start(start, velocity).unwrap();
    composed.run(&mut state, 200).unwrap();
    assert!(error(&state.attitude()) < 1e-8 && (composed.velocity(&state) - end_velocity).amax() < 1e-6);
}

/// A cart so light that no body could be that top: along a horizontal axis across the top the kinetic energy is
/// negative, and that axis depends on the attitude.
#[test]
fn a_coupling_that_is_too_strong_names_the_factor() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 1.0, 0.5)).unwrap();
    let stepper = |M: f64| Stepper::new(TopOnCart { J_d, s: Vector3::z(), M, g: 9.81 }, 0.01).unwrap();
    let started = |M: f64, attitude: SO3| {
        let place = (attitude, R2::from(Vector2::zeros()));
        stepper(M).start(place, SVector::<f64, 5>::zeros()).map(|_| ())
    };
    let (upright, lying) = (SO3::identity(), SO3::exp(Vector3::y() * core::f64::consts::FRAC_PI_2));
    for attitude in [upright, lying] {
        let error = started(0.5, attitude).unwrap_err();
        let SetupError::NegativeKinetic { body: Some(1), pivot } = error else { panic!("{error}") };
        assert!((pivot + 1.0).abs() < 1e-12, "{error}");
        assert!(started(1.5, attitude).is_ok());
    }
}

/// The horizontal momentum is conserved by wrongly solved steps; that about the vertical by solved ones.
#[test]
fn momenta_of_a_top_on_a_cart() {
    let data = &read("several bodies")["top_on_cart"];
    let system = top_on_cart(&data["parameters"]);
    let (start, velocity) = on_cart(&data["states"][0]);
    let sideways = |momentum: &SVector<f64, 5>| momentum.fixed_rows::<2>(3).into_owned();
    let [before, after] = solved_badly(&system, start, &velocity);
    assert_eq!(sideways(&after.momentum()), sideways(&before.momentum()));

    let (stepper, mut state) = started(system, 0.005, (start, velocity));
    let turning = |state: &liestep::motion::Motion<OnCart, _>| {
        let (g, momentum) = (state.attitude(), state.momentum());
        let (place, p) = (g.1.translation(), sideways(&momentum));
        (g.0.as_matrix() * part(&momentum, 0)).z + place.perp(&p)
    };
    let (before, energy) = (turning(&state), stepper.energy(&state));
    let (means, most) = tenths(|| {
        stepper.step(&mut state).unwrap();
        stepper.energy(&state) - energy
    });
    println!("about the vertical {:.1e}, energy {most:.3e}, means {means:?}", turning(&state) - before);
    assert!((turning(&state) - before).abs() < 1e-10 && most < 0.1 && (means[9] - means[0]).abs() < 0.1);
}

/// The error of a step in (2.7), relative to the momentum.
pub(super) fn missed<L: DiscreteLagrangian<Scalar = f64>>(
    system: &L,
    before: &liestep::motion::Motion<L::Group, L::Advected>,
    after: &liestep::motion::Motion<L::Group, L::Advected>,
    h: f64,
) -> f64 {
    let f = before.attitude().inverse().compose(&after.attitude()).matrix();
    let size = |momentum: liestep::mechanics::Vector<L>| {
        let mut sum = 0.0_f64;
        momentum.each(&mut |component| sum += component * component);
        sum.sqrt()
    };
    size(system.legendre_minus(&f, &before.advected(), h) - before.momentum()) / size(before.momentum())
}

/// The states before and after a thousand wrongly solved steps, each with an error in (2.7).
fn solved_badly<L, const D: usize>(
    system: &L,
    start: L::Group,
    velocity: &SVector<f64, D>,
) -> [liestep::motion::Motion<L::Group, L::Advected>; 2]
where
    L: DiscreteLagrangian<Scalar = f64, Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>> + Clone,
    InaccurateSolver<L>: DiscreteLagrangian<Scalar = f64, Group = L::Group, Advected = L::Advected> + Regular,
{
    let (badly, mut state) = started(InaccurateSolver(system.clone()), 0.01, (start, *velocity));
    let (before, mut least) = (*state, f64::INFINITY);
    for _ in 0..1000 {
        let last = state;
        badly.step(&mut state).unwrap();
        least = least.min(missed(system, &last, &state, 0.01));
    }
    assert!(least > 1e-6, "{least:e}");
    [before, *state]
}

type Pair = (SO3, R3, SO3, R3);

fn two_bodies(parameters: &Value) -> TwoBodies {
    let [first, second] = [0, 1].map(|k| moments(&parameters["J"][k]));
    let [m_1, m_2] = [0, 1].map(|k| parameters["m"][k].as_f64().unwrap());
    TwoBodies {
        m_1,
        m_2,
        K_1: NonstandardInertia::from_principal_moments(first).unwrap(),
        K_2: NonstandardInertia::from_principal_moments(second).unwrap(),
        J_1: Inertia::from_principal_moments(first).unwrap(),
        J_2: Inertia::from_principal_moments(second).unwrap(),
        G: parameters["G"].as_f64().unwrap(),
    }
}

fn pair(state: &Value) -> (Pair, SVector<f64, 12>) {
    let [(a, x, first), (b, y, second)] = [0, 1].map(|k| {
        let body = &state["bodies"][k];
        let velocity = [vector(&body["Omega_body"]), vector(&body["v"])];
        (attitude(body), R3::from(vector(&body["x"])), velocity)
    });
    let all = [first, second].concat();
    ((a, x, b, y), SVector::from_fn(|k, _| all[k / 3][k % 3]))
}

/// The momentum of both bodies, and their total angular momentum about the origin.
pub(super) fn whole<W>(state: &liestep::motion::Motion<Pair, W>) -> (Vector3<f64>, Vector3<f64>)
where
    W: liestep::groups::Advected<Pair> + Copy,
{
    let (g, momentum) = (state.attitude(), state.momentum());
    let momenta = [0, 6].map(|first| momentum.fixed_rows::<6>(first).into_owned());
    super::whole(&[(g.0, g.1), (g.2, g.3)], &Bodies(momenta)).into()
}

/// The reference is in inertial coordinates with quaternions, independent of reduced equations.
#[test]
fn two_bodies_that_attract_each_other() {
    let data = &read("several bodies")["two_bodies"];
    let system = two_bodies(&data["parameters"]);
    let (start, velocity) = pair(&data["states"][0]);
    let (end, end_velocity) = pair(&data["states"][1]);
    let error = |g: &Pair| {
        let places =
            (g.1.translation() - end.1.translation()).amax().max((g.3.translation() - end.3.translation()).amax());
        apart(&[g.0, g.2], &[end.0, end.2]).max(places)
    };
    let errors = [(0.01, 200_u64), (0.005, 400), (0.0025, 800)].map(|(h, steps)| {
        let (stepper, mut state) = started(system.clone(), h, (start, velocity));
        assert!((stepper.energy(&state) - number(&data["states"][0]["energy"])).abs() < 1e-14);
        stepper.run(&mut state, steps).unwrap();
        error(&state.attitude())
    });
    order(&errors);
    let (there, after) = solved(&system, (start, velocity), (2.0, 4000));
    assert!(error(&there) < 1e-9 && (after - end_velocity).amax() < 1e-8, "by a solver: {:.1e}", error(&there));
    let composed = Stepper::composed(system, 0.02, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut state = composed.start(start, velocity).unwrap();
    composed.run(&mut state, 100).unwrap();
    assert!(error(&state.attitude()) < 1e-9 && (composed.velocity(&state) - end_velocity).amax() < 1e-8);
    // Potentials are at the ends of steps, so each body, and each translation, is solved separately.
    assert_eq!(TwoBodies::<f64>::FACTS.apart, <Pair as liestep::groups::LieGroup>::FACTORS);
}

/// The relative changes of both bodies' momentum and angular momentum on an orbit without a close approach, with the
/// centre of mass at rest or moving.
fn drift(steps: u64, rests: bool) -> [f64; 2] {
    let data = &read("several bodies")["two_bodies"];
    let system = two_bodies(&data["parameters"]);
    let ((a, x, b, y), velocity) = pair(&data["states"][0]);
    let [x, y] = [x, y].map(|place| R3::from(place.translation() * 2.0));
    let [u, v] = [3, 9].map(|first| velocity.fixed_rows::<3>(first) * 0.7);
    let centre = if rests { (u * system.m_1 + v * system.m_2) / (system.m_1 + system.m_2) } else { Vector3::zeros() };
    let parts = [part(&velocity, 0), u - centre, part(&velocity, 2), v - centre];
    let (stepper, mut state) = started(system, 0.01, ((a, x, b, y), super::stacked(&parts)));
    let ((p, l), energy, mut most) = (whole(&state), stepper.energy(&state), [0.0_f64; 2]);
    for _ in 0..100 {
        stepper.run(&mut state, steps / 100).unwrap();
        assert!((stepper.energy(&state) / energy - 1.0).abs() < 1e-5, "they have come close");
        let (now_p, now_l) = whole(&state);
        most = [most[0].max((now_p - p).norm() / l.norm()), most[1].max((now_l - l).norm() / l.norm())];
    }
    println!("{steps} steps: momentum {:.1e}, angular momentum {:.1e}", most[0], most[1]);
    most
}

/// The change is a random walk: 2.9e-15, 1.4e-14 and 8.5e-14 of the angular momentum after 1e4, 1e5 and 1e6 steps.
#[test]
fn momenta_of_two_bodies() {
    let [p, l] = drift(100_000, true);
    assert!(p < 1e-15 && l < 5e-14, "{p:e} {l:e}");
}

/// If the centre of mass moves 280 m, a position is rounded to 6e-14 m, which is 1.8e-12 of the angular momentum.
#[test]
#[ignore = "twenty seconds: `cargo test -p liestep-long-tests --test systems momenta_of_two_bodies -- --ignored`"]
fn momenta_of_two_bodies_after_a_million_steps() {
    for (rests, most) in [(true, 2e-13), (false, 5e-12)] {
        let [p, l] = drift(1_000_000, rests);
        assert!(p < 5e-14 && l < most, "{p:e} {l:e}");
    }
}

/// The system of two bodies and a coupling moves as the harmonic oscillator, and its bodies rotate freely.
#[test]
fn a_system_of_bodies_that_are_translated() {
    let ([m_1, m_2], k, h) = ([1.5, 0.6], 2.0, 0.01);
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.5, 0.4, 1.0 / 3.0)).unwrap();
    let bodies = Each::<2>::of([m_1, m_2].map(|m| FloatingBody { m, J_d }));
    let tied = |a, b| Stepper::new(bodies + Pairs::<2>::of([PointSpring { k, a, b }]), h).unwrap();
    let system = tied(Vector3::zeros(), Vector3::zeros());
    let alone = Stepper::new(FloatingBody { m: m_1, J_d }, h).unwrap();

    let place = |x: f64| R3::from(Vector3::new(x, 0.2 * x, -0.1 * x));
    let velocity = SVector::<f64, 6>::from([0.3, -0.5, 0.8, 0.0, 0.0, 0.0]);
    let start = [(SO3::identity(), place(-0.4)), (SO3::identity(), place(1.0))];
    let mut state = system.start(start, Bodies([velocity, velocity])).unwrap();
    let mut turning = alone.start(start[0], velocity).unwrap();
    let apart = |state: &[(SO3, R3); 2]| state[1].1.translation() - state[0].1.translation();
    let first = apart(&start);
    system.run(&mut state, 200).unwrap();
    alone.run(&mut turning, 200).unwrap();
    // Half a kick, a drift, half a kick: `sin(θ/2) = ω h/2` of each step's phase `θ`.
    let omega = (k * (1.0 / m_1 + 1.0 / m_2)).sqrt();
    let phase = 2.0 * (0.5 * omega * h).asin();
    let expected = first * (200.0 * phase).cos();
    let found = apart(&state.attitude());
    assert!((found - expected).amax() < 1e-13, "{found} and {expected}");
    assert!((state.attitude()[0].0.matrix() - turning.attitude().0.matrix()).amax() < 1e-13);

    // Tied away from their centres they rotate each other, and conserve all of their momentum.
    let system = tied(Vector3::new(0.3, 0.0, 0.1), Vector3::new(0.0, -0.2, 0.1));
    let mut state = system.start(start, Bodies([velocity, velocity * 0.5])).unwrap();
    let (energy, [p, l]) = (system.energy(&state), super::whole(&state.attitude(), &state.momentum()));
    system.run(&mut state, 2000).unwrap();
    let [now_p, now_l] = super::whole(&state.attitude(), &state.momentum());
    let (p, l) = ((now_p - p).amax(), (now_l - l).amax());
    assert!(p < 1e-13 && l < 1e-12 && (system.energy(&state) / energy - 1.0).abs() < 1e-3, "{p:e} {l:e}");
    assert!((state.attitude()[0].0.matrix() - turning.attitude().0.matrix()).amax() > 0.1);
}

/// A singular or negative kinetic part belongs to a body, or to a factor of its group.
#[test]
fn a_body_without_inertia_is_named() {
    fn whose<S: liestep::mechanics::Regular<Scalar = f64>>(scene: S) -> Option<usize> {
        match Stepper::new(scene, 0.01).map(|_| ()) {
            Err(SetupError::SingularKinetic { determinant, body }) => {
                // The elimination divides by zero.
                assert!(determinant == 0.0 || determinant.is_nan());
                body
            }
            other => panic!("{other:?}"),
        }
    }
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.5, 0.4, 1.0 / 3.0)).unwrap();
    let free = |m: f64| FloatingBody { m, J_d };
    assert_eq!(whose(free(0.0)), Some(1));
    let negative = |body| Err(SetupError::NegativeKinetic { pivot: -1.0, body });
    assert_eq!(Stepper::new(free(-2.0), 0.01).map(|_| ()), negative(Some(1)));
    for light in 0..3 {
        let masses = |m: f64| [0, 1, 2].map(|body| free(if body == light { m } else { 1.0 }));
        assert_eq!(whose(Each::<3>::of(masses(0.0))), Some(light));
        assert_eq!(Stepper::new(Each::<3>::of(masses(-2.0)), 0.01).map(|_| ()), negative(Some(light)));
    }
    // The first body is named if there are several.
    assert_eq!(whose(Each::<3>::of([free(1.0), free(0.0), free(0.0)])), Some(1));
    assert_eq!(whose(Gyrostat { J_w: 0.0, ..gyrostat() }), Some(1));
    let data = read("several bodies");
    assert_eq!(whose(TwoBodies { m_2: 0.0, ..two_bodies(&data["two_bodies"]["parameters"]) }), Some(3));
    // Each pivot is positive, and their product is out of range.
    assert_eq!(whose(TwoBodies { m_1: 1e-120, m_2: 1e-120, ..two_bodies(&data["two_bodies"]["parameters"]) }), None);
}

/// A step across a close approach has a solution, and the energy reveals the error.
#[test]
fn a_close_pass_that_is_stepped_over_is_an_error() {
    let [J, K] = [Vector3::new(0.01, 0.012, 0.015); 2];
    let system = TwoBodies {
        m_1: 1.0,
        m_2: 1.0,
        K_1: NonstandardInertia::from_principal_moments(J).unwrap(),
        K_2: NonstandardInertia::from_principal_moments(K).unwrap(),
        J_1: Inertia::from_principal_moments(J).unwrap(),
        J_2: Inertia::from_principal_moments(K).unwrap(),
        G: 1.0,
    };
    let stepper = Stepper::new(system, 1e-3).unwrap();
    // The bodies approach each other from afar, with an energy near −¼; `aside` is the distance by which they would
    // miss.
    let passed = |aside: f64| {
        let place = |x: f64, y: f64| R3::from(Vector3::new(x, y, 0.0));
        let start = (SO3::identity(), place(-1.0, 0.0), SO3::identity(), place(1.0, aside));
        let mut velocity = SVector::<f64, 12>::zeros();
        (velocity[3], velocity[9]) = (0.5, -0.5);
        let mut state = stepper.start(start, velocity).unwrap();
        let energy = stepper.energy(&state);
        assert!((energy + 0.25).abs() < 0.06, "{energy}");
        let ended = stepper.observed(&mut state).energy_within(0.01).steps(2_500);
        (ended, energy, stepper.energy(&state), stepper.time(&state))
    };
    for aside in [0.1, 1e-3, 1e-8] {
        match passed(aside) {
            (Err(RunError::Energy { time, before, after }), start, now, at) => {
                println!("{aside:e}: t = {time}, from {before} to {after}");
                assert!((before - start).abs() < 0.1 && (after - before).abs() > 0.01, "{start} {before} {after}");
                assert_eq!((time, after), (at, now));
            }
            (other, ..) => panic!("{aside:e}: {other:?}"),
        }
    }
    let (ended, energy, now, _) = passed(1.0);
    assert!(ended.is_ok_and(|ended| ended.steps == 2_500) && (now - energy).abs() < 1e-4, "{energy} {now}");
}

type WithWheels = (SO3, R1, R1, R1);

fn at_rest() -> WithWheels {
    let wheel = R1::from(Vector1::new(0.0));
    (SO3::identity(), wheel, wheel, wheel)
}

pub(super) fn gyrostat() -> Gyrostat {
    Gyrostat {
        J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0)).unwrap(),
        J_w: 0.2,
        a_1: Vector3::x(),
        a_2: Vector3::y(),
        a_3: Vector3::new(0.0, 0.6, 0.8),
    }
}

/// The reference is Euler's equations with constant momenta of the wheels, by Runge and Kutta's steps.
#[test]
fn a_spacecraft_with_wheels() {
    let system = gyrostat();
    let velocity = SVector::<f64, 6>::from([0.3, -0.5, 0.8, 2.0, -3.0, 5.0]);
    let stepper = Stepper::new(system.clone(), 0.01).unwrap();
    let momentum = stepper.start(at_rest(), velocity).unwrap().momentum();
    let axes = Matrix3::from_columns(&[system.a_1, system.a_2, system.a_3]);
    // The momenta J_w(θ̇ + a·Ω) of the wheels, and JΩ + Σ a J_w(θ̇ + a·Ω) of the whole.
    let (omega, turning): (Vector3<f64>, Vector3<f64>) = (part(&velocity, 0), part(&velocity, 1));
    let of_wheels = (turning + axes.transpose() * omega) * 0.2;
    let whole = Vector3::new(2.0, 2.5, 3.0).component_mul(&omega) + axes * of_wheels;
    assert!((part::<6>(&momentum, 0) - whole).amax().max((part::<6>(&momentum, 1) - of_wheels).amax()) < 1e-14);
    let body = Matrix3::from_diagonal(&Vector3::new(0.5, 0.4, 1.0 / 3.0));
    // The attitude's columns, and the momentum beside them.
    let joined = |attitude: Matrix3<f64>, p: Vector3<f64>| {
        Matrix3x4::from_fn(|i, j| if j < 3 { attitude[(i, j)] } else { p[i] })
    };
    let apart = |z: &Matrix3x4<f64>| (z.fixed_columns::<3>(0).into_owned(), z.column(3).into_owned());
    let rates = |z: Matrix3x4<f64>| {
        let (attitude, p) = apart(&z);
        let omega = body * (p - axes * of_wheels);
        joined(attitude * omega.cross_matrix(), p.cross(&omega))
    };
    let start = joined(Matrix3::identity(), whole);
    let exact = apart(&(0..4000).fold(start, |z, _| z + runge_kutta::change(z, 5e-4, rates)));
    let errors = [(0.02, 100_u64), (0.01, 200), (0.005, 400)].map(|(h, steps)| {
        let (stepper, mut state) = started(system.clone(), h, (at_rest(), velocity));
        stepper.run(&mut state, steps).unwrap();
        (state.attitude().0.as_matrix() - exact.0).amax().max((part::<6>(&state.momentum(), 0) - exact.1).amax())
    });
    order(&errors);
    let (there, _) = solved(&system, (at_rest(), velocity), (2.0, 4000));
    assert!((there.0.as_matrix() - exact.0).amax() < 1e-9, "by a solver: {:e}", (there.0.as_matrix() - exact.0).amax());
    // Wrongly solved steps conserve all momenta, as there are no advected parameters.
    let [before, after] = solved_badly(&system, at_rest(), &velocity);
    assert!((after.spatial_momentum() - before.spatial_momentum()).amax() < 1e-13);
    assert_eq!(part::<6>(&after.momentum(), 1), part::<6>(&momentum, 1));
}

/// The derived terms of each agree with the declared ones, in random configurations.
#[test]
fn what_is_derived_of_translated_bodies() {
    let data = read("several bodies");
    check_derived(&top_on_cart(&data["top_on_cart"]["parameters"]), 21);
    check_derived(&two_bodies(&data["two_bodies"]["parameters"]), 22);
    check_derived(&gyrostat(), 23);
}

#[test]
fn steps_of_translated_bodies_are_symplectic() {
    let data = read("several bodies");
    let (cart, bodies) = (&data["top_on_cart"], &data["two_bodies"]);
    let (attitude, velocity) = on_cart(&cart["states"][0]);
    check_symplectic(top_on_cart(&cart["parameters"]), 0.05, attitude, velocity);
    let (attitude, velocity) = pair(&bodies["states"][0]);
    check_symplectic(two_bodies(&bodies["parameters"]), 0.05, attitude, velocity);
    let velocity = SVector::from([0.3, -0.5, 0.8, 2.0, -3.0, 5.0]);
    check_symplectic(gyrostat(), 0.05, at_rest(), velocity);
}
