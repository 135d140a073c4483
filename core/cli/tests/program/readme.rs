//! The scene and the commands of the README.

use std::fs;
use std::path::Path;

fn file(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)).unwrap()
}

#[test]
fn its_scenes_run() {
    let readme = file("README.md");
    let blocks: Vec<&str> = readme.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let scene = blocks.iter().find(|block| block.starts_with("title = \"My top\"")).unwrap();
    let more = blocks.iter().find(|block| block.starts_with("[[event]]")).unwrap();
    let run = liestep_scene::Scene::parse("README.md", scene).unwrap().run().unwrap();
    // The picture has all steps, and the last is at the end.
    assert!(run.steps() >= 1000 && run.samples().len() as u64 == run.steps() + 1, "{}", run.steps());
    assert!((run.samples().last().unwrap().time - 20.0).abs() < 1e-9);
    let several = blocks.iter().find(|block| block.contains("[[body]]")).unwrap();
    liestep_scene::Scene::parse("README.md", several).unwrap().run().unwrap();
    let varied = liestep_scene::Scene::parse("README.md", &format!("{scene}{more}")).unwrap();
    assert_eq!(varied.sweep().unwrap().points.len(), 4);
    assert_eq!(varied.events().collect::<Vec<_>>(), ["low"]);
    varied.first(100).unwrap();
}

/// The first screen is short. Words are counted between spaces, in tables and listings, too.
#[test]
fn it_is_short() {
    let words = file("README.md").split_whitespace().count();
    assert!(words <= 1500, "{words} words");
}

/// Continuous integration runs the commands of README.
#[test]
fn its_commands_are_run() {
    let (readme, checks) = (file("README.md"), file(".ci/run"));
    for word in ["run", "check", "sweep", "ensemble", "import", "derive", "fmu", "replay"] {
        assert!(
            readme.contains(&format!("`liestep {word} ")) && checks.contains(&format!("liestep {word} ")),
            "{word}"
        );
    }
}
