//! The tangent map of one stage and its transpose.

use alloc::vec::Vec;

use crate::groups::{Advected as _, LieGroup, seen_of_unit};
use crate::mechanics::pattern;
use crate::mechanics::{Effect, Group, Matrix, Scalar, SecondDerivatives, Square, StepDerivatives, Vector};
use crate::motion::linearised::recorded::Change;
use crate::numbers::{Coordinates, Entries, Real, real, zero};

/// One change of the motion and the effect that made it: what is differentiated, by an own step of the effect or by a
/// kick of its potential.
///
/// The library's own plans make stages, and its derivatives read them; there is nothing else to do with one.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a, E: Effect> {
    effect: &'a E,
    kind: Kind<Scalar<E>>,
    attitude: Group<E>,
    advected: E::Advected,
    increment: Matrix<E>,
    /// Among the parameters of the plan, the number of the effect's first.
    first: usize,
}

#[derive(Clone, Copy, Debug)]
enum Kind<T> {
    /// A step of this length, s.
    Step(T),
    /// The push of the effect's potential in this time, s.
    Kick(T),
}

impl<'a, E: SecondDerivatives> Stage<'a, E> {
    /// The effect's own step of length `h`.
    pub(crate) fn step<A>(effect: &'a E, h: Scalar<E>, event: &Change<Group<E>, A>, advected: E::Advected) -> Self {
        let (attitude, increment) = (event.before.attitude, event.increment);
        Self { effect, kind: Kind::Step(h), attitude, advected, increment, first: 0 }
    }

    /// The kick of its potential.
    pub(crate) fn kick(effect: &'a E, time: Scalar<E>, event: &Change<Group<E>, E::Advected>) -> Self {
        let (attitude, advected) = (event.before.attitude, event.before.advected);
        Self { effect, kind: Kind::Kick(time), attitude, advected, increment: zero(), first: 0 }
    }

    /// With the effect's parameters behind so many others.
    pub(crate) fn behind(self, first: usize) -> Self {
        Self { first, ..self }
    }

    /// Prepares the map along displacements.
    #[inline(always)]
    pub(super) fn map(&self) -> Map<E> {
        match self.kind {
            // Without a step nothing moves.
            Kind::Step(h) if h == real(0.0) => Map::Nothing,
            Kind::Step(h) => {
                let blocks = self.effect.step_derivatives(&self.increment, &self.advected, h);
                Map::Step(blocks, Group::<E>::from_increment(&self.increment).inverse())
            }
            Kind::Kick(time) => {
                let blocks = self.effect.step_derivatives(&self.increment, &self.advected, real(1.0));
                let slope = blocks.end_by_place + blocks.start_by_place * real::<Scalar<E>>(-1.0);
                Map::Kick(slope * time)
            }
        }
    }

    /// The derivatives of `μ` and `μ⁺` by the parameters, those that are carried not among them.
    #[inline(always)]
    fn by_parameters(&self, visit: &mut impl FnMut(usize, Vector<E>, Vector<E>)) {
        let h = self.length();
        let first = self.first;
        self.effect.by_parameters(&self.increment, &self.advected, h, &mut |number, start, end| {
            visit(first + number, start, end);
        });
    }

    #[inline(always)]
    fn by_advected(&self, visit: &mut impl FnMut(usize, Vector<E>, Vector<E>)) {
        self.effect.by_advected(&self.increment, &self.advected, self.length(), visit);
    }

    /// The `h` of the derivatives; of a kick, which is proportional to it, one second.
    #[inline(always)]
    fn length(&self) -> Scalar<E> {
        match self.kind {
            Kind::Step(h) => h,
            Kind::Kick(_) => real(1.0),
        }
    }

    /// The derivatives of `μ` and `μ⁺` by all parameters; those of one that is visited again are added.
    pub(super) fn forwards(&self, visit: &mut impl FnMut(usize, Vector<E>, Vector<E>)) {
        self.by_parameters(visit);
        E::carried_parameters(&self.advected, &mut |place, parameter| {
            let seen: E::Advected = seen_of_unit(place, &self.attitude);
            let (mut start, mut end) = (Vector::<E>::zero(), Vector::<E>::zero());
            self.by_advected(&mut |number, by_start, by_end| {
                let change = entry(&seen, number);
                (start, end) = (start + by_start * change, end + by_end * change);
            });
            visit(self.first + parameter, start, end);
        });
    }

    /// Adds to the gradient by the parameters: `⟨at_end, ∂μ⁺⟩ − ⟨at_start, ∂μ⟩`.
    #[inline(always)]
    fn backwards(&self, at_start: &Vector<E>, at_end: &Vector<E>, gradient: &mut GradientSum<'_, Scalar<E>>) {
        let paired = |start: Vector<E>, end: Vector<E>| at_end.dot(&end) - at_start.dot(&start);
        self.by_parameters(&mut |number, start, end| gradient.add(number, paired(start, end)));
        // The gradient by what the body sees, and from there by its value in space.
        let by_advected = &mut *gradient.by_advected;
        by_advected.clear();
        self.advected.each(&mut |_| by_advected.push(real(0.0)));
        self.by_advected(&mut |number, start, end| {
            if let Some(entry) = by_advected.get_mut(number) {
                *entry = paired(start, end);
            }
        });
        let mut by_seen = by_advected.iter();
        let by_seen = E::Advected::from_entries(&mut || by_seen.next().copied().unwrap_or_else(|| real(0.0)));
        let mut by_carried = None;
        E::carried_parameters(&self.advected, &mut |place, parameter| {
            let by_carried = by_carried.get_or_insert_with(|| by_seen.pulled_back(&self.attitude));
            gradient.add(self.first + parameter, entry(by_carried, place));
        });
    }

    /// Takes the gradient at the end of the stage to its beginning, and adds the parameters' shares.
    #[inline(always)]
    pub(super) fn pull(
        &self,
        end: &Cotangent<Vector<E>>,
        gradient: &mut GradientSum<'_, Scalar<E>>,
    ) -> Cotangent<Vector<E>> {
        let transposed = |matrix: &Square<E>, v: &Vector<E>| Vector::<E>::transpose(matrix) * *v;
        match self.map() {
            Map::Nothing => *end,
            Map::Step(blocks, inverse) => {
                let attitude = inverse.adjoint_transpose(&end.attitude);
                let right = attitude + transposed(&blocks.end_by_turn, &end.momentum);
                let (factors, det) =
                    Vector::<E>::factorise_with(&Vector::<E>::transpose(&blocks.start_by_turn), pattern::<E>());
                let at_start = Vector::<E>::solve_again_with(&factors, det, pattern::<E>(), &right);
                self.backwards(&at_start, &end.momentum, gradient);
                let attitude = attitude
                    + (transposed(&blocks.end_by_place, &end.momentum) - transposed(&blocks.start_by_place, &at_start));
                Cotangent { attitude, momentum: at_start }
            }
            Map::Kick(slope) => {
                let paired = end.momentum * self.scale();
                self.backwards(&paired, &paired, gradient);
                Cotangent { attitude: end.attitude + transposed(&slope, &end.momentum), momentum: end.momentum }
            }
        }
    }

    /// The time that derivatives by parameters are multiplied by.
    pub(super) fn scale(&self) -> Scalar<E> {
        match self.kind {
            Kind::Step(_) => real(1.0),
            Kind::Kick(time) => time,
        }
    }
}

/// The tangent map of a stage, prepared.
pub(super) enum Map<E: Effect> {
    Nothing,
    /// `∂μ/∂ε ε = δμ − ∂μ/∂ζ ζ`, `ζ⁺ = Ad_{F⁻¹}(ζ + ε)`, `δμ⁺ = ∂μ⁺/∂ε ε + ∂μ⁺/∂ζ ζ`, with `F⁻¹`.
    Step(StepDerivatives<Square<E>>, Group<E>),
    /// `δμ⁺ = δμ + S ζ`.
    Kick(Square<E>),
}

/// The gradient by the parameters so far.
pub(super) struct GradientSum<'a, T> {
    pub(super) parameters: &'a mut [T],
    /// Of one stage, by what the body sees.
    pub(super) by_advected: &'a mut Vec<T>,
}

impl<T: Real> GradientSum<'_, T> {
    #[inline(always)]
    fn add(&mut self, number: usize, share: T) {
        if let Some(sum) = self.parameters.get_mut(number) {
            *sum += share;
        }
    }
}

/// The derivative of a number by the state: along `g ↦ g exp(sÊ_k)`, and by the components of the momentum.
///
/// On SO(3) `attitude` is per radian of a turn about the body's axes, `momentum` per kg m²/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cotangent<V> {
    /// Along displacements of the body, a covector.
    pub attitude: V,
    /// By the momentum, an element of the algebra.
    pub momentum: V,
}

impl<V> Cotangent<V> {
    /// Of a number that doesn't depend on this state.
    #[must_use]
    pub fn zero<T: Real>() -> Self
    where
        V: Coordinates<T>,
    {
        Self { attitude: V::zero(), momentum: V::zero() }
    }
}

/// What is done with the stages of a step, one after the other: by the derivatives of the library's own plans.
pub trait Pass<G: LieGroup> {
    /// Takes notice of a stage.
    fn stage<E: SecondDerivatives<Scalar = G::Scalar, Group = G>>(&mut self, stage: &Stage<'_, E>);
}

/// One of the scalars.
#[inline(always)]
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
