//! Arrows and arcs in space, in parallel projection: for a drawing of axes and angles.

use nalgebra::Vector3;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{Area, PlotResult, at, px};
use super::style::letters;

/// A drawing of space, seen from outside and above.
pub struct Sketch<'a, 'b> {
    area: &'a Area<'b>,
    centre: (i32, i32),
    /// The units of the drawing in a unit of length.
    size: f64,
    right: Vector3<f64>,
    up: Vector3<f64>,
}

/// The angle of the first axis to the left of the eye, and the elevation of the eye, rad.
const AZIMUTH: f64 = 0.55;
const ELEVATION: f64 = 0.35;

impl<'a, 'b> Sketch<'a, 'b> {
    /// A sketch with the origin at a share of the width and the height, and a unit of length in pixels.
    #[must_use]
    pub fn new(area: &'a Area<'b>, (across, down): (f64, f64), pixels: u32) -> Self {
        let (width, height) = area.dim_in_pixel();
        #[allow(clippy::cast_possible_truncation)] // within the drawing
        let place = |share: f64, length: u32| (share * f64::from(length)) as i32;
        let ((sa, ca), (se, ce)) = (AZIMUTH.sin_cos(), ELEVATION.sin_cos());
        Self {
            area,
            centre: (place(across, width), place(down, height)),
            size: f64::from(px(pixels)),
            right: Vector3::new(-sa, ca, 0.0),
            up: Vector3::new(-se * ca, -se * sa, ce),
        }
    }

    /// The projection of a point.
    fn place(&self, point: &Vector3<f64>) -> (i32, i32) {
        #[allow(clippy::cast_possible_truncation)] // within the drawing
        let unit = |x: f64| (self.size * x).round() as i32;
        (self.centre.0 + unit(self.right.dot(point)), self.centre.1 - unit(self.up.dot(point)))
    }

    /// A line through points; `width` in half pixels.
    pub fn line(&self, points: &[Vector3<f64>], colour: RGBColor, width: u32) -> PlotResult {
        let places: Vec<_> = points.iter().map(|point| self.place(point)).collect();
        self.area.draw(&PathElement::new(places, colour.stroke_width(width)))?;
        Ok(())
    }

    /// A surface within a closed line.
    pub fn surface(&self, points: &[Vector3<f64>], colour: RGBColor) -> PlotResult {
        let places: Vec<_> = points.iter().map(|point| self.place(point)).collect();
        self.area.draw(&Polygon::new(places, colour.filled()))?;
        Ok(())
    }

    /// Draws a dot at a point of space.
    pub fn dot(&self, point: &Vector3<f64>, colour: RGBColor) -> PlotResult {
        self.area.draw(&Circle::new(self.place(point), px(4), colour.filled()))?;
        Ok(())
    }

    /// A name, at a distance in pixels right of and below a point.
    pub fn name(&self, name: &str, point: &Vector3<f64>, (right, below): (i32, i32), colour: RGBColor) -> PlotResult {
        let (x, y) = self.place(point);
        let text = letters(14, colour).pos(Pos::new(HPos::Center, VPos::Center));
        self.area.draw_text(name, &text, (x + right * at(1), y + below * at(1)))?;
        Ok(())
    }

    /// Draws a line with an arrow's head at its end.
    pub fn arrow(&self, points: &[Vector3<f64>], colour: RGBColor, width: u32) -> PlotResult {
        self.line(points, colour, width)?;
        let places: Vec<_> = points.iter().map(|point| self.place(point)).collect();
        let (Some(end), Some(before)) = (places.last(), places.iter().rev().nth(1)) else { return Ok(()) };
        let (dx, dy) = (f64::from(end.0 - before.0), f64::from(end.1 - before.1));
        let (dx, dy) = (dx / dx.hypot(dy), dy / dx.hypot(dy));
        #[allow(clippy::cast_possible_truncation)] // within the drawing
        let off = |along: f64, aside: f64| {
            let size = f64::from(px(1));
            let (x, y) = (along * dx - aside * dy, along * dy + aside * dx);
            (end.0 + (x * size).round() as i32, end.1 + (y * size).round() as i32)
        };
        self.area.draw(&Polygon::new(vec![off(2.0, 0.0), off(-9.0, 4.0), off(-9.0, -4.0)], colour.filled()))?;
        Ok(())
    }
}

/// Points of a circle of a radius about `centre`, from `one` towards `other`, from an angle to another, rad.
#[must_use]
pub fn arc(
    centre: &Vector3<f64>,
    (one, other): (&Vector3<f64>, &Vector3<f64>),
    radius: f64,
    (from, to): (f64, f64),
) -> Vec<Vector3<f64>> {
    let angle = |k: u32| from + (to - from) * f64::from(k) / 48.0;
    (0..=48).map(|k| centre + (one * angle(k).cos() + other * angle(k).sin()) * radius).collect()
}
