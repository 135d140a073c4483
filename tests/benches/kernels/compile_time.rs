//! The time that a user waits after an edit: the incremental build of a crate with one declaration.
//!
//! Each source is the `main.rs` of a crate that depends on liestep: a file in `compile_time/`, or a declaration of the
//! examples with a `main` of its own. A number in it is changed, then the crate is checked or built without
//! optimisation, as by a user's `cargo check` and `cargo build`; the time is that of the whole command, including cargo
//! and the linker. The crate `none` declares nothing: the cost of a declaration is the difference. The first run
//! compiles the dependencies. For a new declaration add a line to [`DECLARATIONS`].

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use std::{env, fs, io};

const ROUNDS: u32 = 7;

/// The names and sources of the compiled declarations.
const DECLARATIONS: [(&str, &str); 5] = [
    ("none", include_str!("compile_time/none.rs")),
    ("(3.13)", include_str!("compile_time/heavy_top.rs")),
    (
        "L4",
        concat!(
            include_str!("../../../examples/declarations/fourth_order_top.rs"),
            "type Top = FourthOrderTop;\n",
            include_str!("compile_time/top.rs")
        ),
    ),
    (
        "L6",
        concat!(
            include_str!("../../../examples/declarations/sixth_order_top.rs"),
            "type Top = SixthOrderTop;\n",
            include_str!("compile_time/top.rs")
        ),
    ),
    (
        "double pendulum",
        concat!(
            include_str!("../../../examples/declarations/double_pendulum.rs"),
            include_str!("compile_time/double_pendulum.rs")
        ),
    ),
];

/// The user's crate, in cargo's directory for the temporary files of tests and benchmarks.
struct Crate {
    directory: PathBuf,
    source: &'static str,
}

impl Crate {
    fn new(source: &'static str) -> io::Result<Self> {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compile-time");
        fs::create_dir_all(directory.join("src"))?;
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR"));
        // All crates have one name and one set of versions, so the dependencies are compiled once.
        let manifest = format!(
            "[package]\nname = \"user\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
             [dependencies]\nliestep = {{ path = '{}' }}\nnalgebra = {{ version = \"0.35\", default-features = false }}\n\n\
             [workspace]\n",
            workspace.join("../../core").display()
        );
        fs::write(directory.join("Cargo.toml"), manifest)?;
        fs::copy(workspace.join("../../Cargo.lock"), directory.join("Cargo.lock"))?;
        Ok(Self { directory, source })
    }

    /// The duration of a cargo command after an edit that no earlier build contains, in seconds.
    fn time(&self, command: &str, edit: u32) -> io::Result<f64> {
        let edited = self.source.replacen("EDIT: u32 = 0", &format!("EDIT: u32 = {edit}"), 1);
        assert_ne!(edited, self.source, "there is a number to edit");
        fs::write(self.directory.join("src/main.rs"), edited)?;
        let start = Instant::now();
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args([command, "--offline", "--quiet", "--target-dir", "target"])
            .current_dir(&self.directory)
            .env_remove("RUSTFLAGS")
            .output()?;
        let elapsed = start.elapsed().as_secs_f64();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Ok(elapsed)
    }

    /// The median of some edits after one that fills the cache, in milliseconds.
    fn median(&self, command: &str) -> io::Result<f64> {
        // The number must be new: a build from an earlier run would be in the cache.
        let first = std::process::id() % 1_000_000 * 1_000 + 1;
        self.time(command, first)?;
        let mut times = (1..=ROUNDS).map(|round| self.time(command, first + round)).collect::<io::Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        Ok(times[times.len() / 2] * 1e3)
    }
}

/// Prints the times of all declarations.
pub(crate) fn print() -> io::Result<()> {
    println!("{:<16}{:>12}{:>12}", "ms", "check", "build");
    for (name, source) in DECLARATIONS {
        let user = Crate::new(source)?;
        let (check, build) = (user.median("check")?, user.median("build")?);
        println!("{name:<16}{check:>12.0}{build:>12.0}");
    }
    Ok(())
}
