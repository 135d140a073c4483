//! The trait of effects whose steps can be differentiated.

use core::ops::Add;

use crate::mechanics::effect::{Effect, Matrix, Scalar, Square, Vector};
use crate::mechanics::sum::Sum;
use crate::numbers::Entries as _;

/// An effect with the derivatives of its shares in the momenta at both ends of a step: what the tangent map and the
/// adjoint of a step are made of, see [`Stepper::linearised`](crate::Stepper::linearised).
///
/// They are those of the share `μ(F, w)` in the momentum equation (2.7) and of the share `μ⁺(F, w)` in (2.6), the one before
/// the step and the other after it, along a turn `ε` of the increment and a displacement `ζ` of the body, `g ← g exp ζ̂`:
///
/// ```text
/// δF = ε̂ F        δw = −ζ·w
/// ```
///
/// Of a Lagrangian these are second derivatives of `l_d`. A force has `−f⁻` for `μ` and `f⁺` for `μ⁺`. All are additive.
///
/// `#[lagrangian(…, gradients)]` and `#[force(…, gradients)]` implement it, the effects of the library are declared so, and
/// a sum has it if both terms have. Where nothing asks for it, nothing of it is in the program.
///
/// # Source
///
/// \[RDAE, (2.6), (2.7)\], differentiated; [`motion::linearised`](crate::motion::linearised) has the formulas.
#[diagnostic::on_unimplemented(
    message = "the derivatives of the steps of `{Self}` aren't known",
    label = "declared without `gradients`",
    note = "add the word to its attribute: `#[lagrangian(…, gradients)]` or `#[force(…, gradients)]`; all terms of a \
            sum need it"
)]
pub trait SecondDerivatives: Effect {
    /// How many scalars [`describe`](Effect::describe) shows.
    const PARAMETERS: usize;

    /// The derivatives along turns and displacements; `increment` is `F − I`.
    fn step_derivatives(
        &self,
        increment: &Matrix<Self>,
        w: &Self::Advected,
        h: Scalar<Self>,
    ) -> StepDerivatives<Square<Self>>;

    /// The derivatives of `μ` and `μ⁺` by the scalars of the parameters, as [`describe`](Effect::describe) numbers them,
    /// at fixed `w`; what isn't visited is zero.
    ///
    /// A symmetric matrix has all nine scalars: for a symmetric change `δ` of it, the sum over them of derivative times
    /// change is the change of the momentum.
    fn by_parameters(
        &self,
        increment: &Matrix<Self>,
        w: &Self::Advected,
        h: Scalar<Self>,
        visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>),
    );

    /// The same by the scalars of `w`, as [`Entries`](crate::numbers::Entries) numbers them.
    fn by_advected(
        &self,
        increment: &Matrix<Self>,
        w: &Self::Advected,
        h: Scalar<Self>,
        visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>),
    );

    /// Visits each scalar of [`advected`](crate::mechanics::Term::advected) that is a parameter: its number there, and that among the
    /// parameters. A field that is advected under two names is visited for each.
    fn carried_parameters(w: &Self::Advected, visit: &mut dyn FnMut(usize, usize));
}

/// The derivatives of the momenta `μ` and `μ⁺` along turns `ε` and displacements `ζ`: entry `(k, j)` of each is that of
/// component `k` along `E_j`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDerivatives<M> {
    /// `∂μ/∂ε`, the exact Newton Jacobian [`momentum_jacobian`](Effect::momentum_jacobian).
    pub start_by_turn: M,
    /// `∂μ⁺/∂ε`.
    pub end_by_turn: M,
    /// `∂μ/∂ζ`, at fixed `F`.
    pub start_by_place: M,
    /// `∂μ⁺/∂ζ`, at fixed `F`.
    pub end_by_place: M,
}

impl<M: Add<Output = M>> Add for StepDerivatives<M> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            start_by_turn: self.start_by_turn + other.start_by_turn,
            end_by_turn: self.end_by_turn + other.end_by_turn,
            start_by_place: self.start_by_place + other.start_by_place,
            end_by_place: self.end_by_place + other.end_by_place,
        }
    }
}

impl<A, B> SecondDerivatives for Sum<A, B>
where
    A: SecondDerivatives,
    B: SecondDerivatives<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
    const PARAMETERS: usize = A::PARAMETERS + B::PARAMETERS;

    #[inline(always)]
    fn step_derivatives(
        &self,
        increment: &Matrix<Self>,
        w: &Self::Advected,
        h: Scalar<Self>,
    ) -> StepDerivatives<Square<Self>> {
        self.first.step_derivatives(increment, &w.0, h) + self.second.step_derivatives(increment, &w.1, h)
    }

    #[inline(always)]
    fn by_parameters(
        &self,
        increment: &Matrix<Self>,
        w: &Self::Advected,
        h: Scalar<Self>,
        visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>),
    ) {
        self.first.by_parameters(increment, &w.0, h, visit);
        self.second.by_parameters(increment, &w.1, h, &mut |number, start, end| {
            visit(A::PARAMETERS + number, start, end);
        });
    }

    #[inline(always)]
    fn by_advected(
        &self,
        increment: &Matrix<Self>,
        w: &Self::Advected,
        h: Scalar<Self>,
        visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>),
    ) {
        let mut before = 0;
        w.0.each(&mut |_| before += 1);
        self.first.by_advected(increment, &w.0, h, visit);
        self.second.by_advected(increment, &w.1, h, &mut |number, start, end| visit(before + number, start, end));
    }

    fn carried_parameters(w: &Self::Advected, visit: &mut dyn FnMut(usize, usize)) {
        let mut before = 0;
        w.0.each(&mut |_| before += 1);
        A::carried_parameters(&w.0, visit);
        B::carried_parameters(&w.1, &mut |place, number| visit(before + place, A::PARAMETERS + number));
    }
}
