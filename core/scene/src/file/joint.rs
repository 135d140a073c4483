//! The table of a joint: its kind, its points and axes, friction, springs and motors in it, and where it starts.

use std::ops::Range;

use liestep::methods;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use serde::Deserialize;
use toml::Spanned;

use crate::file::mistake::SpanMessage;
use crate::file::orbit::put;
use crate::file::quantity::{
    Angle, Damping, Direction, Force, Inertia, Length, LinearDamping, Mass, PositiveScalar, Quantity, Rate, Scalar,
    Speed, Stiffness, Torque, Triple, TurningStiffness, short,
};
use crate::file::start::Attitude;

/// A joint of two bodies, that of the body above first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Joint {
    pub(crate) kind: Kind,
    /// A point of each, from the centre of mass in the body's axes, m.
    pub(crate) at: [Vector3<f64>; 2],
    /// A unit vector of each; zero where the kind has no axes.
    pub(crate) axes: [Vector3<f64>; 2],
    /// The attitude of the body below in the axes of the body above, at the angle zero.
    pub(crate) zero: Matrix3<f64>,
    /// The distance between the points of a rod, m.
    pub(crate) length: f64,
    pub(crate) terms: Terms,
    pub(crate) limits: Option<Limits>,
    /// The start by the coordinates of the joint, of bodies without places of their own.
    pub(crate) start: Coordinates,
    /// 1, or −1 where the file names the bodies in the other order: the sign of angles and shifts there.
    pub(crate) sign: f64,
}

/// The attitude of a body, or of space, and the place of its origin.
pub(crate) type Pose = (Matrix3<f64>, Vector3<f64>);

/// Terms in a joint: those of a slider are of shifts, others of turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Terms {
    /// N m s, or N s/m.
    pub(crate) damping: Option<f64>,
    /// N m/rad, or N/m.
    pub(crate) stiffness: Option<f64>,
    /// The angle or the shift at which the spring is at rest, rad or m.
    pub(crate) rest: f64,
    /// The torque or the force of a motor, N m or N.
    pub(crate) effort: Option<f64>,
    /// The torque of dry friction, N m, and the rate below which it is viscous, rad/s; in a slider a force, N, and a speed, m/s.
    pub(crate) friction: Option<[f64; 2]>,
    /// The inertia of a motor's rotor, as the joint feels it, kg m² or kg.
    pub(crate) armature: Option<f64>,
}

impl Terms {
    /// Whether a slider has a spring, or a motor, which is a part of the same term.
    pub(crate) fn has_spring(&self) -> bool {
        self.stiffness.is_some() || self.effort.is_some()
    }
}

/// The ends of a joint's way, which are watched: angles of a pin, rad, or shifts of a slider, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub(crate) ends: [f64; 2],
    /// Whether the run stops there.
    pub(crate) stops: bool,
}

/// Angle, rad, and shift, m, of a joint, and their rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Coordinates {
    pub(crate) angle: f64,
    pub(crate) rate: f64,
    pub(crate) shift: f64,
    pub(crate) speed: f64,
}

/// The kind of a joint, see [`liestep::methods::Joint`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Kind {
    Ball,
    Pin,
    Universal,
    Cylinder,
    Slider,
    Weld,
    Plane,
    Distance,
}

impl Kind {
    pub(crate) const ALL: [Self; 8] =
        [Self::Ball, Self::Pin, Self::Universal, Self::Weld, Self::Cylinder, Self::Slider, Self::Plane, Self::Distance];

    fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball joint",
            Self::Pin => "pin",
            Self::Universal => "universal joint",
            Self::Cylinder => "cylinder",
            Self::Slider => "slider",
            Self::Weld => "weld",
            Self::Plane => "plane",
            Self::Distance => "distance",
        }
    }

    fn has_axes(self) -> bool {
        !matches!(self, Self::Ball | Self::Weld | Self::Distance)
    }

    /// Whether the axes of both bodies are parallel.
    fn has_one_axis(self) -> bool {
        self.has_axes() && self != Self::Universal
    }

    pub(crate) fn turns_about_axis(self) -> bool {
        matches!(self, Self::Pin | Self::Cylinder | Self::Plane)
    }

    fn turns(self) -> bool {
        !matches!(self, Self::Slider | Self::Weld | Self::Distance)
    }

    pub(crate) fn shifts_along_axis(self) -> bool {
        matches!(self, Self::Slider | Self::Cylinder)
    }

    /// Whether points of both bodies coincide.
    pub(crate) fn has_one_point(self) -> bool {
        matches!(self, Self::Ball | Self::Pin | Self::Universal | Self::Weld)
    }

    /// Whether the functions are cosines in part.
    pub(crate) fn has_cosines(self) -> bool {
        !matches!(self, Self::Ball | Self::Distance)
    }

    /// Whether the coordinates of the joint give the place of one body by that of the other.
    pub(crate) fn places(self) -> bool {
        self != Self::Distance
    }
}

/// The names of two bodies.
pub(crate) type Names = Spanned<[Spanned<String>; 2]>;

/// The keys of a joint.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct JointTable {
    /// The name, by which programs reach it.
    pub(crate) name: Option<Spanned<String>>,
    kind: Spanned<Kind>,
    pub(crate) bodies: Names,
    at: [Triple<Length>; 2],
    axes: Option<Spanned<[Direction; 2]>>,
    zero: Option<Spanned<Attitude>>,
    length: Option<Spanned<PositiveScalar<Length>>>,
    damping: Value,
    stiffness: Value,
    rest: Value,
    torque: Value,
    force: Value,
    friction: Option<Spanned<FrictionTable>>,
    armature: Value,
    limits: Option<Spanned<LimitsTable>>,
    angle: Value,
    rate: Value,
    shift: Value,
    speed: Value,
}

/// A value whose unit depends on the kind of joint.
type Value = Option<Spanned<toml::Value>>;

/// Dry friction, regularised: its torque, or its force in a slider.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrictionTable {
    torque: Value,
    force: Value,
    /// The rate or the speed below which friction is viscous.
    below: Value,
}

impl FrictionTable {
    /// The torque or the force, and the rate or the speed below which it is viscous.
    fn friction(&self, span: Range<usize>, is_slider: bool) -> Result<[f64; 2], SpanMessage> {
        let (own, other, message) = if is_slider {
            (
                &self.force,
                &self.torque,
                "dry friction in a slider has a `force`, N, and the speed `below` which it is viscous, m/s",
            )
        } else {
            (
                &self.torque,
                &self.force,
                "dry friction has a `torque`, N m, and the rate `below` which it is viscous, rad/s",
            )
        };
        let [most, below] = if is_slider {
            [positive::<Force>(own)?, positive::<Speed>(&self.below)?]
        } else {
            [positive::<Torque>(own)?, positive::<Rate>(&self.below)?]
        };
        match (most, below, other) {
            (Some(most), Some(below), None) => Ok([most, below]),
            (_, _, Some(other)) => Err((other.span(), message.to_owned())),
            _ => Err((span, message.to_owned())),
        }
    }
}

/// The ends of a joint's way.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitsTable {
    from: Spanned<toml::Value>,
    to: Spanned<toml::Value>,
    #[serde(default)]
    stop: bool,
}

impl LimitsTable {
    fn limits<Q: Quantity>(self, span: Range<usize>, most: f64) -> Result<Limits, SpanMessage> {
        let end = |value| Ok(read::<Q>(&Some(value))?.unwrap_or(0.0));
        let [from, to] = [end(self.from)?, end(self.to)?];
        if from >= to {
            return Err((span, "a joint moves `from` one place `to` a greater one".to_owned()));
        }
        if to - from >= most {
            return Err((
                span,
                "these limits are a turn apart or more, so that none is reached: leave them out".to_owned(),
            ));
        }
        Ok(Limits { ends: [from, to], stops: self.stop })
    }
}

/// The number of a value with the units of a quantity.
fn read<Q: Quantity>(value: &Value) -> Result<Option<f64>, SpanMessage> {
    let Some(value) = value else { return Ok(None) };
    let read = Scalar::<Q>::deserialize(value.get_ref().clone());
    read.map(|scalar| Some(scalar.value)).map_err(|error| (value.span(), error.message().to_owned()))
}

/// A number above zero.
fn positive<Q: Quantity>(value: &Value) -> Result<Option<f64>, SpanMessage> {
    let number = read::<Q>(value)?;
    match (number, value) {
        (Some(number), Some(value)) if number <= 0.0 => Err((value.span(), "must be above zero".to_owned())),
        _ => Ok(number),
    }
}

/// The largest cosine between what `zero` makes of the axis below and a direction across the axis above.
const ALONG: f64 = 1e-6;

impl JointTable {
    /// Refuses keys that the kind doesn't have.
    fn check(&self) -> Result<(), SpanMessage> {
        let kind = *self.kind.get_ref();
        let name = kind.name();
        let refuse = |span: Range<usize>, why: String| Err((span, why));
        if let (Kind::Ball, Some(axes)) = (kind, &self.axes) {
            return refuse(
                axes.span(),
                "a ball joint turns about any axis; leave `axes` out, or make it a `pin`".to_owned(),
            );
        }
        if let (false, Some(axes)) = (kind.has_axes(), &self.axes) {
            return refuse(axes.span(), format!("a {name} has no axis: leave `axes` out"));
        }
        if kind.has_axes() && self.axes.is_none() {
            let message = format!("a {name} has `axes`: that of each of its bodies, in that body's frame");
            return refuse(self.kind.span(), message);
        }
        match (&self.length, kind) {
            (None, Kind::Distance) => {
                return refuse(
                    self.kind.span(),
                    "a distance has a `length`, m, that of a rod between both points".to_owned(),
                );
            }
            (Some(length), kind) if kind != Kind::Distance => {
                return refuse(length.span(), format!("a {name} has no `length`; a `distance` has"));
            }
            _ => (),
        }
        let is_slider = kind == Kind::Slider;
        let of_both = kind.turns() || is_slider;
        let has = [
            ("damping", &self.damping, of_both),
            ("stiffness", &self.stiffness, kind.turns() && kind != Kind::Plane || is_slider),
            ("rest", &self.rest, kind.turns_about_axis() && kind != Kind::Plane || is_slider),
            ("torque", &self.torque, kind.turns_about_axis()),
            ("force", &self.force, is_slider),
            ("armature", &self.armature, of_both),
            ("angle", &self.angle, kind.turns_about_axis()),
            ("rate", &self.rate, kind.turns_about_axis()),
            ("shift", &self.shift, kind.shifts_along_axis()),
            ("speed", &self.speed, kind.shifts_along_axis()),
        ];
        for (key, value, has) in has {
            if let (Some(value), false) = (value, has) {
                let instead = match key {
                    "torque" if is_slider => "; its motor has a `force`",
                    "force" if kind.turns() => "; a motor that turns has a `torque`",
                    "angle" | "rate" if is_slider => "; it starts at a `shift` with a `speed`",
                    "shift" | "speed" if kind.turns_about_axis() => "; it starts at an `angle` with a `rate`",
                    _ => "",
                };
                return refuse(value.span(), format!("a {name} has no `{key}`{instead}"));
            }
        }
        if let (Some(friction), false) = (&self.friction, of_both) {
            return refuse(
                friction.span(),
                format!("a {name} has no dry `friction`: it is for joints that turn, and for sliders"),
            );
        }
        if let (Some(limits), false) = (&self.limits, matches!(kind, Kind::Pin | Kind::Slider)) {
            return refuse(limits.span(), format!("a {name} has no `limits`: those of a pin and a slider are watched"));
        }
        if let (Some(rest), None) = (&self.rest, &self.stiffness) {
            return refuse(rest.span(), "a spring that is at `rest` somewhere has a `stiffness`".to_owned());
        }
        Ok(())
    }

    /// The attitude at the angle zero: that which is given, or by the least turn that makes the axes parallel.
    fn attitude(&self, axes: &[Vector3<f64>; 2]) -> Result<Matrix3<f64>, SpanMessage> {
        let kind = *self.kind.get_ref();
        let given = self.zero.as_ref().map(|zero| *zero.get_ref().rotation().to_rotation_matrix().matrix());
        if !kind.has_one_axis() {
            return Ok(given.unwrap_or_else(Matrix3::identity));
        }
        let [above, below] = axes;
        if let (Some(given), Some(zero)) = (given, &self.zero) {
            let off = (given * below).cross(above).norm();
            if off > ALONG {
                let message = format!(
                    "`zero` turns the second of `axes` away from the first, by {} in sine: in both frames they are one line",
                    short(off)
                );
                return Err((zero.span(), message));
            }
            return Ok(given);
        }
        // Opposite axes have no least turn: half a turn about any axis across them.
        let half = || {
            let across = above.cross(&Vector3::ith(above.iamin(), 1.0));
            Rotation3::from_axis_angle(&Unit::new_normalize(across), std::f64::consts::PI)
        };
        Ok(*Rotation3::rotation_between(below, above).unwrap_or_else(half).matrix())
    }

    /// The place of the first of its coordinates at the start, if any is given.
    pub(crate) fn coordinate(&self) -> Option<Range<usize>> {
        [&self.angle, &self.rate, &self.shift, &self.speed].into_iter().flatten().map(Spanned::span).next()
    }

    /// The joint; if the second of its bodies is space, with both exchanged.
    pub(crate) fn joint(self, is_swapped: bool) -> Result<Joint, SpanMessage> {
        self.check()?;
        let kind = *self.kind.get_ref();
        let axes = self.axes.as_ref().map_or([Vector3::zeros(); 2], |axes| axes.get_ref().map(|axis| axis.0));
        let zero = self.attitude(&axes)?;
        let is_slider = kind == Kind::Slider;
        let by_kind =
            |turn: Result<_, SpanMessage>, shift: Result<_, SpanMessage>| if is_slider { shift } else { turn };
        let terms = Terms {
            damping: by_kind(positive::<Damping>(&self.damping), positive::<LinearDamping>(&self.damping))?,
            stiffness: by_kind(positive::<TurningStiffness>(&self.stiffness), positive::<Stiffness>(&self.stiffness))?,
            rest: by_kind(read::<Angle>(&self.rest), read::<Length>(&self.rest))?.unwrap_or(0.0),
            effort: by_kind(read::<Torque>(&self.torque), read::<Force>(&self.force))?,
            friction: self.friction.map(|one| one.get_ref().friction(one.span(), is_slider)).transpose()?,
            armature: by_kind(positive::<Inertia>(&self.armature), positive::<Mass>(&self.armature))?,
        };
        let start = Coordinates {
            angle: read::<Angle>(&self.angle)?.unwrap_or(0.0),
            rate: read::<Rate>(&self.rate)?.unwrap_or(0.0),
            shift: read::<Length>(&self.shift)?.unwrap_or(0.0),
            speed: read::<Speed>(&self.speed)?.unwrap_or(0.0),
        };
        let limits = self.limits.map(|limits| {
            let (span, limits) = (limits.span(), limits.into_inner());
            if is_slider {
                limits.limits::<Length>(span, f64::INFINITY)
            } else {
                limits.limits::<Angle>(span, std::f64::consts::TAU)
            }
        });
        let limits = limits.transpose()?;
        let length = self.length.map_or(0.0, |length| length.into_inner().value);
        let at = self.at.map(|point| point.value);
        let joint = Joint { kind, at, axes, zero, length, terms, limits, start, sign: 1.0 };
        Ok(if is_swapped { joint.swapped() } else { joint })
    }
}

impl Joint {
    /// The joint from the other end: angles, shifts and what acts along them have the opposite sign.
    fn swapped(self) -> Self {
        let Self { mut at, mut axes, zero, terms, limits, start, .. } = self;
        at.swap(0, 1);
        axes.swap(0, 1);
        let Coordinates { angle, rate, shift, speed } = start;
        let terms = Terms { rest: -terms.rest, effort: terms.effort.map(|effort| -effort), ..terms };
        let start = Coordinates { angle: -angle, rate: -rate, shift: -shift, speed: -speed };
        let limits = limits.map(|limits| Limits { ends: [-limits.ends[1], -limits.ends[0]], ..limits });
        Self { at, axes, zero: zero.transpose(), terms, limits, start, sign: -self.sign, ..self }
    }

    /// Sets a value over time, with the sign that the file has; returns whether it can have this number.
    pub(crate) fn put(&mut self, key: &str, number: f64) -> bool {
        let (terms, signed) = (&mut self.terms, self.sign * number);
        let or_off = Some(number).filter(|number| *number >= 0.0);
        match key {
            "torque" | "force" => put(terms.effort.as_mut(), Some(signed)),
            "rest" => put(Some(&mut terms.rest), Some(signed)),
            "damping" => put(terms.damping.as_mut(), or_off),
            "stiffness" => put(terms.stiffness.as_mut(), or_off),
            "friction.torque" => put(terms.friction.as_mut().map(|[torque, _]| torque), or_off),
            "friction.below" => put(terms.friction.as_mut().map(|[_, below]| below), or_off.filter(|rate| *rate > 0.0)),
            _ => false,
        }
    }

    /// The angle about the axis, rad, from −π to π, and the shift along it, m, between bodies in these poses.
    pub(crate) fn coordinates(&self, [(above, at), (below, to)]: [&Pose; 2]) -> [f64; 2] {
        let Self { at: points, axes: [axis, _], zero, .. } = self;
        let turned = above.tr_mul(below) * zero.transpose();
        let sine = Vector3::new(turned.m32 - turned.m23, turned.m13 - turned.m31, turned.m21 - turned.m12) * 0.5;
        let apart = above.tr_mul(&(to + below * points[1] - at)) - points[0];
        [sine.dot(axis).atan2((turned.trace() - 1.0) * 0.5), axis.dot(&apart)]
    }

    /// The constraint.
    pub(crate) fn constraint(&self) -> methods::Joint {
        let Self { kind, at, axes, zero, length, .. } = *self;
        match kind {
            Kind::Ball => methods::Joint::ball(at),
            Kind::Pin => methods::Joint::pin(at, axes),
            Kind::Universal => methods::Joint::universal(at, axes),
            Kind::Cylinder => methods::Joint::cylinder(at, axes),
            Kind::Slider => methods::Joint::slider(at, axes[0], zero),
            Kind::Weld => methods::Joint::weld(at, zero),
            Kind::Plane => methods::Joint::plane(at, axes),
            Kind::Distance => methods::Joint::distance(at, length),
        }
    }

    /// The attitude of the body below in the axes of the body above, at this angle about the axis.
    pub(crate) fn attitude_at(&self, angle: f64) -> Matrix3<f64> {
        if angle == 0.0 {
            return self.zero;
        }
        Rotation3::from_axis_angle(&Unit::new_normalize(self.axes[0]), angle).matrix() * self.zero
    }
}
