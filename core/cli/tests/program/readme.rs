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
    let scene = blocks.iter().find(|block| block.starts_with("title = ")).unwrap();
    let more = blocks.iter().find(|block| block.starts_with("[[event]]")).unwrap();
    let run = liestep_scene::parse("README.md", scene).unwrap().run().unwrap();
    assert_eq!((run.steps(), run.samples().len()), (2000, 2001));
    let several = blocks.iter().find(|block| block.contains("[[body]]")).unwrap();
    liestep_scene::System::parse("README.md", several).unwrap().run().unwrap();
    let varied = liestep_scene::parse("README.md", &format!("{scene}{more}")).unwrap();
    assert_eq!(varied.sweep().unwrap().points.len(), 6);
    assert_eq!(varied.events().collect::<Vec<_>>(), ["fallen"]);
    varied.first(100).unwrap();
}

/// What takes minutes, as the README says.
const LONG: [&str; 7] =
    ["cargo bench", "cargo install", "cargo fuzz", "--asked", "--ignored", "LIESTEP_CASES", "cargo test --workspace"];

/// Every command of the README is run by continuous integration, or takes minutes.
#[test]
fn its_commands_are_run() {
    let (readme, checks) = (file("README.md"), file(".ci/run"));
    let mut commands: Vec<&str> = Vec::new();
    for (place, _) in readme.match_indices("`cargo ").chain(readme.match_indices("\ncargo ")) {
        let rest = &readme[place + 1..];
        commands.push(rest[..rest.find(['`', '\n']).unwrap()].split(" #").next().unwrap().trim());
    }
    assert!(commands.len() > 20, "{commands:?}");
    for command in commands.into_iter().filter(|command| !LONG.iter().any(|long| command.contains(long))) {
        let words: Vec<_> = command.split(' ').collect();
        let is_run = match words.iter().position(|word| *word == "--example") {
            // In pieces, where the whole takes minutes.
            Some(place) => {
                let example = words[place + 1];
                checks.contains(&format!("built {example}")) || checks.contains(&format!("--example {example}"))
            }
            None => checks.contains(&words[..2].join(" ")),
        };
        assert!(is_run, "{command}");
    }
    assert!(checks.contains("cargo test --locked --workspace"));
    for word in ["run", "check", "sweep", "derive", "replay", "completions"] {
        assert!(
            readme.contains(&format!("`liestep {word} ")) && checks.contains(&format!("liestep {word} ")),
            "{word}"
        );
    }
}
