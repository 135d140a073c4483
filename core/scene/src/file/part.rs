//! The parts of a system: its bodies, and what is between two of them.

use std::ops::Range;
use std::sync::Arc;

use liestep::mechanics::Inertia;
use nalgebra::{UnitQuaternion, Vector3};
use serde::Deserialize;
use toml::Spanned;

use crate::file::body::{AnyInertia, INERTIA, InertiaRows, Kinetic, Moments, NonstandardMoments, principal};
use crate::file::effects::{
    AirDragTable, DipoleTable, DragTable, EFFECTS, EffectEntry, MagneticDampingTable, RotorTable, Table, TorqueTable,
};
use crate::file::kepler::Orbit;
use crate::file::mistake::SpanMessage;
use crate::file::orbit::put;
use crate::file::quantity::{self, Density, Length, Mass, PositiveScalar, Speed, Triple};
use crate::file::shape::{BoxTable, RoundTable, Shape, SphereTable};
use crate::file::start::{FramedStart, Start};
use crate::file::text::check_name;

#[derive(Clone)]
pub(crate) struct SystemBody {
    pub(crate) name: String,
    pub(crate) m: f64,
    /// Inertia about the centre of mass; none of a point mass.
    pub(crate) J: Option<Inertia>,
    /// The shape that the body has in pictures, if it is known.
    pub(crate) shape: Option<Shape>,
    /// A kinetic term of second order.
    pub(crate) kinetic: Kinetic,
    pub(crate) position: Vector3<f64>,
    pub(crate) moving: Vector3<f64>,
    pub(crate) start: Start,
    /// Effects of the library on the body.
    pub(crate) effects: Vec<BodyEffect>,
}

/// An effect with its parameters.
pub(crate) type BodyEffect = (&'static EffectEntry, Arc<dyn Table + Send + Sync>);

impl SystemBody {
    /// Sets the mass, the principal moments, or a parameter of an effect, by a key as `dipole.field`; returns whether it can have
    /// these numbers. A point mass has no moments.
    pub(crate) fn put(&mut self, key: &str, numbers: &[f64]) -> bool {
        match (key, numbers) {
            ("m", &[m]) => {
                // An inertia that is the shape's falls with the mass.
                let of = |m: f64| self.shape.as_ref().map(|shape| shape.inertia() * m);
                let is_of_shape = self.J.as_ref().map(|J| *J.as_matrix()) == of(self.m);
                let now = of(m).filter(|_| is_of_shape).and_then(|J| Inertia::new(J).ok());
                self.J = now.or(self.J);
                put(Some(&mut self.m), Some(m).filter(|m| *m > 0.0))
            }
            ("m", _) => false,
            _ if Self::is_inertial(key) => {
                let of_body = self.J.as_mut();
                of_body.is_some_and(|J| principal(key, numbers).map(|(now, _)| *J = now).is_some())
            }
            _ => numbers.iter().enumerate().all(|(at, &number)| self.put_effect(key, at, number)),
        }
    }

    /// Whether a key is that of the mass or of principal moments.
    pub(crate) fn is_inertial(key: &str) -> bool {
        ["m", "moments", "J_d"].contains(&key.strip_suffix(".effective").unwrap_or(key))
    }

    fn put_effect(&mut self, key: &str, component: usize, number: f64) -> bool {
        let Some((effect, key)) = key.split_once('.') else { return false };
        let Some((_, table)) = self.effects.iter_mut().find(|(entry, _)| entry.key == effect) else { return false };
        if Arc::get_mut(table).is_none() {
            *table = table.copied();
        }
        Arc::get_mut(table).is_some_and(|table| table.put((key, component), number, ""))
    }
}

/// A joint or a spring between two bodies, by their numbers; `None` is space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Between<T> {
    pub(crate) bodies: [Option<usize>; 2],
    pub(crate) of: T,
}

/// The name of space among bodies.
pub(crate) const SPACE: &str = "space";

/// The keys of a body.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyTable {
    name: Spanned<String>,
    m: Option<PositiveScalar<Mass>>,
    density: Option<PositiveScalar<Density>>,
    moments: Option<PrincipalMoments>,
    J_d: Option<NonstandardMoments>,
    J: Option<InertiaRows>,
    r#box: Option<BoxTable>,
    cylinder: Option<RoundTable>,
    capsule: Option<RoundTable>,
    sphere: Option<SphereTable>,
    kinetic: Option<Spanned<Kinetic>>,
    position: Option<Triple<Length>>,
    moving: Option<Triple<Speed>>,
    start: Option<FramedStart>,
    dipole: Option<DipoleTable>,
    rotor: Option<RotorTable>,
    drag: Option<DragTable>,
    air_drag: Option<AirDragTable>,
    torque: Option<TorqueTable>,
    magnetic_damping: Option<MagneticDampingTable>,
}

/// An effect of this key, if its table is given.
fn effect<T: Table + Send + Sync + 'static>(key: &str, table: Option<T>) -> Option<BodyEffect> {
    let entry = EFFECTS.iter().find(|entry| entry.key == key)?;
    Some((entry, Arc::new(table?)))
}

/// Principal moments of a body, or the zeros of a point mass.
#[derive(Deserialize)]
#[serde(try_from = "AnyInertia<Triple<quantity::Inertia>>")]
struct PrincipalMoments(Option<Inertia>);

impl TryFrom<AnyInertia<Triple<quantity::Inertia>>> for PrincipalMoments {
    type Error = String;

    fn try_from(moments: AnyInertia<Triple<quantity::Inertia>>) -> Result<Self, String> {
        if moments.value.value == Vector3::zeros() {
            return Ok(Self(None));
        }
        Moments::try_from(moments).map(|moments| Self(Some(moments.J)))
    }
}

const MASSES: &str = "a body has a mass `m`, or a `density` with one of `box`, `cylinder`, `capsule`, `sphere`";

impl BodyTable {
    /// The shape, if one is given.
    fn shape(&self) -> Result<Option<Shape>, &'static str> {
        let shapes = [
            self.r#box.map(Shape::from),
            self.cylinder.map(|round| round.shape(false)),
            self.capsule.map(|round| round.shape(true)),
            self.sphere.map(Shape::from),
        ];
        let mut shapes = shapes.into_iter().flatten();
        match (shapes.next(), shapes.next()) {
            (_, Some(_)) => Err("a body has one of `box`, `cylinder`, `capsule`, `sphere`"),
            (shape, None) => Ok(shape),
        }
    }

    /// The effects on the body, or why it can't have them.
    fn effects(&self, J: Option<&Inertia>, has_orbit: bool) -> Result<Vec<BodyEffect>, String> {
        let all = [
            effect("dipole", self.dipole),
            effect("rotor", self.rotor),
            effect("drag", self.drag),
            effect("air_drag", self.air_drag),
            effect("torque", self.torque),
            effect("magnetic_damping", self.magnetic_damping),
        ];
        let all: Vec<BodyEffect> = all.into_iter().flatten().collect();
        if let (Some((entry, _)), None) = (all.first(), J) {
            return Err(format!("`{}` turns a body, and a point mass has no inertia: leave it out", entry.key));
        }
        match all.iter().find_map(|(entry, table)| Some((entry, table.on_orbit()?))) {
            Some((entry, key)) if !has_orbit => {
                Err(format!("`{key}` of `{}` follows the orbit, and the file has no table `[orbit]`", entry.key))
            }
            _ => Ok(all),
        }
    }

    /// The mass, and the inertia of one that isn't a point mass.
    fn mass(&self, shape: Option<&Shape>) -> Result<(f64, Option<Inertia>), String> {
        let m = match (&self.m, &self.density, shape) {
            (Some(m), None, _) => m.value,
            (None, Some(density), Some(shape)) => density.value * shape.volume(),
            _ => return Err(MASSES.to_owned()),
        };
        let J = match (&self.moments, &self.J_d, &self.J, shape) {
            (Some(PrincipalMoments(J)), None, None, _) => *J,
            (None, None, Some(InertiaRows(J)), _) => Some(*J),
            (None, Some(J_d), None, _) => Some(J_d.inertia()),
            (None, None, None, Some(shape)) => {
                Some(Inertia::new(shape.inertia() * m).map_err(|error| error.to_string())?)
            }
            _ => return Err(format!("{INERTIA}, or a shape: `box`, `cylinder`, `capsule`, `sphere`")),
        };
        Ok((m, J))
    }

    /// The body of a table at this place, the place of its name, and whether it has a place in space.
    pub(crate) fn body(
        self,
        span: Range<usize>,
        orbit: Option<&Orbit>,
    ) -> Result<(SystemBody, Range<usize>, bool), SpanMessage> {
        let shape = self.shape().map_err(|message| (span.clone(), message.to_owned()))?;
        let mass = self.mass(shape.as_ref());
        let effects = mass.as_ref().map_or(Ok(Vec::new()), |(_, J)| self.effects(J.as_ref(), orbit.is_some()));
        let Self { name, kinetic, position, moving, start, .. } = self;
        check_name("a body", name.get_ref()).map_err(|message| (name.span(), message))?;
        if name.get_ref() == SPACE {
            return Err((name.span(), "`space` is what bodies move in; give the body another name".to_owned()));
        }
        let (m, J) = mass.map_err(|message| (span.clone(), message))?;
        let effects = effects.map_err(|message| (span, message))?;
        if let Some(kinetic) = kinetic.as_ref().filter(|kinetic| kinetic.get_ref().order() != 2) {
            let message =
                "a body among several is `geodesic`, `rigid` or `cayley`: joints and springs are of second order";
            return Err((kinetic.span(), message.to_owned()));
        }
        let kinetic = kinetic.map_or(Kinetic::Geodesic, Spanned::into_inner);
        let has_place = position.is_some();
        let wrong = match (has_place, start.is_some(), moving.is_some()) {
            (true, false, _) => Some("a body with a `position` has a `start`, too: its attitude and angular velocity"),
            (false, true, _) => Some("a body with a `start` has a `position`, too; one that joints place has neither"),
            (false, false, true) => {
                Some("a body that is `moving` has a `position` and a `start`; joints have `rate` and `speed`")
            }
            _ => None,
        };
        if let Some(message) = wrong {
            return Err((name.span(), message.to_owned()));
        }
        let moving = moving.map_or_else(Vector3::zeros, |moving| moving.value);
        let position = position.map_or_else(Vector3::zeros, |position| position.value);
        let rest = Start { attitude: UnitQuaternion::identity(), velocity: Vector3::zeros() };
        let start = start.map_or(Ok(rest), |start| start.in_space(orbit))?;
        let place = name.span();
        let body = SystemBody { name: name.into_inner(), m, J, shape, kinetic, position, moving, start, effects };
        Ok((body, place, has_place))
    }
}
