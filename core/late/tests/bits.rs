//! Declarations read at run time make the steps of compiled ones, to the bit: all of `examples/declarations` and all
//! effects of the library, each by the text that the macro stores.

#[path = "common/same.rs"]
mod same;
#[path = "common/slopes.rs"]
mod slopes;

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
use liestep::gradients::Input;
use liestep::groups::{CayleyRetraction, CovariantTensor, LieGroup as _, Retraction, SE23};
use liestep::lagrangian;
use liestep::laws::samples::Random;
use liestep::mechanics::{DiagonalNonstandardInertia, Effect, Inertia, Regular, SecondDerivatives, Vector};
use liestep::motion::Propagator as _;
use liestep::with::Method;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_late::{Array, Backend, Declaration, Interpreter, LateError, Program, Whole, numbers};
use nalgebra::{Matrix3, Matrix5, Point, SMatrix, SVector, Vector3, Vector5};

use same::{assert_as_compiled, assert_whole, list};

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
            let both = Declaration::sum(&[declared(&body()), declared(&compiled)]).expect("a sum");
            assert_whole(&(body() + compiled), both, seed);
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

/// Sums whose terms have an unknown part besides the body's, or have none.
#[test]
fn sums_of_what_is_read() {
    let (body, drag) = (random!(1, RigidBody { J_d }), random!(2, Drag { c J }));
    let gravity = random!(3, Gravity { m g rho up });
    let terms = [declared(&body), declared(&drag), declared(&gravity)];
    assert_whole(&(body + drag + gravity), Declaration::sum(&terms).expect("a sum"), 4);
    let body = random!(1, FourthOrderBody { J });
    let terms = [declared(&body), declared(&gravity)];
    assert_whole(&(body + gravity), Declaration::sum(&terms).expect("a sum"), 5);
}

/// The outputs of a program by interpretation.
fn outputs<const N: usize>(program: &Program, given: [(Array, &[f64]); N]) -> Vec<f64> {
    let code = <Interpreter as Backend<f64>>::codes(&[program]).expect("a program").remove(0);
    let mut outputs = vec![0.0; program.outputs.len()];
    Interpreter::run(&code, &[], given, &mut outputs);
    outputs
}

/// The product of a matrix, row by row, with a vector.
fn image(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks(vector.len()).map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum()).collect()
}

/// Compares continuous limits, and Jacobians at a step's increment.
fn assert_same_terms<E>(compiled: &E, declaration: &Declaration, seed: u64)
where
    E: Effect<Scalar = f64, Retraction = CayleyRetraction>,
    CayleyRetraction: Retraction<E::Group>,
{
    let near = |found: &[f64], expected: Vector<E>| {
        let expected = list(&expected);
        let size = expected.iter().fold(1.0_f64, |size, entry| size.max(entry.abs()));
        assert!(found.len() >= expected.len());
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-11 * size), "{found:?} {expected:?}");
    };
    let (h, w, velocity): (_, _, Vector<E>) = (0.01, compiled.advected(), Random::new(seed).sample());
    let (parameters, advected) = (declaration.described(&numbers(compiled)).expect("numbers"), list(&w));
    let (xi, programs) = (list(&velocity), &declaration.programs);
    let given = [(Array::Parameters, &*parameters), (Array::Advected, &advected), (Array::Velocity, &xi)];
    let expected = compiled.limit(Some(&velocity), &w);
    let (l, momentum, hessian) = if let Some(programs) = &programs.at_velocity {
        let [l, momentum, hessian] = programs.each_ref().map(|program| outputs(program, given));
        (l[0], momentum, hessian)
    } else {
        let all = outputs(&programs.at_rest, given);
        let (inertia, others) = all.split_at(xi.len() * xi.len());
        let moved = image(inertia, &xi);
        let momentum: Vec<f64> = moved.iter().zip(others).map(|(a, b)| a + b).collect();
        let l: f64 = moved.iter().zip(others).zip(&xi).map(|((j, s), xi)| (0.5 * j + s) * xi).sum();
        (l - others[xi.len()], momentum, inertia.to_vec())
    };
    assert!((l - expected.l).abs() < 1e-11 * (1.0 + expected.l.abs()), "{l} {}", expected.l);
    near(&momentum, expected.momentum);
    near(&image(&hessian, &xi), expected.hessian * velocity);
    let element = <CayleyRetraction as Retraction<E::Group>>::retract(&(velocity * h));
    let (f, inverse) = (element.matrix(), list(&element.inverse().matrix()));
    let given = [
        (Array::Step, &[h][..]),
        (Array::Parameters, &parameters),
        (Array::Advected, &advected),
        (Array::Element, &list(&f)),
        (Array::Inverse, &inverse),
    ];
    let jacobian = outputs(&programs.momentum_jacobian, given);
    near(&image(&jacobian, &xi), compiled.momentum_jacobian(&f, &w, h) * velocity);
}

fn declared<E: Effect>(_: &E) -> &'static Declaration {
    Declaration::parse(E::DECLARATION).expect("a declaration")
}

/// Terms in one program make the steps of their sum.
macro_rules! as_summed {
    ($seed:literal: $first:ident { $($of_first:ident)* } $($name:ident { $($field:ident)* })+) => {{
        let sum = random!($seed, $first { $($of_first)* }) $(+ random!($seed + 1, $name { $($field)* }))+;
        let terms = [
            declared(&random!(0, $first { $($of_first)* })) $(, declared(&random!(0, $name { $($field)* })))+
        ];
        let declaration = Declaration::sum(&terms).expect("a sum");
        println!("{}", declaration.name);
        assert_whole(&sum, declaration, $seed);
        assert_same_terms(&sum, declaration, $seed);
        assert!(matches!(declaration.described(&[1.0]), Err(LateError::Size { .. })));
    }};
}

#[test]
fn sums_in_one_program() {
    as_summed! { 1: RigidBody { J_d } Gravity { m g rho up } };
    as_summed! {
        2: RigidBody { J_d } Gravity { m g rho up } GravityGradient { GM r J direction } Dipole { moment field }
        Spring { k length at anchor } Rotor { spin } Drag { c J } Torque { torque } MagneticDamping { k field J }
    };
    as_summed! { 3: CayleyBody { J } Rotor { spin } Thrust { at thrust } };
    as_summed! { 4: Gravity { m g rho up } RigidBody { J_d } Rotor { spin } Rotor { spin } };
    as_summed! { 5: LogTop { J weight rho up } Gravity { m g rho up } Drag { c J } };
    // The tangent of the retraction multiplies the sum of the Jacobians, not each Jacobian.
    as_summed! { 6: Flyer { J } FluidDrag { C } Thruster { at thrust } };
    let of = |text| Declaration::parse(text).expect("a declaration");
    let [gravity, flyer] = [Gravity::<f64>::DECLARATION, Flyer::DECLARATION].map(of);
    assert!(matches!(Declaration::sum(&[gravity, flyer]), Err(LateError::Group { .. })));
    assert!(matches!(Declaration::sum(&[]), Err(LateError::Nothing)));
    let two = Declaration::sum(&[gravity, gravity]).expect("a sum");
    assert!(
        two.parameters[4].name == "Gravity2.m" && std::ptr::eq(two, Declaration::sum(&[gravity; 2]).expect("kept"))
    );
}

/// The tangent maps of steps are those of the compiled scene, to rounding.
fn assert_transition<S>(scene: &S, terms: &[&'static Declaration])
where
    S: SecondDerivatives + Regular + Effect<Scalar = f64, Retraction = CayleyRetraction> + Clone,
    CayleyRetraction: Retraction<S::Group>,
{
    let declaration = Declaration::sum(terms).expect("a sum");
    let values = declaration.described(&numbers(scene)).expect("numbers");
    let stepper = Stepper::new(scene.clone(), 0.1).expect("a stepper");
    let whole: Whole = Whole::of(declaration, &values, 0.1, Method::default()).expect("a stepper");
    let mut random = Random::new(5);
    let mut vector = || -> Vector<S> { random.sample() };
    let (attitude, velocity) = (<CayleyRetraction as Retraction<S::Group>>::retract(&(vector() * 0.4)), vector());
    let mut expected = stepper.start(attitude, velocity).expect("a start");
    let mut state = whole.start(&list(&attitude.matrix()), &list(&velocity)).expect("a start");
    let linear = stepper.linearised().expect("derivatives");
    for step in 0..5 {
        let by_columns = linear.transition(&mut expected, &Input::Force(velocity)).expect("a step");
        let found = whole.transition(&mut state, &list(&velocity)).expect("a step");
        for (found, columns) in [(&found.by_state, by_columns.by_state), (&found.by_force, by_columns.by_input)] {
            let columns: Vec<f64> =
                columns.iter().flat_map(|(turn, momentum)| [list(turn), list(momentum)].concat()).collect();
            let size = columns.iter().fold(1.0_f64, |size, entry| size.max(entry.abs()));
            assert_eq!(found.len(), columns.len());
            let apart = found.iter().zip(&columns).fold(0.0_f64, |apart, (a, b)| apart.max((a - b).abs()));
            assert!(apart < 1e-11 * size, "step {step} of {}: {apart:e}", declaration.name);
        }
    }
}

#[test]
fn derivatives_of_steps() {
    macro_rules! differentiated {
        ($($name:ident { $($field:ident)* })+) => {$(
            let compiled = random!(3, $name { $($field)* });
            assert_transition(&compiled, &[declared(&compiled)]);
        )+};
    }
    differentiated! { RigidBody { J_d } CayleyBody { J } GeodesicBody { J } Vehicle { J k r up } }
    macro_rules! differentiated_beside {
        ($($name:ident { $($field:ident)* })+) => {$(
            let (body, compiled) = (random!(1, RigidBody { J_d }), random!(3, $name { $($field)* }));
            assert_transition(&(body + compiled), &[declared(&body), declared(&compiled)]);
        )+};
    }
    differentiated_beside! {
        Gravity { m g rho up } GravityGradient { GM r J direction } Dipole { moment field } Spring { k length at anchor }
        Rotor { spin } Drag { c J } AirDrag { c air J } MagneticDamping { k field J } Thrust { at thrust } Torque { torque }
    }
    let (body, gravity, drag) =
        (random!(1, RigidBody { J_d }), random!(2, Gravity { m g rho up }), random!(3, Drag { c J }));
    let terms = [declared(&body), declared(&gravity), declared(&drag), declared(&gravity)];
    assert_transition(&(body + gravity + drag + gravity), &terms);
}
