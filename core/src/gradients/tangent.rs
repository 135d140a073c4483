//! The tangent map: columns that each step of a motion transforms.

use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;

use crate::gradients::recording::Change;
use crate::gradients::stage::{FlowDerivatives, Kind, Pass, Stage, WayBack};
use crate::groups::LieGroup;
use crate::mechanics::pattern;
use crate::mechanics::{Group, SecondDerivatives, Term, Vector};
use crate::numbers::{Coordinates, Entries as _, Real, is_finite, real};
use nalgebra::SimdComplexField as _;

/// The derivatives of a state by its start, and by parameters: columns `(ζ, δμ)` that
/// [`Linearisation::step`](super::Linearisation::step) transforms.
///
/// The first columns are the derivatives by the start, first along its displacements `ζ_0`, then by the components of
/// `μ_0`; together they are the state transition matrix. The others are those by parameters, at a fixed start.
#[derive(Clone, Debug)]
pub struct Tangent<G: LieGroup, A> {
    /// The columns in groups of four; the last group is padded with zeros.
    columns: Vec<FourColumns<Four<G>>>,
    /// The columns before a step.
    kept: Vec<FourColumns<Four<G>>>,
    /// The numbers of the parameters whose derivatives follow the columns of the start.
    numbers: Vec<usize>,
    /// The derivatives of a stage by the parameters, by their numbers; followed by those by the step's prescribed
    /// values.
    shares: Vec<(G::Vector, G::Vector)>,
    /// Number of the shares that belong to prescribed values.
    values: usize,
    /// Whether the step has prescribed values, so that advected parameters have no share.
    pub(super) is_given_values: bool,
    /// The stages of the last step; the memory is reused.
    pub(super) events: RefCell<Vec<Change<G, A>>>,
}

type Four<G> = <<G as LieGroup>::Vector as Coordinates<<G as LieGroup>::Scalar>>::Four;

/// Four columns side by side.
#[derive(Clone, Copy, Debug)]
struct FourColumns<F> {
    attitude: F,
    momentum: F,
}

impl<G: LieGroup, A> Tangent<G, A> {
    /// The identity, with a column for each of the numbered parameters and values; the first argument has the counts of
    /// both.
    pub(super) fn new([parameters, values]: [usize; 2], numbers: &[usize]) -> Self {
        let zero = G::Vector::zero();
        let shares = if numbers.is_empty() { Vec::new() } else { vec![(zero, zero); parameters + values] };
        let (kept, events) = (Vec::new(), RefCell::default());
        let mut tangent = Self {
            columns: Vec::new(),
            kept,
            numbers: numbers.to_vec(),
            shares,
            values,
            is_given_values: false,
            events,
        };
        tangent.set_columns(&Self::identity());
        tangent
    }

    /// The identity's columns of the start.
    fn identity() -> Vec<(G::Vector, G::Vector)> {
        let zero = G::Vector::zero();
        let axes = || (0..G::DIMENSION).map(G::Vector::axis);
        axes().map(|axis| (axis, zero)).chain(axes().map(|axis| (zero, axis))).collect()
    }

    /// Sets the start's columns, and zeros for the parameters.
    fn set_columns(&mut self, start: &[(G::Vector, G::Vector)]) {
        let zero = G::Vector::zero();
        let count = start.len() + self.numbers.len();
        let column = |k: usize| start.get(k).copied().unwrap_or((zero, zero));
        let four = |first: usize| FourColumns {
            attitude: G::Vector::beside(&[0, 1, 2, 3].map(|k| column(first + k).0)),
            momentum: G::Vector::beside(&[0, 1, 2, 3].map(|k| column(first + k).1)),
        };
        self.columns.clear();
        self.columns.extend((0..count).step_by(4).map(four));
        self.kept.clone_from(&self.columns);
    }

    /// Number of parameters of the tangent's plan; `None` without columns for them, which suits any plan of the scene.
    #[hot]
    pub(super) fn parameters(&self) -> Option<usize> {
        (!self.shares.is_empty()).then_some(self.shares.len() - self.values)
    }

    /// The columns: the displacement `ζ` of the attitude, `g ← g exp ζ̂`, and the change `δμ` of the momentum, for
    /// each.
    pub fn columns(&self) -> impl ExactSizeIterator<Item = (G::Vector, G::Vector)> + '_ {
        (0..2 * G::DIMENSION + self.numbers.len()).map(|k| {
            let FourColumns { attitude, momentum } = &self.columns[k / 4];
            (G::Vector::of_four(attitude, k % 4), G::Vector::of_four(momentum, k % 4))
        })
    }

    /// The columns of the parameters, in the order in which they were requested.
    pub fn by_parameters(&self) -> impl ExactSizeIterator<Item = (G::Vector, G::Vector)> + '_ {
        self.columns().skip(2 * G::DIMENSION)
    }

    /// The four blocks of the state transition matrix `∂(ζ, μ)/∂(ζ_0, μ_0)`:
    /// `[[∂ζ/∂ζ_0, ∂ζ/∂μ_0], [∂μ/∂ζ_0, ∂μ/∂μ_0]]`.
    #[must_use]
    pub fn transition(&self) -> [[SquareOfVector<G::Vector, G::Scalar>; 2]; 2] {
        blocks_of(&self.columns().collect::<Vec<_>>())
    }

    /// Orthonormalises the columns of the start, from the first to the last, and visits the length of each: the
    /// diagonal of `R` in `Φ = Q R`, from which Lyapunov exponents are computed. Columns by parameters are dropped, as
    /// they would be derivatives along no parameter.
    ///
    /// `columns` is a buffer that is reused.
    pub(super) fn orthonormalise(
        &mut self,
        columns: &mut Vec<(G::Vector, G::Vector)>,
        mut visit: impl FnMut(usize, G::Scalar),
    ) {
        self.numbers.clear();
        self.shares.clear();
        columns.clear();
        columns.extend(self.columns());
        for at in 0..columns.len() {
            let (known, rest) = columns.split_at_mut(at);
            let Some((attitude, momentum)) = rest.first_mut() else { break };
            // The projection is repeated, as the first leaves the rounding of nearly parallel columns.
            for _ in 0..2 {
                for other in &*known {
                    let shadow = other.0.dot(attitude) + other.1.dot(momentum);
                    (*attitude, *momentum) = (*attitude - other.0 * shadow, *momentum - other.1 * shadow);
                }
            }
            let length = (attitude.dot(attitude) + momentum.dot(momentum)).simd_sqrt();
            let inverse = real::<G::Scalar>(1.0) / length;
            (*attitude, *momentum) = (*attitude * inverse, *momentum * inverse);
            visit(at, length);
        }
        self.set_columns(columns);
    }

    /// Saves the columns.
    #[hot]
    pub(super) fn keep(&mut self) {
        for (kept, four) in self.kept.iter_mut().zip(&self.columns) {
            *kept = *four;
        }
    }

    /// Restores the saved columns.
    #[cold]
    pub(super) fn go_back(&mut self) {
        self.columns.clone_from(&self.kept);
    }

    /// Whether all entries are finite.
    #[hot]
    pub(super) fn is_finite(&self) -> bool {
        let zero = G::Vector::zero();
        let mut sums = G::Vector::beside(&[zero; 4]);
        for four in &self.columns {
            sums = sums + (four.attitude + four.momentum);
        }
        let mut total = real::<G::Scalar>(0.0);
        sums.each(&mut |entry| total += entry);
        is_finite(total)
    }

    /// The derivatives by the parameters of four columns, at the start and at the end of the stage; `None` if none of
    /// the columns has a parameter.
    #[hot]
    fn shares_of(&self, four: usize) -> Option<(Four<G>, Four<G>)> {
        let (start, zero) = (2 * G::DIMENSION, G::Vector::zero());
        if self.numbers.is_empty() || 4 * four + 4 <= start {
            return None;
        }
        let of_column = |k: usize| {
            let number = self.numbers.get((4 * four + k).checked_sub(start)?)?;
            self.shares.get(*number).copied()
        };
        let shares = [0, 1, 2, 3].map(|k| of_column(k).unwrap_or((zero, zero)));
        Some((G::Vector::beside(&shares.map(|share| share.0)), G::Vector::beside(&shares.map(|share| share.1))))
    }
}

#[hot]
impl<G: LieGroup, A> Pass<G> for Tangent<G, A> {
    fn asks_for_parameters(&self) -> bool {
        !self.shares.is_empty()
    }

    fn on_the_way_back(&mut self) -> Option<WayBack<'_, G>> {
        None
    }

    fn stage<E: SecondDerivatives<Scalar = G::Scalar, Group = G>>(&mut self, stage: &Stage<'_, E>) {
        if !self.shares.is_empty() {
            let zero = G::Vector::zero();
            self.shares.fill((zero, zero));
            let first = self.shares.len() - self.values;
            let (shares, is_given) = (&mut self.shares, self.is_given_values);
            stage.forwards((first, self.values, is_given), &mut |number, start, end| {
                if let Some(share) = shares.get_mut(number) {
                    *share = (share.0 + start, share.1 + end);
                }
            });
        }
        match stage.kind {
            // A step of zero length changes nothing.
            Kind::Step(h) if h == real(0.0) => {}
            // The solve is `∂μ/∂ε ε = δμ − ∂μ/∂ζ ζ`; then `ζ⁺ = Ad_{F⁻¹}(ζ + ε)`, `δμ⁺ = ∂μ⁺/∂ε ε + ∂μ⁺/∂ζ ζ`.
            Kind::Step(h) => {
                let blocks = stage.blocks(h);
                let (factors, determinant) = Vector::<E>::factorise_with(&blocks.start_by_turn, pattern::<E>());
                let solution = Vector::<E>::inverse_with(&factors, determinant, pattern::<E>());
                let turned = stage.turned_back();
                for k in 0..self.columns.len() {
                    let shares = self.shares_of(k);
                    let FourColumns { attitude, momentum } = &mut self.columns[k];
                    let mut right_side = *momentum - G::Vector::map_four(&blocks.start_by_place, attitude);
                    if let Some((start, _)) = shares {
                        right_side = right_side - start;
                    }
                    let turn = G::Vector::map_four(&solution, &right_side);
                    let by_turn = G::Vector::map_four(&blocks.end_by_turn, &turn);
                    *momentum = by_turn + G::Vector::map_four(&blocks.end_by_place, attitude);
                    if let Some((_, end)) = shares {
                        *momentum = *momentum + end;
                    }
                    *attitude = G::Vector::map_four(&turned, &(*attitude + turn));
                }
            }
            Kind::Kick(time) => {
                let slope = stage.slope(time);
                for k in 0..self.columns.len() {
                    let shares = self.shares_of(k);
                    let FourColumns { attitude, momentum } = &mut self.columns[k];
                    *momentum = *momentum + G::Vector::map_four(&slope, attitude);
                    if let Some((start, end)) = shares {
                        *momentum = *momentum + (end - start);
                    }
                }
            }
        }
    }

    fn flown(&mut self, flown: &FlowDerivatives<'_, G>) {
        if !self.shares.is_empty() {
            let zero = G::Vector::zero();
            self.shares.fill((zero, zero));
            for (number, turn) in flown.by_parameters {
                if let Some(share) = self.shares.get_mut(*number) {
                    share.0 = share.0 + *turn;
                }
            }
        }
        for k in 0..self.columns.len() {
            let shares = self.shares_of(k);
            let FourColumns { attitude, momentum } = &mut self.columns[k];
            let mut turn = G::Vector::map_four(&flown.turn_by_momentum, momentum);
            if let Some((of_parameters, _)) = shares {
                turn = turn + of_parameters;
            }
            let carried = G::Vector::map_four(&flown.turned_back, momentum);
            *momentum = carried + G::Vector::map_four(&flown.end_by_turn, &turn);
            *attitude = G::Vector::map_four(&flown.turned_back, &(*attitude + turn));
        }
    }
}

/// The type of a scene's tangents.
pub type TangentOf<S> = Tangent<Group<S>, <S as Term>::Advected>;

pub(super) type SquareOfVector<V, T> = <V as Coordinates<T>>::Square;

/// The four blocks of the columns by a start: first those along displacements, then as many by the momentum.
pub(super) fn blocks_of<V: Coordinates<T>, T: Real>(columns: &[(V, V)]) -> [[SquareOfVector<V, T>; 2]; 2] {
    let (along, by_momentum) = columns.split_at(columns.len() / 2);
    let block =
        |columns: &[(V, V)], is_attitude: bool| V::square(|k| if is_attitude { columns[k].0 } else { columns[k].1 });
    [true, false].map(|is_attitude| [block(along, is_attitude), block(by_momentum, is_attitude)])
}
