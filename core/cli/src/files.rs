//! The files of a command, and the names of its results.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use liestep_plot::output::Output;
use liestep_scene::Scene;

use crate::failure::Failure;

/// The files in a command line.
pub(crate) fn files(given: &ArgMatches) -> Vec<&PathBuf> {
    given.get_many("FILE").map(Iterator::collect).unwrap_or_default()
}

/// The files of a command with one result for each, whose names have to differ.
pub(crate) fn different_files(given: &ArgMatches) -> Result<Vec<&PathBuf>, Failure> {
    let paths = files(given);
    for (number, path) in paths.iter().enumerate() {
        if let Some(other) = paths[..number].iter().find(|other| other.file_stem() == path.file_stem()) {
            let message = format!("{} and {} would be written to the same files", other.display(), path.display());
            return Err(Failure::Command(message));
        }
    }
    Ok(paths)
}

pub(crate) fn folder(given: &ArgMatches) -> Result<Output, Failure> {
    let folder: PathBuf = given.get_one::<PathBuf>("out").cloned().unwrap_or_default();
    Ok(Output::new(folder)?)
}

/// Reads all files first, so that a mistake in the last is reported at once.
pub(crate) fn scenes(paths: &[&PathBuf]) -> Result<Vec<Scene>, Failure> {
    paths.iter().map(|path| Scene::read(path).map_err(Failure::from)).collect()
}

/// The file's name with another extension.
pub(crate) fn name(path: &Path, extension: &str) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    format!("{}.{extension}", stem.to_string_lossy())
}
