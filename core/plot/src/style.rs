//! Colours, sizes and lettering.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{Area, PlotResult, at, px};

// Okabe and Ito's palette, which stays distinct under the common forms of colour blindness.
/// The first colour of a series.
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
/// The second colour of a series.
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
/// The third colour of a series.
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
/// The colour of a path.
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
/// The fifth colour of a series.
pub const SKY: RGBColor = RGBColor(86, 180, 233);
/// The sixth colour of a series.
pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
/// The last colour of a series, and the faintest.
pub const YELLOW: RGBColor = RGBColor(240, 228, 66);

/// The colour of letters and axes.
pub const INK: RGBColor = RGBColor(45, 45, 45);
pub(super) const GRID: RGBColor = RGBColor(226, 226, 226);

/// A text style with letters of a size in pixels.
pub(super) fn letters(size: u32, colour: RGBColor) -> TextStyle<'static> {
    // The drawing library divides font sizes by this ratio.
    let size = f64::from(px(size)) * 1.24;
    ("sans-serif", size).into_font().color(&colour)
}

/// A title and a fainter line below it.
pub fn heading(area: &Area<'_>, title: &str, subtitle: &str) -> PlotResult {
    area.draw_text(title, &letters(17, INK), (at(16), at(12)))?;
    area.draw_text(subtitle, &letters(12, RGBColor(100, 100, 100)), (at(16), at(36)))?;
    Ok(())
}

/// Names beside strokes of their colours, in one row that starts `left`, `top` pixels into the area.
pub fn legend(area: &Area<'_>, (left, top): (u32, u32), entries: &[(&str, RGBColor)]) -> PlotResult {
    let mut x = at(left);
    let y = at(top);
    for (name, colour) in entries {
        let stroke = vec![(x, y), (x + at(18), y)];
        area.draw(&PathElement::new(stroke, colour.stroke_width(px(2))))?;
        let text = letters(12, INK).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw_text(name, &text, (x + at(24), y))?;
        // Without a font a width can only be estimated; 0.55 em is a wide average for sans-serif.
        let characters = i32::try_from(name.chars().count()).unwrap_or(0);
        x += at(24 + 18) + characters * at(12) * 55 / 100;
    }
    Ok(())
}
