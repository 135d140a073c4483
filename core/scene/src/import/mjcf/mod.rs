//! The reader of MJCF.
//!
//! A body moves by the joints in it, one behind the other. Some of these sequences are one joint of a scene, others need bodies
//! of little mass in between: see [`Joints`](joints::sequence). Shapes count by their masses alone.

mod classes;
mod compiler;
mod geom;
mod joints;

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Matrix3, Vector3};
use roxmltree::Node;

use self::classes::Classes;
use self::compiler::Compiler;
use self::geom::{Weight, weight};
use super::model::{Connection, Joint, Link, Robot};
use super::rigid::Distribution;
use super::robot::NO_MESH;
use super::xml::{Read, elements, finite, number, numbers, place, triple};

/// The name of the root link, which is space.
const WORLD: &str = "world";

/// The state of a reader.
struct Reader<'a, 'd> {
    robot: Robot,
    compiler: Compiler,
    classes: Classes<'a, 'd>,
    /// The number of elements of each tag that have no counterpart.
    left_out: BTreeMap<&'a str, usize>,
    shapes: usize,
    bodies: usize,
}

/// The surroundings of an element inside of a body.
#[derive(Clone, Copy)]
struct Around<'a> {
    /// The class of elements that name none.
    class: Option<&'a str>,
    /// The frame in the body.
    frame: Isometry3<f64>,
}

/// The parts of a body, in its frame.
#[derive(Default)]
struct Parts<'a, 'd> {
    joints: Vec<(Node<'a, 'd>, Around<'a>)>,
    bodies: Vec<(Node<'a, 'd>, Around<'a>)>,
    inertial: Option<Node<'a, 'd>>,
    shapes: Option<Distribution>,
    unread: usize,
}

/// The robot of an element `mujoco`.
pub(super) fn read(root: &Node<'_, '_>) -> Read<Robot> {
    let name = root.attribute("model").unwrap_or("robot").to_owned();
    let mut reader = Reader {
        robot: Robot { name, has_world: true, ..Robot::default() },
        compiler: Compiler::default(),
        classes: Classes::default(),
        left_out: BTreeMap::new(),
        shapes: 0,
        bodies: 0,
    };
    reader.robot.links.push(Link { name: WORLD.to_owned(), place: place(root), mass: Distribution::NOTHING });
    // Settings and defaults count wherever they stand.
    for element in elements(root) {
        match element.tag_name().name() {
            "compiler" => reader.compiler.read(&element)?,
            "default" => reader.classes.read(&element, None)?,
            _ => (),
        }
    }
    for element in elements(root) {
        match element.tag_name().name() {
            "option" => reader.option(&element)?,
            "worldbody" => {
                let around = Around { class: element.attribute("childclass"), frame: Isometry3::identity() };
                let parts = reader.parts(&element, around)?;
                for (body, around) in parts.bodies {
                    reader.body(&body, WORLD, around)?;
                }
            }
            "equality" => elements(&element).try_for_each(|equality| reader.equality(&equality))?,
            // Read above, pictures, names and memory.
            "compiler" | "default" | "asset" | "visual" | "statistic" | "size" | "custom" => (),
            section => *reader.left_out.entry(section).or_default() += elements(&element).count(),
        }
    }
    Ok(reader.finish())
}

impl<'a, 'd> Reader<'a, 'd> {
    /// Gravity, and the air of an element `option`.
    fn option(&mut self, node: &Node<'a, 'd>) -> Read<()> {
        if let Some(gravity) = triple(node, "gravity")? {
            self.robot.gravity = gravity;
        }
        for key in ["density", "viscosity"] {
            if number(node, key)?.is_some_and(|value| value != 0.0) {
                self.robot.remarks.push(format!("option: the `{key}` of the air has no counterpart"));
            }
        }
        if elements(node).any(|flag| flag.attribute("gravity") == Some("disable")) {
            self.robot.gravity = Vector3::zeros();
        }
        Ok(())
    }

    /// The parts of a body, also those in elements `frame`.
    fn parts(&mut self, node: &Node<'a, 'd>, around: Around<'a>) -> Read<Parts<'a, 'd>> {
        let mut parts = Parts::default();
        // Frames in frames: those that are to be read, in the order of the text.
        let mut open = vec![(*node, around)];
        while let Some((node, around)) = open.pop() {
            let mut inner = Vec::new();
            for element in elements(&node) {
                match element.tag_name().name() {
                    "joint" | "freejoint" => parts.joints.push((element, around)),
                    "body" => parts.bodies.push((element, around)),
                    "inertial" => parts.inertial = Some(element),
                    "frame" => {
                        let class = element.attribute("childclass").or(around.class);
                        let own = self.compiler.frame(&self.classes.of(element, around.class)?)?;
                        inner.push((element, Around { class, frame: around.frame * own }));
                    }
                    "geom" => {
                        self.shapes += 1;
                        match weight(&self.classes.of(element, around.class)?, &self.compiler)? {
                            Weight::Known(mass) => {
                                let mass = mass.seen(&around.frame);
                                parts.shapes = Some(parts.shapes.map_or(mass, |sum| sum.with(&mass)));
                            }
                            Weight::Unread => parts.unread += 1,
                        }
                    }
                    tag => *self.left_out.entry(tag).or_default() += 1,
                }
            }
            open.extend(inner.into_iter().rev());
        }
        Ok(parts)
    }

    /// Reads a body with those in it.
    fn body(&mut self, node: &Node<'a, 'd>, parent: &str, around: Around<'a>) -> Read<()> {
        self.bodies += 1;
        let name = node.attribute("name").map_or_else(|| format!("body-{}", self.bodies), str::to_owned);
        let class = node.attribute("childclass").or(around.class);
        let origin = around.frame * self.compiler.frame(&self.classes.of(*node, None)?)?;
        let parts = self.parts(node, Around { class, frame: Isometry3::identity() })?;
        let mass = self.mass(&name, &parts)?;
        if node.attribute("gravcomp").is_some() {
            self.robot.remarks.push(format!("body {name}: `gravcomp`: no counterpart"));
        }
        self.robot.links.push(Link { name: name.clone(), place: place(node), mass });
        joints::sequence(self, node, [parent, &name], origin, &parts.joints)?;
        parts.bodies.iter().try_for_each(|(body, around)| self.body(body, &name, *around))
    }

    /// The mass of a body: its own, or that of its shapes.
    fn mass(&mut self, name: &str, parts: &Parts<'a, 'd>) -> Read<Distribution> {
        let own = parts.inertial.filter(|_| self.compiler.by_shapes != Some(true));
        let own = own.map(|node| self.inertial(&node)).transpose()?;
        if own.is_none() && parts.unread > 0 {
            let remark = format!("body {name}: the mass of {} {NO_MESH}", parts.unread);
            self.robot.remarks.push(remark);
        }
        let shapes = parts.shapes.filter(|_| self.compiler.by_shapes != Some(false));
        let mut mass = own.or(shapes).unwrap_or(Distribution::NOTHING);
        let [least, moment] = self.compiler.least;
        mass.mass = mass.mass.max(least);
        if moment > 0.0 {
            let eigen = mass.inertia.symmetric_eigen();
            let moments = eigen.eigenvalues.map(|own| own.max(moment));
            mass.inertia = eigen.eigenvectors * Matrix3::from_diagonal(&moments) * eigen.eigenvectors.transpose();
        }
        if self.compiler.balances {
            let eigen = mass.inertia.symmetric_eigen();
            let moments = eigen.eigenvalues;
            if 2.0 * moments.max() > moments.sum() {
                mass.inertia = Matrix3::identity() * moments.mean();
            }
        }
        Ok(mass)
    }

    /// The mass of an element `inertial`.
    fn inertial(&self, node: &Node<'a, 'd>) -> Read<Distribution> {
        let Some(mass) = number(node, "mass")?.filter(|mass| *mass >= 0.0) else {
            return Err((place(node), "`inertial` has a `mass` that isn't negative".to_owned()));
        };
        let inertia = match (node.attribute("fullinertia"), triple(node, "diaginertia")?) {
            (Some(text), _) => {
                let [xx, yy, zz, xy, xz, yz] = numbers(node, "fullinertia", text)?;
                Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
            }
            (None, moments) => Matrix3::from_diagonal(&moments.unwrap_or_default()),
        };
        let own = Distribution { mass, centre: Vector3::zeros(), inertia };
        Ok(own.seen(&self.compiler.frame(&Classes::default().of(*node, None)?)?))
    }

    /// Two bodies that share a point, or an equation without a counterpart.
    fn equality(&mut self, node: &Node<'a, 'd>) -> Read<()> {
        let tag = node.tag_name().name();
        let (body, anchor) = (node.attribute("body1"), triple(node, "anchor")?);
        let (true, Some(body), Some(anchor)) = (tag == "connect", body, anchor) else {
            *self.left_out.entry(tag).or_default() += 1;
            return Ok(());
        };
        if node.attribute("active") == Some("false") {
            return Ok(());
        }
        // The first body has the anchor's place; where the other one is follows from the places of both.
        let other = node.attribute("body2").unwrap_or(WORLD);
        let name = node.attribute("name").map_or_else(|| format!("connect-{body}"), str::to_owned);
        let frame = |link: &str| {
            let unknown = || (place(node), format!("there is no body `{link}`"));
            self.pose(link).ok_or_else(unknown)
        };
        let origin = frame(other)?.inverse() * frame(body)?;
        let plain = Joint::new((name, place(node)), [other.to_owned(), body.to_owned()], (origin, Connection::Ball));
        self.robot.joints.push(Joint { at: anchor, closes: true, ..plain });
        Ok(())
    }

    /// The frame of a link in space.
    fn pose(&self, link: &str) -> Option<Isometry3<f64>> {
        let mut pose = Isometry3::identity();
        let mut name = link;
        // Each link has a parent that was read before it.
        for _ in 0..=self.robot.joints.len() {
            if name == WORLD {
                return Some(pose);
            }
            let joint = self.robot.joints.iter().find(|joint| !joint.closes && joint.child == name)?;
            (pose, name) = (joint.origin * pose, &joint.parent);
        }
        None
    }

    /// Scales all masses where their sum is set, and says what has no counterpart.
    fn finish(mut self) -> Robot {
        let sum: f64 = self.robot.links.iter().map(|link| link.mass.mass).sum();
        if let Some(total) = self.compiler.total
            && sum > 0.0
        {
            for link in &mut self.robot.links {
                link.mass.mass *= total / sum;
                link.mass.inertia *= total / sum;
            }
        }
        if self.shapes > 0 {
            self.robot.remarks.push(format!("`geom`: {} shapes, which have masses and don't touch", self.shapes));
        }
        let left_out = self.left_out.iter().filter(|(_, count)| **count > 0);
        self.robot.remarks.extend(left_out.map(|(tag, count)| format!("`{tag}`: {count} without a counterpart")));
        self.robot
    }

    /// The number of an attribute of an element or of its class.
    fn number(element: &classes::Element<'_, '_>, key: &str) -> Read<Option<f64>> {
        element.with(key).map(|node| finite(node, node.attribute(key).unwrap_or(""))).transpose()
    }
}
