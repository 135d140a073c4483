//! A drawing as an SVG string.

use plotters::coord::Shift;
use plotters::prelude::*;

/// A rectangle of a drawing.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Drawing into a string fails only for an impossible layout.
pub type PlotResult<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// The units in a pixel: the drawing library places points on whole units, and two in a pixel keep lines smooth.
pub(super) const UNITS: u32 = 2;

/// A number of pixels in the units of the drawing.
#[must_use]
pub const fn px(pixels: u32) -> u32 {
    pixels * UNITS
}

#[allow(clippy::cast_possible_wrap)] // sizes of a drawing are thousands at most
pub(super) const fn at(pixels: u32) -> i32 {
    px(pixels) as i32
}

/// The SVG of a drawing of this width and height in pixels.
pub fn render((width, height): (u32, u32), draw: impl FnOnce(&Area<'_>) -> PlotResult) -> PlotResult<String> {
    let (wide, high) = (px(width), px(height));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (wide, high)).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
    }
    // The SVG is displayed at its size in pixels. Joins are round, because a mitre on a dense zigzag becomes a spike.
    let drawn = format!("<svg width=\"{wide}\" height=\"{high}\"");
    let shown =
        format!("<svg width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"");
    Ok(svg.replacen(&drawn, &shown, 1))
}
