//! Methods of a declaration that is data: those of SO(3) against compiled scenes, collocation on other groups against the
//! compiled one, its order and its invariants, the choice for an accuracy, and errors.

use declarations::{OrbitingBody, UnderwaterBody};
use liestep::accuracy::Accuracy;
use liestep::effects::{Gravity, RigidBody, Rotor, Torque};
use liestep::groups::LieGroup;
use liestep::mechanics::{ContinuousLagrangian, Effect, Scene};
use liestep::methods::CotangentGauss;
use liestep::motion::{AnyStepper, Integrator};
use liestep::numbers::Entries;
use liestep::with::{Method, Steppable};
use liestep::{NonstandardInertia, SO3, SetupError, StepError, lagrangian};
use liestep_late::{Declaration, Interpreter, Question, WholeError, for_accuracy, numbers, stepper};
use nalgebra::{Matrix4, Point3, SMatrix, SVector, Vector3, Vector4};

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn list<E: Entries<f64>>(value: &E) -> Vec<f64> {
    let mut list = Vec::new();
    value.each(&mut |entry: f64| list.push(entry));
    list
}

fn body() -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.5, 1.5)).expect("an inertia") }
}

fn weight() -> Gravity {
    Gravity { m: 1.3, g: 9.81, rho: Vector3::new(0.1, 0.0, 0.4), up: Vector3::z() }
}

/// The sum of these texts.
fn sum(texts: &[&str]) -> &'static Declaration {
    let all: Vec<_> = texts.iter().map(|text| Declaration::parse(text).expect("a declaration")).collect();
    Declaration::sum(&all).expect("a sum")
}

fn by(declaration: &'static Declaration, values: &[f64], h: f64, method: &str) -> Result<AnyStepper, WholeError> {
    let values = declaration.described(values).expect("numbers");
    stepper::<Interpreter>(declaration, &values, h, method.parse().expect("a method"))
}

/// Compares the steps of a compiled scene on SO(3) with those of its text, up to rounding.
fn assert_compiled<S>(scene: &S, declaration: &'static Declaration, methods: &[&str])
where
    S: Scene<Scalar = f64, Group = SO3>,
    SO3: Steppable<S>,
{
    for &method in methods {
        let typed = method.parse::<Method>().expect("a method").stepper(scene.clone(), 0.05).expect("a typed stepper");
        let data = by(declaration, &numbers(scene), 0.05, method).expect("a stepper");
        let velocity = [0.3, 4.0, 2.0];
        let mut expected = typed.start(&IDENTITY, &velocity).expect("a start");
        let mut state = data.start(&IDENTITY, &velocity).expect("a start");
        for step in 0..100 {
            let (report, found) = (typed.step(&mut expected), data.step(&mut state));
            assert!(report.is_ok() && found.is_ok(), "step {step} of {method}: {report:?} {found:?}");
            let pairs = (state.attitude().iter().chain(state.momentum()))
                .zip(expected.attitude().iter().chain(expected.momentum()));
            let off = pairs.fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
            assert!(off < 1e-11, "step {step} of {method}: {off:e}");
        }
        let energies = [data.energy(&state), typed.energy(&expected)];
        assert!((energies[0] - energies[1]).abs() < 1e-10, "{method}: {energies:?}");
        assert!((data.time(&state) - typed.time(&expected)).abs() < 1e-12, "{method}");
        let part = [data.part(&state, 0.4).expect("a part"), typed.part(&expected, 0.4).expect("a part")];
        let off = part[0].momentum().iter().zip(part[1].momentum()).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
        assert!(off < 1e-11, "a part of {method}: {off:e}");
    }
}

/// Splittings, processed ones, collocation in quaternions and wrapped steps are those of the compiled scene.
#[test]
fn methods_on_rotations_are_the_compiled_ones() {
    let both = sum(&[RigidBody::<f64>::DECLARATION, Gravity::<f64>::DECLARATION]);
    let methods = [
        "splitting Strang",
        "splitting Strang, compensated",
        "processed 3-6 a",
        "collocation 4",
        "collocation 8",
        "step, compensated",
        "composition Suzuki 4, compensated",
        "step, density 0.5",
    ];
    assert_compiled(&(body() + weight()), both, &methods);
    let names = liestep::methods::SplittingScheme::ALL.map(|scheme| format!("splitting {}", scheme.name()));
    assert_compiled(&(body() + weight()), both, &names.each_ref().map(String::as_str));
    let alone = sum(&[RigidBody::<f64>::DECLARATION]);
    assert_compiled(&body(), alone, &["exact", "splitting Strang", "collocation 4"]);
    let gyrostat = sum(&[RigidBody::<f64>::DECLARATION, Rotor::<f64>::DECLARATION, Gravity::<f64>::DECLARATION]);
    let rotor = Rotor { spin: Vector3::new(0.2, -0.1, 0.7) };
    assert_compiled(&(body() + rotor + weight()), gyrostat, &["collocation 4", "collocation 8"]);
}

/// Steps of a compiled collocation, beside those of the text.
fn assert_collocation<L, const N: usize, const D: usize>(lagrangian: &L, velocity: [f64; D], h: f64)
where
    L: ContinuousLagrangian<Scalar = f64> + Effect + Clone,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
{
    let declaration = Declaration::parse(L::DECLARATION).expect("a declaration");
    let compiled = CotangentGauss::<L, 2, N>::new(lagrangian.clone(), h).expect("a collocation");
    let data = by(declaration, &numbers(lagrangian), h, "collocation 4").expect("a stepper");
    let attitude = L::Group::from_matrix_unchecked(SMatrix::identity());
    let mut expected = compiled.start(attitude, SVector::from(velocity)).expect("a start");
    let mut state = data.start(&list(&attitude.matrix()), &velocity).expect("a start");
    for step in 0..50 {
        let (report, found) = (Integrator::step(&compiled, &mut expected), data.step(&mut state));
        assert_eq!(found.is_ok(), report.is_ok(), "step {step} of {}", declaration.name);
        let typed = [list(&expected.attitude().matrix()), list(&expected.momentum())].concat();
        let own = state.attitude().iter().chain(state.momentum());
        let (off, size) =
            own.zip(&typed).fold((0.0_f64, 1.0_f64), |(off, size), (a, b)| (off.max((a - b).abs()), size.max(b.abs())));
        assert!(off < 1e-12 * size, "step {step} of {}: {off:e}", declaration.name);
    }
    let energies =
        [data.energy(&state), compiled.energy(&expected.attitude(), &expected.momentum()).expect("an energy")];
    assert!((energies[0] - energies[1]).abs() < 1e-11 * energies[1].abs().max(1.0), "{energies:?}");
}

/// A body whose momentum isn't linear in its velocity, so that there is no splitting and no collocation in quaternions.
#[lagrangian(
    group = SO3,
    velocity = v,
    advected(w = up),
    l = 0.5 * v.dot(&(J * v)) + k * v.norm_squared() * v.norm_squared() - m * w.dot(&rho),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug)]
struct Stiffening {
    J: nalgebra::Matrix3<f64>,
    k: f64,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[test]
fn collocation_on_other_groups_is_the_compiled_one() {
    let water = UnderwaterBody {
        J: Matrix4::from_diagonal(&Vector4::new(1.2, 0.8, 0.5, 0.0)),
        M: Matrix4::from_diagonal(&Vector4::new(1.0, 1.8, 3.0, 0.0)),
        origin: Point3::new(0.1, 0.0, -0.2),
        weight: Vector4::new(0.2, -0.1, -1.5, 0.6),
        height: Vector4::z(),
    };
    assert_collocation::<_, 4, 6>(&water, [0.4, -0.3, 0.8, 0.5, 0.2, -0.6], 0.1);
    let (p1, p2) = (Point3::new(0.2, 0.1, 0.3), Point3::new(-0.25, 0.1, -0.35));
    let moment = |p: Point3<f64>| p.to_homogeneous() * p.to_homogeneous().transpose();
    let own = Matrix4::from_diagonal(&Vector4::new(0.3, 0.2, 0.1, 0.3));
    let J = own + 0.8 * moment(p1) + 0.5 * moment(p2);
    let orbiting = OrbitingBody { J, m1: 0.8, p1, m2: 0.5, p2, GM: 6.0, centre: Point3::new(4.5, 2.0, -3.0) };
    assert_collocation::<_, 4, 6>(&orbiting, [0.4, -0.3, 0.8, 0.5, 0.2, -0.6], 0.1);
    let J = nalgebra::Matrix3::from_diagonal(&Vector3::new(1.5, 1.0, 2.0));
    let stiffening = Stiffening { J, k: 0.05, m: 2.0, rho: Vector3::new(0.3, -0.2, 0.9), up: Vector3::z() };
    assert_collocation::<_, 3, 3>(&stiffening, [0.5, -0.8, 1.0], 0.1);
}

/// The text of a free motion whose kinetic energy is that of points fixed in the body.
fn free(n: usize, generators: &[Vec<f64>]) -> &'static Declaration {
    let row =
        |row: &[f64]| format!("[{}]", row.iter().map(|entry| format!("{entry:?}")).collect::<Vec<_>>().join(", "));
    let square = |m: &Vec<f64>| format!("[{}]", m.chunks(n).map(row).collect::<Vec<_>>().join(", "));
    let all = generators.iter().map(square).collect::<Vec<_>>().join(", ");
    let text = format!(
        "#[lagrangian(group = Own, generators = [{all}], l_d = (((F - I) * J * (F - I).transpose()).trace()
            + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace()) / (4 * h))]
        struct Free {{ J: SMatrix<f64, {n}, {n}> }}"
    );
    Declaration::parse(&text).expect("a declaration")
}

fn generator(n: usize, entries: &[(usize, usize, f64)]) -> Vec<f64> {
    let mut matrix = vec![0.0; n * n];
    for &(i, j, entry) in entries {
        matrix[i * n + j] = entry;
    }
    matrix
}

fn orthogonal(n: usize) -> Vec<Vec<f64>> {
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.map(|(i, j)| generator(n, &[(i, j, -1.0), (j, i, 1.0)])).collect()
}

fn symplectic() -> Vec<Vec<f64>> {
    let pairs = (0..2).flat_map(|i| (0..2).map(move |j| (i, j)));
    let mut list: Vec<_> = pairs.map(|(i, j)| generator(4, &[(i, j, 1.0), (2 + j, 2 + i, -1.0)])).collect();
    for (row, column) in [(0, 2), (2, 0)] {
        list.push(generator(4, &[(row, column, 1.0)]));
        list.push(generator(4, &[(row + 1, column + 1, 1.0)]));
        list.push(generator(4, &[(row, column + 1, 1.0), (row + 1, column, 1.0)]));
    }
    list
}

fn affine(n: usize) -> Vec<Vec<f64>> {
    (0..n).flat_map(|i| (0..=n).map(move |j| generator(n + 1, &[(i, j, 1.0)]))).collect()
}

/// On groups that a text declares the order is eight, the attitude stays in the group, and momentum and energy are kept.
#[test]
fn collocation_has_its_order_and_invariants_on_groups_of_texts() {
    for (name, n, generators) in [("SO(4)", 4, orthogonal(4)), ("Sp(4)", 4, symplectic()), ("affine", 3, affine(2))] {
        let small = |number: usize| f64::from(u8::try_from(number).unwrap());
        let entry = |(i, j): (usize, usize)| if i == j { 1.0 + 0.1 * small(i) } else { 0.05 / (1.0 + small(i + j)) };
        let values: Vec<f64> = (0..n * n).map(|at| entry((at / n, at % n))).collect();
        let identity: Vec<f64> = (0..n * n).map(|at| f64::from(u8::from(at / n == at % n))).collect();
        let velocity: Vec<f64> = (0..generators.len()).map(|k| 0.3 * (small(k) * 1.7).sin()).collect();
        let declaration = free(n, &generators);
        let end = |steps: u32, method: &str| {
            let stepper = by(declaration, &values, 2.0 / f64::from(steps), method).expect("a stepper");
            let mut state = stepper.start(&identity, &velocity).expect("a start");
            let before = (stepper.spatial_momentum(&state), stepper.energy(&state));
            stepper.run(&mut state, steps.into()).expect("steps");
            let after = (stepper.spatial_momentum(&state), stepper.energy(&state));
            let drift = before.0.iter().zip(&after.0).fold(0.0_f64, |drift, (a, b)| drift.max((a - b).abs()));
            assert!(drift < 1e-14, "{name}: the momentum in space is kept: {drift:e}");
            let mut row = [vec![0.0; n * n], vec![0.0; n * n + 2 * velocity.len() + 2]];
            let [attitude, numbers] = &mut row;
            stepper.write(&state, &(), attitude, numbers);
            let defect = numbers[numbers.len() - 1];
            // A composition of 400 steps has thousands of stages, with a rounding each.
            let bound = if method.starts_with("collocation") { 1e-14 } else { 1e-13 };
            assert!(defect < bound, "{name} by {steps} steps of {method}: {defect:e} from the group");
            ([state.attitude(), state.momentum()].concat(), (after.1 - before.1).abs())
        };
        let (reference, drift) = end(24, "collocation 8");
        assert!(drift < 1e-14, "{name}: the energy is kept: {drift:e}");
        let error = |steps| {
            let (end, _) = end(steps, "collocation 4");
            end.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        let (coarse, fine) = (error(3), error(6));
        let order = (coarse / fine).log2();
        assert!(coarse > 1e-11 && (7.3..9.0).contains(&order), "{name}: {coarse:e} {fine:e}, of order {order}");
        // The end is that of short steps of another method, too.
        let (composed, _) = end(400, "composition Kahan-Li 8");
        let off = composed.iter().zip(&reference).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
        assert!(off < 1e-12, "{name}: {off:e}");
    }
}

/// The reasons why a method isn't possible, and a state that stays after an error.
#[test]
fn mistakes_are_errors() {
    let refused = |declaration, values: &[f64], method: &str| by(declaration, values, 0.1, method).expect_err(method);
    let method = |error: &WholeError| matches!(error, WholeError::Setup(SetupError::Method { .. }));
    let places = (0..3).flat_map(|i| (0..3).filter(move |&j| i != j).map(move |j| (i, j)));
    let mut special: Vec<_> = places.map(|(i, j)| generator(3, &[(i, j, 1.0)])).collect();
    special.extend((0..2).map(|k| generator(3, &[(k, k, 1.0), (k + 1, k + 1, -1.0)])));
    let found = refused(free(3, &special), &IDENTITY, "collocation 4").to_string();
    assert!(found.contains("collocation leaves this group"), "{found}");

    let plane = free(3, &affine(2));
    for name in ["splitting Strang", "processed 3-6 a", "exact", "step, density 1"] {
        assert!(method(&refused(plane, &IDENTITY, name)), "{name}");
    }
    let values = [numbers(&body()), vec![0.1, 0.2, 0.3]].concat();
    let pushed = sum(&[RigidBody::<f64>::DECLARATION, Torque::<f64>::DECLARATION]);
    for name in ["splitting Strang", "processed 3-6 a", "exact", "collocation 4", "collocation 8, compensated"] {
        let found = refused(pushed, &values, name);
        assert!(method(&found) || pushed.has_force, "{name}: {found}");
    }
    let both = sum(&[RigidBody::<f64>::DECLARATION, Gravity::<f64>::DECLARATION]);
    let values = [numbers(&body()), numbers(&weight())].concat();
    assert!(method(&refused(both, &values, "exact")) && method(&refused(both, &values, "collocation 4, compensated")));
    let few = stepper::<Interpreter>(both, &[1.0], 0.1, "splitting Strang".parse().expect("a method"));
    assert!(matches!(few, Err(WholeError::Declaration(_))), "too few numbers");

    let values = [0.7, 0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 1.0];
    let long = by(plane, &values, 40.0, "collocation 4").expect("a stepper");
    let mut state = long.start(&IDENTITY, &[0.5, 2.0, 0.1, -0.4, 0.3, 0.2]).expect("a start");
    let before = state.clone();
    assert!(matches!(long.step(&mut state), Err(StepError::NotConverged { .. })));
    assert!(long.run(&mut state, 3).is_err() && state == before, "an error leaves the state");
}

/// The choice for an accuracy is the compiled scene's, among the same methods, and the end has that accuracy.
#[test]
fn an_accuracy_has_the_choice_of_the_compiled_scene() {
    let accuracy = Accuracy { tolerance: 1e-6, horizon: 10.0 };
    let both = sum(&[RigidBody::<f64>::DECLARATION, Gravity::<f64>::DECLARATION]);
    let values = both.described(&[numbers(&body()), numbers(&weight())].concat()).expect("numbers");
    let question = Question { accuracy, attitude: &IDENTITY, velocity: &[0.3, 4.0, 2.0] };
    let (data, choice) = for_accuracy::<Interpreter>(both, &values, None, question).expect("a choice");
    let typed =
        liestep::Stepper::for_accuracy(body() + weight(), accuracy, SO3::identity(), Vector3::new(0.3, 4.0, 2.0))
            .expect("a choice");
    let schemes = |choice: &liestep::accuracy::Choice| choice.offers().iter().map(|one| one.scheme).collect::<Vec<_>>();
    assert_eq!(schemes(&choice), schemes(typed.choice()));
    let exact = by(both, &[numbers(&body()), numbers(&weight())].concat(), 0.01, "collocation 8").expect("a stepper");
    let end = |stepper: &AnyStepper, steps| {
        let mut state = stepper.start(&IDENTITY, &[0.3, 4.0, 2.0]).expect("a start");
        stepper.run(&mut state, steps).expect("steps");
        state.momentum().to_vec()
    };
    let pairs = [end(&data, choice.steps), end(&exact, 1000)];
    let off = pairs[0].iter().zip(&pairs[1]).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
    assert!(off < 1e-4, "{off:e}");
}
