//! The programs of a declaration's step as code, shared by steppers of other numbers and other steps.

use std::sync::Arc;

use liestep::SetupError;
use liestep::motion::{Factor, FactorKind, Layout};
use liestep_derivation::whole::{Form, MatrixFactor, Sizes, WholeStep};
use liestep_derivation::{Array, ParameterKind, Program};

use crate::code::Backend;
use crate::declaration::Declaration;
use crate::error::LateError;

/// The programs of a step by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Name {
    Constants,
    Target,
    Iterate,
    Again,
    Finish,
    Seen,
    Restored,
    Defect,
    Inertia,
    Velocity,
    Momentum,
    Energy,
    Spatial,
    Rest,
    Safe,
    Hessian,
}

/// Code, and its number of outputs.
#[derive(Debug)]
struct Coded<C> {
    code: C,
    outputs: usize,
}

/// The step of a declaration on any group, for steppers of all numbers and steps: derived once, and shared.
#[derive(Debug)]
pub struct WholeFamily<B: Backend<f64>> {
    pub(super) declaration: &'static Declaration,
    pub(super) sizes: Sizes,
    pub(super) factors: Vec<MatrixFactor>,
    pub(super) layout: Layout,
    /// All programs in the order of [`Name`]; the last two are missing where they aren't needed.
    codes: Vec<Option<Coded<B::Code>>>,
}

/// Inputs of a program that it doesn't read.
pub(super) const NOTHING: (Array, &[f64]) = (Array::Target, &[]);

impl<B: Backend<f64>> WholeFamily<B> {
    /// Writes the step of a declaration, and the code of its programs.
    ///
    /// # Errors
    ///
    /// [`LateError::Step`] if the group has no retraction here, or the step is too long; [`LateError::Pace`] with a pace.
    pub fn of(declaration: &'static Declaration) -> Result<Arc<Self>, LateError> {
        if declaration.energy.is_some() {
            return Err(LateError::Pace);
        }
        let WholeStep { sizes, factors, programs } = WholeStep::of(declaration)?;
        let all: [Option<&Program>; 16] = [
            Some(&programs.constants),
            Some(&programs.target),
            Some(&programs.iterate),
            Some(&programs.again),
            Some(&programs.finish),
            Some(&programs.seen),
            Some(&programs.restored),
            Some(&programs.defect),
            Some(&programs.inertia),
            Some(&programs.velocity),
            Some(&programs.momentum),
            Some(&programs.energy),
            Some(&programs.spatial),
            Some(&programs.rest),
            programs.safe.as_ref(),
            programs.hessian.as_ref(),
        ];
        let list: Vec<&Program> = all.into_iter().flatten().collect();
        let mut codes = B::codes(&list)?.into_iter();
        let coded = |program: Option<&Program>| {
            let program = program?;
            Some(Coded { code: codes.next()?, outputs: program.outputs.len() })
        };
        let codes = all.into_iter().map(coded).collect();
        let layout = layout(declaration, &factors, &sizes);
        Ok(Arc::new(Self { declaration, sizes, factors, layout, codes }))
    }

    /// The declaration.
    #[must_use]
    pub const fn declaration(&self) -> &'static Declaration {
        self.declaration
    }

    /// Names, units and places of a state's numbers.
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    pub(super) fn has(&self, name: Name) -> bool {
        self.codes[name as usize].is_some()
    }

    /// Runs a program; a missing one writes nothing.
    pub(super) fn run<const N: usize>(
        &self,
        name: Name,
        constants: &[f64],
        given: [(Array, &[f64]); N],
        outputs: &mut [f64],
    ) {
        if let Some(coded) = &self.codes[name as usize] {
            B::run(&coded.code, constants, given, &mut outputs[..coded.outputs]);
        }
    }

    /// The outputs of a program that runs seldom.
    pub(super) fn outputs<const N: usize>(
        &self,
        name: Name,
        constants: &[f64],
        given: [(Array, &[f64]); N],
    ) -> Vec<f64> {
        let mut outputs = vec![0.0; self.codes[name as usize].as_ref().map_or(0, |coded| coded.outputs)];
        self.run(name, constants, given, &mut outputs);
        outputs
    }

    /// Makes machine code now of the programs that a step runs, if the back end does so after some runs.
    pub fn prepare(&self) {
        self.codes.iter().flatten().for_each(|coded| B::prepare(&coded.code));
    }

    /// Checks the numbers of all parameters.
    pub(super) fn check(&self, numbers: &[f64]) -> Result<(), SetupError> {
        let parameters = &self.declaration.parameters;
        let expected = parameters.iter().map(|parameter| parameter.kind.len()).sum();
        if numbers.len() != expected {
            return Err(SetupError::Length { what: "list of all parameters", found: numbers.len(), expected });
        }
        let mut first = 0;
        for parameter in parameters {
            let value = &numbers[first..first + parameter.kind.len()];
            first += value.len();
            let field = parameter.name.as_str();
            if !value.iter().all(|number| number.is_finite()) {
                return Err(SetupError::Parameter { field, cause: "is not finite, or wasn't given" });
            }
            let is_symmetric =
                || (0..9).all(|entry| value[entry].to_bits() == value[entry % 3 * 3 + entry / 3].to_bits());
            if parameter.kind == ParameterKind::Inertia && !is_symmetric() {
                return Err(SetupError::Parameter { field, cause: "is not symmetric" });
            }
        }
        Ok(())
    }

    /// Whether a component of the velocity is a rate of turn: its generator is antisymmetric.
    pub(super) fn turns(&self, component: usize) -> bool {
        let mut before = 0;
        for (own, factor) in self.declaration.factors.iter().zip(&self.factors) {
            if let Some(generator) = component.checked_sub(before).and_then(|k| own.generators.get(k)) {
                let (rows, mut at) = (factor.size(), 0..generator.len());
                return at.all(|at| {
                    let opposite = generator[at % rows * rows + at / rows];
                    (generator[at] + opposite).abs() <= 0.0
                });
            }
            before += own.generators.len();
        }
        false
    }
}

fn layout(declaration: &Declaration, factors: &[MatrixFactor], sizes: &Sizes) -> Layout {
    let kind = |factor: &MatrixFactor| match factor.form {
        Form::Rotation => FactorKind::Rotation,
        Form::Translation => FactorKind::Translation(factor.size()),
        _ => FactorKind::Matrix(factor.size()),
    };
    let named = factors.iter().map(|factor| Factor::of(kind(factor), factor.dimension()));
    let factors = if factors.len() > 1 {
        (1..).zip(named).map(|(place, factor)| factor.at(place)).collect()
    } else {
        named.collect()
    };
    let advected = declaration.carried.iter().enumerate().flat_map(|(number, carried)| {
        let (rows, columns) = carried.shape;
        (1..=rows * columns).map(move |entry| format!("advected_{}_{entry}", number + 1))
    });
    Layout { factors, advected: advected.collect(), memory: 3 * sizes.n }
}
