//! Scene files from a program: each is read, simulated and drawn, and written as a page that plays the motion.
//!
//! ```text
//! cargo run --release -p liestep-scene --example scene -- examples/scenes/sleeping-top.toml
//! ```
//!
//! The program `liestep` can do this and more: `cargo install --path core/cli`.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new("out/scene");
    fs::create_dir_all(folder)?;
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let scene = liestep_scene::Scene::read(&path)?;
        let run = scene.run()?;
        println!("{}", scene.summary(&run));
        let result = folder.join(path.file_name().unwrap_or_default());
        fs::write(result.with_extension("svg"), scene.picture(&run)?)?;
        fs::write(result.with_extension("html"), scene.page(&run))?;
    }
    Ok(())
}
