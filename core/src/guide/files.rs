//! Reading the files from Python, Julia and MATLAB.
//!
//! Before: [a Lagrangian in a file](super::late). Next: [how it works inside](super::inside).
//!
//! # Which files there are
//!
//! | file | written by | format |
//! |---|---|---|
//! | `top.csv` | [`Csv`](crate::recording::Csv); `liestep run --csv` | comma-separated values, RFC 4180 with line feeds |
//! | `top.arrows` | `liestep_arrow::ArrowStream` in `core/arrow`; `liestep run --arrow` | Arrow IPC stream |
//! | `00000000-….arrow` in a folder | `liestep-ensemble` | Arrow IPC file ("Feather"), one for each chunk of members |
//! | tables of errors and costs | [`Refinement::to_csv`](crate::accuracy::Refinement::to_csv), [`to_json`](crate::accuracy::Refinement::to_json) | CSV, JSON |
//! | checkpoints | `Stepper::checkpoint` (feature `serde`) | whatever format of serde is chosen; to go on from, not to be read |
//!
//! # What a table has
//!
//! A row is a moment, a column a double. The names are those of the [`Recorder`](crate::recording::Recorder): `t`, the unit quaternion
//! `q_w, q_x, q_y, q_z` (body to space), `velocity_x, …` and `momentum_x, …` (body frame), `energy`, `defect`, then
//! those of one's own. On other groups the attitude is its matrix, `g_11, g_12, …`. Of the two quaternions of an attitude the
//! one nearer to the row before is written, so columns have no jumps.
//!
//! Three things go wrong when such files are read, whatever the language:
//!
//! * **The order of a quaternion.** Here the real part is first. SciPy has it last.
//! * **The frame.** Velocity and momentum are those of the body. In space they are turned by the quaternion.
//! * **Units.** CSV has none; Arrow has them in the metadata of each field, under `unit`. They are kilograms, metres, seconds
//!   and radians, if that is what the scene was given.
//!
//! This writes the file that the listings below read:
//!
//! ```
//! use liestep::prelude::*;
//! use liestep::recording::{Csv, Recorder};
//!
//! let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))? };
//! let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let top = Stepper::new(body + gravity, 0.01)?;
//! let mut state = top.start(SO3::from_euler_angles(0.0, 0.8, 0.0), Vector3::new(0.5, 2.0, 12.0))?;
//! let mut file = Recorder::new(&top, Csv::new(Vec::new())); // Csv::create("top.csv")? for the file
//! top.observed(&mut state).every(10, |now| file.record(now)).until(20.0)?;
//! let text = String::from_utf8(file.finish()?.into_inner()?)?;
//!
//! let mut lines = text.lines();
//! let names: Vec<&str> = lines.next().ok_or("empty")?.split(',').collect();
//! let expected = "t q_w q_x q_y q_z velocity_x velocity_y velocity_z momentum_x momentum_y momentum_z energy defect";
//! assert_eq!(names, expected.split(' ').collect::<Vec<_>>());
//! // Every number is read back to the bit.
//! let last: Vec<f64> = lines.last().ok_or("empty")?.split(',').map(str::parse).collect::<Result<_, _>>()?;
//! assert_eq!(last[8..11], *state.momentum().as_slice());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Python
//!
//! `core/ensemble/elsewhere/run` reads an ensemble's files with Polars and pandas, where Python has them. A table as CSV:
//!
//! ```python
//! import numpy as np
//! from scipy.spatial.transform import Rotation
//!
//! top = np.genfromtxt("top.csv", delimiter=",", names=True)
//! print(top.dtype.names, len(top))
//! print("energy within", np.ptp(top["energy"]))
//!
//! # Body to space; SciPy has the real part last.
//! attitude = Rotation.from_quat(np.column_stack([top[name] for name in ["q_x", "q_y", "q_z", "q_w"]]))
//! axis = attitude.apply([0, 0, 1])
//! momentum = attitude.apply(np.column_stack([top[name] for name in ["momentum_x", "momentum_y", "momentum_z"]]))
//! print("vertical momentum within", np.ptp(momentum[:, 2]))
//! ```
//!
//! Without any library, `csv.DictReader` and `float` read the same numbers. In Polars it is
//! `polars.read_csv("top.csv")`.
//!
//! As an Arrow stream, which is read without parsing, with its units:
//!
//! ```python
//! import pyarrow as pa
//!
//! with pa.ipc.open_stream("top.arrows") as stream:
//!     table = stream.read_all()
//! print(table.schema.field("velocity_x").metadata)  # {b'unit': b'rad/s'}
//! energy = table["energy"].to_numpy()
//! ```
//!
//! Of a run that was killed the stream has all blocks that were written.
//!
//! An ensemble, all shards at once:
//!
//! ```python
//! import polars as pl
//!
//! members = pl.read_ipc("tops/*/*.arrow")
//! finished = members.filter(pl.col("status") == 1)
//! print(finished.select(pl.col("z").mean()))
//! ```
//!
//! `member` is the number that a member is drawn by, `step` how many steps it made, `status` 0 on its way, 1 at its end, 2
//! where its next step had no solution, 3 where it couldn't be made; then its columns are NaN.
//!
//! # Julia and MATLAB
//!
//! No listing here was tried in them, so this is what the formats guarantee.
//!
//! * CSV: the first line has the names, the separator is a comma, the decimal sign a point, an exponent is written `e-7`, lines
//!   end with a line feed, and no cell is empty. What isn't a number is `NaN`, `inf` or `-inf`. Names are letters, digits and
//!   underscores, but for those of quantities that were given other names; with a comma or a quote in them they are in quotes. So
//!   any reader of delimited text with a line of names takes it: in Julia that of the standard library is `readdlm` of
//!   `DelimitedFiles`, with `header=true`, and in MATLAB `readtable`.
//! * Tables of errors and costs have empty cells where there is no number.
//! * Arrow: the stream has the columnar format of Apache Arrow, version 5 of its metadata, uncompressed, with fields of
//!   64-bit floats that are never null. `Arrow.Table(path)` of Julia's package Arrow reads streams and files of that format.
//! * JSON: an array of objects; what isn't finite is `null`.

#![allow(clippy::doc_markdown)] // names of libraries aren't code
