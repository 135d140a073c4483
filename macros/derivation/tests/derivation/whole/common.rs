//! Groups by generators, declarations on any of them, and programs evaluated in any numbers.

use liestep_derivation::judged::verify::number::Number;
use liestep_derivation::judged::verify::value::Value;
use liestep_derivation::mathematics::group::{Group, built_in};
use liestep_derivation::mathematics::symbolic::Rational;
use liestep_derivation::whole::{MatrixFactor, Value as Symbol, WholeStep, Words};
use liestep_derivation::{
    Action, Array, Carried, Factor, Operation, Parameter, ParameterKind, Program, Role, Source, StagedDeclaration,
    Stages,
};

pub(super) type Generators = Vec<Vec<f64>>;

fn unit(n: usize, entries: &[(usize, usize, f64)]) -> Vec<f64> {
    let mut matrix = vec![0.0; n * n];
    for &(i, j, x) in entries {
        matrix[i * n + j] = x;
    }
    matrix
}

pub(super) fn named(name: &str) -> Generators {
    let group = built_in(name).expect("a group");
    group.generators.iter().map(|one| one.iter().map(|entry| entry.to_f64()).collect()).collect()
}

/// The generators of SL(3): traceless matrices of three rows.
pub(super) fn sl3() -> Generators {
    let pairs = (0..3).flat_map(|i| (0..3).filter(move |&j| i != j).map(move |j| unit(3, &[(i, j, 1.0)])));
    pairs.chain([[(0, 0, 1.0), (1, 1, -1.0)], [(1, 1, 1.0), (2, 2, -1.0)]].map(|diagonal| unit(3, &diagonal))).collect()
}

/// The generators of SO(n): skew matrices.
pub(super) fn so(n: usize) -> Generators {
    (0..n).flat_map(|i| (i + 1..n).map(move |j| unit(n, &[(i, j, -1.0), (j, i, 1.0)]))).collect()
}

/// The generators of Sp(4): Hamiltonian matrices of four rows.
pub(super) fn sp4() -> Generators {
    let mut list: Generators =
        (0..4).map(|at| (at / 2, at % 2)).map(|(i, j)| unit(4, &[(i, j, 1.0), (2 + j, 2 + i, -1.0)])).collect();
    for (r, c) in [(0, 2), (2, 0)] {
        list.push(unit(4, &[(r, c, 1.0)]));
        list.push(unit(4, &[(r + 1, c + 1, 1.0)]));
        list.push(unit(4, &[(r, c + 1, 1.0), (r + 1, c, 1.0)]));
    }
    list
}

/// The generators of the affine maps of `n` coordinates.
pub(super) fn affine(n: usize) -> Generators {
    (0..n).flat_map(|i| (0..=n).map(move |j| unit(n + 1, &[(i, j, 1.0)]))).collect()
}

/// The group of these generators in exact numbers.
pub(super) fn exact(generators: &Generators) -> Group {
    let entries = generators.iter().map(|e| e.iter().map(|&entry| rational(entry)).collect());
    Group::declared(generators[0].len().isqrt(), entries.collect())
}

/// The groups of these tests.
pub(super) fn groups() -> Vec<(&'static str, Generators)> {
    let built_in = ["SO2", "SO3", "SE2", "SE3", "SE23", "SU2", "SL2", "Heisenberg", "R3"];
    let declared =
        [("SO(4)", so(4)), ("SL(3)", sl3()), ("Sp(4)", sp4()), ("planar affine", affine(2)), ("affine", affine(3))];
    built_in.map(|name| (name, named(name))).into_iter().chain(declared).collect()
}

/// The fraction of small numbers with this nearest `f64`.
#[allow(clippy::cast_possible_truncation)] // small numbers
pub(super) fn rational(number: f64) -> Rational {
    let fractions = (1..=64_u32).map(|q| ((number * f64::from(q)).round() as i128, q));
    let fractions = fractions.map(|(p, q)| Rational::new(p, i128::from(q)));
    fractions.into_iter().find(|fraction| fraction.to_f64().to_bits() == number.to_bits()).expect("a small fraction")
}

/// The outputs of a program.
pub(super) fn run<T: Number>(program: &Program, input: impl Fn(Source) -> T) -> Vec<T> {
    let literals = program.literals.iter().map(|&literal| T::of(rational(literal)));
    let mut values: Vec<T> = program.inputs.iter().map(|&source| input(source)).chain(literals).collect();
    for operation in &program.operations {
        let [a, b] = operation.operands().map(|at| values[at]);
        values.push(match operation {
            Operation::Negate(_) => -a,
            Operation::Add(..) => a + b,
            Operation::Subtract(..) => a - b,
            Operation::Multiply(..) => a * b,
            Operation::Divide(..) => a / b,
            Operation::Apply(function, _) => a.apply(*function),
        });
    }
    program.outputs.iter().map(|&at| values[at as usize]).collect()
}

/// The arrays of a step.
#[derive(Clone, Default)]
pub(super) struct Numbers<T>(pub(super) Vec<(Array, Vec<T>)>);

impl<T: Number> Numbers<T> {
    pub(super) fn with(&self, array: Array, numbers: &[T]) -> Self {
        let others = self.0.iter().filter(|(known, _)| *known != array).cloned();
        Self(others.chain([(array, numbers.to_vec())]).collect())
    }

    pub(super) fn run(&self, program: &Program) -> Vec<T> {
        run(program, |source| {
            let found = self.0.iter().find(|(array, _)| *array == source.array);
            found.unwrap_or_else(|| panic!("{:?} isn't given", source.array)).1[source.at]
        })
    }
}

/// A program with these values as outputs.
pub(super) fn program(of: impl FnOnce(&mut Words) -> Vec<Symbol>) -> Program {
    let mut words = Words::default();
    let outputs = of(&mut words);
    words.program(&outputs)
}

pub(super) fn inputs(array: Array, count: usize) -> Program {
    program(|_| Symbol::inputs(array, count))
}

/// A declaration on these factors, whose residual is `c + J y` of half the coordinates `y`, and whose inertia is the identity.
pub(super) fn declared(factors: &[Generators], carried: Vec<Carried>) -> StagedDeclaration {
    let n: usize = factors.iter().map(Vec::len).sum();
    let length = |one: &Carried| one.shape.0 * one.shape.1;
    let at_rest = program(|_| {
        let inertia = (0..n * n).map(|at| Symbol::one_if(at / n == at % n));
        inertia.chain(vec![Symbol::ZERO; n + 1]).collect()
    });
    let residual = |words: &mut Words| {
        let (constants, half) = (Symbol::inputs(Array::Constants, n + n * n), Symbol::inputs(Array::Half, n));
        let image: Vec<Symbol> = constants[n..].chunks(n).map(|row| words.dot(row, &half)).collect();
        words.added(&constants[..n], &image)
    };
    let jacobian = Symbol::inputs(Array::Constants, n + n * n).split_off(n);
    StagedDeclaration {
        name: "Body".to_owned(),
        role: Role::Lagrangian,
        factors: factors.iter().map(|one| Factor { name: "Own".to_owned(), generators: one.clone() }).collect(),
        parameters: (carried.iter())
            .map(|one| Parameter { name: "w".to_owned(), kind: ParameterKind::Vector(length(one)) })
            .collect(),
        carried,
        energy: None,
        derivation: String::new(),
        has_kinetic: true,
        has_force: false,
        parts: [true, false, false],
        denominators: 0,
        has_constant_inertia: true,
        is_quadratic: true,
        is_self_adjoint: true,
        in_increment: false,
        blocks: Vec::new(),
        constraints: liestep_derivation::Constraints::default(),
        programs: Stages {
            constants: inputs(Array::Parameters, n + n * n),
            kick_before: program(|_| vec![Symbol::ZERO; n]),
            newton_system: program(|words| [residual(words), jacobian].concat()),
            newton_residual: program(residual),
            kick_after: program(|_| vec![Symbol::ZERO; n]),
            kick_derivative: None,
            momentum_jacobian: program(|_| (0..n * n).map(|at| Symbol::one_if(at / n == at % n)).collect()),
            at_rest,
            at_velocity: None,
            lagrangian: None,
        },
    }
}

/// Fields with their values in space, one for each action.
pub(super) fn carried(actions: &[(Action, (usize, usize))]) -> Vec<Carried> {
    let all = actions.iter().enumerate();
    all.map(|(field, &(action, shape))| Carried { field: Some(field), action, shape }).collect()
}

/// A step of a declaration with the arrays that its programs read.
pub(super) struct StepInputs<T> {
    pub(super) step: WholeStep,
    pub(super) half: Vec<T>,
    pub(super) numbers: Numbers<T>,
}

impl<T: Number> StepInputs<T> {
    /// A step with random numbers, from the identity.
    pub(super) fn of(staged: &StagedDeclaration, mut next: impl FnMut() -> T) -> Self {
        let step = WholeStep::of(staged).expect("a step");
        let n = step.sizes.n;
        let mut some = |count: usize| (0..count).map(|_| next()).collect::<Vec<T>>();
        let half = some(n);
        let parameters: usize = staged.parameters.iter().map(|one| one.kind.len()).sum();
        let numbers = Numbers(vec![
            (Array::Half, half.clone()),
            (Array::Target, some(n)),
            (Array::Momentum, some(n)),
            (Array::Velocity, some(n)),
            (Array::History, some(2 * n)),
            (Array::Constants, some(n + n * n)),
            (Array::Parameters, some(parameters)),
            (Array::Attitude, step.factors.iter().flat_map(|f| Value::<T>::identity(f.size()).entries).collect()),
        ]);
        let moving = Self { step, half, numbers };
        let advected = moving.numbers.run(&moving.step.programs.seen);
        moving.with(Array::Advected, &advected)
    }

    pub(super) fn with(self, array: Array, numbers: &[T]) -> Self {
        Self { numbers: self.numbers.with(array, numbers), ..self }
    }

    /// The outputs of the last program of a step.
    pub(super) fn finished(&self) -> Vec<T> {
        self.numbers.run(&self.step.programs.finish)
    }

    /// The increments of half coordinates: the attitudes after a step from the identity.
    pub(super) fn increments(&self) -> Vec<Value<T>> {
        let identity: Vec<T> = self.step.factors.iter().flat_map(|f| Value::<T>::identity(f.size()).entries).collect();
        let numbers = self.numbers.with(Array::Attitude, &identity);
        self.matrices(&numbers.run(&self.step.programs.finish))
    }

    /// The matrices of all factors in a state or an attitude.
    pub(super) fn matrices(&self, state: &[T]) -> Vec<Value<T>> {
        let of = |factor: &MatrixFactor| {
            let (n, first) = (factor.size(), factor.entry);
            Value::new(n, n, |i, j| state[first + i * n + j])
        };
        self.step.factors.iter().map(of).collect()
    }
}

pub(super) fn difference<T: Number>(a: &Value<T>, b: &Value<T>) -> Value<T> {
    a.zip(b, |a, b| a - b)
}

/// Whether two matrices are equal, in a field without rounding.
pub(super) fn are_equal<T: Number>(a: &Value<T>, b: &Value<T>) -> bool {
    (a.rows, a.columns) == (b.rows, b.columns) && difference(a, b).entries.iter().all(|entry| entry.is_zero())
}
