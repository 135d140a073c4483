//! The tangent map, forwards: columns that are carried along with a motion.

use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;

use crate::groups::LieGroup;
use crate::mechanics::pattern;
use crate::mechanics::{Group, SecondDerivatives, Term, Vector};
use crate::motion::linearised::recorded::Change;
use crate::motion::linearised::stage::{Map, Pass, Stage};
use crate::numbers::{Coordinates, Entries as _, is_finite, real};
use nalgebra::SimdComplexField as _;

/// How a state changes with its start, and with parameters: columns `(ζ, δμ)` that
/// [`Linearised::step`](super::Linearised::step) carries along.
///
/// The first columns are the derivatives by the start, first along its displacements `ζ_0`, then by the components of
/// `μ_0`; together they are the state transition matrix. The others are those by parameters, at a fixed start.
#[derive(Clone, Debug)]
pub struct Tangent<G: LieGroup, A> {
    columns: Vec<Column<G::Vector>>,
    /// As they were before a step.
    kept: Vec<Column<G::Vector>>,
    /// The parameters' shares in a stage, by their numbers.
    shares: Vec<(G::Vector, G::Vector)>,
    /// The stages of the last step; the memory is used again.
    pub(super) events: RefCell<Vec<Change<G, A>>>,
}

/// A direction, and the parameter that moves with it.
#[derive(Clone, Copy, Debug)]
struct Column<V> {
    attitude: V,
    momentum: V,
    parameter: Option<usize>,
}

impl<G: LieGroup, A> Tangent<G, A> {
    /// The identity, with a column for each of these of so many parameters.
    pub(super) fn new(parameters: usize, numbers: &[usize]) -> Self {
        let zero = G::Vector::zero();
        let start = (0..G::DIMENSION)
            .map(|k| Column { attitude: G::Vector::axis(k), momentum: zero, parameter: None })
            .chain((0..G::DIMENSION).map(|k| Column { attitude: zero, momentum: G::Vector::axis(k), parameter: None }));
        let by_parameters =
            numbers.iter().map(|&number| Column { attitude: zero, momentum: zero, parameter: Some(number) });
        let columns = start.chain(by_parameters).collect();
        let shares = if numbers.is_empty() { Vec::new() } else { vec![(zero, zero); parameters] };
        Self { columns, kept: Vec::new(), shares, events: RefCell::default() }
    }

    /// How many parameters its plan has; `None` without columns for them, where any plan of the scene will do.
    #[inline(always)]
    pub(super) fn parameters(&self) -> Option<usize> {
        (!self.shares.is_empty()).then_some(self.shares.len())
    }

    /// The columns: how the attitude moves, `g ← g exp ζ̂`, and the change `δμ` of the momentum, for each.
    pub fn columns(&self) -> impl ExactSizeIterator<Item = (G::Vector, G::Vector)> + '_ {
        self.columns.iter().map(|column| (column.attitude, column.momentum))
    }

    /// The columns of the parameters, in the order in which they were asked for.
    pub fn by_parameters(&self) -> impl ExactSizeIterator<Item = (G::Vector, G::Vector)> + '_ {
        self.columns().skip(2 * G::DIMENSION)
    }

    /// The state transition matrix `∂(ζ, μ)/∂(ζ_0, μ_0)`, by its four blocks: `[[∂ζ/∂ζ_0, ∂ζ/∂μ_0], [∂μ/∂ζ_0, ∂μ/∂μ_0]]`.
    #[must_use]
    pub fn transition(&self) -> [[<G::Vector as Coordinates<G::Scalar>>::Square; 2]; 2] {
        let block = |first: usize, is_attitude: bool| {
            let columns = self.columns.iter().skip(first).take(G::DIMENSION);
            let zero = G::Vector::zero();
            columns.enumerate().fold(zero.outer(&zero), |block, (k, column)| {
                let part = if is_attitude { column.attitude } else { column.momentum };
                block + part.outer(&G::Vector::axis(k))
            })
        };
        [true, false].map(|is_attitude| [block(0, is_attitude), block(G::DIMENSION, is_attitude)])
    }

    /// Makes the columns of the start orthonormal, from the first to the last, and returns what each was longer than
    /// one: the diagonal of `R` in `Φ = Q R`, of which Lyapunov exponents are made.
    pub(super) fn orthonormalise(&mut self) -> Vec<G::Scalar> {
        self.columns.truncate(2 * G::DIMENSION);
        let mut lengths = Vec::with_capacity(self.columns.len());
        for at in 0..self.columns.len() {
            let (known, rest) = self.columns.split_at_mut(at);
            let Some(column) = rest.first_mut() else { break };
            // Once more, as the first time leaves what rounding makes of nearly parallel columns.
            for _ in 0..2 {
                for other in &*known {
                    let shadow = other.attitude.dot(&column.attitude) + other.momentum.dot(&column.momentum);
                    column.attitude = column.attitude - other.attitude * shadow;
                    column.momentum = column.momentum - other.momentum * shadow;
                }
            }
            let length = (column.attitude.dot(&column.attitude) + column.momentum.dot(&column.momentum)).simd_sqrt();
            let inverse = real::<G::Scalar>(1.0) / length;
            (column.attitude, column.momentum) = (column.attitude * inverse, column.momentum * inverse);
            lengths.push(length);
        }
        lengths
    }

    /// Remembers the columns.
    #[inline(always)]
    pub(super) fn keep(&mut self) {
        self.kept.clone_from(&self.columns);
    }

    /// To the columns that are remembered.
    #[cold]
    pub(super) fn go_back(&mut self) {
        self.columns.clone_from(&self.kept);
    }

    /// Whether all entries are numbers.
    pub(super) fn is_finite(&self) -> bool {
        let mut total = real::<G::Scalar>(0.0);
        for column in &self.columns {
            column.attitude.each(&mut |entry| total += entry);
            column.momentum.each(&mut |entry| total += entry);
        }
        is_finite(total)
    }
}

impl<G: LieGroup, A> Pass<G> for Tangent<G, A> {
    #[inline(always)]
    fn stage<E: SecondDerivatives<Scalar = G::Scalar, Group = G>>(&mut self, stage: &Stage<'_, E>) {
        let map = stage.map();
        if !self.shares.is_empty() {
            let (zero, scale) = (G::Vector::zero(), stage.scale());
            self.shares.fill((zero, zero));
            let shares = &mut self.shares;
            stage.forwards(&mut |number, start, end| {
                if let Some(share) = shares.get_mut(number) {
                    *share = (share.0 + start * scale, share.1 + end * scale);
                }
            });
        }
        let shares = &self.shares;
        let share = |column: &Column<G::Vector>| column.parameter.and_then(|number| shares.get(number));
        match map {
            Map::Nothing => {}
            Map::Step(blocks, inverse) => {
                let (factors, determinant) = Vector::<E>::factorise_with(&blocks.start_by_turn, pattern::<E>());
                for column in &mut self.columns {
                    let mut target = column.momentum - blocks.start_by_place * column.attitude;
                    let share = share(column);
                    if let Some((start, _)) = share {
                        target = target - *start;
                    }
                    let turn = Vector::<E>::solve_again_with(&factors, determinant, pattern::<E>(), &target);
                    let mut momentum = blocks.end_by_turn * turn + blocks.end_by_place * column.attitude;
                    if let Some((_, end)) = share {
                        momentum = momentum + *end;
                    }
                    column.attitude = inverse.adjoint(&(column.attitude + turn));
                    column.momentum = momentum;
                }
            }
            Map::Kick(slope) => {
                for column in &mut self.columns {
                    let mut momentum = column.momentum + slope * column.attitude;
                    if let Some((start, end)) = share(column) {
                        momentum = momentum + (*end - *start);
                    }
                    column.momentum = momentum;
                }
            }
        }
    }
}

/// The type of a scene's tangents.
pub type TangentOf<S> = Tangent<Group<S>, <S as Term>::Advected>;
