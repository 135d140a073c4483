//! The overview: one figure for a front page.

use super::figures::{Figures, tip_path};
use crate::plot::{PlotResult, heading, px, render};
use crate::table::short;

/// The path on the sphere, its last seconds, and the conserved quantities.
pub fn overview(figures: &Figures<'_>) -> PlotResult<String> {
    let (start, end) = figures.late();
    let Some(ours) = figures.series.first() else {
        return Err("no runs to draw".into());
    };
    render((1200, 800), |area| {
        let (header, body) = area.split_vertically(px(84));
        heading(&header, "A heavy top, integrated for what it conserves", &figures.setting())?;
        figures.legend(&header, (16, 68))?;
        let (left, right) = body.split_horizontally(px(520));
        let (top, bottom) = left.split_vertically(px(470));
        let title = format!("Path of the tip, {} s to {} s", short(start), short(end));
        tip_path(&top, (&title, 1), ours, (start, end))?;
        figures.close_up(&figures.close_up_title(), ours).draw(&bottom)?;
        let panels = [
            figures.geometry("Rigidity: how far R leaves the rotations"),
            figures.vertical_momentum("Angular momentum about the vertical: how far from its start"),
            figures.energy_long("Energy: how far from its start; in a band it oscillates, a rise is drift"),
        ];
        for (place, panel) in right.split_evenly((3, 1)).iter().zip(panels) {
            panel.draw(place)?;
        }
        Ok(())
    })
}
