//! Self-adjointness by values, as the normal form doesn't contain every relation of a group.

use super::number::Number;
use super::residue::Residue;
use super::sample::{Sample, products};
use super::{dot, increments};
use crate::declared::Name;
use crate::mathematics::derive::SelfAdjointness;
use crate::mathematics::symbolic::{Function, Rational, Variance};

/// The self-adjointness by the results of [`at`] and [`in_the_field`] at all points; an error if the symbolic form is
/// wrong, which may have found the opposite.
pub(super) fn self_adjointness(found: [bool; 3], is_symbolic: bool) -> Result<SelfAdjointness, &'static str> {
    match (found, is_symbolic) {
        ([true, ..], true) => Ok(SelfAdjointness::Symbolic),
        ([true, ..], false) => Ok(SelfAdjointness::Exact),
        (_, true) => Err("adjoint"),
        ([_, _, true], _) => Ok(SelfAdjointness::WithoutBound),
        ([_, true, _], _) => Ok(SelfAdjointness::ForPoints),
        _ => Ok(SelfAdjointness::No),
    }
}

fn is_reversed<T: Number>(point: &Sample<T>) -> bool {
    (point.declared() - point.reversed()).is_zero()
}

/// Whether `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)` at a point, and whether it holds on a group of affine maps if the last
/// coordinate of all vectors is one; the third entry is that of [`in_the_field`].
pub(super) fn at<T: Number>(point: &Sample<T>) -> [bool; 3] {
    let is_here = is_reversed(point);
    [is_here, is_here || point.with_points().is_some_and(|point| is_reversed(&point)), is_here]
}

/// The results of [`at`], and whether the identity holds for the increment `F²`, where `exp(½ log F²) = F` is known.
pub(super) fn in_the_field(point: &Sample<Residue>) -> [bool; 3] {
    let [is_here, of_points, _] = at(point);
    [is_here, of_points, is_here || is_reversed(&point.squared())]
}

impl Sample<'_, Residue> {
    /// The sample at `F²`. There `exp(½ log F²)` is `I + c_1(q) û + c_2(q) û²` with `u = ½ G vee(F²)` and `q = |u|²`.
    fn squared(&self) -> Self {
        let (mut squared, group, of) = (self.clone(), &self.of.derived.group, |n, m| Residue::of(Rational::new(n, m)));
        for matrices in [&mut squared.element.matrices, &mut squared.element.inverses] {
            *matrices = products(matrices, matrices);
        }
        squared.values.extend(increments(group, &squared.element.matrices));
        for (factor, _) in group.factors().iter().enumerate().filter(|(_, own)| own.is_so3) {
            let [root, f] = [&self.element, &squared.element].map(|element| &element.matrices[factor]);
            let ratio = (of(3, 4) - of(1, 4) * f.trace()).apply(Function::LogRatio(0));
            let u = f.vee().map(|entry| of(1, 2) * ratio * entry);
            let q = dot(&u.entries, &u.entries);
            q.remember([of(1, 2) * (root.trace() - Residue::ONE), dot(&root.vee().entries, &u.entries) / q]);
        }
        squared
    }
}

impl<T: Number> Sample<'_, T> {
    /// The sample with one for the last coordinate of all vectors, on a group of affine maps.
    fn with_points(&self) -> Option<Self> {
        let group = &self.of.derived.group;
        let sizes: Vec<usize> = group.turning().filter(|own| own.is_affine()).map(|own| own.size).collect();
        if sizes.is_empty() {
            return None;
        }
        let mut sample = self.clone();
        for (name, value) in &mut sample.values {
            let is_vector = match name {
                Name::Field(_) => true,
                Name::Advected(index) => self.of.declaration.advected_kind(*index).variance() == Variance::Vector,
                _ => false,
            };
            if is_vector && value.columns == 1 && sizes.contains(&value.rows) {
                value.entries.pop();
                value.entries.push(T::ONE);
            }
        }
        Some(sample)
    }
}
