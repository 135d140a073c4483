//! Joints of a body of MJCF, one behind the other, as joints of a scene.
//!
//! | in the body | in the scene |
//! |---|---|
//! | `hinge`, `slide`, `ball`, `free` | pin, slider, ball joint, a free body |
//! | three `hinge`s of one point and across each other | ball joint |
//! | two | universal joint |
//! | `slide` and `hinge` of one direction | cylinder |
//! | two `slide`s and a `hinge` across both | plane |
//! | others | each of its own, with bodies of little mass in between |

use nalgebra::{Isometry3, Matrix3, Vector3};
use roxmltree::Node;

use super::super::model::{Connection, Joint, Link};
use super::super::rigid::Distribution;
use super::super::xml::{Read, direction, numbers, place, triple};
use super::{Around, Reader};

/// The largest cosine between directions that are across each other, and the largest distance between points that are one.
const SAME: f64 = 1e-9;

/// Connects a body with its parent by its joints; without any it is fixed.
pub(super) fn sequence<'a, 'd>(
    reader: &mut Reader<'a, 'd>,
    body: &Node<'a, 'd>,
    [parent, name]: [&str; 2],
    origin: Isometry3<f64>,
    elements: &[(Node<'a, 'd>, Around<'a>)],
) -> Read<()> {
    let read = |(number, (node, around)): (usize, &(Node<'a, 'd>, Around<'a>))| {
        let label = if elements.len() == 1 { name.to_owned() } else { format!("{name}-{}", number + 1) };
        one(reader, node, around, label)
    };
    let mut joints: Vec<Joint> = elements.iter().enumerate().map(read).collect::<Read<_>>()?;
    if joints.is_empty() {
        let ends = [parent.to_owned(), name.to_owned()];
        let fixed = Joint::new((format!("{name}-fixed"), place(body)), ends, (origin, Connection::Fixed));
        reader.robot.joints.push(fixed);
        return Ok(());
    }
    if joints.len() > 1
        && let Some((connection, at)) = together(&joints)
    {
        let own = |joint: &Joint| {
            let Joint { damping, friction, armature, stiffness, limits, .. } = joint;
            limits.is_some() || [damping, friction, armature, stiffness].into_iter().any(|&term| term > 0.0)
        };
        let has = joints.iter().any(own);
        let first = joints.swap_remove(0);
        let equal = joints.iter().all(|joint| joint.damping.to_bits() == first.damping.to_bits());
        let damping = if equal && connection == Connection::Ball { first.damping } else { 0.0 };
        if has {
            let count = joints.len() + 1;
            let but = if damping > 0.0 { ", and their damping is one" } else { "" };
            let remark = format!(
                "body {name}: its {count} joints are one, without their springs, friction, rotors and limits{but}"
            );
            reader.robot.remarks.push(remark);
        }
        let plain = Joint::new((name.to_owned(), first.place), [String::new(), String::new()], (origin, connection));
        joints = vec![Joint { at, damping, ..plain }];
    }
    let last = joints.len() - 1;
    let mut above = parent.to_owned();
    for (number, mut joint) in joints.into_iter().enumerate() {
        let below = if number == last { name.to_owned() } else { format!("{name}-link-{}", number + 1) };
        if number != last {
            let link = Link { name: below.clone(), place: joint.place, mass: Distribution::NOTHING };
            reader.robot.links.push(link);
        }
        joint.origin = if number == 0 { origin } else { Isometry3::identity() };
        (joint.parent, joint.child) = (above, below.clone());
        above = below;
        reader.robot.joints.push(joint);
    }
    Ok(())
}

/// A joint of one element, without its ends.
fn one<'a, 'd>(reader: &Reader<'a, 'd>, node: &Node<'a, 'd>, around: &Around<'a>, label: String) -> Read<Joint> {
    let element = reader.classes.of(*node, around.class)?;
    let name = node.attribute("name").map_or(label, str::to_owned);
    let kind = if node.has_tag_name("freejoint") { "free" } else { element.text("type").unwrap_or("hinge") };
    let vector = |key| element.with(key).map(|node| triple(node, key)).transpose().map(Option::flatten);
    let at = around.frame.transform_point(&vector("pos")?.unwrap_or_default().into()).coords;
    let axis = || -> Read<Vector3<f64>> {
        let axis = vector("axis")?.unwrap_or_else(Vector3::z);
        Ok(around.frame.rotation * direction(element.with("axis").unwrap_or(node), axis)?)
    };
    let (connection, unit) = match kind {
        "hinge" => (Connection::Pin(axis()?), reader.compiler.unit),
        "slide" => (Connection::Slider(axis()?), 1.0),
        "ball" => (Connection::Ball, reader.compiler.unit),
        "free" => (Connection::Free, 1.0),
        other => {
            let known = "`hinge`, `slide`, `ball`, `free`";
            return Err((place(node), format!("the joint `{name}` has the type `{other}`, expected one of {known}")));
        }
    };
    let plain = Joint::new((name, place(node)), [String::new(), String::new()], (Isometry3::identity(), connection));
    if connection == Connection::Free {
        return Ok(plain);
    }
    let number = |key| Ok(Reader::number(&element, key)?.unwrap_or(0.0));
    // Angles and shifts are counted from `ref`, which they have where the model is drawn.
    let zero = number("ref")? * unit;
    let range = element.with("range").map(|node| numbers::<2>(node, "range", node.attribute("range").unwrap_or("")));
    let range = range.transpose()?.map(|ends| ends.map(|end| end * unit - zero)).filter(|[from, to]| from < to);
    let is_limited = match element.text("limited") {
        Some("true") => true,
        Some("false") => false,
        _ => reader.compiler.limits,
    };
    Ok(Joint {
        at,
        damping: number("damping")?,
        friction: number("frictionloss")?,
        armature: number("armature")?,
        limits: range.filter(|_| is_limited),
        stiffness: number("stiffness")?,
        rest: number("springref")? * unit - zero,
        ..plain
    })
}

/// The one joint that has the motions of several, and its point.
fn together(joints: &[Joint]) -> Option<(Connection, Vector3<f64>)> {
    let mut slides = Vec::new();
    let mut hinges = Vec::new();
    let mut at = None;
    for joint in joints {
        match joint.connection {
            Connection::Slider(axis) => slides.push(axis),
            Connection::Pin(axis) => {
                hinges.push(axis);
                if at.get_or_insert(joint.at).metric_distance(&joint.at) > SAME {
                    return None;
                }
            }
            Connection::Ball if at.is_none() => {
                at = Some(joint.at);
                hinges = vec![Vector3::x(), Vector3::y(), Vector3::z()];
            }
            _ => return None,
        }
    }
    let at = at?;
    let across = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(b).abs() < SAME;
    let is_free = |axes: &[Vector3<f64>]| Matrix3::from_columns(axes).determinant().abs() > SAME;
    let connection = match (slides.as_slice(), hinges.as_slice()) {
        ([_, _, _], [_, _, _]) if is_free(&slides) && is_free(&hinges) => Connection::Free,
        ([], [_, _, _]) if is_free(&hinges) => Connection::Ball,
        ([], &[a, b]) if across(&a, &b) => Connection::Universal([a, b]),
        (&[shift], &[turn]) if shift.cross(&turn).norm() < SAME => Connection::Cylinder(turn),
        ([a, b], [turn]) if across(a, turn) && across(b, turn) && a.cross(b).norm() > SAME => Connection::Plane(*turn),
        _ => return None,
    };
    Some((connection, at))
}
