//! Scenes on three groups: with three, six and nine unknowns.

// A declaration names its fields by the letters of its formula.
#![allow(non_snake_case)]

use declarations::FullTop;
use liestep::NonstandardInertia;
use liestep::groups::{LieGroup, R3, SE3};
use liestep::mechanics::{Inertia, Vector};
use liestep::{SO3, lagrangian};
use nalgebra::{Matrix3, Matrix4, Point3, SVector, UnitQuaternion, Vector3, Vector4};

use crate::kernel::Failure;

/// A start: an attitude, and a velocity in the body frame.
pub(crate) type Start<S> = (<S as liestep::mechanics::Term>::Group, Vector<S>);

/// A rigid body in gravity that a spring ties to a point in space.
#[lagrangian(
    group = SE3,
    advected(w = height, a = anchor),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(weight + F * weight))
        - 0.25 * h * k * ((a - p).norm_squared() + (a - F * p).norm_squared()),
)]
#[derive(Clone, Debug)]
pub(crate) struct TiedBody {
    pub(crate) J: Matrix4<f64>,
    pub(crate) weight: Vector4<f64>,
    pub(crate) k: f64,
    pub(crate) p: Point3<f64>,
    pub(crate) height: Vector4<f64>,
    pub(crate) anchor: Point3<f64>,
}

/// Two links on ball joints, beside a mass on a spring.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3, d = R3),
    advected(u = up.seen_from(F_1), v = up.seen_from(F_2), Q = F_2.seen_from(F_1), x = d.seen_from(space)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        + ((F_1 - I) * s_1).dot(&(Q * ((F_2 - I) * s_2))) / h
        - 0.5 * h * g * (u.dot(&(s_1 + F_1 * s_1)) + v.dot(&(s_2 + F_2 * s_2)))
        - 0.25 * h * k * (x.norm_squared() + (x + d).norm_squared()),
)]
#[derive(Clone, Debug)]
pub(crate) struct LinksAndMass {
    pub(crate) J_1: NonstandardInertia,
    pub(crate) J_2: NonstandardInertia,
    pub(crate) s_1: Vector3<f64>,
    pub(crate) s_2: Vector3<f64>,
    pub(crate) m: f64,
    pub(crate) g: f64,
    pub(crate) k: f64,
    pub(crate) up: Vector3<f64>,
}

fn inertia(moments: [f64; 3]) -> Result<NonstandardInertia, Failure> {
    let [x, y, z] = moments;
    Ok(NonstandardInertia::new(Matrix3::new(x, 0.02, -0.03, 0.02, y, 0.01, -0.03, 0.01, z))?)
}

pub(crate) fn top() -> Result<(FullTop, Start<FullTop>), Failure> {
    let inertia = Inertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0))?;
    let (J_d, rho, up) = (inertia.to_nonstandard(), Vector3::new(0.1, -0.2, 0.4), Vector3::z());
    Ok((FullTop { J_d, m: 1.5, g: 9.81, rho, up }, top_start()))
}

pub(crate) fn top_start() -> (SO3, Vector3<f64>) {
    (SO3::exp(Vector3::new(0.8, 0.0, 0.0)), Vector3::new(0.5, 2.0, 6.0))
}

pub(crate) fn tied_body() -> (TiedBody, Start<TiedBody>) {
    let scene = TiedBody {
        J: Matrix4::new(0.3, 0.02, 0.0, 0.05, 0.02, 0.2, 0.01, 0.0, 0.0, 0.01, 0.25, -0.1, 0.05, 0.0, -0.1, 1.5),
        weight: Vector4::new(0.1, 0.2, -0.3, 1.5) * 9.81,
        k: 20.0,
        p: Point3::new(0.2, -0.1, 0.3),
        height: Vector4::new(0.0, 0.0, 1.0, 0.0),
        anchor: Point3::new(0.0, 0.3, 1.0),
    };
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.2, 0.1));
    let attitude = SE3::from_rotation_and_translation(turn, Vector3::new(0.1, 0.2, 0.5));
    (scene, (attitude, SVector::from([0.5, -0.8, 1.2, 0.3, 0.2, -0.4])))
}

pub(crate) fn links_and_mass() -> Result<(LinksAndMass, Start<LinksAndMass>), Failure> {
    let scene = LinksAndMass {
        J_1: inertia([0.6, 0.5, 0.4])?,
        J_2: inertia([0.4, 0.3, 0.5])?,
        s_1: Vector3::new(0.1, 0.05, -0.3),
        s_2: Vector3::new(0.05, -0.1, -0.2),
        m: 1.2,
        g: 9.81,
        k: 15.0,
        up: Vector3::z(),
    };
    let turns = [[0.8, 0.0, 0.0], [-0.2, 0.3, 0.1]].map(|turn| SO3::exp(Vector3::from(turn)));
    let attitude = (turns[0], turns[1], R3::from(Vector3::new(0.1, 0.2, -0.1)));
    Ok((scene, (attitude, SVector::from([0.5, -0.8, 1.2, -0.3, 0.9, 0.4, 0.3, 0.2, -0.4]))))
}

/// The entries of the matrices of an attitude, row by row.
pub(crate) fn entries<G: LieGroup<Scalar = f64>>(attitude: &G) -> Vec<f64> {
    listed(&attitude.matrix())
}

pub(crate) fn listed<E: liestep::numbers::Entries<f64>>(value: &E) -> Vec<f64> {
    let mut list = Vec::new();
    value.each(&mut |entry| list.push(entry));
    list
}
