//! Recordings that a page plays: a scene's run, or a table of one.

use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::file::column::Column;
use crate::file::mistake::Mistake;
use crate::file::part::SystemBody;
use crate::file::quantity::short;
use crate::file::sample::{BodySample, Sample};
use crate::file::scene::Scene;
use crate::file::scene_file::SceneFile;
use crate::file::system::System;
use crate::run::make::{Happening, Run};
use crate::run::model::Model;
use crate::show::page::{Chart, Figure, Page, ShownBody};

/// A motion, with recorded quantities over time.
#[derive(Clone, Debug)]
pub struct Recording {
    title: String,
    about: String,
    axis: Vector3<f64>,
    bodies: Vec<ShownBody>,
    rods: Vec<(usize, Vector3<f64>)>,
    times: Vec<f64>,
    charts: Vec<Chart>,
    events: Vec<(f64, String)>,
    model: Option<Model>,
}

/// Most bytes of a recording, which may be much larger than a scene.
const MOST_BYTES: u64 = 1 << 30;

/// First bytes of streams and of files of Arrow IPC.
const ARROW: [&[u8]; 2] = [&[0xff; 4], b"ARROW1"];

impl Recording {
    /// Reads a table of `liestep run --csv` or [`Csv`](liestep::recording::Csv): comma-separated values below a row of
    /// names. Time and quaternion are required. Energy, momentum and velocity are drawn if present, with gaps where
    /// they aren't finite.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Mistake> {
        let path = path.as_ref();
        let length = fs::metadata(path).map_err(|cause| Mistake::unreadable(path, &cause))?.len();
        if length > MOST_BYTES {
            return Err(Mistake::at(path, (1, 1), format!("has more than {MOST_BYTES} bytes")));
        }
        let bytes = fs::read(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
        let wrong = |line, column, message: String| Mistake::at(path, (line, column), message);
        if ARROW.iter().any(|beginning| bytes.starts_with(beginning)) {
            let message = "is a table of Arrow IPC; pages are made of CSV, as `liestep run --csv` writes it";
            return Err(wrong(1, 1, message.to_owned()));
        }
        let text = String::from_utf8(bytes).map_err(|error| Mistake::not_text(path, &error))?;
        let Table { names, columns, below, lines } =
            numbers(&text).map_err(|(line, column, message)| wrong(line, column, message))?;
        if names.iter().any(|name| name == "t") && columns.first().is_some_and(Vec::is_empty) {
            return Err(wrong(below, 1, "has no row".to_owned()));
        }
        let title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let about = path.display().to_string();
        let columns: Vec<_> = names.into_iter().zip(columns).collect();
        Self::of_table(&title, &about, &columns, &|row, message| {
            Mistake::at(path, (row.map_or(1, |row| lines[row]), 1), message)
        })
    }

    /// The recording of columns of equal length, with the names of a table. Time and quaternion are required, as in
    /// [`read`](Self::read).
    ///
    /// # Errors
    ///
    /// A [`Mistake`] where a required column is missing, or where the columns are no motion.
    pub fn of_columns(title: &str, about: &str, columns: &[(String, Vec<f64>)]) -> Result<Self, Mistake> {
        Self::of_table(title, about, columns, &|row, message| {
            let place = row.map_or_else(String::new, |row| format!("row {row} "));
            Mistake::of_table(Path::new(title), format!("{place}{message}"))
        })
    }

    fn of_table(
        title: &str,
        about: &str,
        columns: &[(String, Vec<f64>)],
        wrong: &dyn Fn(Option<usize>, String) -> Mistake,
    ) -> Result<Self, Mistake> {
        let get = |name: &str| columns.iter().find(|(other, _)| other == name).map(|(_, numbers)| numbers.clone());
        let all = |names: &[&str]| names.iter().map(|name| get(name)).collect::<Option<Vec<_>>>();
        let missing = |names: &[&str]| {
            let names = names.join(", ");
            wrong(None, format!("has no columns {names}; a recording needs them, as `liestep run --csv` writes them"))
        };
        let times = get("t").ok_or_else(|| missing(&["t"]))?;
        if let Some(row) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(wrong(Some(row + 1), "is not later than the row before".to_owned()));
        }
        let [w, x, y, z] = &all(&Column::QUATERNION).ok_or_else(|| missing(&Column::QUATERNION))?[..] else {
            return Err(missing(&Column::QUATERNION));
        };
        let attitude = |row: usize| {
            let quaternion = Quaternion::new(w[row], x[row], y[row], z[row]);
            UnitQuaternion::try_new(quaternion, 0.5).filter(|unit| (quaternion.norm() - unit.norm()).abs() < 0.01)
        };
        let attitudes = (0..times.len())
            .map(|row| attitude(row).ok_or_else(|| wrong(Some(row), "the quaternion isn't a unit one".to_owned())))
            .collect::<Result<Vec<_>, _>>()?;
        let mut charts = vec![tilt(&attitudes, &Vector3::z())];
        if let Some(energy) = get("energy") {
            charts.push(energy_error(&energy));
        }
        if let Some([x, y, z]) = all(&Column::SPATIAL_MOMENTUM).as_deref() {
            let momentum: Vec<_> = (0..times.len()).map(|row| Vector3::new(x[row], y[row], z[row])).collect();
            charts.push(momentum_error(&momentum));
        }
        if let Some([x, y, z]) = all(&Column::VELOCITY).as_deref() {
            charts.push(rates([x.clone(), y.clone(), z.clone()]));
        }
        let bodies = vec![single(Figure::of(&Matrix3::identity(), None), attitudes)];
        let (title, about) = (title.to_owned(), about.to_owned());
        let (rods, events) = (Vec::new(), Vec::new());
        Ok(Self { title, about, axis: Vector3::z(), bodies, rods, times, charts, events, model: None })
    }

    fn of(scene: &SceneFile, run: &Run) -> Self {
        let samples = run.samples();
        let figures = if let Some(system) = &scene.system {
            figures_of(system)
        } else {
            let arm = scene.gravity.map(|gravity| gravity.rho.value);
            vec![(String::new(), Figure::of(&scene.inertia().unwrap_or_else(Matrix3::identity), arm))]
        };
        // None on a group without a body.
        let shown = samples.first().map_or(0, |sample| sample.bodies.len());
        let body = |(number, (name, figure)): (usize, (String, Figure))| {
            let attitudes = samples.iter().map(|sample| attitude(&sample.bodies[number])).collect();
            let places = samples.iter().filter(|_| scene.system.is_some());
            ShownBody { name, figure, attitudes, positions: places.map(|one| one.bodies[number].position).collect() }
        };
        let bodies: Vec<_> = figures.into_iter().take(shown).enumerate().map(body).collect();
        let rod = |body: Option<usize>, at: Vector3<f64>| Some((body?, at)).filter(|(_, at)| at.norm() > 0.0);
        let joints = scene.system.iter().flat_map(|system| &system.joints);
        let rods = joints.flat_map(|joint| [0, 1].map(|side| rod(joint.bodies[side], joint.of.at[side])));
        let has_script = scene.group.is_rotation() && !scene.event.iter().any(|one| one.stops);
        Self {
            title: String::new(),
            about: String::new(),
            axis: scene.picture.axis.0,
            rods: rods.flatten().collect(),
            times: samples.iter().map(|sample| sample.time).collect(),
            charts: match &scene.system {
                Some(system) => charts_of_system(system, &scene.all_columns(), samples),
                None => charts(scene, &bodies, samples),
            },
            bodies,
            events: Vec::new(),
            model: Model::of(scene).ok().filter(|_| has_script),
        }
    }

    /// One page that plays the motion in a browser without loading anything: the body and the path of its axis in space, or
    /// several bodies and the ways of their centres of mass, and the recorded quantities over time. On another group than SO(3)
    /// it has the quantities alone.
    #[must_use]
    pub fn page(&self) -> String {
        let Self { title, about, axis, bodies, rods, times, charts, events, model } = self;
        Page { title, about, axis, bodies, rods, times, charts, events, model: model.as_ref() }.to_string()
    }
}

/// The names and the shapes of several bodies.
fn figures_of(system: &System) -> Vec<(String, Figure)> {
    // A point mass is a ball that is seen beside the arms of joints.
    let arms = system.joints.iter().flat_map(|joint| joint.of.at).map(|at| at.norm());
    let point = 0.08 * arms.fold(0.0, f64::max).max(1e-3);
    let figure = |body: &SystemBody| {
        let by_mass = body.J.as_ref().map(|J| J.as_matrix() / body.m);
        (body.name.clone(), Figure::among_several(body.shape.as_ref(), by_mass, point))
    };
    system.bodies.iter().map(figure).collect()
}

/// The tilt of a body's axis, energy, momentum and rates; on a group without a body attitude, velocity and momentum.
fn charts(scene: &SceneFile, bodies: &[ShownBody], samples: &[Sample]) -> Vec<Chart> {
    let collect = |value: &dyn Fn(&Sample) -> f64| samples.iter().map(value).collect::<Vec<_>>();
    let energy = energy_error(&collect(&|sample| sample.energy));
    if let Some(body) = bodies.first() {
        let momentum: Vec<_> = samples.iter().map(|sample| sample.angular_momentum).collect();
        let rates = rates([0, 1, 2].map(|k| collect(&|sample| sample.bodies[0].velocity[k])));
        return vec![tilt(&body.attitudes, &scene.picture.axis.0), energy, momentum_error(&momentum), rates];
    }
    let columns = scene.all_columns();
    let chart = |title, key| Chart::linear(title, "", lines_of(&columns, key, samples, 1.0));
    vec![
        chart("Attitude", "attitude"),
        energy,
        chart("Velocity of the body", "velocity"),
        chart("Momentum in space", "spatial-momentum"),
    ]
}

/// The numbers of a column, with their names, times a factor.
fn lines_of(columns: &[Column], key: &str, samples: &[Sample], factor: f64) -> Vec<(String, Vec<f64>)> {
    let column = columns.iter().find(|column| column.key() == key);
    let places =
        column.into_iter().flat_map(|column| column.names().filter_map(|name| Some((name, column.place(name)?))));
    let values = |place: usize| samples.iter().map(|sample| sample.numbers[place] * factor).collect();
    places.map(|(name, place)| (name.to_owned(), values(place))).collect()
}

/// The events of a run, s, with their names among these.
fn named_events<'n>(run: &Run, names: impl Iterator<Item = &'n str>) -> Vec<(f64, String)> {
    let names: Vec<_> = names.collect();
    let event = |happening: &Happening| Some((happening.sample.time, (*names.get(happening.event)?).to_owned()));
    run.happenings().iter().filter_map(event).collect()
}

/// Most curves of a chart of several bodies.
const MOST_CURVES: usize = 8;

/// Angles and shifts of joints, or the turns of bodies without joints, the energy, and how far joints are open.
fn charts_of_system(system: &System, columns: &[Column], samples: &[Sample]) -> Vec<Chart> {
    let of_joints = |key: &str, title, unit, factor: f64| {
        let mut lines = lines_of(columns, key, samples, factor);
        lines.truncate(MOST_CURVES);
        (!lines.is_empty()).then(|| Chart::linear(title, unit, lines))
    };
    let joints = [
        of_joints("angle", "Angles of joints", "°", 1.0_f64.to_degrees()),
        of_joints("shift", "Shifts of joints", "m", 1.0),
    ];
    let mut charts: Vec<_> = joints.into_iter().flatten().collect();
    if charts.is_empty() {
        let rate = |body: usize| samples.iter().map(|sample| sample.bodies[body].velocity.norm()).collect();
        let lines = system.names().enumerate().take(MOST_CURVES).map(|(body, name)| (name.to_owned(), rate(body)));
        charts.push(Chart::linear("Angular velocities of bodies", "rad/s", lines.collect()));
    }
    charts.push(energy_error(&samples.iter().map(|sample| sample.energy).collect::<Vec<_>>()));
    if !system.joints.is_empty() {
        let gaps = samples.iter().map(|sample| sample.gap).collect();
        let unit = if system.has_cosines() { "m, 1" } else { "m" };
        charts.push(Chart::logarithmic("Gaps of joints", unit, vec![("gap".to_owned(), gaps)]));
    }
    charts
}

/// A body that turns about a point.
fn single(figure: Figure, attitudes: Vec<UnitQuaternion<f64>>) -> ShownBody {
    ShownBody { name: String::new(), figure, attitudes, positions: Vec::new() }
}

fn attitude(body: &BodySample) -> UnitQuaternion<f64> {
    let [w, x, y, z] = body.quaternion;
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

impl Scene {
    /// The page of a run of this scene, see [`Recording::page`].
    #[must_use]
    pub fn page(&self, run: &Run) -> String {
        let about = format!("{}, {} steps of {} s{}", self.file.sum(), run.steps(), short(run.step()), run.average);
        let events = named_events(run, self.events());
        Recording { title: self.title().to_owned(), about, events, ..Recording::of(&self.file, run) }.page()
    }
}

fn tilt(attitudes: &[UnitQuaternion<f64>], axis: &Vector3<f64>) -> Chart {
    let degrees = attitudes.iter().map(|attitude| (attitude * axis).angle(&Vector3::z()).to_degrees());
    Chart::linear("Tilt of the axis from e₃", "°", vec![("tilt".to_owned(), degrees.collect())])
}

fn energy_error(energy: &[f64]) -> Chart {
    let start = energy.iter().copied().find(|energy| energy.is_finite()).unwrap_or_default();
    let error = energy.iter().map(|energy| (energy - start).abs()).collect();
    Chart::logarithmic("Energy, from its start", "J", vec![("energy".to_owned(), error)])
}

fn momentum_error(momentum: &[Vector3<f64>]) -> Chart {
    let is_finite = |momentum: &Vector3<f64>| momentum.iter().all(|part| part.is_finite());
    let start = momentum.iter().copied().find(is_finite).unwrap_or_default();
    let error = |length: fn(Vector3<f64>) -> f64| momentum.iter().map(|m| length(m - start)).collect();
    let lines = [("along e₃", error(|m| m.z.abs())), ("all", error(|m| m.norm()))];
    let lines = lines.map(|(name, values)| (name.to_owned(), values)).into();
    Chart::logarithmic("Momentum in space, from its start", "kg m²/s", lines)
}

fn rates(components: [Vec<f64>; 3]) -> Chart {
    let lines = ["Ω₁", "Ω₂", "Ω₃"].map(str::to_owned).into_iter().zip(components).collect();
    Chart::linear("Angular velocity in the body", "rad/s", lines)
}

/// A table of comma-separated values.
struct Table {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// The number of the line below the names.
    below: usize,
    /// Line numbers of the rows.
    lines: Vec<usize>,
}

/// The table of a text, or line, column and message of a mistake.
fn numbers(text: &str) -> Result<Table, (usize, usize, String)> {
    let (names, below, rows) = header(text.strip_prefix('\u{feff}').unwrap_or(text));
    // A motion requires these columns.
    let is_needed = |name: &String| name == "t" || Column::QUATERNION.contains(&name.as_str());
    let needed: Vec<_> = names.iter().map(is_needed).collect();
    let (mut columns, mut lines) = (vec![Vec::new(); names.len()], Vec::new());
    for (number, line) in (below..).zip(rows.lines()).filter(|(_, line)| !line.trim().is_empty()) {
        let mut place = 1;
        let mut found = 0;
        for (column, cell) in line.split(',').enumerate() {
            let value = cell.trim().parse::<f64>().map_err(|_| (number, place, "isn't a number".to_owned()))?;
            if !value.is_finite() && needed.get(column).is_some_and(|needed| *needed) {
                return Err((number, place, "isn't a finite number".to_owned()));
            }
            if let Some(values) = columns.get_mut(column) {
                values.push(value);
            }
            place += cell.chars().count() + 1;
            found = column + 1;
        }
        if found != names.len() {
            return Err((number, 1, format!("has {found} values below {} names", names.len())));
        }
        lines.push(number);
    }
    Ok(Table { names, columns, below, lines })
}

/// The names, of which those with commas, quotes or line feeds are quoted; the number of the next line; and the rest of
/// the text.
fn header(text: &str) -> (Vec<String>, usize, &str) {
    let (mut names, mut is_quoted, mut line) = (vec![String::new()], false, 2);
    let trimmed = |names: Vec<String>| names.iter().map(|name| name.trim().to_owned()).collect();
    let mut letters = text.char_indices().peekable();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' if !is_quoted || letters.next_if(|(_, next)| *next == '"').is_none() => is_quoted = !is_quoted,
            ',' if !is_quoted => names.push(String::new()),
            '\n' if !is_quoted => return (trimmed(names), line, &text[at + 1..]),
            letter => {
                line += usize::from(letter == '\n');
                names.iter_mut().last().into_iter().for_each(|name| name.push(letter));
            }
        }
    }
    (trimmed(names), line, "")
}
