//! Point masses on joints: bodies whose velocity follows from their momentum and their joints together.
//!
//! A point mass has no moments of inertia, so its matrix `A` is singular, and elimination along the tree stops there. An inertia
//! against the opening of its joints, `½ ġᵀ K ġ`, makes `A` regular. It is zero on all motions, as joints stay closed: each step is
//! to the bit an exact solution with it and without it, and so are momenta, energies and multipliers. A point mass whose joints let
//! it turn without moving has no motion that is determined, and the inertia of all bodies together is singular with this term, too.

use alloc::string::String;
use alloc::sync::Arc;

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::constraint::Place;
use super::ends::Ends;
use super::graph::Joint;
use super::system::Multibody;
use super::terms::{AtRest, Blocks, PlacedTerm, space};
use super::{Body, Increment, parts, place};
use crate::error::SetupError;
use crate::groups::{CayleyRetraction, LieGroup as _, Retraction, SO3};
use crate::mechanics::{SceneVisitor, check_inertia};
use crate::numbers::BlockDiagonal;

/// The inertia against the opening of a joint.
struct JointInertia {
    joint: Joint,
    /// The factor `K` of each function: kg for lengths, kg m² for cosines.
    factors: Vector6<f64>,
    /// The step, s.
    h: f64,
}

impl JointInertia {
    /// The inertia of a joint by the mass of a body at it, kg.
    fn of(joint: &Joint, mass: f64) -> Self {
        let mut ends = [Ends::ZERO; 2];
        let [above, below] = &mut ends;
        let axes = Matrix3::identity();
        let at = [&Place::SPACE; 2];
        joint.functions.slopes(at, [Some(&axes); 2], [&mut above.before, &mut below.before]);
        let rows = joint.functions.rows();
        let squared_arm = ends.iter().map(|ends| ends.squared_arm(rows)).fold(0.0, f64::max);
        let is_length = |row: usize| ends[1].before.fixed_view::<3, 1>(3, row).norm_squared() > 0.0;
        let factor = |row: usize| match (row < rows, is_length(row)) {
            (true, true) => mass,
            (true, false) => mass * squared_arm,
            (false, _) => 0.0,
        };
        Self { joint: joint.clone(), factors: Vector6::from_fn(|row, _| factor(row)), h: 1.0 }
    }

    /// The functions' derivatives by the unknowns of both bodies, one a column, for these maps from unknowns to turns.
    fn slopes(&self, places: &[Place; 2], turns: [Matrix3<f64>; 2]) -> [Matrix6<f64>; 2] {
        let mut slopes = [Matrix6::zeros(); 2];
        let [above, below] = &mut slopes;
        self.joint.functions.slopes([&places[0], &places[1]], [Some(&turns[0]), Some(&turns[1])], [above, below]);
        slopes
    }

    /// The blocks `Gᵀ K G` of these slopes, times a factor.
    fn blocks(&self, slopes: &[Matrix6<f64>; 2], factor: f64) -> Blocks<2> {
        let weights = Matrix6::from_diagonal(&(self.factors * factor));
        [0, 1].map(|row| [0, 1].map(|column| slopes[row] * weights * slopes[column].transpose()))
    }

    /// The places after these half increments, and the maps from unknowns to turns.
    fn after(now: [&Body; 2], halves: [&Vector6<f64>; 2]) -> ([Place; 2], [Matrix3<f64>; 2]) {
        let next = [0, 1].map(|side| {
            let (turn, shift) = parts(halves[side]);
            let increment = <CayleyRetraction as Retraction<SO3>>::increment_of_half(&turn);
            let before = place(now[side]);
            let attitude = *now[side].0.advance(&increment).as_matrix();
            let tangent = <CayleyRetraction as Retraction<SO3>>::tangent_of_half(&turn);
            (Place { attitude, position: before.position + shift * 2.0 }, before.attitude * tangent * 0.5)
        });
        (next.map(|(place, _)| place), next.map(|(_, turn)| turn))
    }

    /// The momenta `(2/h) Cᵀ K g` of both bodies at the end of a step.
    fn residual(&self, places: &[Place; 2], slopes: &[Matrix6<f64>; 2]) -> [Vector6<f64>; 2] {
        let [above, below] = places;
        let gap = self.joint.functions.gap(above, below).component_mul(&self.factors) / self.h;
        [0, 1].map(|side| slopes[side] * gap)
    }
}

impl PlacedTerm<2> for JointInertia {
    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn refolded(&self, h: f64) -> Arc<dyn PlacedTerm<2>> {
        Arc::new(Self { joint: self.joint.clone(), factors: self.factors, h })
    }

    fn is_finite(&self) -> bool {
        (self.factors / self.h).iter().all(|factor| factor.is_finite())
    }

    /// The term is zero where the joint is closed, as it is at both ends of a step.
    fn is_self_adjoint(&self) -> bool {
        true
    }

    fn has_unknown(&self) -> bool {
        true
    }

    fn kick_before(&self, _: [&Body; 2]) -> Option<[Vector6<f64>; 2]> {
        None
    }

    fn kick_after(&self, _: [&Increment; 2], _: [&Body; 2]) -> Option<[Vector6<f64>; 2]> {
        None
    }

    /// The Jacobian is that for closed joints, to which the iteration converges.
    fn write_newton(
        &self,
        now: [&Body; 2],
        [_, halves]: [[&Vector6<f64>; 2]; 2],
        to: (&mut [Vector6<f64>; 2], &mut Blocks<2>),
    ) {
        let (places, turns) = Self::after(now, halves);
        let slopes = self.slopes(&places, turns);
        (*to.0, *to.1) = (self.residual(&places, &slopes), self.blocks(&slopes, 2.0 / self.h));
    }

    fn newton_residual(&self, now: [&Body; 2], [_, halves]: [[&Vector6<f64>; 2]; 2]) -> [Vector6<f64>; 2] {
        let (places, turns) = Self::after(now, halves);
        self.residual(&places, &self.slopes(&places, turns))
    }

    fn remainder(&self, a: [&Vector6<f64>; 2]) -> [Vector6<f64>; 2] {
        a.map(|a| *a)
    }

    fn at_rest(&self, now: [&Body; 2]) -> AtRest<2> {
        let places = now.map(place);
        let slopes = self.slopes(&places, [places[0].attitude, places[1].attitude]);
        (0.0, [Vector6::zeros(); 2], self.blocks(&slopes, 1.0))
    }

    fn derivation(&self) -> String {
        String::from("l = ½ ġᵀ K ġ, which is zero: the functions g of a joint of a point mass vanish\n")
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("inertia against the opening of a joint");
        self.factors.iter().for_each(|&factor| visitor.parameter("factor", factor));
    }
}

/// The inertia at rest by the terms of a body, at the origin of space.
fn inertia<'a>(terms: impl Iterator<Item = &'a Arc<dyn PlacedTerm<1>>>) -> Matrix6<f64> {
    terms.map(|term| term.at_rest([&space()]).2[0][0]).fold(Matrix6::zeros(), |sum, part| sum + part)
}

/// Whether a body with this inertia has no velocity by its momentum alone.
pub(super) fn is_point_mass(inertia: &Matrix6<f64>) -> bool {
    matches!(check_inertia::<[Body; 1]>(&BlockDiagonal([*inertia])), Err(SetupError::SingularKinetic { .. }))
}

impl Multibody {
    /// The system with an inertia against the opening of each joint of a point mass.
    pub(super) fn with_point_masses(mut self) -> Self {
        for body in 0..self.bodies {
            let inertia = inertia(self.terms.iter().filter(|(of, _)| *of == body).map(|(_, term)| term));
            if !is_point_mass(&inertia) {
                continue;
            }
            let mass = inertia.fixed_view::<3, 3>(3, 3).trace() / 3.0;
            for joint in &self.joints {
                if joint.below == body || joint.above == Some(body) {
                    let bodies = [joint.above, Some(joint.below)];
                    self.pairs.push((bodies, Arc::new(JointInertia::of(joint, mass))));
                }
            }
        }
        self
    }
}
