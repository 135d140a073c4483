//! Forced steps and derivatives of whole steps: those of the typed stepper, differences, and the symplectic form.

use liestep::effects::{Drag, Gravity, RigidBody};
use liestep::gradients::Input;
use liestep::mechanics::{Effect, Inertia};
use liestep::motion::Propagator as _;
use liestep::with::Method;
use liestep::{NonstandardInertia, SO3, StepError, Stepper};
use liestep_late::{Declaration, Interpreter, Transition, Whole, numbers};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::{Free, Generators, IDENTITY, affine, extended_poses, orthogonal, special_linear, symplectic};

/// A body with gravity and drag, as a text.
fn damped_top(h: f64, method: &str) -> Whole {
    let (body, gravity, drag) = terms();
    let parsed = |text| Declaration::parse(text).expect("a declaration");
    let sum = Declaration::sum(&[
        parsed(<RigidBody as Effect>::DECLARATION),
        parsed(<Gravity as Effect>::DECLARATION),
        parsed(<Drag as Effect>::DECLARATION),
    ]);
    let all = [numbers(&body), numbers(&gravity), numbers(&drag)].concat();
    Whole::of(sum.expect("a sum"), &all, h, method.parse().expect("a method")).expect("a stepper")
}

fn terms() -> (RigidBody, Gravity, Drag) {
    let J_d = Matrix3::new(2.0, 0.1, 0.0, 0.1, 2.5, 0.2, 0.0, 0.2, 1.5);
    let body = RigidBody { J_d: NonstandardInertia::new(J_d).expect("an inertia") };
    let gravity = Gravity { m: 1.3, g: 9.81, rho: Vector3::new(0.1, 0.0, 0.4), up: Vector3::z() };
    let J = Inertia::from_principal_moments(Vector3::new(2.0, 2.5, 1.5)).expect("an inertia");
    (body, gravity, Drag { J, c: 0.3 })
}

fn pairs(columns: &[(Vector3<f64>, Vector3<f64>)]) -> Vec<f64> {
    columns.iter().flat_map(|(turn, momentum)| turn.iter().chain(momentum).copied().collect::<Vec<_>>()).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// Steps with a force have the bits of the typed ones, and the derivatives agree.
#[test]
fn forced_steps_and_transitions_are_the_typed_ones() {
    let (body, gravity, drag) = terms();
    let stepper = Stepper::new(body + gravity + drag, 0.05).expect("a stepper");
    let whole = damped_top(0.05, "step");
    let linear = stepper.linearised().expect("derivatives");
    let mut expected = stepper.start(SO3::identity(), Vector3::new(0.3, 2.0, -1.0)).expect("a start");
    let mut state = whole.start(&IDENTITY, &[0.3, 2.0, -1.0]).expect("a start");
    for step in 0..50 {
        let force = Vector3::new(0.1, -0.2 * f64::from(step % 3), 0.05);
        let by_columns = linear.transition(&mut expected, &Input::Force(force)).expect("a step");
        let mut forced = state.clone();
        whole.step_forced(&mut forced, force.as_slice()).expect("a step");
        let Transition { by_state, by_force } = whole.transition(&mut state, force.as_slice()).expect("a step");
        assert_eq!(forced, state, "the state is that of the forced step");
        assert_eq!(state[whole.layout().momentum()], *expected.momentum().as_slice(), "step {step}");
        let [found, of_force] = [(&by_state, &by_columns.by_state), (&by_force, &by_columns.by_input)]
            .map(|(found, expected)| largest_difference(found, &pairs(expected)));
        assert!(found < 1e-13 && of_force < 1e-14, "step {step}: {found:e}, {of_force:e}");
    }
}

#[test]
fn transitions_of_compositions_are_the_typed_ones() {
    let (body, gravity, _) = terms();
    let parsed = |text| Declaration::parse(text).expect("a declaration");
    let sum = Declaration::sum(&[parsed(<RigidBody as Effect>::DECLARATION), parsed(<Gravity as Effect>::DECLARATION)]);
    let all = [numbers(&body), numbers(&gravity)].concat();
    let method = "composition Suzuki 4".parse().expect("a method");
    let whole: Whole = Whole::of(sum.expect("a sum"), &all, 0.1, method).expect("a stepper");
    let scheme = liestep::methods::CompositionScheme::SUZUKI_4;
    let stepper = Stepper::composed(body + gravity, 0.1, scheme).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    let mut expected = stepper.start(SO3::identity(), Vector3::new(0.3, 2.0, -1.0)).expect("a start");
    let mut state = whole.start(&IDENTITY, &[0.3, 2.0, -1.0]).expect("a start");
    for _ in 0..20 {
        let by_columns = linear.transition(&mut expected, &Input::Free).expect("a step");
        let found = whole.transition(&mut state, &[0.0; 3]).expect("a step");
        assert!(largest_difference(&found.by_state, &pairs(&by_columns.by_state)) < 1e-12);
    }
}

/// A motion on the group of these generators, with a potential of a covector and a tensor.
struct Field {
    stepper: Whole,
    generators: Vec<DMatrix<f64>>,
    identity: Vec<f64>,
    velocity: Vec<f64>,
}

impl Field {
    fn on(n: usize, generators: &Generators, is_rigid: bool) -> Self {
        let text = super::text(n, generators, is_rigid);
        let potential = " - h * (a.dot(&a) / 2 + (T * K).trace() / 2)";
        let (head, tail) = text.split_once(")] struct Free { ").expect("a struct");
        let text = format!(
            "{head}{potential}, advected(a = along, T = metric))] struct Field {{ {}, \
             along: SVector<f64, {n}>, metric: CovariantTensor<f64, {n}>, K: SMatrix<f64, {n}, {n}> }}",
            tail.trim_end_matches(" }"),
        );
        let free = Free::on(n, generators, is_rigid);
        let small = |number: usize| f64::from(u8::try_from(number).unwrap());
        let along: Vec<f64> = (0..n).map(|k| 0.3 + 0.1 * small(k)).collect();
        let metric: Vec<f64> = (0..n * n).map(|at| if at / n == at % n { 1.0 } else { 0.1 }).collect();
        let K: Vec<f64> = (0..n * n).map(|at| 0.2 * (small(at / n + at % n)).cos()).collect();
        let declaration = Declaration::parse(&text).expect("a declaration");
        let values: [(&str, &[f64]); 4] = [("J", &free.numbers), ("along", &along), ("metric", &metric), ("K", &K)];
        let numbers = declaration.numbers(&values).expect("numbers");
        let stepper = Whole::of(declaration, &numbers, 0.1, Method::default()).expect("a stepper");
        let generators = generators.iter().map(|e| DMatrix::from_row_slice(n, n, e)).collect();
        Self { stepper, generators, identity: free.identity, velocity: free.velocity }
    }

    /// The components of an element of the algebra, by least squares.
    fn components(&self, matrix: &DMatrix<f64>) -> DVector<f64> {
        let count = self.generators.len();
        let gram = DMatrix::from_fn(count, count, |i, j| self.generators[i].dot(&self.generators[j]));
        let right = DVector::from_fn(count, |i, _| self.generators[i].dot(matrix));
        gram.lu().solve(&right).expect("independent generators")
    }

    fn attitude(&self, state: &[f64]) -> DMatrix<f64> {
        let n = self.generators[0].nrows();
        DMatrix::from_row_slice(n, n, &state[..n * n])
    }

    /// The state beside this one along a direction.
    fn beside(&self, state: &[f64], direction: &[f64]) -> Box<[f64]> {
        let (turn, change) = direction.split_at(self.generators.len());
        let mut moved = state.to_vec();
        let turned = self.stepper.declaration().displaced(&state[..self.identity.len()], turn);
        moved[..turned.len()].copy_from_slice(&turned);
        let momentum = self.stepper.layout().momentum();
        moved[momentum].iter_mut().zip(change).for_each(|(entry, change)| *entry += change);
        self.stepper.adopt(&moved)
    }

    /// The derivative by all directions, by central differences.
    fn by_differences(&self, state: &[f64], force: &[f64]) -> Vec<f64> {
        let (small, count) = (1e-5, 2 * self.generators.len());
        let mut columns = Vec::new();
        for k in 0..count {
            let mut direction = vec![0.0; count];
            direction[k] = small;
            let end = |sign: f64| {
                let direction: Vec<f64> = direction.iter().map(|entry| entry * sign).collect();
                let mut state = self.beside(state, &direction);
                self.stepper.step_forced(&mut state, force).expect("a step");
                state
            };
            let (mut middle, more, less) = (self.beside(state, &vec![0.0; count]), end(1.0), end(-1.0));
            self.stepper.step_forced(&mut middle, force).expect("a step");
            let inverse = self.attitude(&middle).try_inverse().expect("an element");
            let turn = inverse * (self.attitude(&more) - self.attitude(&less)) / (2.0 * small);
            columns.extend(self.components(&turn).iter());
            let momentum = self.stepper.layout().momentum();
            columns.extend(more[momentum.clone()].iter().zip(&less[momentum]).map(|(a, b)| (a - b) / (2.0 * small)));
        }
        columns
    }

    /// `ω(x, y) = ⟨δν, ζ⟩ − ⟨δμ, η⟩ + ⟨μ, [ζ, η]⟩` of all pairs of columns, at a momentum.
    fn form(&self, momentum: &[f64], columns: &DMatrix<f64>) -> DMatrix<f64> {
        let (n, count) = (self.generators.len(), columns.ncols());
        let momentum = DVector::from_column_slice(momentum);
        let hat = |x: &DVector<f64>| {
            let zero = DMatrix::zeros(self.generators[0].nrows(), self.generators[0].nrows());
            self.generators.iter().zip(x.iter()).fold(zero, |sum, (e, x)| sum + e * *x)
        };
        DMatrix::from_fn(count, count, |i, j| {
            let [(z, p), (y, q)] =
                [i, j].map(|k| (columns.column(k).rows(0, n).into_owned(), columns.column(k).rows(n, n).into_owned()));
            let (left, right) = (hat(&z), hat(&y));
            let bracket = self.components(&(&left * &right - &right * &left));
            q.dot(&z) - p.dot(&y) + momentum.dot(&bracket)
        })
    }
}

fn groups() -> [(&'static str, usize, Generators, bool); 5] {
    [
        ("SL(3)", 3, special_linear(), false),
        ("Sp(4)", 4, symplectic(), false),
        ("SO(4)", 4, orthogonal(4), true),
        ("SE_2(3)", 5, extended_poses(), true),
        ("affine maps of the plane", 3, affine(2), false),
    ]
}

#[test]
fn transitions_on_groups_of_texts_agree_with_differences() {
    for (name, n, generators, is_rigid) in groups() {
        let field = Field::on(n, &generators, is_rigid);
        let count = field.generators.len();
        let mut state = field.stepper.start(&field.identity, &field.velocity).expect("a start");
        field.stepper.run(&mut state, 7).expect("steps");
        let force: Vec<f64> = (0..count).map(|k| if k % 2 == 0 { 0.1 } else { -0.05 }).collect();
        let expected = field.by_differences(&state, &force);
        let found = field.stepper.transition(&mut state, &force).expect("a step");
        let difference = largest_difference(&found.by_state, &expected);
        assert!(difference < 3e-9, "{name}: {difference:e}");
    }
}

/// The product of many transitions preserves the symplectic form at the momenta of both ends.
#[test]
fn transitions_on_groups_of_texts_are_symplectic() {
    for (name, n, generators, is_rigid) in groups() {
        let field = Field::on(n, &generators, is_rigid);
        let (count, momentum) = (2 * field.generators.len(), field.stepper.layout().momentum());
        let mut state = field.stepper.start(&field.identity, &field.velocity).expect("a start");
        let mut product = DMatrix::identity(count, count);
        let before = field.form(&state[momentum.clone()], &product);
        for _ in 0..20 {
            let made = field.stepper.transition(&mut state, &vec![0.0; count / 2]).expect("a step");
            product = DMatrix::from_column_slice(count, count, &made.by_state) * product;
        }
        let after = field.form(&state[momentum], &product);
        let (missed, size) = ((&after - &before).amax(), product.amax());
        assert!(size > 1.0 && missed < 1e-12 * size * size, "{name}: {missed:e} of {size:e}");
    }
}

#[test]
fn hostile_forces_are_errors() {
    let whole = damped_top(0.05, "step");
    let state = whole.start(&IDENTITY, &[0.3, 2.0, -1.0]).expect("a start");
    let wrong = StepError::NonFinite { what: "control force" };
    for force in [&[f64::NAN, 0.0, 0.0][..], &[0.0; 2], &[]] {
        let mut next = state.clone();
        assert_eq!(whole.step_forced(&mut next, force), Err(wrong.clone()));
        assert_eq!(whole.transition(&mut next, force), Err(wrong.clone()));
        assert_eq!(next, state);
    }
    let too_strong = [f64::MAX; 3];
    let mut next = state.clone();
    assert!(whole.step_forced(&mut next, &too_strong).is_err());
    assert_eq!(next, state);
    let other = Err(StepError::NonFinite { what: "state of this layout" });
    assert_eq!(Whole::<Interpreter>::step_forced(&whole, &mut [], &[0.0; 3]).map(|_| ()), other);
}
