//! A robot of links and joints, as a scene of several bodies.

use std::collections::{BTreeSet, HashMap};
use std::f64::consts::TAU;
use std::fmt::Write as _;

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::model::{Connection, Joint, Robot};
use super::rigid::Distribution;
use crate::file::quantity::short;

/// A scene that was made of a model, and the remarks about what it doesn't have.
#[derive(Clone, Debug)]
pub struct Import {
    /// The text of the scene, for [`Scene::parse`](crate::Scene::parse).
    pub text: String,
    /// Elements of the model without a counterpart, and choices that were made.
    pub remarks: Vec<String>,
}

/// The reason why a model can't be a scene, with its line and column.
pub(super) type Unsuitable = ((usize, usize), String);

/// Links that are fixed to each other, in the frame of the first.
struct Group {
    name: String,
    mass: Distribution,
    /// The frame in space, where all joints are at zero.
    pose: Isometry3<f64>,
    /// The joint to the parent; none of the root.
    arm: Option<Arm>,
}

/// A moving joint of a group with its parent, or one that closes a loop.
#[derive(Clone, Copy)]
struct Arm {
    joint: usize,
    parent: usize,
    /// The frame of the joint's child in that of the parent's group, at zero.
    frame: Isometry3<f64>,
    /// The frame of the joint's child in that of its own group.
    own: Isometry3<f64>,
}

/// The group of the child of a joint that closes a loop, and the joint.
type Closing = (usize, Arm);

/// The group of a link, and the link's frame in that of the group.
type Place = (usize, Isometry3<f64>);

/// The end of a remark about a body without a mass but for that of meshes.
pub(super) const NO_MESH: &str = "meshes isn't read, and it has no `inertial`";

/// The radius of a ball whose inertia a link without one gets, m.
const RADIUS: f64 = 0.01;

/// The mass of a link without one, relative to the least mass of the others.
const LIGHT: f64 = 1e-3;

/// The rate below which dry friction is viscous, rad/s, and in sliders the speed, m/s.
const CREEP: f64 = 0.01;

impl Robot {
    /// The scene; its root is a body if it `floats`, and space otherwise.
    pub(super) fn scene(mut self, floats: bool) -> Result<Import, Unsuitable> {
        let without_mass = self.links.iter().filter(|link| link.mass.mass <= 0.0 && link.mass.inertia.amax() > 0.0);
        let remarks =
            without_mass.map(|link| format!("link {}: an inertia without a mass, counted as it is given", link.name));
        let remarks: Vec<_> = remarks.collect();
        self.remarks.extend(remarks);
        let (mut groups, closings) = self.groups()?;
        if floats && self.has_world {
            let message = "this model says itself which bodies are free: leave `--floating` out, which is for URDF";
            return Err(((1, 1), message.to_owned()));
        }
        // A model of one body is that of a thing, not of a machine that stands somewhere.
        let floats = floats || (groups.len() == 1 && !self.has_world);
        let mut is_there = self.leaves(&groups, floats);
        if !floats && let Some(root) = is_there.first_mut() {
            *root = false;
        }
        if !is_there.contains(&true) {
            let place = self.links.first().map_or((1, 1), |link| link.place);
            let meshes = self.remarks.iter().any(|remark| remark.contains(NO_MESH));
            let why = if meshes { ": masses of meshes aren't read, give its bodies an `inertial`" } else { "" };
            return Err((place, format!("the model has no body with a mass that moves{why}")));
        }
        self.complete(&mut groups, &is_there);
        let own = groups.iter().map(|group| group.name.as_str());
        let mut names = unique(own.chain(self.joints.iter().map(|joint| joint.name.as_str())));
        let of_joints = names.split_off(groups.len());
        let mut text = String::new();
        for (number, group) in groups.iter().enumerate().filter(|(number, _)| is_there[*number]) {
            body(&mut text, group, &names[number], &self.joints);
        }
        let placing = groups.iter().enumerate().filter_map(|(number, group)| Some((number, group.arm?)));
        for (number, arm) in placing.chain(closings) {
            let end = |group: usize| {
                if is_there[group] {
                    (names[group].as_str(), groups[group].mass.centre)
                } else {
                    ("space", Vector3::zeros())
                }
            };
            let ends = [end(arm.parent), end(number)];
            if is_there[number] || (self.joints[arm.joint].closes && is_there[arm.parent]) {
                self.joint(&mut text, (&arm, &of_joints[arm.joint]), ends);
            }
        }
        if self.watched > 0 {
            self.remarks.push(format!("limits of joints: {}, watched as events and not imposed", self.watched));
        }
        let head = self.head();
        let run = "[run]\nstep = \"1 ms\"\nduration = 1\n";
        Ok(Import { text: format!("{head}{text}{run}"), remarks: self.remarks })
    }

    /// The title, the remarks as comments, and the weight.
    fn head(&self) -> String {
        let plain = |text: &str| text.replace(char::is_control, " ");
        let mut head = String::new();
        for remark in &self.remarks {
            let _ = writeln!(head, "# {}", plain(remark));
        }
        let title = toml::Value::String(plain(&self.name));
        let _ = writeln!(head, "title = {title}");
        let g = self.gravity.norm();
        if g > 0.0 {
            let _ = writeln!(head, "gravity = {{ g = {}, up = {} }}", written(g), list(&(self.gravity / -g)));
        }
        head.push('\n');
        head
    }

    /// The groups of fixed links, from the root on: each after its parent; and the joints that close loops, each with the group
    /// of its child.
    fn groups(&self) -> Result<(Vec<Group>, Vec<Closing>), Unsuitable> {
        let mut numbers = HashMap::new();
        for (number, link) in self.links.iter().enumerate() {
            if numbers.insert(link.name.as_str(), number).is_some() {
                return Err((link.place, format!("there are two links called `{}`", link.name)));
            }
        }
        let mut parents: Vec<Option<usize>> = vec![None; self.links.len()];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.links.len()];
        for (number, joint) in self.joints.iter().enumerate() {
            let find = |name: &str| {
                let unknown = || (joint.place, format!("the joint `{}` is at `{name}`, which is no link", joint.name));
                numbers.get(name).copied().ok_or_else(unknown)
            };
            let (parent, child) = (find(&joint.parent)?, find(&joint.child)?);
            if joint.closes {
                continue;
            }
            if parents[child].replace(number).is_some() {
                return Err((joint.place, format!("the link `{}` has a parent already", joint.child)));
            }
            children[parent].push(number);
        }
        let roots: Vec<usize> = (0..self.links.len()).filter(|&link| parents[link].is_none()).collect();
        let &[root] = roots.as_slice() else {
            let names: Vec<_> = roots.iter().map(|&link| format!("`{}`", self.links[link].name)).collect();
            let place = roots.get(1).map_or((1, 1), |&link| self.links[link].place);
            return Err((place, format!("a model has one link without a parent, found {}", names.join(", "))));
        };
        let group = |link: usize, pose, arm| Group {
            name: self.links[link].name.clone(),
            mass: self.links[link].mass,
            pose,
            arm,
        };
        let mut groups = vec![group(root, Isometry3::identity(), None)];
        // The links whose children are to be read, each with its group and its frame there.
        let mut open = vec![(root, 0, Isometry3::identity())];
        let mut places: Vec<Option<Place>> = vec![None; self.links.len()];
        places[root] = Some((0, Isometry3::identity()));
        while let Some((link, number, frame)) = open.pop() {
            for &joint in children[link].iter().rev() {
                let Joint { origin, connection, child, .. } = &self.joints[joint];
                let (child, frame) = (numbers[child.as_str()], frame * origin);
                let place = if *connection == Connection::Fixed {
                    groups[number].mass = groups[number].mass.with(&self.links[child].mass.seen(&frame));
                    (number, frame)
                } else {
                    let arm = Arm { joint, parent: number, frame, own: Isometry3::identity() };
                    let pose = groups[number].pose * frame;
                    groups.push(group(child, pose, Some(arm)));
                    (groups.len() - 1, Isometry3::identity())
                };
                places[child] = Some(place);
                open.push((child, place.0, place.1));
            }
        }
        let Some(places) = places.into_iter().collect::<Option<Vec<Place>>>() else {
            let lost = (0..self.links.len()).find(|&link| self.is_in_circle(link, &parents, &numbers));
            let place = lost.map_or((1, 1), |link| self.links[link].place);
            return Err((place, "joints lead in a circle: no link of it is reached from the root".to_owned()));
        };
        let closing = |(joint, Joint { parent, child, origin, .. }): (usize, &Joint)| {
            let ((parent, above), (child, own)) = (places[numbers[parent.as_str()]], places[numbers[child.as_str()]]);
            (child, Arm { joint, parent, frame: above * origin, own })
        };
        let closings = self.joints.iter().enumerate().filter(|(_, joint)| joint.closes).map(closing).collect();
        Ok((groups, closings))
    }

    /// Whether the parents of a link never end.
    fn is_in_circle(&self, mut link: usize, parents: &[Option<usize>], numbers: &HashMap<&str, usize>) -> bool {
        for _ in 0..parents.len() {
            let Some(joint) = parents[link] else { return false };
            link = numbers[self.joints[joint].parent.as_str()];
        }
        true
    }

    /// The groups without those at the ends of arms that have no mass: frames of tools and sensors.
    fn leaves(&mut self, groups: &[Group], floats: bool) -> Vec<bool> {
        let mut is_there = vec![true; groups.len()];
        for number in (0..groups.len()).rev() {
            let has_child = groups
                .iter()
                .zip(&is_there)
                .any(|(group, is_there)| *is_there && group.arm.is_some_and(|arm| arm.parent == number));
            if has_child || groups[number].mass.mass > 0.0 || (number == 0 && !floats) {
                continue;
            }
            is_there[number] = false;
            let joint =
                groups[number].arm.map_or(String::new(), |arm| format!(" and joint {}", self.joints[arm.joint].name));
            self.remarks
                .push(format!("link {}{joint}: without a mass at the end of an arm, left out", groups[number].name));
        }
        is_there
    }

    /// Gives masses and inertias to those without, and possible inertias to those with others.
    fn complete(&mut self, groups: &mut [Group], is_there: &[bool]) {
        let masses = groups.iter().zip(is_there).filter(|(group, is_there)| **is_there && group.mass.mass > 0.0);
        let least = masses.map(|(group, _)| group.mass.mass).fold(f64::INFINITY, f64::min);
        let light = if least.is_finite() { least * LIGHT } else { 1.0 };
        for (group, _) in groups.iter_mut().zip(is_there).filter(|(_, is_there)| **is_there) {
            let name = &group.name;
            let mass = &mut group.mass;
            if mass.mass <= 0.0 {
                mass.mass = light;
                self.remarks.push(format!("link {name}: without a mass between joints, given {} kg", short(light)));
            }
            match mass.possible() {
                Some((inertia, true)) => {
                    mass.inertia = inertia;
                    self.remarks.push(format!(
                        "link {name}: no body has its inertia, as a principal moment is at most the sum of the others; the least one is raised"
                    ));
                }
                Some((inertia, false)) => mass.inertia = inertia,
                None => {
                    let moment = 0.4 * mass.mass * RADIUS * RADIUS;
                    mass.inertia = Matrix3::identity() * moment;
                    self.remarks.push(format!(
                        "link {name}: its inertia isn't positive, given that of a ball of 1 cm, {} kg m²",
                        short(moment)
                    ));
                }
            }
        }
    }

    /// The table of a joint between two bodies, each with its name and its centre of mass: that above and that below.
    fn joint(&mut self, text: &mut String, (arm, plain): (&Arm, &str), ends: [(&str, Vector3<f64>); 2]) {
        let Joint { connection, at, closes, .. } = &self.joints[arm.joint];
        let Some((kind, axes)) = connection.kind() else { return };
        let [(above, centre), (below, own)] = ends;
        let [at_above, at_below] = [(&arm.frame, centre), (&arm.own, own)]
            .map(|(frame, centre)| frame.transform_point(&(*at).into()).coords - centre);
        let _ = writeln!(text, "[[joint]]\nname = \"{plain}\"");
        let _ = writeln!(text, "kind = \"{kind}\"\nbodies = [\"{above}\", \"{below}\"]");
        let _ = writeln!(text, "at = [{}, {}]", list(&at_above), list(&at_below));
        if let Some([first, second]) = axes {
            let [first, second] = [arm.frame.rotation * first, arm.own.rotation * second];
            let _ = writeln!(text, "axes = [{}, {}]", list(&first), list(&second));
        }
        // The attitude of the body below, as the one above sees it.
        let turn = arm.frame.rotation * arm.own.rotation.inverse();
        if turn.angle() > 0.0 {
            let [w, x, y, z] = [turn.w, turn.i, turn.j, turn.k].map(written);
            let _ = writeln!(text, "zero = {{ quaternion = {{ w = {w}, x = {x}, y = {y}, z = {z} }} }}");
        }
        let has_coordinate = matches!(kind, "pin" | "slider");
        if has_coordinate && !closes {
            text.push_str(if kind == "pin" { "angle = 0\n" } else { "shift = 0\n" });
        }
        self.terms(text, (arm.joint, kind));
        text.push('\n');
    }

    /// The terms in a joint of this kind, and its limits.
    fn terms(&mut self, text: &mut String, (joint, kind): (usize, &str)) {
        let Joint { name, damping, friction, armature, limits, stiffness, rest, .. } = &self.joints[joint];
        let most = if kind == "slider" { "force" } else { "torque" };
        let terms = [
            ("damping", *damping, written(*damping)),
            ("friction", *friction, format!("{{ {most} = {}, below = {CREEP} }}", written(*friction))),
            ("armature", *armature, written(*armature)),
        ];
        for (key, size, value) in terms.into_iter().filter(|(_, size, _)| *size > 0.0) {
            if kind == "weld" {
                self.remarks.push(format!("joint {name}: it is fixed, and its {key} is left out, {}", short(size)));
            } else {
                let _ = writeln!(text, "{key} = {value}");
            }
        }
        if *stiffness > 0.0 && matches!(kind, "plane" | "weld") {
            self.remarks.push(format!("joint {name}: a {kind} has no spring, {} N m/rad", short(*stiffness)));
        } else if *stiffness > 0.0 {
            let _ = writeln!(text, "stiffness = {}", written(*stiffness));
            if matches!(kind, "pin" | "slider") {
                let _ = writeln!(text, "rest = {}", angle(*rest, kind));
            }
        }
        match (limits, kind) {
            (Some([from, to]), "pin") if to - from >= TAU => {
                self.remarks.push(format!("joint {name}: its limits are a turn apart or more, left out"));
            }
            (Some([from, to]), "pin" | "slider") => {
                let _ = writeln!(text, "limits = {{ from = {}, to = {} }}", angle(*from, kind), angle(*to, kind));
                self.watched += 1;
            }
            (Some(_), _) => self.remarks.push(format!("joint {name}: a {kind} has no limits")),
            (None, _) => (),
        }
    }
}

/// A limit of a joint; angles of more than a turn have their unit.
fn angle(limit: f64, kind: &str) -> String {
    if kind == "pin" && limit.abs() > 6.0 { format!("\"{} rad\"", written(limit)) } else { written(limit) }
}

/// The table of a body. Joints place it, but for a root and for one that is free.
fn body(text: &mut String, group: &Group, name: &str, joints: &[Joint]) {
    let Distribution { mass, centre, inertia } = &group.mass;
    let _ = writeln!(text, "[[body]]\nname = \"{name}\"\nm = {}", written(*mass));
    let scale = inertia.diagonal().amax();
    let rows: Vec<_> = inertia.row_iter().map(|row| list(&row.transpose())).collect();
    let is_diagonal = [(0, 1), (0, 2), (1, 2)].iter().all(|&at| inertia[at].abs() <= 1e-15 * scale);
    let _ = if is_diagonal {
        writeln!(text, "moments = {}", list(&inertia.diagonal()))
    } else {
        writeln!(text, "J = [{}]", rows.join(", "))
    };
    if group.arm.is_none_or(|arm| matches!(joints[arm.joint].connection, Connection::Free)) {
        let position = group.pose.transform_point(&(*centre).into()).coords;
        let turn = group.pose.rotation;
        let [w, x, y, z] = [turn.w, turn.i, turn.j, turn.k].map(written);
        let _ = writeln!(text, "position = {}", list(&position));
        let _ =
            writeln!(text, "start.quaternion = {{ w = {w}, x = {x}, y = {y}, z = {z} }}\nstart.velocity = [0, 0, 0]");
    }
    text.push('\n');
}

/// A number with fifteen digits, which are those of a file that was typed.
fn written(number: f64) -> String {
    let rounded = format!("{number:.14e}").parse::<f64>().unwrap_or(number);
    if rounded == 0.0 { "0".to_owned() } else { format!("{rounded:?}") }
}

/// A vector without parts that are rounding beside the others.
fn list(vector: &Vector3<f64>) -> String {
    let least = 1e-15 * vector.amax();
    let [x, y, z] = [vector.x, vector.y, vector.z].map(|part| written(if part.abs() <= least { 0.0 } else { part }));
    format!("[{x}, {y}, {z}]")
}

/// Names of letters, digits, `-` and `_`, each once.
fn unique<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::from(["space".to_owned()]);
    let mut name = |name: &str| {
        let plain = |letter: char| if letter.is_alphanumeric() || "_-".contains(letter) { letter } else { '-' };
        let name: String = name.chars().map(plain).collect();
        let name = if name.is_empty() { "link".to_owned() } else { name };
        let mut all = core::iter::once(name.clone()).chain((2..).map(|number| format!("{name}-{number}")));
        let free = all.find(|name| !taken.contains(name)).unwrap_or(name);
        taken.insert(free.clone());
        free
    };
    names.map(&mut name).collect()
}
