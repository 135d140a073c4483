//! Sums of the terms of a system: residuals and Jacobians of a step, and momenta and inertias of the continuous limit.

use alloc::vec::Vec;
use core::array::from_mut;

use nalgebra::{Matrix6, Vector6};

use super::Body;
use super::couplings::{Coefficients, Coupling};
use super::elimination::{factorise, solve};
use super::nodes::{Node, Unknowns, set_blocks};
use super::stepper::MultibodyStepper;
use super::system::PlacedPair;
use super::terms::{PlacedTerm, space};
use crate::error::SetupError;
use crate::mechanics::check_inertia;
use crate::numbers::{BlockDiagonal, Coordinates as _, Pattern};

impl MultibodyStepper {
    pub(super) fn terms(&self, body: usize) -> impl Iterator<Item = &dyn PlacedTerm<1>> {
        self.system.terms[self.ranges[body].clone()].iter().map(|(_, term)| &**term)
    }

    /// Sets residuals and Jacobians of the momentum equations.
    pub(super) fn set_newton(
        &self,
        now: &[Body],
        a: &[Vector6<f64>],
        half: &[Vector6<f64>],
        coefficients: &mut Coefficients,
    ) {
        for body in 0..self.bodies() {
            let to = (&mut coefficients.vectors[body], &mut coefficients.matrices[body]);
            self.write_newton(body, &now[body], [&a[body], &half[body]], to);
        }
        coefficients.blocks.fill([Matrix6::zeros(); 2]);
        let (space, still) = (space(), Vector6::zeros());
        for &coupling in &self.couplings {
            let (bodies, term) = &self.system.pairs[coupling.pair];
            let halves = bodies.map(|body| body.map_or(&still, |body| &half[body]));
            let (mut residuals, mut matrix) = ([still; 2], [[Matrix6::zeros(); 2]; 2]);
            let (ends, to) = (self.ends(coupling.pair, now, &space), (&mut residuals, &mut matrix));
            term.write_newton(ends, [[&still; 2], halves], to);
            coefficients.add(bodies, coupling, &residuals, &matrix);
        }
    }

    /// Sets the residuals alone.
    pub(super) fn set_residuals(
        &self,
        now: &[Body],
        a: &[Vector6<f64>],
        half: &[Vector6<f64>],
        residuals: &mut [Vector6<f64>],
    ) {
        for body in 0..self.bodies() {
            residuals[body] = self.newton_residual(body, &now[body], &a[body], &half[body]);
        }
        let (space, still) = (space(), Vector6::zeros());
        for &Coupling { pair, .. } in &self.couplings {
            let (bodies, term) = &self.system.pairs[pair];
            let halves = bodies.map(|body| body.map_or(&still, |body| &half[body]));
            let both = term.newton_residual(self.ends(pair, now, &space), [[&still; 2], halves]);
            for (body, residual) in bodies.iter().zip(both) {
                if let Some(body) = *body {
                    residuals[body] += residual;
                }
            }
        }
    }

    /// Writes residual and Jacobian of a body's momentum equation by its own terms.
    fn write_newton(
        &self,
        body: usize,
        now: &Body,
        [a, half]: [&Vector6<f64>; 2],
        (residual, matrix): (&mut Vector6<f64>, &mut Matrix6<f64>),
    ) {
        let mut terms = self.terms(body).filter(|term| term.has_unknown());
        let Some(first) = terms.next() else {
            (*residual, *matrix) = (Vector6::zeros(), Matrix6::zeros());
            return;
        };
        first.write_newton([now], [[a], [half]], (from_mut(&mut *residual), from_mut(from_mut(&mut *matrix))));
        let (mut before, mut left) = (first, None);
        for term in terms {
            let [a] = before.remainder([left.as_ref().unwrap_or(a)]);
            let (mut of_term, mut part) = ([Vector6::zeros()], [[Matrix6::zeros()]]);
            term.write_newton([now], [[&a], [half]], (&mut of_term, &mut part));
            *residual += of_term[0];
            *matrix += part[0][0];
            (before, left) = (term, Some(a));
        }
    }

    /// The residual of a body's momentum equation by its own terms.
    fn newton_residual(&self, body: usize, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> Vector6<f64> {
        let (mut sum, mut a) = (Vector6::zeros(), *a);
        for term in self.terms(body).filter(|term| term.has_unknown()) {
            sum += term.newton_residual([now], [[&a], [half]])[0];
            [a] = term.remainder([&a]);
        }
        sum
    }

    /// The trace of the Jacobian at rest.
    pub(super) fn trace(&self) -> f64 {
        let zero = Vector6::zeros();
        let of_body = |body: usize| {
            let (mut residual, mut matrix) = (zero, Matrix6::zeros());
            self.write_newton(body, &space(), [&zero; 2], (&mut residual, &mut matrix));
            matrix.trace()
        };
        (0..self.bodies()).map(of_body).sum()
    }

    /// The Lagrangian, the momentum and the inertia of the limit at rest by a body's own terms.
    pub(super) fn at_rest(&self, body: usize, now: &Body) -> (f64, Vector6<f64>, Matrix6<f64>) {
        let mut sum = (0.0, Vector6::zeros(), Matrix6::zeros());
        for term in self.terms(body) {
            let (l, [momentum], [[inertia]]) = term.at_rest([now]);
            sum = (sum.0 + l, sum.1 + momentum, sum.2 + inertia);
        }
        sum
    }

    /// Sets momenta and inertias of the limit at rest.
    pub(super) fn set_limit(&self, now: &[Body], coefficients: &mut Coefficients) {
        for (body, now) in now.iter().enumerate() {
            let mut terms = self.terms(body);
            let Some(first) = terms.next() else { continue };
            let (vector, matrix) = (&mut coefficients.vectors[body], &mut coefficients.matrices[body]);
            (_, [*vector], [[*matrix]]) = first.at_rest([now]);
            for term in terms {
                let (_, [momentum], [[inertia]]) = term.at_rest([now]);
                *vector += momentum;
                *matrix += inertia;
            }
        }
        coefficients.blocks.fill([Matrix6::zeros(); 2]);
        let space = space();
        for &coupling in &self.couplings {
            let (bodies, term) = &self.system.pairs[coupling.pair];
            let (_, momenta, inertia) = term.at_rest(self.ends(coupling.pair, now, &space));
            coefficients.add(bodies, coupling, &momenta, &inertia);
        }
    }

    /// Momenta and inertias of the limit at rest.
    pub(super) fn limit(&self, now: &[Body]) -> Coefficients {
        let mut coefficients = Coefficients::default();
        coefficients.fit(self.bodies(), self.tree.couplings.len());
        self.set_limit(now, &mut coefficients);
        coefficients
    }

    /// The energy `½ ξ·Jξ + V` of these momenta, J.
    pub(super) fn energy_of(&self, now: &[Body], momenta: &[Vector6<f64>]) -> f64 {
        let (limit, velocities) = (self.limit(now), self.velocities_of(now, momenta));
        let mut kinetic = 0.0;
        for (velocity, inertia) in velocities.iter().zip(&limit.matrices) {
            kinetic += velocity.dot(&(inertia * velocity));
        }
        for (&[one, other], [upper, lower]) in self.tree.couplings.iter().zip(&limit.blocks) {
            let [of_one, of_other] = [velocities[one], velocities[other]];
            kinetic += of_one.dot(&(upper * of_other)) + of_other.dot(&(lower * of_one));
        }
        let l: f64 = now.iter().enumerate().map(|(body, now)| self.at_rest(body, now).0).sum();
        let space = space();
        let of_pair = |(pair, (_, term)): (usize, &PlacedPair)| -term.at_rest(self.ends(pair, now, &space)).0;
        let between: f64 = self.system.pairs.iter().enumerate().map(of_pair).sum();
        kinetic * 0.5 + (between - l)
    }

    /// The momenta of these velocities.
    pub(super) fn momenta_of(&self, now: &[Body], velocities: &[Vector6<f64>]) -> Vec<Vector6<f64>> {
        let Coefficients { vectors, matrices, blocks } = self.limit(now);
        let of_bodies = vectors.iter().zip(&matrices).zip(velocities);
        let mut momenta: Vec<_> = of_bodies.map(|((bias, inertia), velocity)| inertia * velocity + bias).collect();
        for (&[one, other], [upper, lower]) in self.tree.couplings.iter().zip(&blocks) {
            momenta[one] += upper * velocities[other];
            momenta[other] += lower * velocities[one];
        }
        momenta
    }

    /// The velocities of these momenta.
    pub(super) fn velocities_of(&self, now: &[Body], momenta: &[Vector6<f64>]) -> Vec<Vector6<f64>> {
        if self.couplings.is_empty() {
            return (0..self.bodies()).map(|body| self.velocity_of(body, &now[body], &momenta[body])).collect();
        }
        let coefficients = self.limit(now);
        let nodes = self.inertias(&coefficients);
        let right = coefficients.vectors.iter().zip(momenta).map(|(bias, momentum)| bias - momentum);
        let joints = alloc::vec![Vector6::zeros(); self.bodies()];
        let mut unknowns = Unknowns { bodies: right.collect(), joints, ..Unknowns::default() };
        solve(&self.free, &nodes, &[], &mut unknowns);
        unknowns.bodies
    }

    /// The eliminated inertias of all bodies, as if there were no joints.
    fn inertias(&self, limit: &Coefficients) -> Vec<Node> {
        let of_body = |(matrix, neighbours): (&Matrix6<f64>, &Vec<_>)| Node {
            matrix: *matrix,
            ..Node::new(0, false, neighbours)
        };
        let mut nodes: Vec<_> = limit.matrices.iter().zip(&self.free.neighbours).map(of_body).collect();
        set_blocks(&self.free, &mut nodes, &limit.blocks);
        factorise(&self.free, &mut nodes, &mut [], &mut Vec::new());
        nodes
    }

    /// The velocity of a momentum, without terms between bodies.
    pub(super) fn velocity_of(&self, body: usize, now: &Body, momentum: &Vector6<f64>) -> Vector6<f64> {
        let (_, bias, inertia) = self.at_rest(body, now);
        let factors = Vector6::factorise_apart(&inertia, Pattern::WHOLE).0;
        Vector6::solve_apart(&factors, Pattern::WHOLE, &(momentum - bias))
    }

    /// Writes approximately half the coordinates of the increments at these momenta: without terms between bodies, unless a body
    /// has no velocity without them.
    pub(super) fn estimate(&self, bodies: &[Body], momenta: &[Vector6<f64>], halves: &mut [Vector6<f64>]) {
        for (body, half) in halves.iter_mut().enumerate() {
            *half = self.velocity_of(body, &bodies[body], &momenta[body]) * (self.h * 0.5);
        }
        if self.has_point_masses {
            let velocities = self.velocities_of(bodies, momenta);
            halves.iter_mut().zip(velocities).for_each(|(half, velocity)| *half = velocity * (self.h * 0.5));
        }
    }

    /// Checks the inertias of the bodies at these configurations.
    pub(super) fn check_inertias(&self, at: &[Body]) -> Result<(), SetupError> {
        let Coefficients { matrices, .. } = self.limit(at);
        matrices.into_iter().enumerate().try_for_each(|(body, inertia)| {
            let inertia = BlockDiagonal([inertia]);
            let of_body = (self.bodies() > 1).then_some(body);
            check_inertia::<[Body; 1]>(&inertia).map_err(|error| match error {
                SetupError::NegativeKinetic { pivot, .. } => SetupError::NegativeKinetic { pivot, body: of_body },
                SetupError::SingularKinetic { determinant, .. } => {
                    SetupError::SingularKinetic { determinant, body: of_body }
                }
                error => error,
            })
        })
    }

    /// Checks that the inertia of all bodies together is positive, if terms couple them.
    pub(super) fn check_coupled_inertia(&self, now: &[Body]) -> Result<(), SetupError> {
        if self.couplings.is_empty() {
            return Ok(());
        }
        // A NaN counts as the wrong sign.
        let is_right = |node: &Node| node.determinant > f64::EPSILON;
        match self.inertias(&self.limit(now)).iter().enumerate().find(|(_, node)| !is_right(node)) {
            Some((body, node)) => Err(SetupError::SingularKinetic { determinant: node.determinant, body: Some(body) }),
            None => Ok(()),
        }
    }
}
