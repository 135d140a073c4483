//! Machine code computes what the interpreter computes, to the bit: each program of each declaration of the repository
//! and of random ones, with random inputs, alone and in lanes; and whole steps.

use declarations::{
    Alike, CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, FallingBody, FloatingBody, FluidDrag, Flyer,
    FourthOrderTop, FreeBody, FullTop, Gyrostat, HeavyTop, LogTop, LogTraceTop, Magnet, OrbitingBody, PointSpring,
    RodElement, Satellite, SixthOrderTop, SlidingTop, Spring as SpringTop, SuspendedLoad, TetheredPlate, Thruster,
    TopOnCart, Torquer, TwoBodies, UnderwaterBody,
};
use liestep::effects::{
    CayleyBody, Dipole, Drag, GeodesicBody, Gravity, GravityGradient, MagneticDamping, PrincipalBody, RigidBody, Rotor,
    Spring, Thrust, Torque,
};
use liestep::laws::samples::Random;
use liestep::mechanics::Effect;
use liestep::motion::Propagator as _;
use liestep::numbers::Real;
use liestep::with::Method;
use liestep_late::{Array, Backend, Declaration, Interpreter, LateError, Operation, Program, Source, Whole};
use liestep_machine::Machine;
use nalgebra::SimdValue as _;
use simba::simd::AutoF64x8;

macro_rules! texts {
    ($($name:ident)+) => { [$(<$name as Effect>::DECLARATION),+] };
}

/// All declarations of the repository that have steps.
fn texts() -> Vec<&'static str> {
    texts! {
        HeavyTop FullTop CayleyTop LogTop LogTraceTop ContinuousTop SlidingTop FreeBody Magnet Satellite
        SpringTop FourthOrderTop SixthOrderTop ElasticFlow TetheredPlate Flyer FluidDrag Thruster Torquer
        OrbitingBody UnderwaterBody DoublePendulum Alike TopOnCart FloatingBody FallingBody SuspendedLoad Gyrostat
        TwoBodies PointSpring RodElement RigidBody PrincipalBody CayleyBody GeodesicBody Gravity GravityGradient
        Dipole Spring Rotor Drag MagneticDamping Thrust Torque
    }
    .to_vec()
}

fn programs(declaration: &Declaration) -> Vec<&Program> {
    let mut list = Vec::new();
    let all = declaration.programs.try_map(|program| {
        list.push(program);
        Ok::<_, LateError>(())
    });
    all.map(|_| list).expect("no program fails")
}

/// The outputs of a program for these arrays.
fn outputs<B: Backend<f64>>(program: &Program, arrays: &[Vec<f64>]) -> Vec<u64> {
    let code = B::codes(&[program]).expect("a program").remove(0);
    outputs_of::<B>(&code, program, arrays)
}

fn outputs_of<B: Backend<f64>>(code: &B::Code, program: &Program, arrays: &[Vec<f64>]) -> Vec<u64> {
    numbers_of::<f64, B>(code, program, arrays).into_iter().map(bits).collect()
}

/// Bits of NaNs depend on the order of operands, which is the compiler's.
fn bits(number: f64) -> u64 {
    if number.is_nan() { u64::MAX } else { number.to_bits() }
}

fn numbers_of<T: Real, B: Backend<T>>(code: &B::Code, program: &Program, arrays: &[Vec<T>]) -> Vec<T> {
    let given = Array::ALL.map(|array| (array, arrays[array as usize].as_slice()));
    let mut numbers = vec![T::zero(); program.outputs.len()];
    B::prepare(code);
    B::run(code, &arrays[Array::Constants as usize], given, &mut numbers);
    numbers
}

/// Random arrays, as long as the program reads them.
fn inputs(program: &Program, random: &mut Random) -> Vec<Vec<f64>> {
    let mut arrays = vec![Vec::new(); Array::COUNT];
    for source in &program.inputs {
        let array = &mut arrays[source.array as usize];
        let length = array.len().max(source.at + 1);
        array.resize_with(length, || random.signed());
    }
    arrays
}

/// Compares all outputs; returns how many are numbers.
fn assert_same(programs: &[&Program], seed: u64) -> usize {
    let machine = <Machine as Backend<f64>>::codes(programs).expect("machine code");
    let interpreted = <Interpreter as Backend<f64>>::codes(programs).expect("programs");
    let (mut random, mut numbers) = (Random::new(seed), 0);
    for ((program, machine), interpreted) in programs.iter().zip(&machine).zip(&interpreted) {
        for _ in 0..3 {
            let all: [_; 8] = std::array::from_fn(|_| inputs(program, &mut random));
            let expected = all.each_ref().map(|arrays| outputs_of::<Interpreter>(interpreted, program, arrays));
            for (arrays, expected) in all.iter().zip(&expected) {
                assert_eq!(&outputs_of::<Machine>(machine, program, arrays), expected, "{program:?}");
                numbers += expected.iter().filter(|&&bits| bits != u64::MAX).count();
            }
            // All inputs in lanes.
            let lanes = |array: usize, at| AutoF64x8::from(std::array::from_fn(|k| all[k][array][at]));
            let of = |array: usize| (0..all[0][array].len()).map(|at| lanes(array, at)).collect();
            let together: Vec<Vec<AutoF64x8>> = (0..Array::COUNT).map(of).collect();
            let found = numbers_of::<AutoF64x8, Machine>(machine, program, &together);
            for (k, expected) in expected.iter().enumerate() {
                let lane: Vec<u64> = found.iter().map(|number| bits(number.extract(k))).collect();
                assert_eq!(&lane, expected, "lane {k}: {program:?}");
            }
        }
    }
    numbers
}

#[test]
fn all_declarations_of_the_repository() {
    let mut numbers = 0;
    for (seed, text) in (0..).zip(texts()) {
        let declaration = Declaration::parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        numbers += assert_same(&programs(declaration), seed);
    }
    println!("{numbers} numbers are the same");
    assert!(numbers > 50_000, "{numbers}");
}

/// A random vector, or number, of some depth.
fn expression(random: &mut Random, is_vector: bool, depth: u32) -> String {
    let chosen = (random.signed() + 1.0) * if depth == 0 { 1.5 } else { 3.0 };
    let mut deeper = |is_vector| expression(random, is_vector, depth.saturating_sub(1));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // one of few
    match (is_vector, chosen as u32) {
        (true, 0) => "w".to_owned(),
        (true, 1) => "r".to_owned(),
        (true, 2) => "(F * r)".to_owned(),
        (true, 3) => format!("({} + {})", deeper(true), deeper(true)),
        (true, 4) => format!("(A * {})", deeper(true)),
        (true, _) => format!("({} * {})", deeper(false), deeper(true)),
        (false, 0) => "k".to_owned(),
        (false, 1 | 2) => format!("{}.dot(&{})", deeper(true), deeper(true)),
        (false, 3) => format!("({} - {})", deeper(false), deeper(false)),
        (false, 4) => format!("(0.3 * {}).sin()", deeper(false)),
        (false, _) => format!("(1.0 + {}.powi(2)).sqrt()", deeper(false)),
    }
}

/// Random declarations with random potentials, on each group.
#[test]
fn random_declarations() {
    let groups =
        [("SO2", 2), ("SO3", 3), ("SE2", 3), ("SE3", 4), ("SE23", 5), ("SU2", 4), ("SL2", 2), ("Heisenberg", 3)];
    let groups = groups.into_iter().chain([("R1", 2), ("R2", 3), ("R3", 4)]);
    let (mut accepted, mut numbers) = (0, 0);
    for seed in 0..200 {
        for (group, size) in groups.clone() {
            if accepted == 300 {
                break;
            }
            let random = &mut Random::new(seed);
            let text = format!(
                "#[lagrangian(group = {group}, advected(w = up), l_d = ((F - I) * A * A.transpose() * (F - I).transpose())\
                 .trace() / (2.0 * h) - 0.5 * h * ({} + {}))] struct Random {{ A: SMatrix<f64, {size}, {size}>, \
                 r: SVector<f64, {size}>, up: SVector<f64, {size}>, k: f64 }}",
                expression(random, false, 3),
                expression(random, false, 2),
            );
            let Ok(declaration) = Declaration::parse(&text) else { continue };
            accepted += 1;
            numbers += assert_same(&programs(declaration), seed);
        }
    }
    println!("{numbers} numbers of {accepted} random declarations are the same");
    assert_eq!(accepted, 300);
}

/// Compares steps that are interpreted at first, and then machine code, with those that stay interpreted.
fn assert_same_steps(text: &str, numbers: &[(&str, &[f64])]) {
    fn stepper<B: Backend<f64>>(declaration: &'static Declaration, numbers: &[f64]) -> Whole<B> {
        Whole::of(declaration, numbers, 0.01, Method::default()).expect("a stepper")
    }
    let declaration = Declaration::parse(text).expect("a declaration");
    let numbers = declaration.numbers(numbers).expect("numbers");
    let (one, other) = (stepper::<Machine>(declaration, &numbers), stepper::<Interpreter>(declaration, &numbers));
    let (mut random, layout) = (Random::new(1), other.layout());
    let velocity: Vec<f64> = (0..layout.components()).map(|_| random.signed()).collect();
    let size = layout.attitude().len().isqrt();
    let identity: Vec<f64> = (0..size * size).map(|at| f64::from(u8::from(at / size == at % size))).collect();
    let mut first = one.start(&identity, &velocity).expect("a start");
    let mut second = other.start(&identity, &velocity).expect("a start");
    for step in 0..1_000 {
        assert_eq!(one.step(&mut first), other.step(&mut second), "step {step}");
        assert_eq!(first, second, "state after step {step} of {}", declaration.name);
    }
}

#[test]
fn steps_are_the_same() {
    let inertia: &[f64] = &[2.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 3.0];
    let (rho, up): (&[f64], &[f64]) = (&[0.1, -0.2, 0.4], &[0.0, 0.0, 1.0]);
    let full = FullTop::DECLARATION;
    assert_same_steps(full, &[("J_d", inertia), ("m", &[1.5]), ("g", &[9.81]), ("rho", rho), ("up", up)]);
    for text in [FourthOrderTop::DECLARATION, LogTop::DECLARATION] {
        assert_same_steps(text, &[("J", inertia), ("weight", &[1.5]), ("rho", rho), ("up", up)]);
    }
    let all = [3.0, 0.1, 0.0, 0.0, 0.1, 4.0, 0.2, 0.0, 0.0, 0.2, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let of_water: &[(&str, &[f64])] = &[
        ("J", &all),
        ("M", &all),
        ("origin", &[0.0; 3]),
        ("weight", &[0.0, 0.1, -0.2, 0.3]),
        ("height", &[0.0, 0.0, 1.0, 0.0]),
    ];
    assert_same_steps(UnderwaterBody::DECLARATION, of_water);
}

/// The comparison detects a swapped operand, an input of another stage and another register.
#[test]
fn what_is_wrong_is_seen() {
    let declaration = Declaration::parse(FullTop::DECLARATION).expect("a declaration");
    let right = &declaration.programs.newton_system;
    let arrays = inputs(right, &mut Random::new(5));
    let expected = outputs::<Interpreter>(right, &arrays);
    assert_eq!(outputs::<Machine>(right, &arrays), expected);
    let is_seen = |what: &str, wrong: Program| {
        // The arrays are at least as long as the wrong program needs them.
        let mut arrays = arrays.clone();
        for array in &mut arrays {
            array.resize(array.len().max(64), 0.5);
        }
        let expected = outputs::<Interpreter>(right, &arrays);
        let found = outputs::<Machine>(&wrong, &arrays);
        let differing = found.iter().zip(&expected).filter(|(found, expected)| found != expected).count();
        println!("{what}: {differing} of {} outputs differ", expected.len());
        assert!(differing > 0, "{what}");
    };
    let mut swapped = right.clone();
    let difference = |operation: &mut Operation| match operation {
        Operation::Subtract(a, b) => {
            std::mem::swap(a, b);
            true
        }
        _ => false,
    };
    assert!(swapped.operations.iter_mut().any(difference), "a difference");
    is_seen("a swapped operand", swapped);
    let mut stage = right.clone();
    let term = stage.inputs.iter_mut().find(|source| source.array == Array::Target).expect("a right side");
    *term = Source::new(Array::Constants, term.at);
    is_seen("an input of another stage", stage);
    let mut register = right.clone();
    let product = register.operations.iter_mut().find_map(|operation| match operation {
        Operation::Multiply(a, _) => Some(a),
        _ => None,
    });
    let operand = product.expect("a product");
    *operand = if *operand == 0 { 1 } else { *operand - 1 };
    is_seen("another register", register);
}

/// A program isn't called with an array shorter than it reads.
#[test]
#[should_panic(expected = "an input is missing")]
fn short_arrays_are_refused() {
    let declaration = Declaration::parse(FullTop::DECLARATION).expect("a declaration");
    let program = &declaration.programs.newton_system;
    let mut arrays = inputs(program, &mut Random::new(5));
    arrays[Array::Half as usize].pop();
    let _ = outputs::<Machine>(program, &arrays);
}
