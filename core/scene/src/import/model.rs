//! A model as its file has it: links, and joints between them.

use nalgebra::{Isometry3, Vector3};

use super::rigid::Distribution;

/// Links, the joints between them, and remarks about elements without a counterpart.
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<Joint>,
    pub(super) remarks: Vec<String>,
    /// The acceleration of falling bodies, m/s².
    pub(super) gravity: Vector3<f64>,
    /// Whether the root is the world, which is space.
    pub(super) has_world: bool,
    /// The number of joints with limits.
    pub(super) watched: usize,
}

impl Default for Robot {
    fn default() -> Self {
        let gravity = Vector3::new(0.0, 0.0, -9.81);
        Self {
            name: String::new(),
            links: Vec::new(),
            joints: Vec::new(),
            remarks: Vec::new(),
            gravity,
            has_world: false,
            watched: 0,
        }
    }
}

pub(super) struct Link {
    pub(super) name: String,
    pub(super) place: (usize, usize),
    /// The mass in the link's frame; none of a frame alone.
    pub(super) mass: Distribution,
}

pub(super) struct Joint {
    pub(super) name: String,
    pub(super) place: (usize, usize),
    pub(super) parent: String,
    pub(super) child: String,
    /// The frame of the child in that of the parent, where the joint is at zero.
    pub(super) origin: Isometry3<f64>,
    /// The point of the joint in the child's frame, m.
    pub(super) at: Vector3<f64>,
    pub(super) connection: Connection,
    /// Whether the joint closes a loop: others place its child.
    pub(super) closes: bool,
    /// N m s, or N s/m.
    pub(super) damping: f64,
    /// N m, or N.
    pub(super) friction: f64,
    /// The inertia of a motor's rotor behind its gear, kg m² or kg.
    pub(super) armature: f64,
    /// The ends of the joint's way, rad or m.
    pub(super) limits: Option<[f64; 2]>,
    /// N m/rad, or N/m.
    pub(super) stiffness: f64,
    /// The coordinate at which the spring is at rest, rad or m.
    pub(super) rest: f64,
}

impl Joint {
    /// A joint with its name and its place in the model, between a parent and a child, at the child's origin and with nothing in it.
    pub(super) fn new(
        (name, place): (String, (usize, usize)),
        [parent, child]: [String; 2],
        (origin, connection): (Isometry3<f64>, Connection),
    ) -> Self {
        let at = Vector3::zeros();
        let (closes, limits) = (false, None);
        let (damping, friction, armature, stiffness, rest) = (0.0, 0.0, 0.0, 0.0, 0.0);
        Self {
            name,
            place,
            parent,
            child,
            origin,
            at,
            connection,
            closes,
            damping,
            friction,
            armature,
            limits,
            stiffness,
            rest,
        }
    }
}

/// The kind of a joint, with its axis in the child's frame, where the joint is at zero.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Connection {
    Fixed,
    Pin(Vector3<f64>),
    Slider(Vector3<f64>),
    Cylinder(Vector3<f64>),
    /// The axis that the parent carries, and that of the child.
    Universal([Vector3<f64>; 2]),
    Plane(Vector3<f64>),
    Ball,
    Free,
}

impl Connection {
    /// The kind's name in a scene, with the axis that the body above carries and that of the body below.
    pub(super) fn kind(&self) -> Option<(&'static str, Option<[Vector3<f64>; 2]>)> {
        Some(match *self {
            Self::Pin(axis) => ("pin", Some([axis; 2])),
            Self::Slider(axis) => ("slider", Some([axis; 2])),
            Self::Cylinder(axis) => ("cylinder", Some([axis; 2])),
            Self::Universal(axes) => ("universal", Some(axes)),
            Self::Plane(axis) => ("plane", Some([axis; 2])),
            Self::Ball => ("ball", None),
            Self::Fixed => ("weld", None),
            Self::Free => return None,
        })
    }
}
