//! The reader of URDF.

use nalgebra::{Isometry3, Matrix3, Vector3};
use roxmltree::Node;

use super::model::{Connection, Joint, Link, Robot};
use super::rigid::Distribution;
use super::xml::{Read, child, direction, elements, frame, name, number, place, triple};
use crate::file::shape::{Round, Shape};

/// The robot of an element `robot`.
pub(super) fn read(root: &Node<'_, '_>) -> Read<Robot> {
    let mut robot = Robot { name: root.attribute("name").unwrap_or("robot").to_owned(), ..Robot::default() };
    for element in elements(root) {
        match element.tag_name().name() {
            "link" => robot.links.push(link(&element, &mut robot.remarks)?),
            "joint" => robot.joints.push(joint(&element, &mut robot.remarks)?),
            "material" => (),
            other => {
                let name = element.attribute("name").or(element.attribute("reference")).unwrap_or("");
                robot.remarks.push(format!("`{other}` {name}: no counterpart"));
            }
        }
    }
    Ok(robot)
}

/// The frame of an element `origin`; the identity without one.
fn origin(node: &Node<'_, '_>) -> Read<Isometry3<f64>> {
    let Some(origin) = child(node, "origin") else { return Ok(Isometry3::identity()) };
    let shift = triple(&origin, "xyz")?.unwrap_or_default();
    let turn = triple(&origin, "rpy")?.unwrap_or_default();
    Ok(frame(shift, turn))
}

/// The remark about a shape that isn't read.
fn unread(link: &str, tag: &str) -> String {
    format!("link {link}: `{tag}` is a shape, and shapes aren't read")
}

/// The inertia by the mass, m², of the first shape that collides or is seen and that has one, in the axes of its link.
fn of_shape(link: &Node<'_, '_>) -> Read<Option<(&'static str, Matrix3<f64>)>> {
    for tag in ["collision", "visual"] {
        for element in link.children().filter(|child| child.has_tag_name(tag)) {
            let Some(geometry) = child(&element, "geometry") else { continue };
            if let Some(shape) = shape(&geometry)? {
                let R = origin(&element)?.rotation.to_rotation_matrix();
                return Ok(Some((tag, R.matrix() * shape.inertia() * R.matrix().transpose())));
            }
        }
    }
    Ok(None)
}

/// The box, the cylinder or the sphere of an element `geometry`; none of a mesh.
fn shape(geometry: &Node<'_, '_>) -> Read<Option<Shape>> {
    let positive = |node: &Node<'_, '_>, attribute: &str| Ok(number(node, attribute)?.filter(|number| *number > 0.0));
    if let Some(element) = child(geometry, "box") {
        return Ok(triple(&element, "size")?.filter(|edges| edges.min() > 0.0).map(Shape::Box));
    }
    if let Some(element) = child(geometry, "cylinder") {
        let (radius, length) = (positive(&element, "radius")?, positive(&element, "length")?);
        let round = |(radius, length)| Shape::Round(Round { radius, length, axis: Vector3::z(), has_caps: false });
        return Ok(radius.zip(length).map(round));
    }
    let Some(element) = child(geometry, "sphere") else { return Ok(None) };
    Ok(positive(&element, "radius")?.map(Shape::Sphere))
}

fn link(node: &Node<'_, '_>, remarks: &mut Vec<String>) -> Read<Link> {
    let name = name(node)?;
    for shape in ["visual", "collision"] {
        let count = node.children().filter(|child| child.has_tag_name(shape)).count();
        if count > 0 {
            remarks.push(unread(&name, shape));
        }
    }
    for other in elements(node) {
        let tag = other.tag_name().name();
        if !["visual", "collision", "inertial"].contains(&tag) {
            remarks.push(format!("link {name}: `{tag}`: no counterpart"));
        }
    }
    let mut mass = Distribution::NOTHING;
    if let Some(inertial) = child(node, "inertial") {
        let kg = child(&inertial, "mass").map(|node| number(&node, "value")).transpose()?.flatten();
        let kg = kg.ok_or_else(|| (place(&inertial), "`inertial` has no `mass` with a `value`".to_owned()))?;
        if kg < 0.0 {
            return Err((place(&inertial), format!("the mass {kg} is negative")));
        }
        let mut J = Matrix3::zeros();
        if let Some(inertia) = child(&inertial, "inertia") {
            for (row, column, attribute) in
                [(0, 0, "ixx"), (0, 1, "ixy"), (0, 2, "ixz"), (1, 1, "iyy"), (1, 2, "iyz"), (2, 2, "izz")]
            {
                let entry = number(&inertia, attribute)?.unwrap_or(0.0);
                (J[(row, column)], J[(column, row)]) = (entry, entry);
            }
        }
        mass = Distribution { mass: kg, centre: Vector3::zeros(), inertia: J }.seen(&origin(&inertial)?);
        if J.amax() == 0.0
            && kg > 0.0
            && let Some((tag, inertia)) = of_shape(node)?
        {
            mass.inertia = inertia * kg;
            remarks.retain(|remark| *remark != unread(&name, tag));
            remarks.push(format!("link {name}: its inertia is zero, given that of its `{tag}` of one material"));
        }
    }
    Ok(Link { name, place: place(node), mass })
}

/// The axis of a joint.
fn axis(node: &Node<'_, '_>) -> Read<Vector3<f64>> {
    let Some(axis) = child(node, "axis") else { return Ok(Vector3::x()) };
    direction(&axis, triple(&axis, "xyz")?.unwrap_or_else(Vector3::x))
}

fn joint(node: &Node<'_, '_>, remarks: &mut Vec<String>) -> Read<Joint> {
    let name = name(node)?;
    let end = |tag: &str| {
        let link = child(node, tag).and_then(|end| end.attribute("link").map(str::to_owned));
        link.ok_or_else(|| (place(node), format!("the joint `{name}` has no `{tag}` with a `link`")))
    };
    let (parent, child_link) = (end("parent")?, end("child")?);
    let connection = match node.attribute("type") {
        Some("fixed") => Connection::Fixed,
        Some("revolute" | "continuous") => Connection::Pin(axis(node)?),
        Some("prismatic") => Connection::Slider(axis(node)?),
        Some("planar") => Connection::Plane(axis(node)?),
        Some("spherical") => Connection::Ball,
        Some("floating") => Connection::Free,
        other => {
            let found = other.map_or("no `type`".to_owned(), |other| format!("the type `{other}`"));
            let known = "`fixed`, `revolute`, `continuous`, `prismatic`, `planar`, `spherical`, `floating`";
            return Err((place(node), format!("the joint `{name}` has {found}, expected one of {known}")));
        }
    };
    let (mut damping, mut friction, mut limits) = (0.0, 0.0, None);
    for other in elements(node) {
        match other.tag_name().name() {
            "parent" | "child" | "origin" | "axis" => (),
            "dynamics" => {
                damping = number(&other, "damping")?.unwrap_or(0.0);
                friction = number(&other, "friction")?.unwrap_or(0.0);
            }
            "limit" if node.attribute("type") == Some("continuous") => (),
            "limit" => {
                let [lower, upper] = ["lower", "upper"].map(|key| number(&other, key));
                let ends = [lower?.unwrap_or(0.0), upper?.unwrap_or(0.0)];
                limits = Some(ends).filter(|[lower, upper]| lower < upper);
                if limits.is_none() {
                    remarks.push(format!("joint {name}: its limits leave it no way, left out"));
                }
                for key in ["effort", "velocity"].into_iter().filter(|key| other.attribute(*key).is_some()) {
                    remarks.push(format!("joint {name}: `{key}` of its limit: no counterpart"));
                }
            }
            "mimic" => {
                let follows = other.attribute("joint").unwrap_or("another");
                remarks.push(format!("joint {name}: it moves by itself, and doesn't follow {follows}"));
            }
            tag => remarks.push(format!("joint {name}: `{tag}`: no counterpart")),
        }
    }
    let origin = origin(node)?;
    let plain = Joint::new((name, place(node)), [parent, child_link], (origin, connection));
    Ok(Joint { damping, friction, limits, ..plain })
}
