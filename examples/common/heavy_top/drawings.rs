//! Figures 3.1 and 3.2 of the thesis: the Euler angles, and the top.

use nalgebra::{Rotation3, Vector3};
use plotters::style::RGBColor;

use crate::plot::{BLUE, GREEN, INK, ORANGE, PURPLE, PlotResult, Sketch, arc, heading, px, render};

const LIGHT: RGBColor = RGBColor(200, 205, 210);
const PALE: RGBColor = RGBColor(226, 238, 246);

/// The angles `φ`, `θ`, `ψ` of the drawings, rad.
const ANGLES: [f64; 3] = [0.9, 0.75, 0.8];
const CIRCLE: (f64, f64) = (0.0, 2.0 * core::f64::consts::PI);

/// The axes `X`, `Y`, `Z` that follow `φ` and `θ`, and the body's first axis, which follows `ψ` too.
fn axes() -> [Vector3<f64>; 4] {
    let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
    let [precession, nutation, spin] = ANGLES;
    let frame = about(Vector3::z_axis(), precession) * about(Vector3::x_axis(), nutation);
    let body = frame * about(Vector3::z_axis(), spin);
    [frame * Vector3::x(), frame * Vector3::y(), frame * Vector3::z(), body * Vector3::x()]
}

fn axis(sketch: &Sketch<'_, '_>, direction: &Vector3<f64>, name: &str, colour: RGBColor) -> PlotResult {
    sketch.arrow(&[Vector3::zeros(), *direction], colour, 3)?;
    sketch.name(name, &(direction * 1.09), (0, 0), colour)
}

/// Figure 3.1 of the thesis.
pub fn euler_angles() -> PlotResult<String> {
    let [x, y, z, body] = axes();
    let [precession, nutation, spin] = ANGLES;
    let (origin, ex, ey, ez) = (Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z());
    let node = ez.cross(&x);
    render((640, 560), |area| {
        let (header, below) = area.split_vertically(px(62));
        heading(
            &header,
            "Euler angles",
            "precession φ about z, nutation θ about X, spin ψ about Z; after figure 3.1 of the thesis",
        )?;
        let sketch = Sketch::new(&below, (0.5, 0.6), 235);
        sketch.surface(&arc(&origin, (&x, &y), 0.8, CIRCLE), PALE)?;
        sketch.line(&arc(&origin, (&ex, &ey), 0.8, CIRCLE), LIGHT, 2)?;
        sketch.line(&arc(&origin, (&x, &y), 0.8, CIRCLE), BLUE, 2)?;
        for (direction, name) in [(ex, "x"), (ey, "y"), (ez, "z")] {
            axis(&sketch, &direction, name, INK)?;
        }
        for (direction, name) in [(x, "X = x'"), (y, "Y"), (z, "Z = z''")] {
            axis(&sketch, &direction, name, BLUE)?;
        }
        sketch.line(&[origin, body * 0.8], GREEN, 3)?;
        sketch.name("body", &body, (14, -2), GREEN)?;
        for (plane, radius, angle, name, colour) in [
            ((&ex, &ey), 0.45, precession, "φ", ORANGE),
            ((&ez, &-node), 0.55, nutation, "θ", PURPLE),
            ((&x, &y), 0.45, spin, "ψ", GREEN),
        ] {
            sketch.arrow(&arc(&origin, plane, radius, (0.0, angle)), colour, 4)?;
            let middle = arc(&origin, plane, radius + 0.09, (0.5 * angle, angle));
            sketch.name(name, &middle[0], (0, 0), colour)?;
        }
        Ok(())
    })
}

/// Figure 3.2 of the thesis.
pub fn top() -> PlotResult<String> {
    let [x, y, z, _] = axes();
    let (origin, ez) = (Vector3::zeros(), Vector3::z());
    let node = ez.cross(&x);
    let centre = z * 0.55;
    render((640, 560), |area| {
        let (header, below) = area.split_vertically(px(62));
        heading(
            &header,
            "Heavy top",
            "a body on a pivot, with its centre of mass ρ on the axis of symmetry; after figure 3.2 of the thesis",
        )?;
        let sketch = Sketch::new(&below, (0.45, 0.74), 285);
        // A double cone: the rim, and the lines from it to its two ends.
        let rim = arc(&(z * 0.62), (&x, &y), 0.36, CIRCLE);
        for end in [origin, z * 0.78] {
            for pair in rim.windows(2) {
                sketch.surface(&[end, pair[0], pair[1]], PALE)?;
            }
        }
        for end in [origin, z * 0.78] {
            for point in rim.iter().step_by(8) {
                sketch.line(&[end, *point], LIGHT, 1)?;
            }
        }
        sketch.line(&rim, BLUE, 2)?;
        axis(&sketch, &Vector3::x(), "x", INK)?;
        axis(&sketch, &Vector3::y(), "y", INK)?;
        axis(&sketch, &ez, "z", INK)?;
        axis(&sketch, &(x * 0.8), "X", BLUE)?;
        axis(&sketch, &(z * 1.2), "Z", BLUE)?;
        sketch.dot(&centre, ORANGE)?;
        sketch.name("ρ", &centre, (-14, -4), ORANGE)?;
        sketch.arrow(&[centre, centre - ez * 0.38], ORANGE, 4)?;
        sketch.name("m g", &(centre - ez * 0.38), (20, 0), ORANGE)?;
        for (plane, middle, radius, (from, to), name, colour) in [
            ((&ez, &-node), origin, 0.92, (0.0, ANGLES[1]), "θ", PURPLE),
            ((&x, &-node), ez * 0.72, 0.12, (0.6, 5.6), "φ'", GREEN),
            ((&x, &y), z * 1.06, 0.1, (2.2, 7.2), "ψ'", GREEN),
            ((&y, &z), x * 0.55, 0.1, (0.6, 5.6), "θ'", GREEN),
        ] {
            sketch.arrow(&arc(&middle, plane, radius, (from, to)), colour, 3)?;
            let outside = arc(&middle, plane, radius + 0.1, (0.5 * (from + to), to));
            sketch.name(name, &outside[0], (0, 0), colour)?;
        }
        Ok(())
    })
}
