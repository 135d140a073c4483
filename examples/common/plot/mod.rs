//! Figures as SVG: panels with axes, and paths on a sphere.
//!
//! Only the SVG back end is used, and text stays text, so no font is needed where the figures are made.

mod canvas;
mod envelope;
mod panel;
mod sketch;
mod sphere;
mod style;
mod thin;

pub use canvas::{Area, Drawn, render};
pub use panel::{Line, Panel, Vertical};
pub use sketch::{Sketch, arc};
pub use sphere::{Path, sphere};
pub use style::{BLUE, GREEN, INK, ORANGE, PURPLE, heading, legend, px};
