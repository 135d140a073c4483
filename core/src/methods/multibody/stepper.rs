//! The stepper of a system of bodies.

use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::{Matrix6, Vector6};

roots!();

use super::constraint::Place;
use super::couplings::{Coupling, couplings};
use super::equations::{gap, gap_of_all};
use super::graph::{Joint, Tree};
use super::point_mass::is_point_mass;
use super::state::{Offsets, body_at, layout};
use super::system::{Multibody, ends};
use super::terms::{PlacedTerm, space};
use super::{Body, place};
use crate::error::{SetupError, StepError};
use crate::mechanics::SceneVisitor;
use crate::methods::CompositionScheme;
use crate::motion::Layout;

/// The stepper of a [`Multibody`] system: a [`Propagator`](crate::motion::Propagator) whose states are slices of numbers.
///
/// # Contract
///
/// - Gaps of joints stay at rounding, some units in the last place of the distances from the origin.
/// - Velocities satisfy the constraints as well: energies and momenta of a state are those of the jointed system.
/// - A step satisfies its equations to rounding, or is an error, mostly of a body or a joint, and leaves the state as it
///   was.
/// - A step turns each body by less than a right angle, whatever its kinetic term; one that would turn a body farther is
///   [`StepError::UnsolvedBody`].
/// - Nothing is allocated after a thread's first step of a system of this size.
///
/// A state has the attitudes of all bodies, each a rotation and a translation, then their momenta, the memory for the
/// guess of the next increments and of momenta before their projection, and the number of steps.
///
/// # Source
///
/// The step (2.7) of \[RDAE\] with the multipliers of constrained variational integrators, \[MW01\], section 3: SHAKE in
/// positions, RATTLE in momenta.
#[derive(Clone)]
pub struct MultibodyStepper {
    pub(super) h: f64,
    /// The system, its terms in the order of their bodies.
    pub(super) system: Multibody,
    /// The terms of each body.
    pub(super) ranges: Vec<Range<usize>>,
    pub(super) tree: Arc<Tree>,
    /// The joints some of whose functions are left out.
    pub(super) reduced: Vec<usize>,
    /// The terms that couple bodies within a step.
    pub(super) couplings: Vec<Coupling>,
    /// The bodies without joints: the order in which inertias are eliminated.
    pub(super) free: Arc<Tree>,
    /// The inertia of each body at the origin.
    inertias: Vec<Matrix6<f64>>,
    /// The radius of gyration of each body, m, by which rotations are compared with translations.
    pub(super) lengths: Vec<f64>,
    /// Whether all joints are balls in trees: then momenta are projected for who reads them, and no step needs it.
    pub(super) is_open: bool,
    /// Whether a body has no velocity without its joints.
    pub(super) has_point_masses: bool,
    /// The stages of a composition.
    pub(super) stages: Option<Arc<Stages>>,
    pub(super) layout: Layout,
    pub(super) offsets: Offsets,
}

/// The stages of a composition, each with its share of the step.
pub(super) struct Stages {
    pub(super) scheme: CompositionScheme,
    pub(super) steppers: Vec<(f64, MultibodyStepper)>,
}

impl Stages {
    /// The shares of the stages.
    pub(super) fn gammas(&self) -> impl Iterator<Item = f64> + '_ {
        self.steppers.iter().map(|(gamma, _)| *gamma)
    }
}

impl core::fmt::Debug for MultibodyStepper {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (bodies, joints) = (self.bodies(), self.joints().len());
        let mut debug = f.debug_struct("MultibodyStepper");
        debug.field("h", &self.h).field("bodies", &bodies).field("joints", &joints).finish_non_exhaustive()
    }
}

impl Multibody {
    /// The stepper of the system by steps of `h`, s.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::new`](crate::Stepper::new), and [`SetupError::BodyParameter`] for one of several
    /// bodies; [`SetupError::Joint`] and [`SetupError::JointParameter`] name an invalid joint, [`SetupError::Place`] a
    /// term at a body that there isn't.
    pub fn stepper(self, h: f64) -> Result<MultibodyStepper, SetupError> {
        self.check_terms()?;
        MultibodyStepper::of(self.with_point_masses(), h, None)
    }

    /// Checks the places and the parameters of all terms.
    pub(super) fn check_terms(&self) -> Result<(), SetupError> {
        self.check_places()?;
        for (body, term) in &self.terms {
            term.validate().map_err(|error| match error {
                SetupError::Parameter { field, cause } if self.bodies > 1 => {
                    SetupError::BodyParameter { body: *body, field, cause }
                }
                error => error,
            })?;
        }
        self.pairs.iter().try_for_each(|(_, term)| term.validate())
    }
}

impl MultibodyStepper {
    /// The stepper of a system whose parameters are valid; what is known from a stepper with the same joints isn't found again.
    pub(super) fn of(mut system: Multibody, h: f64, known: Option<&Self>) -> Result<Self, SetupError> {
        // 1/h and the constants that depend on it must be finite, unless h is zero.
        if !h.is_finite() || !(h == 0.0 || (1.0 / h).is_finite()) {
            return Err(SetupError::InvalidStep { step: h });
        }
        // Stable, so that the terms of a body are added in their own order.
        system.terms.sort_by_key(|(body, _)| *body);
        let pairs = system.pairs.iter().map(|(bodies, term)| (bodies, term.has_unknown()));
        let (couplings, coupled) = couplings(pairs);
        let (tree, free) = if let Some(known) = known.filter(|known| known.tree.couplings == coupled) {
            (Arc::clone(&known.tree), Arc::clone(&known.free))
        } else {
            let tree = Tree::of(&system.joints, system.bodies, coupled)?;
            let free = tree.without_joints();
            (Arc::new(tree), Arc::new(free))
        };
        let is_reduced = |joined: &Joint| joined.functions.gap_of_all(&Place::SPACE, &Place::SPACE).is_some();
        let reduced =
            system.joints.iter().enumerate().filter(|(_, joined)| is_reduced(joined)).map(|(k, _)| k).collect();
        let place = |body: usize| system.terms.partition_point(|(of, _)| *of < body);
        let ranges = (0..system.bodies).map(|body| place(body)..place(body + 1)).collect();
        let (layout, offsets, stages) = (layout(system.bodies, 1), Offsets::of(system.bodies, 1), None);
        let (inertias, lengths, has_point_masses) = (Vec::new(), Vec::new(), false);
        let is_open = tree.are_balls(&system.joints);
        let mut stepper = Self {
            h,
            system,
            ranges,
            tree,
            reduced,
            couplings,
            free,
            inertias,
            lengths,
            is_open,
            has_point_masses,
            stages,
            layout,
            offsets,
        };
        let at_origin = alloc::vec![space(); stepper.bodies()];
        stepper.inertias = stepper.limit(&at_origin).matrices;
        let known = known.filter(|known| known.inertias == stepper.inertias);
        if let Some(known) = known {
            (stepper.lengths, stepper.has_point_masses) = (known.lengths.clone(), known.has_point_masses);
        } else {
            stepper.check_inertias(&at_origin)?;
            stepper.has_point_masses =
                (0..stepper.bodies()).any(|body| is_point_mass(&stepper.at_rest(body, &space()).2));
            stepper.lengths = stepper.inertias.iter().map(length).collect();
        }
        if h == 0.0 {
            return Ok(stepper);
        }
        let refolded = stepper.system.refolded(h);
        // Some constants aren't finite for any step.
        if !refolded.is_finite() && !stepper.system.is_finite() {
            return Err(SetupError::NonFiniteConstant);
        }
        stepper.system = refolded;
        let is_possible = known.is_some_and(|known| known.h.to_bits() == h.to_bits());
        if !is_possible && !(stepper.trace() / h).is_finite() {
            return Err(SetupError::InvalidStep { step: h });
        }
        Ok(stepper)
    }

    /// The number of bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.system.bodies
    }

    pub(super) fn joints(&self) -> &[Joint] {
        &self.system.joints
    }

    /// The declaration of each term and all derived equations, as text.
    #[must_use]
    pub fn derivation(&self) -> String {
        self.system.derivation()
    }

    /// Visits the derivations, parameters and places of all terms and joints. Two steppers with the same description and
    /// the same step make the same steps.
    pub fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        #[allow(clippy::cast_precision_loss)] // far fewer than a float counts
        let number = |body: Option<usize>| body.map_or(-1.0, |body| body as f64);
        visitor.term("bodies with joints");
        visitor.parameter("bodies", number(Some(self.bodies())));
        for (body, term) in &self.system.terms {
            visitor.term("on a body");
            visitor.parameter("body", number(Some(*body)));
            term.describe(visitor);
        }
        for (bodies, term) in &self.system.pairs {
            visitor.term("between two bodies");
            for &body in bodies {
                visitor.parameter("body", number(body));
            }
            term.describe(visitor);
        }
        for joined in self.joints() {
            visitor.term(joined.functions.name());
            visitor.parameter("body above", number(joined.above));
            visitor.parameter("body below", number(Some(joined.below)));
            joined.functions.describe(&mut |name, value| visitor.parameter(name, value));
        }
        if let Some(stages) = &self.stages {
            visitor.term(stages.scheme.name());
            stages.gammas().for_each(|gamma| visitor.parameter("gamma", gamma));
        }
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> f64 {
        self.h
    }

    /// The configurations of a state.
    pub(super) fn attitudes(&self, state: &[f64]) -> Vec<Body> {
        (0..self.bodies()).map(|body| body_at(state, body)).collect()
    }

    /// The momenta of a state.
    pub(super) fn momenta(&self, state: &[f64]) -> Vec<Vector6<f64>> {
        (0..self.bodies()).map(|body| self.offsets.momentum(state, body)).collect()
    }

    /// The configuration of a body, as attitude and position.
    ///
    /// # Panics
    ///
    /// If there is no such body, or if the slice is no state of this [`layout`](crate::motion::Propagator::layout).
    #[must_use]
    pub fn attitude(&self, state: &[f64], body: usize) -> Body {
        body_at(state, body)
    }

    /// The momentum of a body in its own axes, its linear momentum in those of space.
    ///
    /// # Panics
    ///
    /// If there is no such body, or if the slice is no state of this [`layout`](crate::motion::Propagator::layout).
    #[must_use]
    pub fn momentum(&self, state: &[f64], body: usize) -> Vector6<f64> {
        self.offsets.momentum(state, body)
    }

    /// The velocity of a body, rad/s in its own axes and m/s in those of space.
    ///
    /// # Panics
    ///
    /// If there is no such body, or if the slice is no state of this [`layout`](crate::motion::Propagator::layout).
    #[must_use]
    pub fn velocity(&self, state: &[f64], body: usize) -> Vector6<f64> {
        if !self.couplings.is_empty() {
            return self.velocities_of(&self.attitudes(state), &self.momenta(state))[body];
        }
        self.velocity_of(body, &self.attitude(state, body), &self.momentum(state, body))
    }

    /// The energy `½ ξ·Jξ + V`, J; NaN if the slice is no state of this layout.
    #[must_use]
    pub fn energy(&self, state: &[f64]) -> f64 {
        if self.check(state).is_err() {
            return f64::NAN;
        }
        self.energy_of(&self.attitudes(state), &self.momenta(state))
    }

    /// The widest gap of a joint, m; the norm includes the cosines of its axes, see [`Joint`](crate::methods::Joint).
    #[must_use]
    pub fn widest_gap(&self, state: &[f64]) -> f64 {
        if self.check(state).is_err() {
            return f64::NAN;
        }
        let places: Vec<Place> = (0..self.bodies()).map(|body| place(&self.attitude(state, body))).collect();
        self.largest_gap(&places).1
    }

    /// The joint with the largest gap, in the units of its functions.
    pub(super) fn largest_gap(&self, places: &[Place]) -> (usize, f64) {
        let gaps =
            self.joints().iter().enumerate().map(|(joint, joined)| {
                (joint, gap_of_all(joined, places).unwrap_or_else(|| gap(joined, places)).norm())
            });
        // A NaN counts as the widest gap.
        gaps.fold((0, 0.0), |widest, gap| if gap.1 <= widest.1 { widest } else { gap })
    }

    /// Adds the kicks of all terms before or after a step.
    pub(super) fn kick(
        &self,
        kicks: &mut [Vector6<f64>],
        between: &mut [Vector6<f64>],
        of_body: impl Fn(&dyn PlacedTerm<1>, usize) -> Option<[Vector6<f64>; 1]>,
        of_pair: impl Fn(usize) -> Option<[Vector6<f64>; 2]>,
    ) {
        for (body, kick) in kicks.iter_mut().enumerate() {
            let parts = self.terms(body).filter_map(|term| of_body(term, body)).map(|[part]| part);
            *kick = parts.reduce(|sum, part| sum + part).unwrap_or_else(Vector6::zeros);
        }
        if self.system.pairs.is_empty() {
            return;
        }
        between.fill(Vector6::zeros());
        for (number, (bodies, _)) in self.system.pairs.iter().enumerate() {
            let Some(both) = of_pair(number) else { continue };
            for (body, part) in bodies.iter().zip(both) {
                if let Some(body) = *body {
                    between[body] += part;
                }
            }
        }
        for (kick, between) in kicks.iter_mut().zip(&*between) {
            *kick += between;
        }
    }

    /// Checks that a slice is a state.
    pub(super) fn check(&self, state: &[f64]) -> Result<(), StepError> {
        if state.len() == self.offsets.length() {
            Ok(())
        } else {
            Err(StepError::NonFinite { what: "state of this layout" })
        }
    }

    /// The configurations of both ends of a term between two bodies.
    pub(super) fn ends<'a>(&self, pair: usize, all: &'a [Body], space: &'a Body) -> [&'a Body; 2] {
        ends(&self.system.pairs[pair].0, all, space)
    }

    /// Sets the memory of a state to that of a new start.
    pub(super) fn begin(&self, state: &mut [f64]) {
        let bodies = self.attitudes(state);
        let momenta = self.momenta(state);
        let mut halves = momenta.clone();
        self.estimate(&bodies, &momenta, &mut halves);
        let gammas = self.stages.as_ref().map_or_else(|| alloc::vec![1.0], |stages| stages.gammas().collect());
        for (stage, gamma) in gammas.into_iter().enumerate() {
            let of_stage: Vec<_> = halves.iter().map(|half| half * gamma).collect();
            self.offsets.begin(state, stage, &of_stage);
        }
    }
}

/// The radius of gyration of a body with this inertia, m.
fn length(inertia: &Matrix6<f64>) -> f64 {
    let trace = |first: usize| (first..first + 3).map(|k| inertia[(k, k)]).sum::<f64>();
    (trace(0) / trace(3)).sqrt()
}
