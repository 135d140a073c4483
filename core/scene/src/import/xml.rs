//! Elements of XML: their places, their attributes and their numbers.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use super::robot::Unsuitable;

pub(super) type Read<T> = Result<T, Unsuitable>;

/// The elements of a text.
pub(super) fn parsed(text: &str) -> Read<Document<'_>> {
    Document::parse(text).map_err(|error| {
        let at = error.pos();
        ((at.row as usize, at.col as usize), format!("isn't XML: {error}"))
    })
}

/// Line and column, from one.
pub(super) fn place(node: &Node<'_, '_>) -> (usize, usize) {
    let at = node.document().text_pos_at(node.range().start);
    (at.row as usize, at.col as usize)
}

pub(super) fn child<'a, 'd>(node: &Node<'a, 'd>, name: &str) -> Option<Node<'a, 'd>> {
    node.children().find(|child| child.has_tag_name(name))
}

pub(super) fn elements<'a, 'd>(node: &Node<'a, 'd>) -> impl Iterator<Item = Node<'a, 'd>> {
    node.children().filter(Node::is_element)
}

pub(super) fn name(node: &Node<'_, '_>) -> Read<String> {
    let missing = || (place(node), format!("`{}` has no `name`", node.tag_name().name()));
    node.attribute("name").map(str::to_owned).ok_or_else(missing)
}

pub(super) fn finite(node: &Node<'_, '_>, text: &str) -> Read<f64> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| (place(node), format!("`{text}` isn't a finite number")))
}

/// The number of an attribute.
pub(super) fn number(node: &Node<'_, '_>, attribute: &str) -> Read<Option<f64>> {
    node.attribute(attribute).map(|text| finite(node, text)).transpose()
}

/// The numbers of a text of an element, as many as `N`.
pub(super) fn numbers<const N: usize>(node: &Node<'_, '_>, of: &str, text: &str) -> Read<[f64; N]> {
    let all = text.split_whitespace().map(|text| finite(node, text)).collect::<Read<Vec<_>>>()?;
    let wrong = |all: Vec<f64>| {
        let count = if N == 3 { "three".to_owned() } else { N.to_string() };
        (place(node), format!("`{of}` has {count} numbers, found {}", all.len()))
    };
    all.try_into().map_err(wrong)
}

/// Three numbers of an attribute.
pub(super) fn triple(node: &Node<'_, '_>, attribute: &str) -> Read<Option<Vector3<f64>>> {
    let text = node.attribute(attribute);
    text.map(|text| Ok(Vector3::from(numbers::<3>(node, attribute, text)?))).transpose()
}

/// A unit vector along these numbers, which is the coordinate axis without rounding where it is one.
pub(super) fn direction(node: &Node<'_, '_>, given: Vector3<f64>) -> Read<Vector3<f64>> {
    let scaled = given / given.amax();
    let unit = scaled.try_normalize(0.5).filter(|unit| unit.iter().all(|part| part.is_finite()));
    unit.ok_or_else(|| (place(node), "an axis can't be zero".to_owned()))
}

/// A frame by its origin and its angles of roll, pitch and yaw, rad.
pub(super) fn frame(shift: Vector3<f64>, turn: Vector3<f64>) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(shift), UnitQuaternion::from_euler_angles(turn.x, turn.y, turn.z))
}
