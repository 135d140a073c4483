//! One figure with all of it, for a front page.

use nalgebra::Vector3;

use super::figures::Figures;
use crate::plot::{Path, PlotResult, heading, px, render, sphere};
use crate::table::short;

/// The path on the sphere, its last seconds, and what is conserved.
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
        let points: Vec<_> = ours.between(start, end).iter().map(|q| q.tip).collect();
        let title = format!("Path of the tip, {} s to {} s", short(start), short(end));
        sphere(
            &top,
            &Path { title: &title, colour: ours.colour, width: 1, points: &points, axis: (Vector3::z(), "e₃") },
        )?;
        figures.close_up(&figures.close_up_title(), ours).draw(&bottom)?;
        let panels = [
            figures.geometry("Rigidity: how far R leaves the rotations"),
            figures.vertical_momentum("Angular momentum about the vertical: how far from its start"),
            figures.energy_long("Energy: how far from its start"),
        ];
        for (place, panel) in right.split_evenly((3, 1)).iter().zip(panels) {
            panel.draw(place)?;
        }
        Ok(())
    })
}
