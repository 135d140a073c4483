//! Declarations read at run time make the steps of compiled ones, to the bit: all of `examples/declarations` and all
//! effects of the library, each by the text that the macro stores.

#[path = "common/same.rs"]
mod same;

use declarations::{
    Alike, CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, FallingBody, FloatingBody, FluidDrag, Flyer,
    FourthOrderTop, FreeBody, FullTop, Gyrostat, HeavyTop, LogTop, LogTraceTop, Magnet, OrbitingBody, PointSpring,
    RodElement, Satellite, SixthOrderTop, SlidingTop, SuspendedLoad, TetheredPlate, Thruster, TopOnCart, Torquer,
    TwoBodies, UnderwaterBody,
};
use liestep::effects::{
    AirDrag, CayleyBody, Dipole, Drag, FourthOrderBody, GeodesicBody, Gravity, GravityGradient, MagneticDamping,
    PrincipalBody, RigidBody, Rotor, SixthOrderBody, Spring, Thrust, Torque,
};
use liestep::groups::{CayleyRetraction, CovariantTensor, LieGroup as _, Retraction, SE23};
use liestep::lagrangian;
use liestep::laws::samples::Random;
use liestep::mechanics::{
    DiagonalNonstandardInertia, Effect, Inertia, OnlyKicks, SecondDerivatives, StepPoint, Term as _, Vector,
    WithKinetic, WithoutKinetic,
};
use liestep::motion::Batch;
use liestep::numbers::{Coordinates as _, Entries as _};
use liestep::{NonstandardInertia, SO3, SetupError, Stepper};
use liestep_late::{Array, Backend, Declaration, Interpreter, Late, LateError, numbers, specialised};
use nalgebra::{Matrix3, Matrix5, Point, SMatrix, SVector, Vector3, Vector5};
use simba::simd::AutoF64x4;

use same::{assert_as_compiled, assert_same, assert_whole};

/// Random parameters for which a declaration is valid.
trait Sample {
    fn sample(random: &mut Random) -> Self;
}

impl Sample for f64 {
    fn sample(random: &mut Random) -> Self {
        1.0 + 0.5 * random.signed()
    }
}

macro_rules! sampled {
    ($([$($parameter:tt)*] $type:ty, $random:ident: $value:expr;)+) => {
        $(impl<$($parameter)*> Sample for $type {
            fn sample($random: &mut Random) -> Self {
                $value
            }
        })+
    };
}

/// A symmetric positive definite matrix.
fn metric<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let root: SMatrix<f64, N, N> = random.sample();
    SMatrix::identity() + root * root.transpose() * 0.3
}

sampled! {
    [] Vector3<f64>, random: random.sample();
    [] nalgebra::Vector4<f64>, random: random.sample();
    [] Vector5<f64>, random: random.sample();
    [const N: usize] Point<f64, N>, random: Point { coords: random.sample::<SVector<f64, N>>() };
    [] nalgebra::Matrix2<f64>, random: metric(random);
    [] Matrix3<f64>, random: metric(random);
    [] nalgebra::Matrix4<f64>, random: metric(random);
    [] Matrix5<f64>, random: metric(random);
    [const N: usize] CovariantTensor<f64, N>, random: CovariantTensor(metric(random));
    [] NonstandardInertia, random: NonstandardInertia::new(metric(random)).expect("an inertia");
    [] Inertia, random: NonstandardInertia::sample(random).to_inertia();
    [] DiagonalNonstandardInertia, random: {
        let moments = Vector3::repeat(3.0) + random.sample::<Vector3<f64>>() * 0.5;
        DiagonalNonstandardInertia::from_principal_moments(moments).expect("an inertia")
    };
}

macro_rules! random {
    ($seed:expr, $name:ident { $($field:ident)* }) => {{
        let random = &mut Random::new($seed);
        $name { $($field: Sample::sample(random)),* }
    }};
}

/// Compares single declarations.
macro_rules! as_compiled {
    ($($name:ident { $($field:ident)* })+) => {
        $(for seed in 1..3 {
            println!("{}", stringify!($name));
            let compiled = random!(seed, $name { $($field)* });
            assert_as_compiled(&compiled, seed);
        })+
    };
}

/// Compares declarations without a kinetic part, added to a compiled body.
macro_rules! as_compiled_beside {
    ($body:ident { $($of_body:ident)* }: $($name:ident { $($field:ident)* })+) => {
        let body = || random!(0, $body { $($of_body)* });
        $(for seed in 1..3 {
            println!("{}", stringify!($name));
            let compiled = random!(seed, $name { $($field)* });
            let late: Late<_, _, WithoutKinetic> = Late::like(&compiled).expect("a declaration");
            assert_same(&(body() + compiled), &(body() + late), seed);
            let both = Declaration::sum(&[declared(&body()), declared(&compiled)]).expect("a sum");
            assert_whole(&(body() + compiled), both, seed);
            if let Ok(kicks) = Late::<_, _, OnlyKicks>::like(&compiled) {
                assert_same(&(body() + compiled), &(body() + kicks), seed);
            }
        })+
    };
}

#[test]
fn tops() {
    as_compiled! {
        HeavyTop { J_d m g rho up } FullTop { J_d m g rho up } CayleyTop { J weight rho up }
        LogTop { J weight rho up } LogTraceTop { I1 weight rho up } ContinuousTop { J_d m g rho up }
        SlidingTop { J_d m g rho up } FreeBody { J_d } Magnet { J_d m Q field gradient }
        Satellite { J_d m tip GM centre }
    }
}

/// A declaration may share its name with an effect of the library.
#[test]
fn a_spring() {
    type Spring = declarations::Spring;
    as_compiled! { Spring { J_d k length rho anchor } }
}

#[test]
fn of_higher_orders() {
    as_compiled! {
        FourthOrderTop { J weight rho up } SixthOrderTop { J weight rho up } FourthOrderBody { J }
        SixthOrderBody { J }
    }
}

#[test]
fn effects_of_the_library() {
    as_compiled! {
        RigidBody { J_d } PrincipalBody { J_d } CayleyBody { J } GeodesicBody { J }
    }
    as_compiled_beside! {
        RigidBody { J_d }:
        Gravity { m g rho up } GravityGradient { GM r J direction } Dipole { moment field }
        Spring { k length at anchor } Rotor { spin } Drag { c J } AirDrag { c air J } MagneticDamping { k field J } Thrust { at thrust }
        Torque { torque } Torquer { moment field }
    }
}

/// A body on SE(2,3) with advected vectors.
#[lagrangian(
    group = SE23,
    gradients,
    advected(w = up),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * k * w.dot(&(r + F * r)),
)]
#[derive(Clone, Copy, Debug)]
struct Vehicle {
    J: Matrix5<f64>,
    k: f64,
    r: Vector5<f64>,
    up: Vector5<f64>,
}

#[test]
fn other_groups() {
    as_compiled! {
        ElasticFlow { M k metric } TetheredPlate { J k length p anchor } Flyer { J }
        OrbitingBody { J m1 p1 m2 p2 GM centre } UnderwaterBody { J M origin weight height } Vehicle { J k r up }
    }
    as_compiled_beside! { Flyer { J }: FluidDrag { C } Thruster { at thrust } }
}

#[test]
fn several_bodies() {
    as_compiled! {
        DoublePendulum { J_1 J_2 rho s_1 s_2 g up } TopOnCart { J_d s M g } FloatingBody { m J_d }
        FallingBody { m J_d g up } SuspendedLoad { J_d m K m_load cable g up } Gyrostat { J_d J_w a_1 a_2 a_3 }
    }
    as_compiled_beside! { DoublePendulum { J_1 J_2 rho s_1 s_2 g up }: Alike { kappa } }
    as_compiled! { TwoBodies { m_1 m_2 K_1 K_2 J_1 J_2 G } }
    as_compiled_beside! {
        TwoBodies { m_1 m_2 K_1 K_2 J_1 J_2 G }:
        PointSpring { k a b } RodElement { k c a b }
    }
}

/// A Lagrangian with a pace: its energy is one more number of the state.
#[lagrangian(
    group = SO3,
    advected(w = up),
    given(E_0 = energy),
    pace = 1.0 / (1.0 + w.dot(&rho).powi(2)),
    velocity = Omega,
    l = 0.5 * Omega.dot(&(J * Omega)) - weight * w.dot(&rho),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug)]
struct PacedTop {
    J: Inertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
    energy: f64,
}

#[test]
fn a_pace() {
    as_compiled! { PacedTop { J weight rho up energy } }
}

/// Sums of a body and effects that are both read at run time: their values determine which of them has an unknown part.
#[test]
fn sums_of_what_is_read() {
    let (body, drag) = (random!(1, RigidBody { J_d }), random!(2, Drag { c J }));
    let gravity = random!(3, Gravity { m g rho up });
    let late: Late<_, (), WithKinetic> = Late::like(&body).expect("a declaration");
    let late_drag: Late<_, (), WithoutKinetic> = Late::like(&drag).expect("a declaration");
    let late_gravity: Late<_, Vector3<f64>, WithoutKinetic> = Late::like(&gravity).expect("a declaration");
    assert_same(&(body + drag + gravity), &(late + late_drag + late_gravity), 4);
    assert!(Late::<SO3, (), OnlyKicks>::like(&drag).is_err() && Late::<_, _, OnlyKicks>::like(&gravity).is_ok());
    let body = random!(1, FourthOrderBody { J });
    let late: Late<_, (), WithKinetic> = Late::like(&body).expect("a declaration");
    let late_gravity: Late<_, Vector3<f64>, WithoutKinetic> = Late::like(&gravity).expect("a declaration");
    assert_same(&(body + gravity), &(late + late_gravity), 5);
}

/// Compares continuous limits, and Jacobians at a step's increment.
fn assert_same_terms<A, B>(one: &A, other: &B, seed: u64)
where
    A: Effect<Scalar = f64, Retraction = CayleyRetraction>,
    B: Effect<Scalar = f64, Group = A::Group, Advected = A::Advected>,
    CayleyRetraction: Retraction<A::Group>,
{
    let near = |a: Vector<A>, b: Vector<A>| {
        let difference = a - b;
        assert!(difference.dot(&difference).sqrt() < 1e-11 * (1.0 + a.dot(&a).sqrt()), "{a:?} {b:?}");
    };
    let (h, w, velocity): (_, _, Vector<A>) = (0.01, one.advected(), Random::new(seed).sample());
    let (a, b) = (one.limit(Some(&velocity), &w), other.limit(Some(&velocity), &w));
    assert!((a.l - b.l).abs() < 1e-11 * (1.0 + a.l.abs()));
    near(a.momentum, b.momentum);
    near(a.hessian * velocity, b.hessian * velocity);
    let f = <CayleyRetraction as Retraction<A::Group>>::retract(&(velocity * h)).matrix();
    near(one.momentum_jacobian(&f, &w, h) * velocity, other.momentum_jacobian(&f, &w, h) * velocity);
}

fn declared<E: Effect>(_: &E) -> &'static Declaration {
    Declaration::parse(E::DECLARATION).expect("a declaration")
}

/// Terms in one program make the steps of their sum.
macro_rules! as_summed {
    ($assert:ident $seed:literal: $first:ident { $($of_first:ident)* } $($name:ident { $($field:ident)* })+) => {{
        let sum = random!($seed, $first { $($of_first)* }) $(+ random!($seed + 1, $name { $($field)* }))+;
        let terms = [
            declared(&random!(0, $first { $($of_first)* })) $(, declared(&random!(0, $name { $($field)* })))+
        ];
        let declaration = Declaration::sum(&terms).expect("a sum");
        let late = Late::<_, _, WithKinetic>::of(declaration).and_then(|late| late.with_all(&numbers(&sum)));
        let late = late.expect("numbers");
        println!("{}", declaration.name);
        $assert(&sum, &late, $seed);
        assert_whole(&sum, declaration, $seed);
        assert_same_terms(&sum, &late, $seed);
        assert!(Late::<_, _, WithKinetic>::of(declaration).and_then(|late| late.with_all(&[1.0])) != Ok(late));
    }};
}

#[test]
fn sums_in_one_program() {
    as_summed! { assert_same 1: RigidBody { J_d } Gravity { m g rho up } };
    as_summed! {
        assert_same 2: RigidBody { J_d } Gravity { m g rho up } GravityGradient { GM r J direction } Dipole { moment field }
        Spring { k length at anchor } Rotor { spin } Drag { c J } Torque { torque } MagneticDamping { k field J }
    };
    as_summed! { assert_same 3: CayleyBody { J } Rotor { spin } Thrust { at thrust } };
    as_summed! { assert_same 4: Gravity { m g rho up } RigidBody { J_d } Rotor { spin } Rotor { spin } };
    as_summed! { assert_same 5: LogTop { J weight rho up } Gravity { m g rho up } Drag { c J } };
    // The tangent of the retraction multiplies the sum of the Jacobians, not each Jacobian.
    as_summed! { assert_same_terms 6: Flyer { J } FluidDrag { C } Thruster { at thrust } };
    let of = |text| Declaration::parse(text).expect("a declaration");
    let [gravity, flyer] = [Gravity::<f64>::DECLARATION, Flyer::DECLARATION].map(of);
    assert!(matches!(Declaration::sum(&[gravity, flyer]), Err(LateError::Group { .. })));
    assert!(matches!(Declaration::sum(&[]), Err(LateError::Nothing)));
    let two = Declaration::sum(&[gravity, gravity]).expect("a sum");
    assert!(
        two.parameters[4].name == "Gravity2.m" && std::ptr::eq(two, Declaration::sum(&[gravity; 2]).expect("kept"))
    );
}

/// A sum by the directions of space makes the same steps, and has the derivatives by these directions.
#[test]
fn a_sum_in_frames() {
    type Frame = (Vector3<f64>, Vector3<f64>, Vector3<f64>);
    let (body, gravity, dipole) =
        (random!(1, RigidBody { J_d }), random!(2, Gravity { m g rho up }), random!(3, Dipole { moment field }));
    let [one, other] = [4, 5].map(|seed| random!(seed, Spring { k length at anchor }));
    let sum = body + gravity + one + dipole + other;
    let terms = [declared(&body), declared(&gravity), declared(&one), declared(&dipole), declared(&other)];
    let declaration = Declaration::sum_in_frames(&terms).expect("a sum");
    assert_eq!(declaration.carried.len(), 3);
    let late = Late::<SO3, Frame, WithKinetic>::of(declaration).and_then(|late| late.with_all(&numbers(&sum)));
    let late = late.and_then(Late::differentiable).expect("numbers");
    let (start, velocity) = (SO3::exp(Vector3::new(0.3, -0.2, 0.5)), Vector3::new(0.3, 1.0, 5.0));
    let compiled = Stepper::new(sum, 0.01).expect("a stepper");
    let framed = Stepper::new(late.clone(), 0.01).expect("a stepper");
    let mut a = compiled.start(start, velocity).expect("a start");
    let mut b = framed.start(start, velocity).expect("a start");
    assert!((compiled.energy(&a) - framed.energy(&b)).abs() < 1e-12);
    compiled.run(&mut a, 200).expect("steps");
    framed.run(&mut b, 200).expect("steps");
    assert!((a.momentum() - b.momentum()).norm() < 1e-11, "{} {}", a.momentum(), b.momentum());
    // A vector is `Σ_i u_i e_i`: the gradients by the directions are sums of those by the vectors.
    let increment = SO3::exp(velocity * 0.1).matrix() - Matrix3::identity();
    let (seen, frame) = (sum.advected(), late.advected());
    let (own, framed) =
        (StepPoint { increment: &increment, w: &seen, h: 0.1 }, StepPoint { increment: &increment, w: &frame, h: 0.1 });
    let (u, p) = (Vector3::new(0.4, 0.1, -0.7), Vector3::new(-0.2, 0.9, 0.3));
    let by_own = sum.adjoint_gradient(own, [&u, &p], &mut |_, _| {}).1;
    let (mut vectors, mut by_vectors, mut by_frame) = (Vec::new(), Vec::new(), Vec::new());
    seen.each(&mut |entry| vectors.push(entry));
    by_own.each(&mut |entry| by_vectors.push(entry));
    late.adjoint_gradient(framed, [&u, &p], &mut |_, _| {}).1.each(&mut |entry| by_frame.push(entry));
    for (direction, place) in (0..3).flat_map(|direction| (0..3).map(move |place| (direction, place))) {
        let chain: f64 = vectors.chunks(3).zip(by_vectors.chunks(3)).map(|(u, by)| u[direction] * by[place]).sum();
        assert!((chain - by_frame[3 * direction + place]).abs() < 1e-11, "{direction} {place}");
    }
    let mut by_number = vec![[Vector3::zeros(); 2]; 12];
    sum.by_advected(own, &mut |number, start, end| by_number[number] = [start, end]);
    late.by_advected(framed, &mut |number, start, end| {
        for (which, found) in [start, end].into_iter().enumerate() {
            let chain: Vector3<f64> =
                (0..4).map(|one| by_number[3 * one + number % 3][which] * vectors[3 * one + number / 3]).sum();
            assert!((chain - found).norm() < 1e-11, "{number}");
        }
    });
    // The sum of a sum by directions, and the C code of its step.
    let twice = Declaration::sum_in_frames(&[declaration, terms[1]]).expect("a sum");
    let values = [numbers(&sum), numbers(&gravity)].concat();
    let twice = Late::<SO3, Frame, WithKinetic>::of(twice).and_then(|late| late.with_all(&values)).expect("numbers");
    let by_hand = sum + gravity;
    let limits = (twice.limit(None, &twice.advected()).l, by_hand.limit(None, &by_hand.advected()).l);
    assert!((limits.0 - limits.1).abs() < 1e-12, "{limits:?}");
    let written = liestep_late::c(declaration).expect("a step in C");
    let seen = written.split("static void seen").nth(1).expect("a program");
    assert!(seen.contains("x3 = in->attitude[3];") && seen.contains("outputs[3] = x3;"), "{written}");
}

/// The numbers of all derivatives of a step, at a random step.
fn derivatives<E>(effect: &E, seed: u64) -> Vec<f64>
where
    E: SecondDerivatives<Scalar = f64>,
    CayleyRetraction: Retraction<E::Group>,
{
    let mut random = Random::new(seed);
    let [turn, u, p]: [Vector<E>; 3] = [random.sample(), random.sample(), random.sample()];
    let increment = <CayleyRetraction as Retraction<E::Group>>::retract(&(turn * 0.4)).increment();
    let (w, mut found) = (effect.advected(), Vec::new());
    let at = StepPoint { increment: &increment, w: &w, h: 0.1 };
    let mut add = |vector: Vector<E>| vector.each(&mut |entry| found.push(entry));
    let blocks = effect.step_derivatives(at);
    add(blocks.start_by_turn * u);
    add(blocks.end_by_turn * u);
    add(blocks.start_by_place * u);
    add(blocks.end_by_place * u);
    let (matrix, right_side) = effect.adjoint_system(at, &p);
    let (by_place, by_advected) = effect.adjoint_gradient(at, [&u, &p], &mut |_, _| {});
    [matrix * u, right_side, by_place].into_iter().for_each(&mut add);
    // Derivatives by numbers without effect may be visited or left out.
    let mut sum = Vector::<E>::zero();
    effect.by_advected(at, &mut |number, start, end| {
        let number = 1.5_f64.powi(i32::try_from(number).unwrap());
        sum = sum + start * number + end * number.recip();
    });
    add(sum);
    by_advected.each(&mut |entry| found.push(entry));
    found
}

/// Derivatives agree to the bit; in one program those of a sum agree to rounding.
#[test]
fn derivatives_of_steps() {
    type Seen = ((((), Vector3<f64>), ()), Vector3<f64>);
    macro_rules! differentiated {
        ($kinetic:ident: $($name:ident { $($field:ident)* })+) => {$(
            let compiled = random!(3, $name { $($field)* });
            let late = Late::<_, _, $kinetic>::like(&compiled).and_then(Late::differentiable).expect("derivatives");
            assert_eq!(derivatives(&compiled, 5), derivatives(&late, 5), "{}", stringify!($name));
        )+};
    }
    differentiated! { WithKinetic: RigidBody { J_d } CayleyBody { J } GeodesicBody { J } Vehicle { J k r up } }
    differentiated! { WithoutKinetic:
        Gravity { m g rho up } GravityGradient { GM r J direction } Dipole { moment field } Spring { k length at anchor }
        Rotor { spin } Drag { c J } AirDrag { c air J } MagneticDamping { k field J } Thrust { at thrust } Torque { torque }
    }
    let (body, gravity, drag) =
        (random!(1, RigidBody { J_d }), random!(2, Gravity { m g rho up }), random!(3, Drag { c J }));
    let sum = body + gravity + drag + gravity;
    let terms = [declared(&body), declared(&gravity), declared(&drag), declared(&gravity)];
    let late = Declaration::sum(&terms).and_then(Late::<SO3, Seen, WithKinetic>::of);
    let late = late.and_then(|late| late.with_all(&numbers(&sum))?.differentiable()).expect("derivatives");
    let (one, other) = (derivatives(&sum, 7), derivatives(&late, 7));
    assert!(
        one.len() == other.len() && one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-11),
        "{one:?} {other:?}"
    );
    let plain: Late<_, _, WithKinetic> = Late::like(&random!(1, FreeBody { J_d })).expect("a declaration");
    assert_eq!(
        Stepper::new(plain.clone(), 0.1).expect("a stepper").linearised().err(),
        Some(SetupError::NoSecondDerivatives)
    );
    assert_eq!(plain.differentiable(), Err(LateError::NoGradients));
}

/// A step with constant parameters is a shorter program, with the same results up to roundings.
#[test]
fn specialised_programs_are_shorter() {
    let (J_d, rho, up) = ([2.0, 0.0, 0.0, 0.0, 2.5, 0.0, 0.0, 0.0, 3.0], [0.0, 0.0, 0.4], [0.0, 0.0, 1.0]);
    let numbers: [(&str, &[f64]); 5] = [("J_d", &J_d), ("m", &[1.5]), ("g", &[9.81]), ("rho", &rho), ("up", &up)];
    let late = Late::<SO3, Vector3<f64>>::parse(FullTop::DECLARATION).expect("a declaration");
    let late = numbers.iter().try_fold(late, |late, (name, value)| late.with(name, value)).expect("numbers");
    let after = |late: Late<_, _>| {
        let stepper = Stepper::new(late, 0.01).expect("a stepper");
        let mut state = stepper.start(SO3::identity(), Vector3::new(0.3, 1.0, 5.0)).expect("a start");
        stepper.run(&mut state, 100).expect("steps");
        state.momentum()
    };
    let programs = &late.declaration().programs;
    let parameters: Vec<f64> = numbers.iter().flat_map(|(_, value)| value.iter().copied()).collect();
    let code = <Interpreter as Backend<f64>>::codes(&[&programs.constants]).expect("a program").remove(0);
    let mut constants = vec![0.0; programs.constants.outputs.len()];
    let given = [(Array::Step, &[0.01][..]), (Array::Parameters, &parameters)];
    Interpreter::run(&code, &[], given, &mut constants);
    let lengths = [programs, &specialised(programs, &constants)].map(|all| all.newton_system.operations.len());
    println!("{} operations an iteration, specialised {}", lengths[0], lengths[1]);
    // Three of the operations are products of the right-hand side.
    assert!(lengths[0] >= 90 + 3 && lengths[1] <= 61 + 3, "{lengths:?}");
    let (general, specialised) = (after(late.clone()), after(late.specialised()));
    assert!((general - specialised).norm() < 1e-13 * general.norm(), "{general} {specialised}");
}

/// Programs of one form with different numbers, in lanes.
#[test]
fn lanes_have_the_bits_of_single_steps() {
    let top = random!(1, FullTop { J_d m g rho up });
    let full: Late<SO3, Vector3<f64>, WithKinetic> = Late::like(&top).expect("a declaration");
    let top = random!(2, FourthOrderTop { J weight rho up });
    let fourth: Late<SO3, Vector3<f64>, WithKinetic> = Late::like(&top).expect("a declaration");
    // The kicks of a torque are known before a step.
    let both = [RigidBody::<f64>::DECLARATION, Torque::<f64>::DECLARATION].map(|it| Declaration::parse(it).unwrap());
    let values = [numbers(&random!(1, RigidBody { J_d })), numbers(&random!(2, Torque { torque }))].concat();
    let both = Late::of(Declaration::sum(&both).unwrap()).and_then(|late| late.with_all(&values)).expect("numbers");
    for (late, name, count) in [(full, "m", 1), (fourth, "weight", 1), (both, "Torque.torque", 3)] {
        let bodies = [1.0, 1.5, 2.0, 2.5].map(|number| {
            let late = late.clone().with(name, &vec![number; count]).expect("a number");
            let stepper = Stepper::new(late, 0.01).expect("a stepper");
            let state = stepper.start(SO3::exp(Vector3::x() * number), Vector3::new(0.3, 1.0, 5.0)).expect("a start");
            (stepper, state)
        });
        let mut batch = Batch::<AutoF64x4, _>::new(&bodies).expect("they share a text");
        batch.run(1_000);
        for (k, (stepper, mut alone)) in bodies.into_iter().enumerate() {
            stepper.run(&mut alone, 1_000).expect("steps");
            assert_eq!(batch.state(k), alone, "lane {k}");
        }
    }
    let [one, other] = [Late::like(&random!(1, FreeBody { J_d })), Late::like(&random!(1, RigidBody { J_d }))]
        .map(|late: Result<Late<SO3>, _>| Stepper::new(late.expect("a declaration"), 0.01).expect("a stepper"));
    let state = one.start(SO3::identity(), Vector3::z()).expect("a start");
    assert!(Batch::<AutoF64x4, _>::new(&[(one, state), (other, state)]).is_err(), "two texts share no lanes");
}
