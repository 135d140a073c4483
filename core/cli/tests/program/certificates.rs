//! Certificates: those of all declarations of the repository, by a checker that shares no code, and the page that lists them.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

use declarations::{
    Alike, CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, EqualNeedle, FallingBody, FloatingBody, FluidDrag,
    Flyer, FourthOrderTop, FreeBody, FullTop, Gyrostat, HeavyTop, LogTop, LogTraceTop, Magnet, Needle, OrbitingBody,
    PointSpring, RodElement, Satellite, SixthOrderTop, SlidingTop, Spring, SuspendedLoad, TetheredPlate, Thruster,
    TopOnCart, Torquer, TwoBodies, UnderwaterBody,
};
use liestep::effects::RigidBody;
use liestep::effects::joints::{
    DryFriction, JointDamping, JointSpring, JointTorque, SliderDamping, SliderFriction, SliderSpring,
};
use liestep::mechanics::Effect;
use liestep_late::{Declaration, certificate};

use crate::called::{folder, printed};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../late/PROVED.md");
const CHECKER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../python/python/liestep");
/// The counts of claims that Coq proves, which `core/python/coq/check.py --table` writes and holds to account.
const BY_COQ: &str = include_str!("../../../python/coq/proved.txt");
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes");

/// The texts of declared types, by their names.
macro_rules! texts {
    ($($type:ident),* $(,)?) => {
        [$((stringify!($type).to_owned(), <$type as Effect>::DECLARATION)),*]
    };
}

/// The declaration of a text, beside a body of its group where it has no kinetic part.
fn with_a_body(text: &str) -> &'static Declaration {
    let declaration = Declaration::parse(text).unwrap();
    if declaration.has_kinetic {
        return declaration;
    }
    let bodies = texts![RigidBody, Flyer, DoublePendulum, FloatingBody, TwoBodies];
    let sums = bodies.map(|(_, body)| Declaration::sum(&[Declaration::parse(body).unwrap(), declaration]));
    sums.into_iter().find_map(Result::ok).expect("there is a body on each group")
}

/// Whether Python is there; if it isn't, a reason is printed.
fn has_python() -> bool {
    let found = Command::new("python3").arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no `python3`");
    }
    found
}

/// The output of the checker for certificates below a folder.
fn checked(arguments: &[&str], files: &[String], folder: &Path) -> String {
    let mut command = Command::new("python3");
    command.env("PYTHONPATH", CHECKER).env("PYTHONDONTWRITEBYTECODE", "1").current_dir(folder);
    let output = command.args(["-m", "verify"]).args(arguments).args(files).output().unwrap();
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A table of what the checker says of certificates with these names.
fn table(folder: &Path, certificates: &[(String, String)]) -> String {
    let files: Vec<String> = certificates.iter().map(|(name, _)| format!("{name}.json")).collect();
    for (file, (_, text)) in files.iter().zip(certificates) {
        fs::write(folder.join(file), text).unwrap();
    }
    let said = checked(&["--table"], &files, folder);
    let rows = said.lines().zip(certificates).map(|(row, (name, _))| format!("{row} {} |\n", by_coq(name)));
    let head = "| | group | unknowns | operations | functions | claims that hold | others | by Coq |\n".to_owned();
    head + "|---|---|---|---|---|---|---|---|\n" + &rows.collect::<String>()
}

/// The count of a certificate's claims that Coq proves, or nothing.
fn by_coq(name: &str) -> &'static str {
    let mut counts = BY_COQ.lines().filter_map(|line| line.split_once(": "));
    counts.find(|(of, _)| *of == name).map_or("", |(_, count)| count)
}

/// The certificates of all declarations of the repository are those of the page; `UPDATE_EXPECT=1` writes the page anew.
#[test]
fn the_page_of_what_is_proved() {
    if !has_python() {
        return;
    }
    let folder = folder("certificates");
    let of = |(name, text): (String, &str)| (name, certificate(with_a_body(text)).unwrap());
    let library = liestep_scene::derived().map(|name| (name.clone(), liestep_scene::declaration(&name).unwrap()));
    let joints =
        texts![JointSpring, JointTorque, JointDamping, DryFriction, SliderSpring, SliderDamping, SliderFriction,];
    let declared = texts![
        Alike,
        CayleyTop,
        ContinuousTop,
        DoublePendulum,
        ElasticFlow,
        EqualNeedle,
        FallingBody,
        FloatingBody,
        FluidDrag,
        Flyer,
        FourthOrderTop,
        FreeBody,
        FullTop,
        Gyrostat,
        HeavyTop,
        LogTop,
        LogTraceTop,
        Magnet,
        Needle,
        OrbitingBody,
        PointSpring,
        RodElement,
        Satellite,
        SixthOrderTop,
        SlidingTop,
        Spring,
        SuspendedLoad,
        TetheredPlate,
        Thruster,
        TopOnCart,
        Torquer,
        TwoBodies,
        UnderwaterBody,
    ];
    let mut scenes: Vec<_> = fs::read_dir(SCENES).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|ending| ending == "toml") && !is_of_several(path));
    scenes.sort();
    let of_scene = |path: &Path| {
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        (name, printed(&folder, &["derive", path.to_str().unwrap(), "--certificate"]))
    };
    let tables = [
        table(&folder, &library.chain(joints).map(of).collect::<Vec<_>>()),
        table(&folder, &declared.map(of)),
        table(&folder, &scenes.iter().map(|path| of_scene(path)).collect::<Vec<_>>()),
    ];
    let page = fs::read_to_string(PAGE).unwrap();
    let (mut made, mut rest) = (String::new(), page.as_str());
    for table in tables {
        let (before, behind) = rest.split_once("<!-- table -->\n").unwrap();
        let (_, behind) = behind.split_once("<!-- end -->").unwrap();
        made = made + before + "<!-- table -->\n" + &table + "<!-- end -->";
        rest = behind;
    }
    made += rest;
    if env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(PAGE, &made).unwrap();
    }
    assert!(made == page || env::var_os("UPDATE_EXPECT").is_some(), "core/late/PROVED.md isn't up to date:\n{made}");
    assert!(!made.contains("WRONG"), "{made}");
}

/// Whether a scene is one of several bodies, whose step has no programs.
fn is_of_several(path: &Path) -> bool {
    fs::read_to_string(path).unwrap().contains("[[body]]")
}

/// Digest and statements are those of the text in C; another text in C and another declaration are refused.
#[test]
fn a_certificate_of_the_text_in_c() {
    if !has_python() {
        return;
    }
    let folder = folder("certificate-of-c");
    for form in ["c", "certificate"] {
        let text = printed(&folder, &["derive", "rigid-body", &format!("--{form}")]);
        fs::write(folder.join(form), text).unwrap();
    }
    let files = ["certificate".to_owned()];
    assert!(checked(&["--c", "c"], &files, &folder).contains("19 of 19 claims hold"));
    assert!(checked(&["--c", "certificate"], &files, &folder).contains("digest: WRONG"));
    let text = fs::read_to_string(folder.join("c")).unwrap();
    let (before, behind) = text.split_once("static void rigid_body_finish").unwrap();
    fs::write(
        folder.join("other"),
        format!("{before}static void rigid_body_finish{}", behind.replacen(" - x", " + x", 1)),
    )
    .unwrap();
    assert!(checked(&["--c", "other"], &files, &folder).contains("statements: WRONG"));
    let right = fs::read_to_string(folder.join("certificate")).unwrap();
    let wrong = right.replace("trace() / (2.0 * h)", "trace() / (3.0 * h)");
    fs::write(folder.join("wrong"), &wrong).unwrap();
    let found = checked(&[], &["wrong".to_owned()], &folder);
    assert!(wrong != right && found.contains("residual: WRONG"), "{found}");
}
