//! A drawing as a string.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::style::px;

/// A rectangle of a drawing.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Drawing into a string fails only for an impossible layout.
pub type Drawn<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// The SVG of a drawing of so many pixels.
pub fn render((width, height): (u32, u32), draw: impl FnOnce(&Area<'_>) -> Drawn) -> Drawn<String> {
    let (wide, high) = (px(width), px(height));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (wide, high)).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
    }
    // Shown at its size in pixels; and round joins, because a mitre on a dense zigzag becomes a spike.
    let drawn = format!("<svg width=\"{wide}\" height=\"{high}\"");
    let shown =
        format!("<svg width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"");
    Ok(svg.replacen(&drawn, &shown, 1))
}
