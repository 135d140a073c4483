//! The trait of effects with derivatives of their steps.

use core::ops::Add;

use crate::groups::LieGroup;
use crate::mechanics::effect::{Effect, Group, Scalar, Square, Vector};
use crate::mechanics::sum::Sum;
use crate::mechanics::term::Term;
use crate::numbers::{Entries, Real, zero};

/// An effect with the derivatives of its parts of the momenta at both ends of a step. The tangent map and the adjoint
/// of a step consist of these, see [`Stepper::linearised`](crate::Stepper::linearised).
///
/// They are the derivatives of the part `μ(F, w)` in the momentum equation (2.7), before the step, and of `μ⁺(F, w)` in
/// (2.6), after it, along a turn `ε` of the increment and a displacement `ζ` of the body, `g ← g exp ζ̂`:
///
/// ```text
/// δF = ε̂ F        δw = −ζ·w
/// ```
///
/// For a Lagrangian these are second derivatives of `l_d`. A force has `−f⁻` for `μ` and `f⁺` for `μ⁺`. All are
/// additive.
///
/// `#[lagrangian(…, gradients)]` and `#[force(…, gradients)]` implement it, the effects of the library are declared so,
/// and a sum has it if both terms have. Code for unused derivatives isn't part of the program.
///
/// # Source
///
/// \[RDAE, (2.6), (2.7)\], differentiated; [`gradients`](crate::gradients) has the formulas.
#[diagnostic::on_unimplemented(
    message = "the derivatives of the steps of `{Self}` aren't known",
    label = "declared without `gradients`",
    note = "add the word to its attribute: `#[lagrangian(…, gradients)]` or `#[force(…, gradients)]`; all terms of a \
            sum need it"
)]
pub trait SecondDerivatives: Effect {
    /// The number of scalars that [`describe`](Effect::describe) visits.
    const PARAMETERS: usize;

    /// The derivatives along turns and displacements.
    fn step_derivatives(&self, at: PointOf<'_, Self>) -> StepDerivatives<Square<Self>>;

    /// The derivatives of `μ` and `μ⁺` with respect to the scalars of the parameters, in the numbering of
    /// [`describe`](Effect::describe), at fixed `w`; derivatives that aren't visited are zero.
    ///
    /// A symmetric matrix has all nine scalars: for a symmetric change `δ` of it, the change of the momentum is the sum
    /// over them of derivative times change.
    fn by_parameters(&self, at: PointOf<'_, Self>, visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>));

    /// The derivatives of `μ` and `μ⁺` with respect to the scalars of `w`, in the numbering of
    /// [`Entries`](crate::numbers::Entries).
    fn by_advected(&self, at: PointOf<'_, Self>, visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>));

    /// Visits each scalar of [`advected`](crate::mechanics::Term::advected) that is a parameter: its number there, and
    /// its number among the parameters. A field that is advected under two names is visited for each.
    fn carried_parameters(visit: &mut impl FnMut(usize, usize));

    /// The effect's part of the linear system of a step's adjoint: `∂μ/∂ε`, whose entry `(k, j)` is the derivative of
    /// component `k` along `E_j`, and the covector `(∂μ⁺/∂ε)ᵀ p`. Let `p`, passed as `at_end`, be the derivative of a
    /// number with respect to `μ⁺`, and the covector `a` that with respect to the configuration after the step. The
    /// system is
    ///
    /// ```text
    /// (∂μ/∂ε)ᵀ u = Ad*_{F⁻¹} a + (∂μ⁺/∂ε)ᵀ p
    /// ```
    ///
    /// Its solution `u` is the derivative of that number with respect to `μ`. Both `u` and `p` are in the algebra: for
    /// a number without a unit, on SO(3) in 1/(kg m²/s). The matrix has the unit of a momentum per `ε`, on SO(3) kg
    /// m²/s per rad.
    ///
    /// This function and [`adjoint_gradient`](Self::adjoint_gradient) are in reverse mode, so they cost a few times the
    /// operations of the momenta, and not as much as all derivatives.
    fn adjoint_system(&self, at: PointOf<'_, Self>, at_end: &Vector<Self>) -> (Square<Self>, Vector<Self>);

    /// The gradient of `⟨p, μ⁺⟩ − ⟨u, μ⟩` at a fixed increment, for `ends = [u, p]`: `u` pairs with the momentum `μ` at the
    /// start and solves the system of [`adjoint_system`](Self::adjoint_system), `p` pairs with `μ⁺` at the end.
    ///
    /// Returns the covector along displacements `ζ` of the body before the step, with component `k` along `E_k`, and
    /// the derivatives with respect to the scalars of `w`, each in the place of its scalar. The derivatives with
    /// respect to the parameters, at fixed `w`, are visited by number, as in [`by_parameters`](Self::by_parameters); a
    /// number that is visited twice is summed. Each has the unit of the number per unit of the variable.
    fn adjoint_gradient(
        &self,
        at: PointOf<'_, Self>,
        ends: [&Vector<Self>; 2],
        visit: &mut impl FnMut(usize, Scalar<Self>),
    ) -> (Vector<Self>, Self::Advected);

    /// The gradient of `⟨u, D_v τ⟩ + ⟨r, τ − J u⟩` for `weights = [u, r]`. Here `τ` is the torque, the
    /// [`kick_before`](Effect::kick_before) of a step of two seconds, `D_v τ` its [derivative](Effect::kick_derivative)
    /// along the velocity `v`, and `J` the [inertia](crate::mechanics::inertia()). `None` if `D_v τ` or its derivative isn't known.
    ///
    /// Results are returned and visited as by [`adjoint_gradient`](Self::adjoint_gradient). The derivatives of a force
    /// gradient need no more from a term: with `J u = τ` and `J r = D_v τ` this is the gradient of `⟨J⁻¹τ, D_v τ⟩`,
    /// which is `⟨v, f⟩` for the torque `f` of the potential `−½ τ·J⁻¹τ`.
    ///
    /// On SO(3), for a number with the unit N:
    ///
    /// - `u` in rad/s²
    /// - `v` in N per unit of `f`, N/(kg m²/s⁴)
    /// - `r` in N per unit of `τ`, N/(kg m²/s²)
    /// - the returned covector in N/rad, the other derivatives in N per unit of their variable
    fn kick_gradient(
        &self,
        w: &Self::Advected,
        velocity: &Vector<Self>,
        weights: [&Vector<Self>; 2],
        visit: &mut impl FnMut(usize, Scalar<Self>),
    ) -> Option<(Vector<Self>, Self::Advected)> {
        let _ = (w, velocity, weights, visit);
        None
    }
}

/// The point at which a step is differentiated.
#[derive(Clone, Copy, Debug)]
pub struct StepPoint<'a, G: LieGroup, A> {
    /// The increment less the identity, `F − I`, as a matrix of the group.
    pub increment: &'a G::Matrix,
    /// The advected parameters `w` in the body frame before the step.
    pub w: &'a A,
    /// The length `h` of the step, s.
    pub h: G::Scalar,
}

/// The point of a step of this effect.
pub(crate) type PointOf<'a, E> = StepPoint<'a, Group<E>, <E as Term>::Advected>;

impl<'a, G: LieGroup, A, B> StepPoint<'a, G, (A, B)> {
    /// The points for each of two terms.
    #[hot]
    fn of_terms(self) -> (StepPoint<'a, G, A>, StepPoint<'a, G, B>) {
        let Self { increment, w: (first, second), h } = self;
        (StepPoint { increment, w: first, h }, StepPoint { increment, w: second, h })
    }
}

/// The derivatives of the momenta `μ` and `μ⁺` along turns `ε` and displacements `ζ`: the entry `(k, j)` of each is the
/// derivative of component `k` along `E_j`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDerivatives<M> {
    /// The derivative `∂μ/∂ε`, the exact Newton Jacobian [`momentum_jacobian`](Effect::momentum_jacobian).
    pub start_by_turn: M,
    /// The derivative `∂μ⁺/∂ε`.
    pub end_by_turn: M,
    /// The derivative `∂μ/∂ζ`, at fixed `F`.
    pub start_by_place: M,
    /// The derivative `∂μ⁺/∂ζ`, at fixed `F`.
    pub end_by_place: M,
}

impl<M: Add<Output = M>> Add for StepDerivatives<M> {
    type Output = Self;

    #[hot]
    fn add(self, other: Self) -> Self {
        Self {
            start_by_turn: self.start_by_turn + other.start_by_turn,
            end_by_turn: self.end_by_turn + other.end_by_turn,
            start_by_place: self.start_by_place + other.start_by_place,
            end_by_place: self.end_by_place + other.end_by_place,
        }
    }
}

#[hot]
impl<A, B> SecondDerivatives for Sum<A, B>
where
    A: SecondDerivatives,
    B: SecondDerivatives<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
    const PARAMETERS: usize = A::PARAMETERS + B::PARAMETERS;

    fn step_derivatives(&self, at: PointOf<'_, Self>) -> StepDerivatives<Square<Self>> {
        let (first, second) = at.of_terms();
        self.first.step_derivatives(first) + self.second.step_derivatives(second)
    }

    fn by_parameters(&self, at: PointOf<'_, Self>, visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>)) {
        let (first, second) = at.of_terms();
        self.first.by_parameters(first, visit);
        self.second.by_parameters(second, &mut |number, start, end| {
            visit(A::PARAMETERS + number, start, end);
        });
    }

    fn by_advected(&self, at: PointOf<'_, Self>, visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>)) {
        let ((first, second), before) = (at.of_terms(), scalars::<Scalar<Self>, A::Advected>());
        self.first.by_advected(first, visit);
        self.second.by_advected(second, &mut |number, start, end| visit(before + number, start, end));
    }

    fn carried_parameters(visit: &mut impl FnMut(usize, usize)) {
        let before = scalars::<Scalar<Self>, A::Advected>();
        A::carried_parameters(visit);
        B::carried_parameters(&mut |place, number| visit(before + place, A::PARAMETERS + number));
    }

    fn adjoint_system(&self, at: PointOf<'_, Self>, at_end: &Vector<Self>) -> (Square<Self>, Vector<Self>) {
        let (first, second) = at.of_terms();
        let (first, right_side) = self.first.adjoint_system(first, at_end);
        let (second, other) = self.second.adjoint_system(second, at_end);
        (first + second, right_side + other)
    }

    fn adjoint_gradient(
        &self,
        at: PointOf<'_, Self>,
        ends: [&Vector<Self>; 2],
        visit: &mut impl FnMut(usize, Scalar<Self>),
    ) -> (Vector<Self>, Self::Advected) {
        let (first, second) = at.of_terms();
        let (first, seen) = self.first.adjoint_gradient(first, ends, visit);
        let behind = &mut |number, share| visit(A::PARAMETERS + number, share);
        let (second, other) = self.second.adjoint_gradient(second, ends, behind);
        (first + second, (seen, other))
    }

    fn kick_gradient(
        &self,
        w: &Self::Advected,
        velocity: &Vector<Self>,
        weights: [&Vector<Self>; 2],
        visit: &mut impl FnMut(usize, Scalar<Self>),
    ) -> Option<(Vector<Self>, Self::Advected)> {
        let (first, seen) = self.first.kick_gradient(&w.0, velocity, weights, visit)?;
        let behind = &mut |number, share| visit(A::PARAMETERS + number, share);
        let (second, other) = self.second.kick_gradient(&w.1, velocity, weights, behind)?;
        Some((first + second, (seen, other)))
    }
}

/// The number of scalars of these parameters.
#[hot]
fn scalars<T: Real, A: Entries<T>>() -> usize {
    let mut count = 0;
    zero::<T, A>().each(&mut |_| count += 1);
    count
}
