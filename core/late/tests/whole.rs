//! Whole steps on groups that a text declares: order, momentum in space and the group's relation; compositions,
//! substeps and prescribed values as by typed steppers; errors.

#[path = "whole/compensated.rs"]
mod compensated;
#[path = "whole/motions.rs"]
mod motions;
#[path = "whole/own_factors.rs"]
mod own_factors;
#[path = "whole/products.rs"]
mod products;
#[path = "whole/special_linear.rs"]
mod special_linear;
#[path = "whole/tangent.rs"]
mod tangent;
#[path = "whole/varied.rs"]
mod varied;

use declarations::FullTop;
use liestep::effects::{RigidBody, Torque};
use liestep::mechanics::Effect as _;
use liestep::methods::CompositionScheme;
use liestep::motion::{AnyStepper, Integrator as _, Propagator as _, Remedy};
use liestep::with::Method;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper};
use liestep_late::{Declaration, LateError, Whole, WholeError};
use nalgebra::Vector3;

type Generators = Vec<Vec<f64>>;

/// A matrix with these entries.
fn matrix(n: usize, entries: &[(usize, usize, f64)]) -> Vec<f64> {
    let mut matrix = vec![0.0; n * n];
    for &(i, j, entry) in entries {
        matrix[i * n + j] = entry;
    }
    matrix
}

fn special_linear() -> Generators {
    let places = (0..3).flat_map(|i| (0..3).filter(move |&j| i != j).map(move |j| (i, j)));
    let mut list: Generators = places.map(|(i, j)| matrix(3, &[(i, j, 1.0)])).collect();
    list.extend((0..2).map(|k| matrix(3, &[(k, k, 1.0), (k + 1, k + 1, -1.0)])));
    list
}

fn orthogonal(n: usize) -> Generators {
    (0..n).flat_map(|i| (i + 1..n).map(move |j| matrix(n, &[(i, j, -1.0), (j, i, 1.0)]))).collect()
}

fn symplectic() -> Generators {
    let pairs = (0..2).flat_map(|i| (0..2).map(move |j| (i, j)));
    let mut list: Generators = pairs.map(|(i, j)| matrix(4, &[(i, j, 1.0), (2 + j, 2 + i, -1.0)])).collect();
    for (row, column) in [(0, 2), (2, 0)] {
        list.push(matrix(4, &[(row, column, 1.0)]));
        list.push(matrix(4, &[(row + 1, column + 1, 1.0)]));
        list.push(matrix(4, &[(row, column + 1, 1.0), (row + 1, column, 1.0)]));
    }
    list
}

fn affine(n: usize) -> Generators {
    (0..n).flat_map(|i| (0..=n).map(move |j| matrix(n + 1, &[(i, j, 1.0)]))).collect()
}

fn extended_poses() -> Generators {
    let turns = [(1, 2), (2, 0), (0, 1)];
    let mut list: Generators = turns.iter().map(|&(a, b)| matrix(5, &[(a, b, -1.0), (b, a, 1.0)])).collect();
    list.extend((0..6).map(|k| matrix(5, &[(k % 3, 3 + k / 3, 1.0)])));
    list
}

/// Blocks of one matrix, each of which the group of these generators moves.
fn blocks(count: usize, generators: &Generators) -> Generators {
    let (size, n) = (3, 3 * count);
    let in_block = move |block: usize, own: &Vec<f64>| {
        let entry = |at: usize| (size * block + at / size, size * block + at % size, own[at]);
        matrix(n, &(0..size * size).map(entry).collect::<Vec<_>>())
    };
    (0..count).flat_map(|block| generators.iter().map(move |own| in_block(block, own))).collect()
}

fn decimal(entry: f64) -> String {
    format!("{entry:?}")
}

/// Generators as an array, each by rows.
fn written(generators: &Generators) -> String {
    let n = generators[0].len().isqrt();
    let row = |row: &[f64]| format!("[{}]", row.iter().map(|&entry| decimal(entry)).collect::<Vec<_>>().join(", "));
    let square = |m: &Vec<f64>| format!("[{}]", m.chunks(n).map(row).collect::<Vec<_>>().join(", "));
    format!("[{}]", generators.iter().map(square).collect::<Vec<_>>().join(", "))
}

/// A kinetic energy on the group of these generators. Where the group isn't rigid, half of it is that of `I − F⁻¹`, or the
/// order is one.
fn text(n: usize, generators: &Generators, is_rigid: bool) -> String {
    let all = written(generators);
    let kinetic = if is_rigid {
        "((F - I) * J * (F - I).transpose()).trace() / (2 * h)"
    } else {
        "(((F - I) * J * (F - I).transpose()).trace()
            + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace()) / (4 * h)"
    };
    format!(
        "#[lagrangian(group = Own, generators = {all}, l_d = {kinetic})] struct Free {{ J: SMatrix<f64, {n}, {n}> }}"
    )
}

/// Free motion on one group over a second.
struct Free {
    declaration: &'static Declaration,
    identity: Vec<f64>,
    numbers: Vec<f64>,
    velocity: Vec<f64>,
}

impl Free {
    fn on(n: usize, generators: &Generators, is_rigid: bool) -> Self {
        let declaration = Declaration::parse(&text(n, generators, is_rigid)).expect("a declaration");
        let small = |number: usize| f64::from(u8::try_from(number).unwrap());
        let entry = |(i, j): (usize, usize)| if i == j { 1.0 + 0.1 * small(i) } else { 0.05 / (1.0 + small(i + j)) };
        let numbers = (0..n * n).map(|at| entry((at / n, at % n))).collect();
        let identity = (0..n * n).map(|at| f64::from(u8::from(at / n == at % n))).collect();
        let velocity = (0..generators.len()).map(|k| 0.3 * (small(k) * 1.7).sin()).collect();
        Self { declaration, identity, numbers, velocity }
    }

    /// Attitude and momentum after a second, and the drift of the momentum in space relative to it.
    fn end(&self, method: &str, steps: u32) -> (Vec<f64>, f64) {
        let method: Method = method.parse().expect("a method");
        let stepper: Whole =
            Whole::of(self.declaration, &self.numbers, 1.0 / f64::from(steps), method).expect("a stepper");
        let mut state = stepper.start(&self.identity, &self.velocity).expect("a start");
        let [mut before, mut after] = [vec![0.0; self.velocity.len()], vec![0.0; self.velocity.len()]];
        stepper.spatial_momentum(&state, &mut before);
        stepper.run(&mut state, steps.into()).expect("steps");
        stepper.spatial_momentum(&state, &mut after);
        assert!(stepper.defect(&state) < 1e-14, "the attitude is in the group: {:e}", stepper.defect(&state));
        let size = before.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
        let drift = before.iter().zip(&after).fold(0.0_f64, |drift, (a, b)| drift.max((a - b).abs()));
        (state[..stepper.layout().momentum().end].to_vec(), drift / size)
    }

    /// The order of a method, by the difference of the ends to that of short steps.
    fn order(&self, method: &str, [coarse, fine, exact]: [u32; 3]) -> f64 {
        let (reference, drift) = self.end(method, exact);
        assert!(drift < 1e-14, "the momentum in space is conserved: {drift:e}");
        let error = |steps: u32| {
            let (end, _) = self.end(method, steps);
            end.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        (error(coarse) / error(fine)).log2() / f64::from(fine / coarse).log2()
    }
}

#[test]
fn groups_of_texts_have_the_order_and_the_invariants() {
    let groups: [(&str, usize, Generators, bool); 8] = [
        ("SL(3)", 3, special_linear(), false),
        ("Sp(4)", 4, symplectic(), false),
        ("SO(4)", 4, orthogonal(4), true),
        ("SO(6), fifteen unknowns", 6, orthogonal(6), true),
        ("three rotations, nine rows", 9, blocks(3, &orthogonal(3)), true),
        ("SE_2(3)", 5, extended_poses(), true),
        ("affine maps of the plane", 3, affine(2), false),
        ("affine maps of space", 4, affine(3), false),
    ];
    for (name, n, generators, is_rigid) in groups {
        let free = Free::on(n, &generators, is_rigid);
        let order = free.order("step", [10, 20, 320]);
        assert!((order - 2.0).abs() < 0.01, "{name}: {order}");
        let order = free.order("composition Suzuki 4", [8, 16, 96]);
        assert!((order - 4.0).abs() < 0.03, "{name}: {order}");
    }
}

fn top() -> FullTop {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.5, 1.5)).expect("an inertia");
    FullTop { J_d, m: 1.3, g: 9.81, rho: Vector3::new(0.1, 0.0, 0.4), up: Vector3::z() }
}

fn whole(h: f64, method: &str) -> Whole {
    let (declaration, values) = Declaration::like(&top()).expect("a declaration");
    Whole::of(declaration, &values, h, method.parse().expect("a method")).expect("a stepper")
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Compositions, substeps and their errors are those of the typed stepper, to the bit.
#[test]
fn methods_are_the_typed_ones() {
    let velocity = Vector3::new(0.3, 4.0, 2.0);
    for (h, method, steps) in [
        (0.05, "composition Suzuki 4", 1100),
        (0.1, "composition Kahan-Li 8", 200),
        (0.5, "composition Suzuki 4", 20),
        (0.6, "step, substeps 16", 50),
    ] {
        let typed = method.parse::<Method>().expect("a method").stepper(top(), h).expect("a stepper");
        let whole = whole(h, method);
        let mut expected = typed.start(&IDENTITY, velocity.as_slice()).expect("a start");
        let mut state = whole.start(&IDENTITY, velocity.as_slice()).expect("a start");
        let moving = ..whole.layout().advected().end;
        let mut remedies = 0;
        for step in 0..steps {
            let (report, found) = (typed.step(&mut expected), whole.step(&mut state));
            assert_eq!(found, report, "step {step} of {method} by {h} s");
            assert_eq!(state[moving], expected.numbers()[moving], "step {step} of {method} by {h} s");
            remedies += u32::from(found.is_ok_and(|report| matches!(report.remedy, Some(Remedy::Substeps(_)))));
        }
        assert_eq!(remedies > 0, method.starts_with("step, substeps"), "{method}: {remedies}");
    }
}

/// A step with other values in space is that of a typed stepper with these values.
#[test]
fn values_are_prescribed_for_a_step() {
    let stepper = Stepper::new(top(), 0.02).expect("a stepper");
    let whole = whole(0.02, "step");
    let mut expected = stepper.start(SO3::identity(), Vector3::y()).expect("a start");
    let mut state = whole.start(&IDENTITY, &[0.0, 1.0, 0.0]).expect("a start");
    for step in 0..100 {
        let angle = 0.01 * f64::from(step);
        let up = Vector3::new(angle.sin(), 0.0, angle.cos());
        let mut values = whole.numbers().to_vec();
        whole.declaration().set(&mut values, "up", up.as_slice()).expect("a value");
        let report = stepper.step_with(&mut expected, &up);
        assert_eq!(whole.step_with(&mut state, &values), report);
        let momentum = expected.momentum();
        assert_eq!(state[whole.layout().momentum()], *momentum.as_slice(), "step {step}");
    }
    let before = state.clone();
    let wrong = vec![f64::NAN; whole.numbers().len()];
    let error = StepError::NonFinite { what: "value given to the step" };
    assert_eq!((whole.step_with(&mut state, &wrong), state), (Err(error), before));
}

/// A stepper that takes numbers and a step has the bits of one that is made with them, by a composition, too.
#[test]
fn numbers_are_taken() {
    for method in ["step", "composition Suzuki 4"] {
        let first = whole(0.02, method);
        let mut own = first.clone();
        let state = first.start(&IDENTITY, &[0.1, 1.0, -0.3]).expect("a start");
        for (name, value, h) in [
            ("up", &[0.0, 0.6, 0.8][..], 0.02),
            ("rho", &[0.1, 0.0, 0.9], 0.02),
            ("m", &[1.5], 0.02),
            ("m", &[1.5], -0.01),
        ] {
            let mut values = own.numbers().to_vec();
            own.declaration().set(&mut values, name, value).expect("a value");
            let made = first.with(&values, h).expect("a stepper");
            let mut expected = [0.0; 3];
            made.velocity(&state, &mut expected);
            assert_eq!(own.velocity_with(&state, &values), expected);
            assert_eq!(own.energy_with(&state, &values).to_bits(), made.energy(&state).to_bits());
            own.take(&values, h).expect("numbers");
            let [mut one, mut other] = [&own, &made].map(|stepper| stepper.adopt(&state));
            assert_eq!(own.run(&mut one, 50), made.run(&mut other, 50));
            assert_eq!((own.numbers(), own.step_size().to_bits(), one), (&values[..], h.to_bits(), other), "{name}");
        }
        let before = own.numbers().to_vec();
        let wrong = vec![f64::NAN; before.len()];
        assert!(
            own.take(&wrong, -0.01).is_err()
                && own.take(&before, f64::NAN).is_err()
                && own.take(&before[1..], 0.1).is_err()
        );
        assert_eq!((own.numbers(), own.step_size().to_bits()), (&before[..], (-0.01_f64).to_bits()));
        assert!(own.velocity_with(&state[1..], &before).iter().all(|rate| rate.is_nan()));
        assert!(own.energy_with(&state, &before[1..]).is_nan());
    }
}

/// Bodies of one text with other numbers and another step, in lanes, have the bits that they have alone, and their own ends.
#[test]
fn lanes_have_the_bits_of_single_steps() {
    let texts = [RigidBody::<f64>::DECLARATION, Torque::<f64>::DECLARATION].map(|it| Declaration::parse(it).unwrap());
    // The kicks of a torque are known before a step.
    let both = Declaration::sum(&texts).expect("a sum");
    let of_both = [2.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 3.0, 0.1, -0.2, 0.1];
    let (full, of_full) = Declaration::like(&top()).expect("a declaration");
    for (declaration, values, name) in [(both, &of_both[..], "Torque.torque"), (full, &of_full, "rho")] {
        // The last body turns too far for its step.
        let mut bodies = [0.0, 1.0, 2.0, 3.0, 40.0].map(|number| {
            let mut values = values.to_vec();
            declaration.set(&mut values, name, &[0.1 * number, -0.2, 0.1]).expect("a value");
            let whole: Whole =
                Whole::of(declaration, &values, 0.01 + 1e-3 * number, Method::default()).expect("a stepper");
            let stepper = whole.into_joinable();
            let state = stepper.start(&IDENTITY, &[0.3, 1.0 + number, 5.0 + number]).expect("a start");
            (stepper, state)
        });
        let (mut together, count) = AnyStepper::abreast(&bodies).expect("they share a text");
        assert_eq!(count, 5);
        together.run(1_100);
        for (lane, (stepper, alone)) in bodies.iter_mut().enumerate() {
            let ended = stepper.run_stretches(alone, 1_100, &mut |_, _| 0).err();
            assert_eq!(together.error(lane), ended.as_ref(), "lane {lane}");
            assert_eq!(ended.is_some(), lane == 4, "lane {lane}");
            assert_eq!(&*together.state(lane), alone.numbers(), "lane {lane}");
        }
    }
}

/// Steppers with other numbers share the code, and are those that are made anew.
#[test]
fn numbers_and_steps_are_replaced() {
    let whole = whole(0.02, "step");
    let mut values = whole.numbers().to_vec();
    whole.declaration().set(&mut values, "m", &[2.6]).expect("a value");
    let heavy = whole.with(&values, 0.01).expect("a stepper");
    let anew: Whole = Whole::of(whole.declaration(), &values, 0.01, Method::default()).expect("a stepper");
    let [mut one, mut other] =
        [&heavy, &anew].map(|stepper| stepper.start(&IDENTITY, &[0.1, 0.2, 3.0]).expect("a start"));
    heavy.run(&mut one, 100).expect("steps");
    anew.run(&mut other, 100).expect("steps");
    assert_eq!(one, other);
    let light = whole.adopt(&one);
    assert_eq!(light[whole.layout().momentum()], one[heavy.layout().momentum()]);
    assert!((heavy.energy(&one) - whole.energy(&light)).abs() > 1.0);
}

#[test]
fn hostile_values_are_errors() {
    let whole = whole(0.01, "step");
    let start = |attitude: &[f64], velocity: &[f64]| whole.start(attitude, velocity).map(|_| ());
    let length = |what, found, expected| Err(SetupError::Length { what, found, expected });
    assert_eq!(start(&[1.0; 8], &[0.0; 3]), length("attitude", 8, 9));
    assert_eq!(start(&IDENTITY, &[0.0; 4]), length("velocity", 4, 3));
    assert_eq!(start(&IDENTITY, &[0.0, f64::NAN, 0.0]), Err(SetupError::NonFinite { what: "velocity" }));
    assert!(matches!(start(&[1.0; 9], &[0.0; 3]), Err(SetupError::NotInGroup { .. })));
    assert!(matches!(start(&[f64::NAN; 9], &[0.0; 3]), Err(SetupError::NotInGroup { defect }) if defect.is_nan()));
    assert_eq!(
        whole.start_with_momentum(&IDENTITY, &[f64::INFINITY; 3]),
        Err(SetupError::NonFinite { what: "momentum" })
    );
    let declaration = whole.declaration();
    let of = |name: &str, value: &[f64], h: f64| {
        let mut values = whole.numbers().to_vec();
        declaration.set(&mut values, name, value).expect("a value");
        Whole::<liestep_late::Interpreter>::of(declaration, &values, h, Method::default()).map(|_| ())
    };
    let wrong = |error| Err(WholeError::Setup(error));
    let field = SetupError::Parameter { field: "m", cause: "is not finite, or wasn't given" };
    assert_eq!(of("m", &[f64::NAN], 0.01), wrong(field));
    for step in [f64::INFINITY, 1e300, 1e-300] {
        assert_eq!(of("m", &[1.0], step), wrong(SetupError::InvalidStep { step }), "{step}");
    }
    assert!(matches!(of("J_d", &[-1.0, -1.0, -1.0], 0.01), Err(WholeError::Setup(SetupError::NegativeKinetic { .. }))));
    assert!(matches!(of("J_d", &[0.0, 0.0, 0.0], 0.01), Err(WholeError::Setup(SetupError::SingularKinetic { .. }))));
    assert_eq!(of("J_d", &[1.0, 1.0, 1.0], 0.0), Ok(()));
    let few = Whole::<liestep_late::Interpreter>::of(declaration, &[1.0], 0.01, Method::default()).map(|_| ());
    assert!(matches!(few, Err(WholeError::Declaration(LateError::Size { .. }))));
    let exact = Whole::<liestep_late::Interpreter>::of(declaration, whole.numbers(), 0.01, "exact".parse().unwrap());
    assert!(matches!(exact.map(|_| ()), Err(WholeError::Setup(SetupError::Method { .. }))));

    let state = whole.start(&IDENTITY, &[0.1, 0.2, 3.0]).expect("a start");
    let other = StepError::NonFinite { what: "state of this layout" };
    assert_eq!(whole.step(&mut state[1..].to_vec()), Err(other.clone()));
    assert_eq!((whole.run(&mut [], 5), whole.part(&[0.0], 0.5)), (Err(other.clone()), Err(other)));
    assert!(whole.energy(&[]).is_nan() && whole.defect(&[]).is_nan() && whole.adopt(&[1.0]).iter().all(|x| x.is_nan()));
    for place in 0..whole.layout().advected().end {
        for number in [f64::NAN, f64::INFINITY, 1e300] {
            let mut hostile = state.clone();
            hostile[place] = number;
            let before: Vec<u64> = hostile.iter().map(|number| number.to_bits()).collect();
            // An attitude isn't read by the solve.
            if whole.layout().attitude().contains(&place) {
                continue;
            }
            assert!(whole.step(&mut hostile).is_err() && whole.run(&mut hostile, 3).is_err(), "{place} {number}");
            assert_eq!(before, hostile.iter().map(|number| number.to_bits()).collect::<Vec<_>>(), "{place} {number}");
        }
    }
    let compositions = CompositionScheme::ALL.iter().map(|scheme| format!("composition {}", scheme.name()));
    compositions.for_each(|method| assert!(self::whole(0.01, &method).step(&mut state.clone()).is_ok(), "{method}"));
}
