//! The tangent map of one stage and its transpose.

use alloc::vec::Vec;

use crate::gradients::recording::Change;
use crate::groups::{Advected as _, LieGroup, SquareOf, seen_of_unit};
use crate::mechanics::pattern;
use crate::mechanics::{
    Effect, Group, Matrix, PointOf, Scalar, SecondDerivatives, Square, StepDerivatives, StepPoint, Vector,
};
use crate::numbers::{Coordinates, Entries, Real, real, zero};

/// One differentiable change of the motion, and the effect that made it by its own step or by a kick of its potential.
///
/// The library's own plans make stages, and its derivatives read them; they have no other use.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a, E: Effect> {
    effect: &'a E,
    /// The kind of the change.
    pub(super) kind: Kind<Scalar<E>>,
    attitude: Group<E>,
    advected: E::Advected,
    increment: Matrix<E>,
    /// The force gradient of a kick.
    gradient: Option<ForceGradient<'a, Scalar<E>, E::Constants, Square<E>>>,
    /// The index of the effect's first parameter among the parameters of the plan.
    first: usize,
}

/// The share of a force gradient in a kick: of the push `f` of the potential `−½ τ·J⁻¹τ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForceGradient<'a, T, C, M> {
    /// The share of the force gradient, s³.
    pub(crate) share: T,
    /// The constants for which [`Effect::kick_before`] returns the torque `τ`.
    pub(crate) torque: &'a C,
    /// The inverse inertia `J⁻¹`.
    pub(crate) inverse_inertia: &'a M,
}

/// The kind of a change. It is matched where its derivatives are used, so that each arm is straight-line code with its
/// own values.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind<T> {
    /// A step of this length, s.
    Step(T),
    /// The kick of the effect's potential in this time, s.
    Kick(T),
}

#[hot]
impl<'a, E: SecondDerivatives> Stage<'a, E> {
    /// The effect's own step of length `h`.
    pub(crate) fn step<A>(effect: &'a E, h: Scalar<E>, event: &Change<Group<E>, A>, advected: E::Advected) -> Self {
        let (attitude, increment) = (event.before.attitude, event.increment);
        Self { effect, kind: Kind::Step(h), attitude, advected, increment, gradient: None, first: 0 }
    }

    /// The kick of the effect's potential, with a share of the force gradient or without.
    #[inline]
    pub(crate) fn kick(
        effect: &'a E,
        time: Scalar<E>,
        gradient: Option<ForceGradient<'a, Scalar<E>, E::Constants, Square<E>>>,
        event: &Change<Group<E>, E::Advected>,
    ) -> Self {
        let (attitude, advected) = (event.before.attitude, event.before.advected);
        Self { effect, kind: Kind::Kick(time), attitude, advected, increment: zero(), gradient, first: 0 }
    }

    /// The stage with the effect's parameters after this number of others.
    pub(crate) fn behind(self, first: usize) -> Self {
        Self { first, ..self }
    }

    /// The point at which the derivatives of a step of this length are evaluated.
    fn point(&self, h: Scalar<E>) -> PointOf<'_, E> {
        StepPoint { increment: &self.increment, w: &self.advected, h }
    }

    /// The blocks of the tangent map of a step of this length.
    pub(super) fn blocks(&self, h: Scalar<E>) -> StepDerivatives<Square<E>> {
        self.effect.step_derivatives(self.point(h))
    }

    /// The matrix of `Ad_{F⁻¹}`.
    pub(super) fn turned_back(&self) -> Square<E> {
        Group::<E>::from_increment(&self.increment).inverse().adjoint_matrix()
    }

    /// The slope `S` of a kick in this time, `δμ⁺ = δμ + S ζ`.
    pub(super) fn slope(&self, time: Scalar<E>) -> Square<E> {
        let blocks = self.blocks(real(1.0));
        let slope = (blocks.end_by_place + blocks.start_by_place * real::<Scalar<E>>(-1.0)) * time;
        if self.gradient.is_none() {
            return slope;
        }
        let rows = Vector::<E>::square(|k| self.of_gradient(&Vector::<E>::axis(k), &mut |_, _| {}, &mut []));
        slope + Vector::<E>::transpose(&rows)
    }

    /// The step at which the derivatives are evaluated. A kick is proportional to its duration, so its derivatives are those
    /// of one second.
    fn length(&self) -> Scalar<E> {
        match self.kind {
            Kind::Step(h) => h,
            Kind::Kick(_) => real(1.0),
        }
    }

    /// Visits the derivatives of `μ` and `μ⁺` by all parameters, and by the first `values` scalars of the values,
    /// numbered from `first_value` on; advected parameters have none in a step with prescribed values. Derivatives by
    /// one number that is visited several times add.
    #[inline]
    pub(super) fn forwards(
        &self,
        (first_value, values, is_given_values): (usize, usize, bool),
        visit: &mut impl FnMut(usize, Vector<E>, Vector<E>),
    ) {
        if self.gradient.is_some() {
            for axis in (0..Group::<E>::DIMENSION).map(Vector::<E>::axis) {
                let mut by_values = Vec::new();
                if is_given_values {
                    self.advected.each(&mut |_| by_values.push(real(0.0)));
                }
                let add = &mut |number, share| visit(self.first + number, Vector::<E>::zero(), axis * share);
                self.of_gradient(&axis, add, &mut by_values);
                for (place, share) in by_values.into_iter().enumerate().take(values) {
                    visit(first_value + place, Vector::<E>::zero(), axis * share);
                }
            }
        }
        let scale = match self.kind {
            Kind::Step(_) => real(1.0),
            Kind::Kick(time) => time,
        };
        let visit = &mut |number, start, end| visit(number, start * scale, end * scale);
        // The derivatives by advected parameters follow below.
        self.effect.by_parameters(self.point(self.length()), &mut |number, start, end| {
            visit(self.first + number, start, end);
        });
        if !is_given_values {
            E::carried_parameters(&mut |place, parameter| {
                let (start, end) = self.by_value(place);
                visit(self.first + parameter, start, end);
            });
        }
        for place in 0..values {
            let (start, end) = self.by_value(place);
            visit(first_value + place, start, end);
        }
    }

    /// The derivatives of `μ` and `μ⁺` by the scalar in this place of the advected parameters in space.
    #[inline]
    fn by_value(&self, place: usize) -> (Vector<E>, Vector<E>) {
        let seen: E::Advected = seen_of_unit(place, &self.attitude);
        let (mut start, mut end) = (Vector::<E>::zero(), Vector::<E>::zero());
        self.effect.by_advected(self.point(self.length()), &mut |number, by_start, by_end| {
            let change = entry(&seen, number);
            (start, end) = (start + by_start * change, end + by_end * change);
        });
        (start, end)
    }

    /// Adds the gradient of `⟨p, μ⁺⟩ − ⟨u, μ⟩` by the parameters at a fixed increment, for `[u, p]`, and returns that
    /// along displacements; to `values` it adds that by the advected parameters in space.
    fn fixed_increment(
        &self,
        ends: [&Vector<E>; 2],
        add: &mut impl FnMut(usize, Scalar<E>),
        values: &mut [Scalar<E>],
    ) -> Vector<E> {
        let (by_place, by_seen) = self.effect.adjoint_gradient(self.point(self.length()), ends, &mut *add);
        self.add_carried(&by_seen, add, values);
        by_place
    }

    /// Adds the gradient of `⟨p, f⟩` by the parameters, where `f` is the push of the force gradient, and returns that
    /// along displacements.
    ///
    /// `⟨p, f⟩ = ⟨u, D_v τ⟩` with `J u = τ` and `v = s p` for the share `s`. The change of `u` is included in the
    /// gradient of `⟨u, D_v τ⟩ + ⟨r, τ − J u⟩` at fixed `u` and `r` with `J r = D_v τ`.
    fn of_gradient(
        &self,
        paired: &Vector<E>,
        add: &mut impl FnMut(usize, Scalar<E>),
        values: &mut [Scalar<E>],
    ) -> Vector<E> {
        let Some(ForceGradient { share, torque, inverse_inertia }) = self.gradient else {
            return Vector::<E>::zero();
        };
        let along = *paired * share;
        let u = *inverse_inertia * E::kick_before(torque, &self.advected);
        // The derivative exists, as the plan refuses scenes without it.
        let change = E::kick_derivative(torque, &self.advected, &along).unwrap_or_else(Vector::<E>::zero);
        let r = *inverse_inertia * change;
        let Some((by_place, by_seen)) = self.effect.kick_gradient(&self.advected, &along, [&u, &r], &mut *add) else {
            return Vector::<E>::zero();
        };
        self.add_carried(&by_seen, add, values);
        by_place
    }

    /// Adds the derivatives by the advected parameters, from the gradient by their components in the body frame; for a
    /// step with prescribed values, adds the derivatives by these to `values`.
    fn add_carried(&self, by_seen: &E::Advected, add: &mut impl FnMut(usize, Scalar<E>), values: &mut [Scalar<E>]) {
        if !values.is_empty() {
            let mut sums = values.iter_mut();
            by_seen.pulled_back(&self.attitude).each(&mut |share| {
                if let Some(sum) = sums.next() {
                    *sum += share;
                }
            });
            return;
        }
        let mut by_carried = None;
        E::carried_parameters(&mut |place, parameter| {
            let by_carried = by_carried.get_or_insert_with(|| by_seen.pulled_back(&self.attitude));
            add(parameter, entry(by_carried, place));
        });
    }

    /// Transforms the gradient at the end of the stage to its beginning, and adds the derivatives by the parameters,
    /// and by the prescribed values if `values` isn't empty.
    pub(super) fn pull(
        &self,
        end: &Cotangent<Vector<E>>,
        gradient: &mut [Scalar<E>],
        values: &mut [Scalar<E>],
    ) -> Cotangent<Vector<E>> {
        // The range is checked once, not for each scalar.
        let own = gradient.get_mut(self.first..self.first + E::PARAMETERS).unwrap_or_default();
        debug_assert_eq!(own.len(), E::PARAMETERS, "a plan counts the parameters of its stages");
        let add = &mut |number: usize, share: Scalar<E>| {
            if let Some(sum) = own.get_mut(number) {
                *sum += share;
            }
        };
        match self.kind {
            // A step of zero length changes nothing.
            Kind::Step(h) if h == real(0.0) => *end,
            Kind::Step(h) => {
                let (matrix, share) = self.effect.adjoint_system(self.point(h), &end.momentum);
                let inverse = Group::<E>::from_increment(&self.increment).inverse();
                let attitude = inverse.adjoint_transpose(&end.attitude);
                let (factors, det) = Vector::<E>::factorise_with(&Vector::<E>::transpose(&matrix), pattern::<E>());
                let start = Vector::<E>::solve_again_with(&factors, det, pattern::<E>(), &(attitude + share));
                let by_place = self.fixed_increment([&start, &end.momentum], add, values);
                Cotangent { attitude: attitude + by_place, momentum: start }
            }
            Kind::Kick(time) => {
                let paired = end.momentum * time;
                let mut attitude = end.attitude + self.fixed_increment([&paired; 2], add, values);
                if self.gradient.is_some() {
                    attitude = attitude + self.of_gradient(&end.momentum, add, values);
                }
                Cotangent { attitude, momentum: end.momentum }
            }
        }
    }
}

/// The derivative of a scalar by the state: along `g ↦ g exp(sÊ_k)`, and by the components of the momentum.
///
/// On SO(3) `attitude` is per radian of a turn about the body's axes, `momentum` per kg m²/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cotangent<V> {
    /// The derivative along displacements of the body, a covector.
    pub attitude: V,
    /// The derivative by the momentum, an element of the algebra.
    pub momentum: V,
}

impl<V> Cotangent<V> {
    /// The gradient of a scalar that doesn't depend on this state.
    #[must_use]
    pub fn zero<T: Real>() -> Self
    where
        V: Coordinates<T>,
    {
        Self { attitude: V::zero(), momentum: V::zero() }
    }
}

/// A change of the motion whose turn is a known function `F(μ)` of the momentum and of parameters: an exact flow.
///
/// ```text
/// ε = ∂_με δμ + ∂_θε δθ        ζ⁺ = Ad_{F⁻¹}(ζ + ε)        δμ⁺ = Ad*_F(δμ + ad*_ε μ)
/// ```
///
/// The library's own plans make it, and its derivatives read it, as a [`Stage`].
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct FlowDerivatives<'a, G: LieGroup> {
    /// The derivative `∂ε/∂μ` of the turn.
    pub(crate) turn_by_momentum: SquareOf<G>,
    /// The matrices of `Ad_{F⁻¹}`, and of `Ad*_F`: on SO(3) both are `Fᵀ`.
    pub(crate) turned_back: SquareOf<G>,
    /// The derivative `∂μ⁺/∂ε`, which is `Ad*_F ad*_ε μ` along `ε`.
    pub(crate) end_by_turn: SquareOf<G>,
    /// The derivatives `∂ε/∂θ`, each with the number of its parameter.
    pub(crate) by_parameters: &'a [(usize, G::Vector)],
}

impl<G: LieGroup> FlowDerivatives<'_, G> {
    /// Transforms the gradient at the end to the beginning, and adds the derivatives by the parameters.
    #[hot]
    pub(super) fn pull(&self, end: &Cotangent<G::Vector>, gradient: &mut [G::Scalar]) -> Cotangent<G::Vector> {
        let attitude = pulled::<G>(&self.turned_back, &end.attitude);
        let by_turn = attitude + pulled::<G>(&self.end_by_turn, &end.momentum);
        for (number, turn) in self.by_parameters {
            if let Some(sum) = gradient.get_mut(*number) {
                *sum += by_turn.dot(turn);
            }
        }
        let momentum = pulled::<G>(&self.turned_back, &end.momentum) + pulled::<G>(&self.turn_by_momentum, &by_turn);
        Cotangent { attitude, momentum }
    }
}

/// The product `Mᵀ a`.
#[hot]
fn pulled<G: LieGroup>(matrix: &SquareOf<G>, a: &G::Vector) -> G::Vector {
    G::Vector::of_four(&G::Vector::map_four(&G::Vector::transpose(matrix), &G::Vector::beside(&[*a; 4])), 0)
}

/// Adds derivatives by consecutive parameters.
#[hot]
pub(crate) fn add_shares<T: Real>(gradient: &mut [T], first: usize, shares: &[T]) {
    // The range is checked once, not for each scalar.
    let own = gradient.get_mut(first..first + shares.len()).unwrap_or_default();
    own.iter_mut().zip(shares).for_each(|(sum, share)| *sum += *share);
}

/// A gradient by the state, and that by the parameters.
pub(super) type WayBack<'a, G> = (&'a mut Cotangent<<G as LieGroup>::Vector>, &'a mut [<G as LieGroup>::Scalar]);

/// A pass over the stages of a step, by the derivatives of the library's own plans.
#[doc(hidden)]
pub trait Pass<G: LieGroup> {
    /// Whether the pass needs derivatives by parameters; those of an exact flow may otherwise be left out.
    fn asks_for_parameters(&self) -> bool;

    /// The gradients of a reverse pass: by the state after the stage, to be replaced by that before it, and by the
    /// parameters, to be added to. None for a forward pass.
    fn on_the_way_back(&mut self) -> Option<WayBack<'_, G>>;

    /// Processes a stage.
    fn stage<E: SecondDerivatives<Scalar = G::Scalar, Group = G>>(&mut self, stage: &Stage<'_, E>);

    /// Processes an exact flow.
    fn flown(&mut self, flown: &FlowDerivatives<'_, G>);
}

/// The scalar of this number.
#[hot]
fn entry<T: Real, A: Entries<T>>(values: &A, number: usize) -> T {
    let (mut place, mut found) = (0, T::zero());
    values.each(&mut |value| {
        if place == number {
            found = value;
        }
        place += 1;
    });
    found
}
