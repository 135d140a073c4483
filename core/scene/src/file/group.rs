//! The group of a scene: its factors, with their names in a file.

use std::ops::Range;
use std::sync::Arc;

use liestep::motion::{Factor, FactorKind};
use liestep_late::{Declaration, LateError, layout};

use crate::file::lagrangian::Backend;

/// A group, with the places of its numbers in a sample: the columns of the attitude, then velocity, momentum, momentum
/// in space, energy and defect.
#[derive(Clone)]
pub(crate) struct Group {
    /// The factors, with the names of their columns.
    pub(crate) factors: Vec<Factor>,
    /// The names of the groups of the factors, such as `SE3`.
    pub(crate) groups: Vec<String>,
    /// The names of the factors' increments in a product; empty for a single factor.
    pub(crate) increments: Vec<String>,
    /// The places of quaternions in a sample.
    pub(crate) quaternions: Arc<[usize]>,
}

impl Default for Group {
    /// SO(3).
    fn default() -> Self {
        let factors = vec![Factor::of(FactorKind::Rotation, 3)];
        Self { factors, groups: vec!["SO3".to_owned()], increments: Vec::new(), quaternions: Arc::new([0]) }
    }
}

impl Group {
    /// The group of a declaration, whose increments have these names.
    pub(crate) fn of(declaration: &'static Declaration, increments: Vec<String>) -> Result<Self, LateError> {
        let groups = declaration.factors.iter().map(|factor| factor.name.clone()).collect();
        let factors = layout::<Backend>(declaration)?.factors;
        let (mut place, mut quaternions) = (0, Vec::new());
        for factor in &factors {
            quaternions.extend((factor.kind == FactorKind::Rotation).then_some(place));
            place += factor.kind.columns();
        }
        Ok(Self { factors, groups, increments, quaternions: quaternions.into() })
    }

    /// Whether it is SO(3), the group of a body about a fixed point.
    pub(crate) fn is_rotation(&self) -> bool {
        matches!(self.factors[..], [Factor { kind: FactorKind::Rotation, .. }])
    }

    /// The number of components of a velocity.
    pub(crate) fn dimension(&self) -> usize {
        self.factors.iter().map(|factor| factor.components.len()).sum()
    }

    fn columns(&self) -> usize {
        self.factors.iter().map(|factor| factor.kind.columns()).sum()
    }

    /// The places of the attitude's columns in a sample.
    pub(crate) fn attitude(&self) -> Range<usize> {
        0..self.columns()
    }

    /// The places of one of velocity, momentum and momentum in space.
    fn vector(&self, which: usize) -> Range<usize> {
        let start = self.columns() + which * self.dimension();
        start..start + self.dimension()
    }

    /// The places of the velocity.
    pub(crate) fn velocity(&self) -> Range<usize> {
        self.vector(0)
    }

    /// The places of the momentum in the body frame.
    pub(crate) fn momentum(&self) -> Range<usize> {
        self.vector(1)
    }

    /// The places of the momentum in space.
    pub(crate) fn in_space(&self) -> Range<usize> {
        self.vector(2)
    }

    /// The place of the energy; the defect follows.
    pub(crate) fn energy(&self) -> usize {
        self.vector(3).start
    }

    /// The unit of an energy: that of angular velocities times angular momenta, or none that is known.
    pub(crate) fn unit_of_energy(&self) -> &'static str {
        if self.factors.iter().all(|factor| factor.kind == FactorKind::Rotation) { "J" } else { "" }
    }
}
