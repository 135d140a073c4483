//! A declaration on SO(3) as a scene of the library, for its methods that know the free body: splittings, processed ones,
//! collocation in quaternions, compensated sums of divided steps.
//!
//! Whatever is advected is seen from the attitude, so that one type carries all: the directions of space, as seen from the
//! body.

use std::sync::Arc;

use liestep::groups::{CayleyRetraction, Retraction};
use liestep::mechanics::{DiscreteLagrangian, Effect, Facts, Limit, SceneVisitor, Term, WithKinetic};
use liestep::numbers::Entries;
use liestep::{SO3, SetupError};
use liestep_derivation::whole::in_directions;
use liestep_derivation::{Array, StagedDeclaration, Stages};
use nalgebra::{Matrix3, Vector3};

use crate::code::Backend;
use crate::declaration::{Declaration, Ready, ready};
use crate::error::LateError;

/// The directions of space as seen from the body: the rows of the attitude.
type Directions = (Vector3<f64>, Vector3<f64>, Vector3<f64>);

/// The code of the stages, by the directions of space.
#[derive(Debug)]
struct ByDirections<C>(Arc<Stages<Ready<C>>>);

/// A declaration on SO(3) with the numbers of its parameters.
#[derive(Debug)]
pub(super) struct RotatingScene<B: Backend<f64>> {
    declaration: &'static Declaration,
    stages: Arc<Stages<Ready<B::Code>>>,
    numbers: Arc<[f64]>,
}

impl<B: Backend<f64>> Clone for RotatingScene<B> {
    fn clone(&self) -> Self {
        let (stages, numbers) = (Arc::clone(&self.stages), Arc::clone(&self.numbers));
        Self { declaration: self.declaration, stages, numbers }
    }
}

/// The constants of a step.
#[derive(Clone, Debug)]
pub(super) struct RotatingConstants<B: Backend<f64>> {
    scene: RotatingScene<B>,
    numbers: Arc<[f64]>,
}

impl<B: Backend<f64>> PartialEq for RotatingConstants<B> {
    fn eq(&self, other: &Self) -> bool {
        let is_same = std::ptr::eq(self.scene.declaration, other.scene.declaration);
        is_same && self.numbers == other.numbers && self.scene.numbers == other.scene.numbers
    }
}

impl<B: Backend<f64>> RotatingScene<B> {
    /// The scene of a declaration on SO(3) with the numbers of all parameters.
    pub(super) fn of(declaration: &'static Declaration, numbers: &[f64]) -> Result<Self, LateError> {
        let stages = declaration.once(|| {
            let programs = in_directions(declaration).map_err(LateError::Step)?;
            Ok(ByDirections(Arc::new(ready::<B>(&programs)?)))
        })?;
        Ok(Self { declaration, stages: Arc::clone(&stages.0), numbers: numbers.into() })
    }

    /// A term of the Lagrangian at `F`, the directions and `h`; zero for a force.
    fn term(&self, program: &Ready<B::Code>, (f, w, h): (&Matrix3<f64>, &Directions, f64)) -> Vec<f64> {
        let (element, inverse) = (list(f), list(&f.transpose()));
        let given = [
            (Array::Step, std::slice::from_ref(&h)),
            (Array::Parameters, &*self.numbers),
            (Array::Advected, &list(w)),
            (Array::Element, &element),
            (Array::Inverse, &inverse),
        ];
        let mut outputs = vec![0.0; program.outputs];
        B::run(&program.code, &[], given, &mut outputs);
        outputs
    }

    fn of_lagrangian(&self, index: usize, at: (&Matrix3<f64>, &Directions, f64)) -> Vec<f64> {
        self.stages.lagrangian.as_ref().map_or_else(|| vec![0.0; 3], |terms| self.term(&terms[index], at))
    }
}

impl<B: Backend<f64>> RotatingConstants<B> {
    /// The outputs of a program of a step, of at most this many numbers.
    fn run<const N: usize, const M: usize>(&self, program: &Ready<B::Code>, given: [(Array, &[f64]); N]) -> [f64; M] {
        let mut outputs = [0.0; M];
        B::run(&program.code, &self.numbers, given, &mut outputs[..program.outputs.min(M)]);
        outputs
    }
}

/// The entries of a value; those of a matrix row by row.
fn list<E: Entries<f64>>(value: &E) -> [f64; 9] {
    let (mut list, mut at) = ([0.0; 9], 0);
    value.each(&mut |entry| {
        list[at % 9] = entry;
        at += 1;
    });
    list
}

fn square(entries: &[f64]) -> Matrix3<f64> {
    Matrix3::from_row_slice(&entries[..9])
}

fn vector(entries: &[f64]) -> Vector3<f64> {
    Vector3::new(entries[0], entries[1], entries[2])
}

impl<B: Backend<f64>> Term for RotatingScene<B> {
    type Scalar = f64;
    type Group = SO3;
    type Advected = Directions;

    fn validate(&self) -> Result<(), SetupError> {
        self.declaration.check(&self.numbers)
    }

    fn advected(&self) -> Directions {
        (Vector3::x(), Vector3::y(), Vector3::z())
    }
}

impl<B: Backend<f64>> Effect for RotatingScene<B> {
    type Retraction = CayleyRetraction;
    type Kinetic = WithKinetic;
    type Constants = RotatingConstants<B>;
    type StepTerms = (Vector3<f64>, Directions);

    // Whoever asks for steps that undo each other asks the declaration first.
    const FACTS: Facts = Facts { is_self_adjoint: true, ..Facts::ANY };
    const DERIVATION: &'static str = "a declaration that was read while the program runs; see its derivation\n";

    fn facts(&self) -> Facts {
        let StagedDeclaration { denominators, has_constant_inertia, is_quadratic, .. } = **self.declaration;
        let parts = self.declaration.parts;
        Facts { parts, denominators, has_constant_inertia, is_quadratic, ..Self::FACTS }
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(&self.declaration.derivation);
        for (index, parameter) in self.declaration.parameters.iter().enumerate() {
            let (start, length) = self.declaration.place(index);
            let own = self.numbers.iter().skip(start).take(length);
            own.for_each(|&number| visitor.parameter(&parameter.name, number));
        }
    }

    fn momentum_jacobian(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> Matrix3<f64> {
        square(&self.term(&self.stages.momentum_jacobian, (f, w, h)))
    }

    fn limit(&self, velocity: Option<&Vector3<f64>>, w: &Directions) -> Limit<Self> {
        let (w, zero) = (list(w), Vector3::zeros());
        let of = |program: &Ready<B::Code>| {
            let given = [
                (Array::Parameters, &*self.numbers),
                (Array::Advected, &w[..]),
                (Array::Velocity, velocity.unwrap_or(&zero).as_slice()),
            ];
            let mut outputs = [0.0; 13];
            B::run(&program.code, &[], given, &mut outputs[..program.outputs.min(13)]);
            outputs
        };
        if let (Some(_), Some(programs)) = (velocity, &self.stages.at_velocity) {
            let [l, momentum, hessian] = programs.each_ref().map(of);
            return Limit { l: l[0], momentum: vector(&momentum), hessian: square(&hessian) };
        }
        let at_rest = of(&self.stages.at_rest);
        Limit::quadratic(velocity, square(&at_rest), vector(&at_rest[9..]), at_rest[12])
    }

    fn constants(&self, h: f64) -> Self::Constants {
        let program = &self.stages.constants;
        let mut numbers = vec![0.0; program.outputs];
        let given = [(Array::Step, std::slice::from_ref(&h)), (Array::Parameters, &*self.numbers)];
        B::run(&program.code, &[], given, &mut numbers);
        RotatingConstants { scene: self.clone(), numbers: numbers.into() }
    }

    fn are_finite(constants: &Self::Constants) -> bool {
        constants.numbers.iter().all(|number| number.is_finite())
    }

    #[inline]
    fn kick_before(constants: &Self::Constants, w: &Directions) -> Vector3<f64> {
        let RotatingScene { stages, numbers, .. } = &constants.scene;
        let kick = constants.run(&stages.kick_before, [(Array::Parameters, &**numbers), (Array::Advected, &list(w))]);
        Vector3::from(kick)
    }

    fn kick_derivative(constants: &Self::Constants, w: &Directions, velocity: &Vector3<f64>) -> Option<Vector3<f64>> {
        let RotatingScene { stages, numbers, .. } = &constants.scene;
        let program = stages.kick_derivative.as_ref()?;
        let given =
            [(Array::Parameters, &**numbers), (Array::Advected, &list(w)), (Array::Velocity, velocity.as_slice())];
        Some(Vector3::from(constants.run(program, given)))
    }

    fn step_terms(_: &Self::Constants, a: &Vector3<f64>, w: &Directions) -> Self::StepTerms {
        (*a, *w)
    }

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector3<f64>,
    ) -> (Vector3<f64>, Matrix3<f64>) {
        let outputs: [f64; 12] = iteration(constants, &constants.scene.stages.newton_system, terms, half);
        let (residual, jacobian) = (vector(&outputs), square(&outputs[3..]));
        if !constants.scene.declaration.in_increment {
            return (residual, jacobian);
        }
        let tangent: Matrix3<f64> = <CayleyRetraction as Retraction<SO3>>::tangent_of_half(half);
        (residual, jacobian * tangent)
    }

    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector3<f64>) -> Vector3<f64> {
        let outputs: [f64; 3] = iteration(constants, &constants.scene.stages.newton_residual, terms, half);
        Vector3::from(outputs)
    }

    fn kick_after(constants: &Self::Constants, increment: &Matrix3<f64>, next: &Directions) -> Vector3<f64> {
        let RotatingScene { stages, numbers, .. } = &constants.scene;
        let inverse = list(&(increment + Matrix3::identity()).transpose());
        let given = [
            (Array::Parameters, &**numbers),
            (Array::Increment, &list(increment)),
            (Array::Next, &list(next)),
            (Array::Inverse, &inverse),
        ];
        Vector3::from(constants.run(&stages.kick_after, given))
    }
}

/// The outputs of a program of the momentum equation at half the coordinates of an increment.
fn iteration<B: Backend<f64>, const M: usize>(
    constants: &RotatingConstants<B>,
    program: &Ready<B::Code>,
    (target, w): &(Vector3<f64>, Directions),
    half: &Vector3<f64>,
) -> [f64; M] {
    let increment = <CayleyRetraction as Retraction<SO3>>::increment_of_half(half);
    let given = [
        (Array::Parameters, &*constants.scene.numbers),
        (Array::Half, half.as_slice()),
        (Array::Target, target.as_slice()),
        (Array::Advected, &list(w)),
        (Array::Increment, &list(&increment)),
        (Array::InverseIncrement, &list(&increment.transpose())),
    ];
    constants.run(program, given)
}

impl<B: Backend<f64>> DiscreteLagrangian for RotatingScene<B> {
    fn l_d(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> f64 {
        self.of_lagrangian(0, (f, w, h))[0]
    }

    fn right_momentum(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> Vector3<f64> {
        vector(&self.of_lagrangian(1, (f, w, h)))
    }

    fn left_momentum(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> Vector3<f64> {
        vector(&self.of_lagrangian(2, (f, w, h)))
    }

    fn diamond(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> Vector3<f64> {
        vector(&self.of_lagrangian(3, (f, w, h)))
    }

    fn legendre_minus(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> Vector3<f64> {
        vector(&self.of_lagrangian(4, (f, w, h)))
    }

    fn discrete_energy(&self, f: &Matrix3<f64>, w: &Directions, h: f64) -> f64 {
        self.of_lagrangian(5, (f, w, h))[0]
    }
}
