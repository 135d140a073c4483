//! Mutated scene files: each gives a mistake with line and column, or a run.

use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use std::{env, fs, process, thread};

use liestep_scene::{Mistake, Scene, SceneEnsemble, Spread};

/// Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 32).unwrap() % bound.max(1)
    }
}

/// The example files and those of the sessions, of which one has every key.
fn seeds() -> Vec<String> {
    let folders = ["../../examples/scenes", "tests/program/scenes"];
    let files = |folder: &str| fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap();
    let mut paths: Vec<_> =
        folders.iter().flat_map(|folder| files(folder)).map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    // A shorter search for an accuracy.
    let short = |text: String| text.replace("accuracy = 1e-9", "accuracy = 1e-6").replace("\"60 s\"", "0.1");
    paths.iter().map(|path| short(fs::read_to_string(path).unwrap())).collect()
}

/// Typical slips, and invalid numbers.
const WORDS: [&str; 40] = [
    "nan",
    "inf",
    "1e999",
    "''",
    "[nan, 0, -0.0]",
    "{ times = [0, 1], values = [0, nan], between = \"steps\" }",
    "-1",
    "0",
    "-0.0",
    "1e308",
    "1e-308",
    "1e400",
    "5e-324",
    "99999999999999999999",
    "[]",
    "[[]]",
    "{}",
    "\"\"",
    "\"1 m\"",
    "\"1e308 km\"",
    "true",
    "=",
    "\"",
    "[",
    "]",
    "\n",
    "[run]\n",
    "\nstep = 1e-9\n",
    "method",
    "{ collocation = 8 }",
    "\"cayley\"",
    "\"sixth-order\"",
    "{ composition = \"Kahan-Li 8\" }",
    "1979-05-27",
    ".",
    ",",
    "\u{0}",
    "ü",
    "#",
    "[1e200, 1, 1e-200]",
];

fn mutated(seed: &str, random: &mut Random) -> String {
    let mut letters: Vec<char> = seed.chars().collect();
    for _ in 0..=random.below(2) {
        let at = random.below(letters.len());
        let is_word = |letter: &char| letter.is_alphanumeric() || "._-".contains(*letter);
        let start = letters[..at].iter().rposition(|letter| !is_word(letter)).map_or(0, |before| before + 1);
        let end = at + letters[at..].iter().take_while(|letter| is_word(letter)).count();
        match random.below(16) {
            0 => drop(letters.drain(at..(at + 1 + random.below(12)).min(letters.len()))),
            1 => drop(letters.splice(at..at, WORDS[random.below(WORDS.len())].chars())),
            // The mutation replaces a value or a key.
            2 => drop(letters.splice(start..end, WORDS[random.below(WORDS.len())].chars())),
            3 => {
                let from = random.below(letters.len());
                let piece: Vec<_> = letters[from..(from + random.below(40)).min(letters.len())].to_vec();
                letters.splice(at..at, piece);
            }
            4 => {
                let other = random.below(letters.len());
                letters.swap(at, other);
            }
            // The mutation flips a bit of a letter.
            5 => letters[at] = char::from_u32(u32::from(letters[at]) ^ 1 << random.below(7)).unwrap_or('?'),
            // The mutation misspells a word.
            6 if end > start + 1 => letters.swap(start, start + 1 + random.below(end - start - 1)),
            number @ 7..=11 => letters = of_lines(&letters, number, random),
            // The mutation replaces a digit of the next number.
            _ => {
                let digit = letters[at..].iter().position(char::is_ascii_digit);
                if let Some(digit) = digit {
                    letters[at + digit] = char::from(b"0123456789"[random.below(10)]);
                }
            }
        }
        if letters.is_empty() {
            break;
        }
    }
    letters.into_iter().collect()
}

/// A text with a line dropped, doubled, exchanged with another, or with another value.
fn of_lines(letters: &[char], number: usize, random: &mut Random) -> Vec<char> {
    let text: String = letters.iter().collect();
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    let [at, other] = [0; 2].map(|_| random.below(lines.len()));
    match number {
        7 => drop(lines.remove(at)),
        8 => lines.insert(other, lines[at].clone()),
        9 => lines.swap(at, other),
        _ => {
            if let Some((key, _)) = lines[at].split_once('=') {
                let huge = || format!("[{}1]", "1, ".repeat(5000));
                let value = random.below(WORDS.len() + 1);
                lines[at] = format!("{key}= {}", WORDS.get(value).map_or_else(huge, |&word| word.to_owned()));
            }
        }
    }
    lines.join("\n").chars().collect()
}

/// Asserts that a mistake has a place in the text.
fn assert_placed(mistake: &Mistake, text: &str) {
    let (line, column) = mistake.place().unwrap_or_else(|| panic!("{mistake}\n{text}"));
    let lines: Vec<_> = text.split('\n').collect();
    assert!((1..=lines.len()).contains(&line), "{mistake}\n{text}");
    assert!((1..=lines[line - 1].chars().count() + 1).contains(&column), "{mistake}\n{text}");
    assert!(mistake.to_string().len() < 2000, "{mistake}");
}

/// Constructs two members of an ensemble, and runs some of their steps.
fn make_members(drawn: &SceneEnsemble, text: &str, random: &mut Random) {
    for _ in 0..2 {
        #[allow(clippy::cast_precision_loss)] // a share
        let mut draw = |_: &str, spread: Spread| {
            let part = random.below(1 << 20) as f64 / f64::from(1 << 20);
            match spread {
                Spread::Uniform { from, to } => from + (to - from) * part,
                Spread::Normal { mean, deviation } => mean + deviation * (6.0 * part - 3.0),
            }
        };
        let made = drawn.member(&mut draw).and_then(|scene| {
            let (stepper, mut state) = scene.stepper()?;
            // A step without a solution is the member's own failure.
            let _ = stepper.run(&mut state, 30);
            assert!(state.momentum().iter().all(|number| number.is_finite()), "{text}");
            scene.first(1)
        });
        if let Err(mistake) = made {
            assert_placed(&mistake, text);
        }
    }
}

/// The file that is read now, and since when: a thread ends the test if one takes too long.
struct Watched(Arc<Mutex<Option<(Instant, String)>>>);

impl Watched {
    /// Far longer than any of the files takes, on a machine shared with others.
    const PATIENCE: Duration = Duration::from_secs(120);

    fn new() -> Self {
        let shared = Arc::new(Mutex::new(Some((Instant::now(), String::new()))));
        let seen = Arc::clone(&shared);
        thread::spawn(move || {
            loop {
                match seen.lock().as_deref() {
                    Ok(Some((since, text))) if since.elapsed() > Self::PATIENCE => {
                        eprintln!("a file takes more than {:?}:\n{text}", Self::PATIENCE);
                        process::exit(101);
                    }
                    Ok(Some(_)) => {}
                    _ => return,
                }
                thread::sleep(Duration::from_secs(1));
            }
        });
        Self(shared)
    }

    fn begin(&self, text: &str) {
        *self.0.lock().unwrap() = Some((Instant::now(), text.to_owned()));
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        let now = self.0.lock().ok().and_then(|mut now| now.take());
        if let Some((_, text)) = now.filter(|_| thread::panicking()) {
            eprintln!("by this file:\n{text}");
        }
    }
}

/// Runs this number of files. Returns the numbers of files that ran, of members that were constructed, and of files
/// with several bodies.
fn survive(cases: usize, seed: u64) -> [usize; 3] {
    let (seeds, mut random, mut ran, mut drawn, mut several) = (seeds(), Random(seed), 0, 0, 0);
    let watch = Watched::new();
    for case in 0..cases {
        let text = mutated(&seeds[random.below(seeds.len())], &mut random);
        watch.begin(&text);
        let answer = Scene::parse("mutated.toml", &text).and_then(|scene| {
            several += usize::from(scene.system().is_some());
            // A search in a debug build takes minutes, also where a file has lost its step.
            let is_long = scene.system().is_some() || cfg!(debug_assertions) && !text.contains("accuracy");
            if is_long && scene.asks_for_accuracy() {
                return Ok(());
            }
            if let Some(ensemble) = scene.ensemble() {
                make_members(ensemble, &text, &mut random);
                drawn += 1;
            }
            let run = scene.first(30)?;
            let are_finite = |sample: &liestep_scene::Sample| sample.numbers.iter().all(|number| number.is_finite());
            assert!(run.samples().iter().all(are_finite), "{case}: {text}");
            if case % 20 == 0 {
                assert!(scene.picture(&run).unwrap().contains("</svg>") && scene.page(&run).contains("</html>"));
            }
            Ok(())
        });
        match answer {
            Ok(()) => ran += 1,
            Err(mistake) => assert_placed(&mistake, &text),
        }
    }
    [ran, drawn, several]
}

#[test]
fn mutated_files_are_refused_or_run() {
    let [ran, drawn, several] = survive(1000, 0x9e37_79b9_7f4a_7c15);
    assert!((100..900).contains(&ran) && drawn > 10 && several > 20, "{ran} {drawn} {several}");
}

#[test]
#[ignore = "some minutes: cargo test --release -p liestep-cli -- --ignored; LIESTEP_SEED is another seed"]
fn ten_thousand_mutated_files_are_refused_or_run() {
    let seed = env::var("LIESTEP_SEED").map_or(0x2545_f491_4f6c_dd1d, |seed| seed.parse().expect("a whole number"));
    let [ran, drawn, several] = survive(10_000, seed);
    println!("seed {seed}: {ran} of 10000 ran, {drawn} with an ensemble, {several} with several bodies");
    assert!((1000..9000).contains(&ran) && drawn > 100 && several > 200, "{ran} {drawn} {several}");
}
