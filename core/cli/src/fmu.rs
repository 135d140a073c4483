//! The command `fmu`: scenes as units of other simulations.

use std::path::Path;
use std::process::Command;
use std::{env, fs, io};

use clap::ArgMatches;
use liestep_scene::{Fmi, Fmu, Scene, archive, visible};

use crate::failure::Failure;
use crate::files::{different_files, folder, name};
use crate::output::print;

/// Writes the unit of each scene: its source always, and a binary where there is a compiler.
pub(crate) fn fmu(given: &ArgMatches) -> Result<(), Failure> {
    let paths = different_files(given)?;
    let fmi = if given.get_flag("fmi2") { Fmi::Two } else { Fmi::Three };
    let units = paths.iter().map(|path| unit(path, fmi)).collect::<Result<Vec<_>, _>>()?;
    let mut output = folder(given)?;
    for (path, mut unit) in paths.iter().zip(units) {
        match binary(&unit) {
            Ok(binary) => unit.files.push((format!("{}/{}.so", unit.binaries, unit.name), binary)),
            Err(why) => eprintln!("note: {}: the source alone, {why}", visible(&path.display().to_string())),
        }
        let archive = archive(&unit.files).ok_or_else(|| Failure::Output("the unit is too large".to_owned()))?;
        output.write(&name(path, "fmu"), &archive)?;
    }
    print(&output.to_string())
}

fn unit(path: &Path, fmi: Fmi) -> Result<Fmu, Failure> {
    Ok(Scene::read(path)?.fmu(&path.file_stem().unwrap_or_default().to_string_lossy(), fmi)?)
}

/// The source compiled for this machine, or the reason why it isn't.
fn binary(unit: &Fmu) -> Result<Vec<u8>, String> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return Err("as binaries are made on x86-64 Linux".to_owned());
    }
    let folder = env::temp_dir().join(format!("liestep-fmu-{}-{}", unit.name, std::process::id()));
    let made = compiled(unit, &folder);
    // The remainder lies in the folder of temporary files.
    let _ = fs::remove_dir_all(&folder);
    made.map_err(|cause| format!("as `cc` made no binary: {cause}"))
}

fn compiled(unit: &Fmu, folder: &Path) -> io::Result<Vec<u8>> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("unit.c"), &unit.source)?;
    let flags = ["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "unit.c", "-o", "unit.so", "-lm"];
    let run = Command::new("cc").args(flags).current_dir(folder).output()?;
    if !run.status.success() {
        return Err(io::Error::other(String::from_utf8_lossy(&run.stderr).into_owned()));
    }
    fs::read(folder.join("unit.so"))
}
