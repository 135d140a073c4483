//! One figure with all of it, for a front page.

use super::figures::Figures;
use crate::plot::{Path, PlotResult, px, render, sphere};
use crate::table::short;

/// Two flips, s: more would cover their own path.
const SHOWN: f64 = 19.0;

/// The path of the middle axis on the sphere, the flips, and what is conserved.
pub fn overview(figures: &Figures<'_>) -> PlotResult<String> {
    let Some(ours) = figures.series.first() else {
        return Err("no runs to draw".into());
    };
    render((1200, 760), |area| {
        let body = figures.header(area, "A free body that flips about its middle axis")?;
        let (left, right) = body.split_horizontally(px(520));
        let (top, bottom) = left.split_vertically(px(450));
        let shown = ours.values.iter().take_while(|q| q.time <= SHOWN);
        let points: Vec<_> = shown.map(|q| q.axis).collect();
        let axis = (ours.values[0].spatial.normalize(), "RΠ");
        let title =
            format!("Path of the middle axis in space, the first {} s", short(SHOWN.min(figures.schedule.end())));
        sphere(&top, &Path { title: &title, colour: ours.colour, width: 3, points: &points, axis })?;
        figures.flips("The rate about it, all methods").draw(&bottom)?;
        let panels = [
            figures.energy_ratio("Energy over its initial value"),
            figures.momentum_error("Angular momentum in space: how far from its start"),
        ];
        for (place, panel) in right.split_evenly((2, 1)).iter().zip(panels) {
            panel.draw(place)?;
        }
        Ok(())
    })
}
