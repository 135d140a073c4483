//! Masses of the shapes of MJCF.

use nalgebra::{Matrix3, Translation3, Vector3};

use super::super::rigid::Distribution;
use super::super::xml::{Read, finite, numbers, place};
use super::classes::Element;
use super::compiler::{Compiler, to_axis};
use crate::file::shape::{Round, Shape};

/// The density of a shape that says nothing of it, kg/m³.
const DENSITY: f64 = 1000.0;

/// The mass of a shape in the axes of its body.
pub(super) enum Weight {
    Known(Distribution),
    /// None of a shape whose volume isn't read: a mesh.
    Unread,
}

/// The mass of an element `geom`.
pub(super) fn weight(element: &Element<'_, '_>, compiler: &Compiler) -> Read<Weight> {
    let number = |key| element.with(key).map(|node| finite(node, node.attribute(key).unwrap_or(""))).transpose();
    let group = number("group")?.unwrap_or(0.0);
    let (mass, density) = (number("mass")?, number("density")?.unwrap_or(DENSITY));
    let (lowest, highest) = (compiler.groups[0], compiler.groups[1]);
    if mass == Some(0.0) || (mass.is_none() && density == 0.0) || group < lowest || group > highest {
        return Ok(Weight::Known(Distribution::NOTHING));
    }
    let kind = element.text("type").unwrap_or(if element.text("mesh").is_some() { "mesh" } else { "sphere" });
    if matches!(kind, "plane" | "hfield") {
        return Ok(Weight::Known(Distribution::NOTHING));
    }
    if matches!(kind, "mesh" | "sdf") {
        return Ok(Weight::Unread);
    }
    let mut frame = compiler.frame(element)?;
    let mut half = None;
    if let Some(node) = element.with("fromto").filter(|_| kind != "sphere") {
        let [a, b, c, d, e, f] = numbers(node, "fromto", node.attribute("fromto").unwrap_or(""))?;
        let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        let way = to - from;
        if way.norm() == 0.0 {
            return Err((place(node), "the ends of `fromto` are one point".to_owned()));
        }
        frame.translation = Translation3::from((from + to) * 0.5);
        // The third axis is that from the second point to the first, as in MuJoCo.
        frame.rotation = to_axis(&(-way.normalize()));
        half = Some(way.norm() * 0.5);
    }
    let shape = sizes(element, kind, half)?;
    let (volume, inertia) = match shape {
        Solid::Shape(shape) => (shape.volume(), shape.inertia()),
        Solid::Ellipsoid(axes) => {
            let squares = axes.component_mul(&axes);
            let moments = squares.map(|square| squares.sum() - square) / 5.0;
            (4.0 / 3.0 * std::f64::consts::PI * axes.product(), Matrix3::from_diagonal(&moments))
        }
    };
    let mass = mass.unwrap_or(density * volume);
    let own = Distribution { mass, centre: Vector3::zeros(), inertia: inertia * mass };
    Ok(Weight::Known(own.seen(&frame)))
}

enum Solid {
    Shape(Shape),
    /// An ellipsoid and its half axes, m.
    Ellipsoid(Vector3<f64>),
}

/// The solid of a kind of shape, with half of its length where its ends are given.
fn sizes(element: &Element<'_, '_>, kind: &str, half: Option<f64>) -> Read<Solid> {
    let node = element.with("size").unwrap_or(element.node());
    let text = element.text("size").unwrap_or("");
    let mut sizes = text.split_whitespace().map(|text| finite(node, text)).collect::<Read<Vec<_>>>()?;
    let count = match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        "box" | "ellipsoid" => 3,
        other => {
            let known = "`sphere`, `capsule`, `ellipsoid`, `cylinder`, `box`, `mesh`, `plane`, `hfield`, `sdf`";
            return Err((place(element.node()), format!("a shape of the type `{other}`, expected one of {known}")));
        }
    };
    if let Some(half) = half {
        // A radius is all that two ends leave open.
        let radius = sizes.first().copied();
        sizes = if count == 2 { [radius, Some(half), None] } else { [radius, radius, Some(half)] }
            .into_iter()
            .flatten()
            .collect();
    }
    if sizes.len() < count || sizes[..count].iter().any(|size| *size <= 0.0) {
        return Err((place(node), format!("a {kind} has a `size` of {count} numbers above zero")));
    }
    let round =
        |has_caps| Shape::Round(Round { radius: sizes[0], length: 2.0 * sizes[1], axis: Vector3::z(), has_caps });
    Ok(match kind {
        "sphere" => Solid::Shape(Shape::Sphere(sizes[0])),
        "capsule" => Solid::Shape(round(true)),
        "cylinder" => Solid::Shape(round(false)),
        "box" => Solid::Shape(Shape::Box(Vector3::new(sizes[0], sizes[1], sizes[2]) * 2.0)),
        _ => Solid::Ellipsoid(Vector3::new(sizes[0], sizes[1], sizes[2])),
    })
}
