//! Compensated sums off SO(3): the bits of the compiled step with compensated sums, which shares no code with the text's, and what
//! they gain.

// A declaration names its fields by the letters of its formula.
#![allow(non_snake_case)]

use declarations::DoublePendulum;
use liestep::groups::{LieGroup, SE2, SE3};
use liestep::mechanics::{Effect, Regular};
use liestep::methods::CompositionScheme;
use liestep::motion::Plan;
use liestep::numbers::Entries;
use liestep::{SO3, Stepper, force, lagrangian};
use liestep_late::{Declaration, Interpreter, numbers, stepper};
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector4};

use crate::products::scene;

/// A plate that moves in a plane, on a spring.
#[lagrangian(
    group = SE2,
    advected(a = anchor),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        - 0.25 * h * ((a - p).norm_squared() + (F.transpose() * a - p).norm_squared()),
)]
#[derive(Clone, Debug)]
struct Plate {
    J: Matrix3<f64>,
    p: Vector3<f64>,
    anchor: Vector3<f64>,
}

/// An impulse at the end of a step, by what is seen there.
#[force(group = SE2, advected(u = wind), work = h * u.dot(&push) * eta_next[1] - 0.02 * h * eta[0])]
#[derive(Clone, Debug)]
struct Wind {
    push: Vector3<f64>,
    wind: Vector3<f64>,
}

#[lagrangian(group = SE3, l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Debug)]
struct Free {
    K: Matrix4<f64>,
}

fn listed<E: Entries<f64>>(value: &E) -> Vec<f64> {
    let mut list = Vec::new();
    value.each(&mut |entry| list.push(entry));
    list
}

/// Steps of the compiled stepper beside those of the text, compared to the bit.
fn assert_bits<S, P>(compiled: &Stepper<S, P>, terms: &[(&str, Vec<f64>)], start: (S::Group, &[f64]), method: &str)
where
    S: Regular<Scalar = f64>,
    P: Plan<S>,
{
    let parsed: Vec<_> = terms.iter().map(|(text, _)| Declaration::parse(text).expect("a declaration")).collect();
    let declaration = Declaration::sum(&parsed).expect("a sum");
    let values = parsed.iter().zip(terms).flat_map(|(one, (_, given))| one.described(given).expect("numbers"));
    let values: Vec<f64> = values.collect();
    let read =
        stepper::<Interpreter>(declaration, &values, 0.01, method.parse().expect("a method")).expect("a stepper");
    let mut velocity = start.1.iter();
    let velocity = Entries::from_entries(&mut || velocity.next().copied().expect("a component"));
    let mut state = compiled.start(start.0, velocity).expect("a start");
    let mut data = read.start(&listed(&start.0.matrix()), start.1).expect("a start");
    for step in 0..5_000 {
        assert_eq!(compiled.step(&mut state), read.step(&mut data), "{method}, step {step}");
        let expected =
            [listed(&state.attitude().matrix()), listed(&state.momentum()), listed(&state.advected())].concat();
        let found = [data.attitude(), data.momentum(), data.advected()].concat();
        assert_eq!(expected, found, "{method}, step {step}");
    }
}

#[test]
fn they_are_those_of_the_compiled_step() {
    let suzuki = CompositionScheme::SUZUKI_4;
    let plate = Plate {
        J: Matrix3::new(1.0, 0.1, 0.2, 0.1, 1.5, -0.1, 0.2, -0.1, 2.0),
        p: Vector3::new(0.3, -0.2, 0.0),
        anchor: Vector3::new(0.5, 1.0, 0.0),
    };
    let start = (SE2::identity(), &[1.3, 0.4, -0.7][..]);
    let terms = [(Plate::DECLARATION, numbers(&plate))];
    let stepper = Stepper::new(plate.clone(), 0.01).expect("a stepper");
    assert_bits(&stepper.compensated(), &terms, start, "step, compensated");
    let composed = Stepper::composed(plate.clone(), 0.01, suzuki).expect("a stepper");
    assert_bits(&composed.compensated(), &terms, start, "composition Suzuki 4, compensated");

    // A kick at the end of a step sees what is advected there.
    let wind = Wind { push: Vector3::new(0.2, -0.1, 0.0), wind: Vector3::new(1.0, 0.5, 0.0) };
    let terms = [(Plate::DECLARATION, numbers(&plate)), (Wind::DECLARATION, numbers(&wind))];
    let both = Stepper::new(plate + wind, 0.01).expect("a stepper");
    assert_bits(&both.compensated(), &terms, start, "step, compensated");

    let terms = [(crate::products::BodyAndWheel::DECLARATION, numbers(&scene()))];
    let velocity = [0.3, -0.7, 1.1, 0.2, 0.5, -0.4, 0.9, 0.4, -2.0];
    let product = Stepper::new(scene(), 0.01).expect("a stepper").compensated();
    assert_bits(&product, &terms, (liestep::groups::LieGroup::identity(), &velocity), "step, compensated");
    let _: (SE3, SO3) = liestep::groups::LieGroup::identity();

    // Two rotations are looked at often, and restored as seldom as one.
    let terms = [(DoublePendulum::<f64>::DECLARATION, numbers(&DoublePendulum::asymmetric()))];
    let two = Stepper::new(DoublePendulum::asymmetric(), 0.01).expect("a stepper").compensated();
    let velocity = [0.5, -0.8, 1.2, -0.3, 0.9, 0.4];
    assert_bits(&two, &terms, (liestep::groups::LieGroup::identity(), &velocity), "step, compensated");
}

/// The momentum in space after many short steps, with compensated sums and without.
#[test]
fn they_lose_less() {
    let mut K = Matrix4::from_diagonal(&Vector4::new(2.0, 1.5, 1.1, 1.3));
    (K[(0, 3)], K[(3, 0)]) = (0.2, 0.2);
    let declaration = Declaration::parse(Free::DECLARATION).expect("a declaration");
    let values = declaration.described(&numbers(&Free { K })).expect("numbers");
    let identity = listed(&SE3::<f64>::identity().matrix());
    let drift = |method: &str| {
        let read =
            stepper::<Interpreter>(declaration, &values, 1e-4, method.parse().expect("a method")).expect("a stepper");
        let mut state = read.start(&identity, &[0.3, -0.7, 1.1, 0.2, 0.5, -0.4]).expect("a start");
        let before = SVector::<f64, 6>::from_vec(read.spatial_momentum(&state));
        read.run(&mut state, 40_000).expect("steps");
        (SVector::<f64, 6>::from_vec(read.spatial_momentum(&state)) - before).norm() / before.norm()
    };
    let [plain, compensated] = ["step", "step, compensated"].map(drift);
    println!("{plain:.1e}, {compensated:.1e}");
    assert!(compensated < 0.1 * plain && compensated < 4e-16, "{plain:e}, {compensated:e}");
}
