//! Pictures of runs.

use liestep_plot::{
    Area, BLUE, Colour, GREEN, Line, ORANGE, PURPLE, Panel, Path, PlotResult, Vertical, heading, px, render, sphere,
};
use liestep_scene::Recording;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::table::Table;

/// The most points of a line in a picture.
const POINTS: usize = 4000;

/// The indices of every k-th row, so that there are no more than [`POINTS`].
fn thinned(rows: usize) -> impl Iterator<Item = usize> {
    (0..rows).step_by(rows.div_ceil(POINTS).max(1))
}

/// The picture of a run as SVG: on SO(3) the path of the body's third axis, and everywhere velocity and energy over time.
#[pyfunction]
pub(crate) fn picture(table: &Table, title: &str, subtitle: &str) -> PyResult<String> {
    Ok(drawn(table, title, subtitle).map_err(|error| Failure::Of("Error", error.to_string()))?)
}

fn drawn(table: &Table, title: &str, subtitle: &str) -> PlotResult<String> {
    let time = table.named("t").ok_or("a run has a time")?;
    let line = |numbers: &[f64], colour: Colour, height: &dyn Fn(f64) -> f64| Line {
        colour,
        width: 3,
        points: thinned(time.len()).map(|row| (time[row], height(numbers[row]))).collect(),
    };
    let velocities = table.all().filter(|(name, _)| name.starts_with("velocity_"));
    let colours = [BLUE, ORANGE, GREEN].into_iter().cycle();
    let lines =
        velocities.zip(colours).map(|((_, numbers), colour)| line(&numbers, colour, &|number| number)).collect();
    let rates = Panel::over_time("Velocity of the body", "", Vertical::Linear, lines);
    let energy = table.named("energy").ok_or("a run has an energy")?;
    let first = energy.first().copied().unwrap_or_default();
    // A deviation is at least one rounding: a zero would stretch the logarithmic axis.
    let away = vec![line(&energy, BLUE, &|number| (number - first).abs().max(f64::EPSILON * first.abs()))];
    let energy = Panel::over_time("Energy: how far from its start", "", Vertical::Logarithmic, away);
    let panels = |area: &Area<'_>| {
        area.split_evenly((2, 1)).iter().zip([&rates, &energy]).try_for_each(|(place, panel)| panel.draw(place))
    };
    render((1000, 520), |area| {
        let (header, body) = area.split_vertically(px(64));
        heading(&header, title, subtitle)?;
        let Some(points) = axis(table) else { return panels(&body) };
        let (left, right) = body.split_horizontally(px(440));
        let title = "Path of the body's axis in space";
        sphere(&left, &Path { title, colour: PURPLE, width: 2, points: &points, axis: (Vector3::z(), "e₃") })?;
        panels(&right)
    })
}

/// The third axis of a body in space.
fn axis(table: &Table) -> Option<Vec<Vector3<f64>>> {
    let [w, x, y, z] = ["q_w", "q_x", "q_y", "q_z"].map(|name| table.named(name));
    let (w, x, y, z) = (w?, x?, y?, z?);
    let point = |row| UnitQuaternion::new_normalize(Quaternion::new(w[row], x[row], y[row], z[row])) * Vector3::z();
    Some(thinned(w.len()).map(point).collect())
}

/// The page that plays a run on SO(3) in a browser.
#[pyfunction]
pub(crate) fn page(table: &Table, title: &str, about: &str) -> PyResult<String> {
    let columns: Vec<_> = table.all().map(|(name, numbers)| (name.to_owned(), numbers.to_vec())).collect();
    Ok(Recording::of_columns(title, about, &columns).map_err(Failure::from)?.page())
}
