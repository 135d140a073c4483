//! Figures as SVG: panels with axes, and paths on a sphere.
//!
//! Only the SVG back end is used, and text stays text, so no font is needed where the figures are made.

mod canvas;
mod envelope;
mod panel;
mod sphere;
mod style;
mod thin;

pub(crate) use canvas::{Area, Drawn, render};
pub(crate) use panel::{Line, Panel, Vertical};
pub(crate) use sphere::{Path, sphere};
pub(crate) use style::{BLUE, GREEN, ORANGE, PURPLE, heading, legend, px};
