//! Paths on the unit sphere, seen from outside and slightly above, in parallel projection.

use nalgebra::Vector3;
use plotters::prelude::*;

use super::canvas::{Area, PlotResult, at, px};
use super::style::{INK, letters};
use super::thin::thinned;

/// A path near the unit sphere.
pub struct Path<'a> {
    /// The title above the sphere.
    pub title: &'a str,
    /// The colour of the path.
    pub colour: RGBColor,
    /// The width in half pixels; thin for a path that covers itself many times.
    pub width: u32,
    /// The points in space, from the beginning to the end.
    pub points: &'a [Vector3<f64>],
    /// A direction to be marked, and its name.
    pub axis: (Vector3<f64>, &'a str),
}

/// The direction of the eye: high enough to see the rim of a cap at 45°.
const AZIMUTH: f64 = 0.6;
const ELEVATION: f64 = 0.6;

const SEA: RGBColor = RGBColor(246, 248, 250);
const FAR_GRATICULE: RGBColor = RGBColor(228, 231, 235);
const NEAR_GRATICULE: RGBColor = RGBColor(190, 196, 203);

/// Draws the sphere and the path, its visible arcs over its hidden ones.
pub fn sphere(area: &Area<'_>, path: &Path<'_>) -> PlotResult {
    let view = View::of(area);
    area.draw_text(path.title, &letters(13, INK), (at(16), at(6)))?;
    area.draw(&Circle::new(view.centre, view.size, SEA.filled()))?;
    let graticule: Vec<_> = graticule().iter().flat_map(|line| view.arcs(line)).collect();
    let arcs = view.arcs(path.points);
    for near in [false, true] {
        let (grid, ink) = if near { (NEAR_GRATICULE, path.colour) } else { (FAR_GRATICULE, faint(path.colour)) };
        for arc in graticule.iter().filter(|arc| arc.near == near) {
            area.draw(&PathElement::new(arc.points.clone(), grid.stroke_width(px(1) / 2)))?;
        }
        if near {
            view.axis(area, path.axis)?;
        }
        for arc in arcs.iter().filter(|arc| arc.near == near) {
            area.draw(&PathElement::new(arc.points.clone(), ink.stroke_width(path.width)))?;
        }
    }
    area.draw(&Circle::new(view.centre, view.size, NEAR_GRATICULE.stroke_width(px(1))))?;
    // The end of the path is marked: a path that shrinks to a point would be invisible otherwise.
    if let Some((arc, end)) = arcs.last().and_then(|arc| Some((arc, arc.points.last()?))) {
        let ink = if arc.near { path.colour } else { faint(path.colour) };
        area.draw(&Circle::new(*end, px(3), ink.filled()))?;
    }
    Ok(())
}

/// Mixed with white rather than transparent, as overlapping arcs would add up.
fn faint(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let mixed = |c: u8| 255 - (255 - c) / 3;
    RGBColor(mixed(r), mixed(g), mixed(b))
}

struct Arc {
    near: bool,
    points: Vec<(i32, i32)>,
}

struct View {
    centre: (i32, i32),
    size: u32,
    right: Vector3<f64>,
    up: Vector3<f64>,
    towards: Vector3<f64>,
}

impl View {
    fn of(area: &Area<'_>) -> Self {
        let (width, height) = area.dim_in_pixel();
        let top = px(30);
        let size = (width.min(height - top) / 2).saturating_sub(px(18));
        let half = |length: u32| i32::try_from(length / 2).unwrap_or(0);
        let centre = (half(width), half(height - top) + at(34));
        let ((sa, ca), (se, ce)) = (AZIMUTH.sin_cos(), ELEVATION.sin_cos());
        Self {
            centre,
            size,
            right: Vector3::new(-sa, ca, 0.0),
            up: Vector3::new(-se * ca, -se * sa, ce),
            towards: Vector3::new(ce * ca, ce * sa, se),
        }
    }

    fn project(&self, point: &Vector3<f64>) -> (i32, i32) {
        let size = f64::from(self.size);
        #[allow(clippy::cast_possible_truncation)] // clamped to a few radii
        let unit = |x: f64| (size * x.clamp(-3.0, 3.0)).round() as i32;
        (self.centre.0 + unit(self.right.dot(point)), self.centre.1 - unit(self.up.dot(point)))
    }

    /// The pieces of a path before and behind the sphere, each joined to the next.
    fn arcs(&self, path: &[Vector3<f64>]) -> Vec<Arc> {
        let mut arcs: Vec<Arc> = Vec::new();
        for point in path.iter().filter(|p| p.iter().all(|x| x.is_finite())) {
            let (near, place) = (self.towards.dot(point) >= 0.0, self.project(point));
            match arcs.last_mut() {
                Some(arc) if arc.near == near => {
                    if arc.points.last() != Some(&place) {
                        arc.points.push(place);
                    }
                }
                Some(arc) => {
                    arc.points.push(place);
                    arcs.push(Arc { near, points: vec![place] });
                }
                None => arcs.push(Arc { near, points: vec![place] }),
            }
        }
        for arc in &mut arcs {
            arc.points = thinned(&arc.points, |&(x, y)| (f64::from(x), f64::from(y)));
        }
        arcs
    }

    /// Draws a direction, from the surface outwards.
    fn axis(&self, area: &Area<'_>, (direction, name): (Vector3<f64>, &str)) -> PlotResult {
        let ends = [1.0, 1.3].map(|length| self.project(&(direction * length)));
        area.draw(&PathElement::new(ends.to_vec(), INK.stroke_width(px(1))))?;
        area.draw_text(name, &letters(12, INK), (ends[1].0 + at(5), ends[1].1 - at(6)))?;
        Ok(())
    }
}

/// The graticule: circles every 30°.
fn graticule() -> Vec<Vec<Vector3<f64>>> {
    let angles = || (0..=90).map(|k| (f64::from(k) * 4.0).to_radians());
    let parallels = (-2..=2).map(|k| {
        let (z, radius) = (f64::from(k) * 30.0).to_radians().sin_cos();
        angles().map(|a| Vector3::new(radius * a.cos(), radius * a.sin(), z)).collect()
    });
    let meridians = (0..6).map(|k| {
        let (s, c) = (f64::from(k) * 30.0).to_radians().sin_cos();
        angles().map(|a| Vector3::new(a.cos() * c, a.cos() * s, a.sin())).collect()
    });
    parallels.chain(meridians).collect()
}
