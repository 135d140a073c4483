//! The reader of SDF.
//!
//! Links, joints and models have their places in frames that are named, and joints connect links in any order: see
//! [`Reader::tree`]. Links without a way to the world are free, or fixed where their model is static.

use std::collections::{BTreeMap, HashMap, VecDeque};

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::model::{Connection, Joint, Link, Robot};
use super::rigid::Distribution;
use super::xml::{Read, child, direction, elements, finite, frame, name, numbers, place};

/// The name of the root link, which is space.
const WORLD: &str = "world";
/// The name of a model's own frame inside of it.
const MODEL: &str = "__model__";
/// The most models inside of models, and frames relative to frames.
const DEPTH: usize = 64;

/// A frame by another one, and the pose in it.
struct Frame {
    base: String,
    pose: Isometry3<f64>,
    /// The frame or the link that moves with it.
    attached: Option<String>,
}

/// A joint between two links as the file has it.
struct Hinge<'a, 'd> {
    node: Node<'a, 'd>,
    name: String,
    /// The model around it.
    prefix: String,
    /// Parent and child.
    links: [usize; 2],
}

#[derive(Default)]
struct Reader<'a, 'd> {
    robot: Robot,
    /// The version of the format, as a number of two digits: 1.5 is 105.
    version: u32,
    frames: HashMap<String, Frame>,
    links: HashMap<String, usize>,
    /// The poses of links in space.
    poses: Vec<Isometry3<f64>>,
    is_static: Vec<bool>,
    joints: Vec<(Node<'a, 'd>, String)>,
    left_out: BTreeMap<&'a str, usize>,
}

/// The robot of an element `sdf`.
pub(super) fn read(root: &Node<'_, '_>) -> Read<Robot> {
    let mut digits = root.attribute("version").unwrap_or("1.9").split('.').map(str::parse::<u32>);
    let (Some(Ok(major)), Some(Ok(minor))) = (digits.next(), digits.next()) else {
        return Err((place(root), "the `version` of a file of SDF is like `1.9`".to_owned()));
    };
    let mut reader = Reader { version: 100 * major + minor, ..Reader::default() };
    reader.robot.has_world = true;
    "robot".clone_into(&mut reader.robot.name);
    // The format's own default.
    reader.robot.gravity = Vector3::new(0.0, 0.0, -9.8);
    reader.link(WORLD.to_owned(), place(root), Distribution::NOTHING, true);
    let world = child(root, "world").unwrap_or(*root);
    if let Some(gravity) = child(&world, "gravity") {
        reader.robot.gravity = Vector3::from(numbers::<3>(&gravity, "gravity", gravity.text().unwrap_or(""))?);
    }
    for element in elements(&world) {
        match element.tag_name().name() {
            "model" => reader.model(&element, "", false)?,
            "gravity" | "physics" | "scene" => (),
            tag => *reader.left_out.entry(tag).or_default() += 1,
        }
    }
    reader.poses = reader.robot.links.iter().map(|link| reader.pose(&link.name, link.place)).collect::<Read<_>>()?;
    let hinges = reader.hinges()?;
    reader.tree(&hinges)?;
    let left_out = reader.left_out.iter().map(|(tag, count)| format!("`{tag}`: {count} without a counterpart"));
    let left_out: Vec<_> = left_out.collect();
    reader.robot.remarks.extend(left_out);
    Ok(reader.robot)
}

/// The text of a child element.
fn text<'a>(node: &Node<'a, '_>, name: &str) -> Option<&'a str> {
    child(node, name).and_then(|child| child.text()).map(str::trim)
}

/// The number of a child element.
fn value(node: &Node<'_, '_>, name: &str) -> Read<Option<f64>> {
    let Some(child) = child(node, name) else { return Ok(None) };
    finite(&child, child.text().unwrap_or("")).map(Some)
}

/// The pose of an element, and the frame that it is relative to if it names one.
fn posed<'a>(node: &Node<'a, '_>) -> Read<(Isometry3<f64>, Option<&'a str>)> {
    let Some(pose) = child(node, "pose") else { return Ok((Isometry3::identity(), None)) };
    let written = pose.text().unwrap_or("").trim();
    let base = pose.attribute("relative_to").or(pose.attribute("frame")).filter(|base| !base.is_empty());
    if written.is_empty() {
        return Ok((Isometry3::identity(), base));
    }
    if pose.attribute("rotation_format") == Some("quat_xyzw") {
        let [x, y, z, a, b, c, w] = numbers(&pose, "pose", written)?;
        let turn = UnitQuaternion::try_new(Quaternion::new(w, a, b, c), 1e-9);
        let turn = turn.ok_or_else(|| (place(&pose), "a quaternion isn't zero".to_owned()))?;
        return Ok((Isometry3::from_parts(Translation3::new(x, y, z), turn), base));
    }
    let [x, y, z, roll, pitch, yaw] = numbers(&pose, "pose", written)?;
    let unit = if pose.attribute("degrees") == Some("true") { 1_f64.to_radians() } else { 1.0 };
    Ok((frame(Vector3::new(x, y, z), Vector3::new(roll, pitch, yaw) * unit), base))
}

impl<'a, 'd> Reader<'a, 'd> {
    fn link(&mut self, name: String, place: (usize, usize), mass: Distribution, is_static: bool) {
        self.links.insert(name.clone(), self.robot.links.len());
        self.robot.links.push(Link { name, place, mass });
        self.is_static.push(is_static);
    }

    /// Reads the links and frames of a model, whose names begin with `prefix`, and notes its joints.
    fn model(&mut self, node: &Node<'a, 'd>, prefix: &str, is_static: bool) -> Read<()> {
        let own = name(node)?;
        if node.has_attribute("placement_frame") {
            return Err((place(node), "a model with a `placement_frame` isn't read: give its `pose`".to_owned()));
        }
        // Names of links have the model's name before them, unless the file has one model alone.
        let around_it = node.parent().filter(|around| !around.has_tag_name("model"));
        let count = |around: Node<'a, 'd>| elements(&around).filter(|other| other.has_tag_name("model")).count();
        let is_alone = around_it.is_some_and(|around| count(around) == 1);
        if around_it.is_some() && self.robot.links.len() == 1 {
            self.robot.name.clone_from(&own);
        }
        let inner = if is_alone { String::new() } else { format!("{prefix}{own}::") };
        if inner.matches("::").count() > DEPTH {
            return Err((place(node), format!("models stand in models at most {DEPTH} deep")));
        }
        let is_static = is_static || text(node, "static").is_some_and(|text| matches!(text, "true" | "1"));
        let (pose, base) = posed(node)?;
        let base = scoped(prefix, base.unwrap_or(if around_it.is_some() { WORLD } else { MODEL }));
        self.frames.insert(format!("{inner}{MODEL}"), Frame { base, pose, attached: None });
        let model = format!("{inner}{MODEL}");
        for element in elements(node) {
            match element.tag_name().name() {
                "link" => self.read_link(&element, &inner, is_static)?,
                "joint" => {
                    let (pose, base) = posed(&element)?;
                    let below = text(&element, "child").unwrap_or("");
                    let base = scoped(&inner, base.unwrap_or(below));
                    self.frames.insert(
                        format!("{inner}{}", name(&element)?),
                        Frame { base, pose, attached: Some(scoped(&inner, below)) },
                    );
                    self.joints.push((element, inner.clone()));
                }
                "frame" => {
                    let (pose, base) = posed(&element)?;
                    let attached = element.attribute("attached_to").filter(|name| !name.is_empty()).unwrap_or(MODEL);
                    let base = scoped(&inner, base.unwrap_or(attached));
                    self.frames.insert(
                        format!("{inner}{}", name(&element)?),
                        Frame { base, pose, attached: Some(scoped(&inner, attached)) },
                    );
                }
                "model" => {
                    self.model(&element, &inner, is_static)?;
                    let frame = Frame {
                        base: format!("{inner}{}::{MODEL}", name(&element)?),
                        pose: Isometry3::identity(),
                        attached: None,
                    };
                    self.frames.insert(format!("{inner}{}", name(&element)?), frame);
                }
                "pose" | "static" | "self_collide" | "allow_auto_disable" => (),
                tag => *self.left_out.entry(tag).or_default() += 1,
            }
        }
        // A frame of the model moves with its first link.
        let first = elements(node).find(|element| element.has_tag_name("link")).and_then(|link| link.attribute("name"));
        if let (Some(frame), Some(first)) = (self.frames.get_mut(&model), first) {
            frame.attached = Some(format!("{inner}{first}"));
        }
        Ok(())
    }

    /// Reads a link with its mass, which is 1 kg with moments of 1 kg m² where the file says nothing of it.
    fn read_link(&mut self, node: &Node<'a, 'd>, prefix: &str, is_static: bool) -> Read<()> {
        let full = format!("{prefix}{}", name(node)?);
        if self.links.contains_key(&full) {
            return Err((place(node), format!("there are two links called `{full}`")));
        }
        let (pose, base) = posed(node)?;
        let base = scoped(prefix, base.unwrap_or(MODEL));
        self.frames.insert(full.clone(), Frame { base, pose, attached: None });
        for element in elements(node) {
            match element.tag_name().name() {
                "gravity" if element.text().is_some_and(|text| matches!(text.trim(), "false" | "0")) => {
                    self.robot.remarks.push(format!("link {full}: it has weight here, as all bodies have"));
                }
                "gravity" | "pose" | "inertial" | "self_collide" | "enable_wind" | "must_be_base_link" => (),
                tag => *self.left_out.entry(tag).or_default() += 1,
            }
        }
        let Some(inertial) = child(node, "inertial") else {
            if !is_static {
                self.robot.remarks.push(format!("link {full}: without `inertial`, given 1 kg and 1 kg m²"));
            }
            let mass = Distribution { mass: 1.0, centre: Vector3::zeros(), inertia: Matrix3::identity() };
            self.link(full, place(node), mass, is_static);
            return Ok(());
        };
        if inertial.attribute("auto") == Some("true") {
            self.robot.remarks.push(format!("link {full}: its inertia by shapes isn't read, given 1 kg m²"));
        }
        let mass = value(&inertial, "mass")?.unwrap_or(1.0);
        if mass < 0.0 {
            return Err((place(&inertial), format!("the mass {mass} is negative")));
        }
        let mut inertia = Matrix3::identity();
        if let Some(entries) = child(&inertial, "inertia") {
            for (row, column, key) in
                [(0, 0, "ixx"), (0, 1, "ixy"), (0, 2, "ixz"), (1, 1, "iyy"), (1, 2, "iyz"), (2, 2, "izz")]
            {
                let entry = value(&entries, key)?.unwrap_or(if row == column { 1.0 } else { 0.0 });
                (inertia[(row, column)], inertia[(column, row)]) = (entry, entry);
            }
        }
        let own = Distribution { mass, centre: Vector3::zeros(), inertia };
        self.link(full, place(node), own.seen(&posed(&inertial)?.0), is_static);
        Ok(())
    }

    /// The pose of a frame in space.
    fn pose(&self, name: &str, place: (usize, usize)) -> Read<Isometry3<f64>> {
        let (mut pose, mut at) = (Isometry3::identity(), name);
        for _ in 0..=DEPTH {
            if at == WORLD {
                return Ok(pose);
            }
            let Some(frame) = self.frames.get(at) else {
                return Err((place, format!("there is no frame `{at}`, in which `{name}` has its place")));
            };
            (pose, at) = (frame.pose * pose, &frame.base);
        }
        Err((place, format!("the frames below `{name}` lead in a circle")))
    }

    /// The link that moves with a frame.
    fn carrier(&self, name: &str, place: (usize, usize)) -> Read<usize> {
        let mut at = name;
        for _ in 0..=DEPTH {
            if let Some(&link) = self.links.get(at) {
                return Ok(link);
            }
            let Some(frame) = self.frames.get(at) else { break };
            at = frame.attached.as_deref().unwrap_or(&frame.base);
        }
        Err((place, format!("`{name}` is no link, and no frame of one")))
    }

    /// The joints with their links; those that are no joints of bodies are left out.
    fn hinges(&mut self) -> Read<Vec<Hinge<'a, 'd>>> {
        let mut hinges = Vec::new();
        for (node, prefix) in std::mem::take(&mut self.joints) {
            let name = name(&node)?;
            if node.attribute("type") == Some("gearbox") {
                self.robot.remarks.push(format!("joint {name}: a gearbox has no counterpart"));
                continue;
            }
            let end = |tag: &str| {
                let missing = || (place(&node), format!("the joint `{name}` has no `{tag}`"));
                self.carrier(&scoped(&prefix, text(&node, tag).ok_or_else(missing)?), place(&node))
            };
            let links = [end("parent")?, end("child")?];
            hinges.push(Hinge { node, name, prefix, links });
        }
        Ok(hinges)
    }

    /// Makes a tree of the joints, from the world on and then from links that are free, and closes loops by the others.
    ///
    /// A joint from a child to its parent is that about the opposite axis.
    fn tree(&mut self, hinges: &[Hinge<'a, 'd>]) -> Read<()> {
        let mut is_reached = vec![false; self.poses.len()];
        let mut is_used = vec![false; hinges.len()];
        let is_child = |link: usize| hinges.iter().any(|hinge| hinge.links[1] == link);
        let mut order: Vec<usize> = (1..self.poses.len()).collect();
        order.sort_by_key(|&link| is_child(link));
        for root in std::iter::once(0).chain(order) {
            if is_reached[root] {
                continue;
            }
            is_reached[root] = true;
            if root != 0 {
                let link = &self.robot.links[root];
                let connection = if self.is_static[root] { Connection::Fixed } else { Connection::Free };
                let ends = [WORLD.to_owned(), link.name.clone()];
                let joint =
                    Joint::new((format!("{}-free", link.name), link.place), ends, (self.poses[root], connection));
                self.robot.joints.push(joint);
            }
            let mut open = VecDeque::from([root]);
            while let Some(above) = open.pop_front() {
                for (number, hinge) in hinges.iter().enumerate() {
                    let [parent, child] = hinge.links;
                    let (below, is_turned) = if parent == above { (child, false) } else { (parent, true) };
                    if is_used[number] || is_reached[below] || (child != above && parent != above) {
                        continue;
                    }
                    (is_used[number], is_reached[below]) = (true, true);
                    let joint = self.joint(hinge, [above, below], is_turned)?;
                    self.robot.joints.push(joint);
                    open.push_back(below);
                }
            }
        }
        for (hinge, _) in hinges.iter().zip(is_used).filter(|(_, is_used)| !is_used) {
            let joint = self.joint(hinge, hinge.links, false)?;
            self.robot.joints.push(Joint { closes: true, ..joint });
        }
        Ok(())
    }

    /// The joint of an element between two links: that above and that below.
    fn joint(&mut self, hinge: &Hinge<'a, 'd>, [above, below]: [usize; 2], is_turned: bool) -> Read<Joint> {
        let Hinge { node, name, prefix, .. } = hinge;
        let here = self.pose(&scoped(prefix, name), place(node))?;
        let to_child = self.poses[below].inverse();
        let axis = |tag: &str| -> Read<Vector3<f64>> {
            let Some(axis) = child(node, tag) else { return Ok(to_child * here * Vector3::z()) };
            let xyz = child(&axis, "xyz");
            let given = match xyz {
                Some(xyz) => Vector3::from(numbers::<3>(&xyz, "xyz", xyz.text().unwrap_or(""))?),
                None => Vector3::z(),
            };
            let of_model = self.version < 105
                || text(&axis, "use_parent_model_frame").is_some_and(|text| matches!(text, "true" | "1"));
            let frame = match xyz.and_then(|xyz| xyz.attribute("expressed_in")).filter(|name| !name.is_empty()) {
                Some(base) => self.pose(&scoped(prefix, base), place(node))?,
                None if of_model => self.pose(&scoped(prefix, MODEL), place(node))?,
                None => here,
            };
            let unit = direction(&xyz.unwrap_or(axis), given)?;
            Ok((to_child * frame) * if is_turned { -unit } else { unit })
        };
        let connection = match node.attribute("type") {
            Some("fixed") => Connection::Fixed,
            Some("revolute" | "continuous") => Connection::Pin(axis("axis")?),
            Some("prismatic") => Connection::Slider(axis("axis")?),
            Some("ball") => Connection::Ball,
            Some("universal" | "revolute2") => {
                let [first, second] = [axis("axis")?, axis("axis2")?];
                if first.dot(&second).abs() > 1e-6 {
                    return Err((
                        place(node),
                        format!(
                            "the axes of the joint `{name}` are those of a universal joint only where they are across each other"
                        ),
                    ));
                }
                Connection::Universal(if is_turned { [second, first] } else { [first, second] })
            }
            other => {
                let found = other.map_or("no `type`".to_owned(), |other| format!("the type `{other}`"));
                let known = "`fixed`, `revolute`, `continuous`, `prismatic`, `ball`, `universal`, `revolute2`";
                return Err((place(node), format!("the joint `{name}` has {found}, expected one of {known}")));
            }
        };
        let ends = [above, below].map(|link| self.robot.links[link].name.clone());
        let origin = self.poses[above].inverse() * self.poses[below];
        let plain = Joint::new((name.clone(), place(node)), ends, (origin, connection));
        let at = (to_child * here).translation.vector;
        let inner = child(node, "axis").filter(|_| matches!(connection, Connection::Pin(_) | Connection::Slider(_)));
        for element in elements(node) {
            let tag = element.tag_name().name();
            if !["parent", "child", "pose", "axis", "axis2"].contains(&tag) {
                *self.left_out.entry(tag).or_default() += 1;
            }
        }
        let Some(axis) = inner else { return Ok(Joint { at, ..plain }) };
        let dynamics =
            |key: &str| child(&axis, "dynamics").map(|node| value(&node, key)).transpose().map(Option::flatten);
        let number = |key: &str| dynamics(key).map(Option::unwrap_or_default);
        // An end that is nowhere is written as a large number.
        let end = |key: &str| -> Read<Option<f64>> {
            let Some(node) = child(&axis, "limit").and_then(|limit| child(&limit, key)) else { return Ok(None) };
            let written = node.text().unwrap_or("").trim();
            let end = written.parse::<f64>().map_err(|_| (place(&node), format!("`{written}` isn't a number")))?;
            Ok(Some(end).filter(|end| end.abs() < 1e15))
        };
        let limits = end("lower")?
            .zip(end("upper")?)
            .map(|(lower, upper)| [lower, upper])
            .filter(|[lower, upper]| lower < upper);
        Ok(Joint {
            at,
            damping: number("damping")?,
            friction: number("friction")?,
            stiffness: number("spring_stiffness")?,
            rest: number("spring_reference")?,
            limits: limits.filter(|_| node.attribute("type") != Some("continuous")),
            ..plain
        })
    }
}

/// The whole name of a frame of a model.
fn scoped(prefix: &str, name: &str) -> String {
    if name == WORLD { WORLD.to_owned() } else { format!("{prefix}{name}") }
}
