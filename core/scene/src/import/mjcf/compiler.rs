//! Settings of MJCF that change the meaning of numbers: units of angles, and frames.

use nalgebra::{Isometry3, Matrix3, Quaternion, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::super::xml::{Read, direction, number, numbers, place, triple};
use super::classes::Element;

/// The settings of an element `compiler`.
pub(super) struct Compiler {
    /// The unit of angles, rad.
    pub(super) unit: f64,
    /// The axes of three angles in their order: large letters for those of the parent, small ones for those that turn.
    order: String,
    /// Whether the inertia is that of shapes: always, never, or where a body has no other.
    pub(super) by_shapes: Option<bool>,
    /// Least mass of a body, kg, and least moment, kg m².
    pub(super) least: [f64; 2],
    /// The mass of all bodies, kg, where it is set.
    pub(super) total: Option<f64>,
    /// Whether limits count where nothing says that they do.
    pub(super) limits: bool,
    /// Whether impossible moments are replaced by their mean.
    pub(super) balances: bool,
    /// The groups of the shapes that have a mass.
    pub(super) groups: [f64; 2],
}

impl Default for Compiler {
    fn default() -> Self {
        Self {
            unit: 1_f64.to_radians(),
            order: "xyz".to_owned(),
            by_shapes: None,
            least: [0.0; 2],
            total: None,
            limits: true,
            balances: false,
            groups: [0.0, 5.0],
        }
    }
}

impl Compiler {
    /// Takes the settings of an element `compiler`.
    pub(super) fn read(&mut self, node: &Node<'_, '_>) -> Read<()> {
        let wrong =
            |key: &str, text: &str, known: &str| Err((place(node), format!("`{key}` is `{text}`, expected {known}")));
        for attribute in node.attributes() {
            let (key, text) = (attribute.name(), attribute.value());
            match (key, text) {
                ("angle", "degree") => self.unit = 1_f64.to_radians(),
                ("angle", "radian") => self.unit = 1.0,
                ("angle", _) => return wrong(key, text, "`degree` or `radian`"),
                ("coordinate", "local") => (),
                ("coordinate", _) => return wrong(key, text, "`local`: places of bodies are those in their parents"),
                ("eulerseq", order) => {
                    if order.len() != 3 || !order.chars().all(|axis| "xyzXYZ".contains(axis)) {
                        return wrong(key, text, "three letters of `xyzXYZ`");
                    }
                    order.clone_into(&mut self.order);
                }
                ("inertiafromgeom", "auto") => self.by_shapes = None,
                ("inertiafromgeom", "true") => self.by_shapes = Some(true),
                ("inertiafromgeom", "false") => self.by_shapes = Some(false),
                ("inertiafromgeom", _) => return wrong(key, text, "`auto`, `true` or `false`"),
                ("boundmass", _) => self.least[0] = number(node, key)?.unwrap_or(0.0),
                ("boundinertia", _) => self.least[1] = number(node, key)?.unwrap_or(0.0),
                ("settotalmass", _) => self.total = number(node, key)?.filter(|total| *total > 0.0),
                ("autolimits", _) => self.limits = text == "true",
                ("balanceinertia", _) => self.balances = text == "true",
                ("inertiagrouprange", _) => self.groups = numbers(node, key, text)?,
                _ => (),
            }
        }
        Ok(())
    }

    /// The frame of an element, in that around it.
    pub(super) fn frame(&self, element: &Element<'_, '_>) -> Read<Isometry3<f64>> {
        let shift = element.with("pos").map(|node| triple(node, "pos")).transpose()?.flatten().unwrap_or_default();
        Ok(Isometry3::from_parts(Translation3::from(shift), self.turn(element)?))
    }

    /// The attitude of an element, in one of five ways.
    fn turn(&self, element: &Element<'_, '_>) -> Read<UnitQuaternion<f64>> {
        let given = ["quat", "axisangle", "euler", "xyaxes", "zaxis"]
            .into_iter()
            .find_map(|key| Some((key, element.with(key)?, element.text(key)?)));
        let Some((key, node, text)) = given else { return Ok(UnitQuaternion::identity()) };
        Ok(match key {
            "quat" => {
                let [w, x, y, z] = numbers(node, key, text)?;
                let quaternion = Quaternion::new(w, x, y, z);
                let unit = UnitQuaternion::try_new(quaternion, 1e-9);
                unit.ok_or_else(|| (place(node), "a `quat` isn't zero".to_owned()))?
            }
            "axisangle" => {
                let [x, y, z, angle] = numbers(node, key, text)?;
                let axis = Unit::new_unchecked(direction(node, Vector3::new(x, y, z))?);
                UnitQuaternion::from_axis_angle(&axis, angle * self.unit)
            }
            "euler" => {
                let angles = numbers::<3>(node, key, text)?;
                self.order.chars().zip(angles).fold(UnitQuaternion::identity(), |turn, (axis, angle)| {
                    let about = match axis.to_ascii_lowercase() {
                        'x' => Vector3::x_axis(),
                        'y' => Vector3::y_axis(),
                        _ => Vector3::z_axis(),
                    };
                    let next = UnitQuaternion::from_axis_angle(&about, angle * self.unit);
                    if axis.is_lowercase() { turn * next } else { next * turn }
                })
            }
            "xyaxes" => {
                let [a, b, c, d, e, f] = numbers(node, key, text)?;
                let x = direction(node, Vector3::new(a, b, c))?;
                let y = Vector3::new(d, e, f);
                let y = direction(node, y - x * x.dot(&y))?;
                rotation(Matrix3::from_columns(&[x, y, x.cross(&y)]))
            }
            _ => to_axis(&direction(node, Vector3::from(numbers::<3>(node, key, text)?))?),
        })
    }
}

/// The quaternion of a rotation that was made of unit vectors.
fn rotation(R: Matrix3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(R))
}

/// The least turn of the third axis to a unit vector; half a turn is about the first axis.
pub(super) fn to_axis(axis: &Vector3<f64>) -> UnitQuaternion<f64> {
    let half = || UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    UnitQuaternion::rotation_between(&Vector3::z(), axis).unwrap_or_else(half)
}
