//! Constraints that are linear in the velocities, `A(w)·ξ = 0`, as programs.

use super::{Array, Program, Source, StagedDeclaration, Stages};

/// A constraint on velocities as programs of increments, advected parameters and constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint<P = Program> {
    /// The constraint at the increment, `h c(F, w)`.
    pub at_increment: P,
    /// The derivative of that along `exp(t E_k) F`.
    pub slope: P,
    /// The covector `A(w)` of the reaction.
    pub reaction: P,
}

impl<P> Constraint<P> {
    /// Maps all programs.
    pub fn map<Q>(&self, mut make: impl FnMut(&P) -> Q) -> Constraint<Q> {
        Constraint { at_increment: make(&self.at_increment), slope: make(&self.slope), reaction: make(&self.reaction) }
    }
}

/// The constraints of a declaration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraints {
    /// All constraints.
    pub each: Vec<Constraint>,
    /// The inertia, the bias and the potential at rest, of advected parameters and constants; none of a constraint alone.
    pub at_rest: Option<Program>,
    /// The index among the constants of the scale of the constraints, and behind it of `2/h`.
    pub scale: usize,
}

impl StagedDeclaration {
    /// The declaration of a constraint, whose Lagrangian is linear in the velocity, without the effects of that Lagrangian.
    pub(super) fn into_constraint(self, reaction: Program) -> Self {
        let n = self.programs.kick_before.outputs.len();
        let Some([at_increment, slope, ..]) = self.programs.lagrangian else { return self };
        let mut constraint = Constraint { at_increment, slope, reaction };
        let mut constants = Constants(zeros(0));
        for program in [&mut constraint.at_increment, &mut constraint.slope, &mut constraint.reaction] {
            constants.fold(program);
        }
        Self {
            parts: [false; 3],
            denominators: 0,
            has_constant_inertia: true,
            is_quadratic: true,
            blocks: Vec::new(),
            constraints: Constraints { each: vec![constraint], ..Constraints::default() },
            programs: Stages { constants: constants.0, ..Stages::zeros(n) },
            ..self
        }
    }
}

impl Stages<Program> {
    /// The programs of a declaration that is no part of a momentum equation of this dimension.
    pub(super) fn zeros(n: usize) -> Self {
        Self {
            constants: zeros(0),
            kick_before: zeros(n),
            newton_system: zeros(n + n * n),
            newton_residual: zeros(n),
            kick_after: zeros(n),
            kick_derivative: None,
            momentum_jacobian: zeros(n * n),
            at_rest: zeros(n * n + n + 1),
            at_velocity: None,
            lagrangian: None,
        }
    }
}

/// The program of so many zeros.
fn zeros(count: usize) -> Program {
    Program { inputs: Vec::new(), literals: vec![0.0], operations: Vec::new(), outputs: vec![0; count] }
}

/// A program of constants that gets more of them.
pub(crate) struct Constants(pub(crate) Program);

impl Constants {
    /// Makes a program read its parameters, and the step, from among the constants.
    pub(crate) fn fold(&mut self, program: &mut Program) {
        for source in &mut program.inputs {
            if matches!(source.array, Array::Parameters | Array::Step) {
                *source = Source::new(Array::Constants, self.place(*source));
            }
        }
    }

    /// The index of the constant that is this input.
    fn place(&mut self, source: Source) -> usize {
        let known = |inputs: &[Source], outputs: &[u32]| {
            let register = inputs.iter().position(|known| *known == source)?;
            outputs.iter().position(|&output| output as usize == register)
        };
        let Self(Program { inputs, operations, outputs, .. }) = self;
        if let Some(at) = known(inputs, outputs) {
            return at;
        }
        let at = inputs.iter().position(|known| *known == source).unwrap_or_else(|| {
            // A new input comes behind the others, and all registers behind it move.
            let first = u32::try_from(inputs.len()).unwrap_or(u32::MAX);
            let moved = |register: u32| register + u32::from(register >= first);
            for operation in operations.iter_mut() {
                *operation = operation.of(operation.read().map(moved));
            }
            for output in outputs.iter_mut() {
                *output = moved(*output);
            }
            inputs.push(source);
            inputs.len() - 1
        });
        outputs.push(u32::try_from(at).unwrap_or(u32::MAX));
        outputs.len() - 1
    }
}
