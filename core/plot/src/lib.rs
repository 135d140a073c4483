//! Figures as SVG: panels with axes, and paths on a sphere; and the folder that they are written to.
//!
//! Only the SVG back end is used, and text stays text, so creating a figure needs no font.

// The errors of all functions are described at `PlotResult`.
#![allow(clippy::missing_errors_doc)]

mod canvas;
mod envelope;
pub mod output;
mod panel;
mod sketch;
mod sphere;
mod style;
mod thin;

pub use canvas::{Area, PlotResult, px, render};
pub use panel::{Line, Panel, Vertical};
pub use plotters::style::RGBColor as Colour;
pub use sketch::{Sketch, arc};
pub use sphere::{Path, sphere};
pub use style::{BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION, YELLOW, heading, legend};
