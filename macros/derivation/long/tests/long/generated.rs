//! Random declarations, half of them right: right ones are accepted, wrong ones refused by a message, and accepted ones
//! have the numbers of their text, which is evaluated apart. What some of them expand to is one crate, which rustc has
//! to accept.

mod apart;
pub(crate) mod texts;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use std::{env, fs};

use apart::{Change, Env, carried, inverse_of, slope, value, with};
use syn::Expr;
use texts::{KINDS, Kind, MISTAKES, WORDS, declaration, right};

use crate::common::numeric::Matrix;
use crate::common::random::{Random, exponential};
use crate::common::{evaluated, is_refused, tokens};
use crate::fuzz::{Mutation, mutated};
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Declaration, Name, Quadrature, Role, check, lower, parse};
use liestep_derivation::judged::{Choice, ConstraintSlopes, cheapest, discretised, held};
use liestep_derivation::mathematics::derive::{Derivation, View, derive};
use liestep_derivation::program::{Beginning, Input, Scalariser, components};
use liestep_derivation::{MOST_WORK, staged};

/// The discrete Lagrangian of a text: `l_d`, or a declared `l` discretised.
fn lagrangian(declaration: &Declaration, text: &Expr, env: &Env) -> Option<f64> {
    let at = |env: &Env| value(text, env).filter(|value| value.entries.len() == 1).map(|value| value.at(0, 0));
    let h = env["h"].at(0, 0);
    if declaration.continuous.is_none() {
        return at(env);
    }
    let (mut env, f) = (env.clone(), &env["F"]);
    env.insert("xi".to_owned(), f.vee().scaled(4.0 / (1.0 + f.trace()) / h));
    env.insert("v".to_owned(), env.get("s").unwrap_or(&Matrix::scalar(0.0)).scaled(1.0 / h));
    let mut next = env.clone();
    for (factor, own) in declaration.factors.iter().enumerate() {
        let (f, back) = (&env[&own.name], env.get(&inverse_of(&own.name)).cloned());
        next = carried(declaration, factor, [&back.unwrap_or_else(|| f.scaled(-1.0)), f], &next);
    }
    if declaration.discretisation().is_some_and(|asked| asked.quadrature == Quadrature::Chord) {
        let mean = |(name, now): (&String, &Matrix)| (name.clone(), now.plus(&next[name]).scaled(0.5));
        return Some(h * at(&env.iter().map(mean).collect())?);
    }
    Some(0.5 * h * (at(&env)? + at(&next)?))
}

/// The changes along all generators.
fn changes(declaration: &Declaration) -> Vec<Change<'_>> {
    let of_factor = |(factor, own): (usize, &liestep_derivation::mathematics::group::Group)| {
        let (is_added, size, dimension) = (own.is_added, own.size, own.dimension());
        let along = own.generators.iter().enumerate().map(move |(k, entries)| {
            if is_added {
                Matrix::unit(k, dimension)
            } else {
                Matrix::new(size, size, |i, j| entries[size * i + j].to_f64())
            }
        });
        along.map(move |along| Change { declaration, factor, along }).collect::<Vec<_>>()
    };
    declaration.group.factors().iter().enumerate().flat_map(of_factor).collect()
}

/// Both momentum maps, the diamond and the momentum of the text along all generators, and its energy.
fn expected(declaration: &Declaration, text: &Expr, env: &Env) -> Option<Vec<f64>> {
    let at = |env: &Env| lagrangian(declaration, text, env);
    if declaration.role == Role::Force {
        let still = with(env, "eta_next", Matrix::new(3, 1, |_, _| 0.0));
        return (0..3).map(|k| Some(-at(&with(&still, "eta", Matrix::unit(k, 3)))?)).collect();
    }
    let mut all = Vec::new();
    for change in changes(declaration) {
        all.push(slope(|e| at(&change.scaled(e).turned(env, false)))?);
        all.push(slope(|e| at(&change.scaled(e).turned(env, true)))?);
        all.push(-slope(|e| at(&change.scaled(e).carried(env)))?);
        all.push(slope(|e| at(&change.scaled(e).carried(&change.scaled(e).turned(env, false))))?);
    }
    all.push(-slope(|e| at(&with(env, "h", Matrix::scalar(0.1 + 0.1 * e))))? / 0.1);
    Some(all)
}

/// Random values of all names, with increments of this size.
fn environment(random: &mut Random, declaration: &Declaration, size: f64) -> Env {
    let (any, mut env) = (random.matrix(3, 3), Env::new());
    let vectors = ["eta", "eta_next", "a", "b", "up", "wind"].map(|name| (name, random.matrix(3, 1)));
    let scalars = [("h", 0.1), ("k", 1.1), ("m", 0.7)].map(|(name, x)| (name, Matrix::scalar(x)));
    let matrices = [("I", Matrix::identity(3)), ("J", any.times(&any.transpose())), ("A", any)];
    let named = vectors.into_iter().chain(scalars).chain(matrices);
    env.extend(named.map(|(name, value)| (name.to_owned(), value)));
    for (factor, own) in declaration.factors.iter().zip(declaration.group.factors()) {
        let start = if own.is_added { Matrix::new(own.dimension(), 1, |_, _| 0.0) } else { Matrix::identity(own.size) };
        env.extend([(factor.name.clone(), start.clone()), (inverse_of(&factor.name), start)]);
        if own.is_added {
            env.remove(&inverse_of(&factor.name));
        }
    }
    for change in changes(declaration) {
        env = change.scaled(size * random.signed()).turned(&env, false);
    }
    for w in &declaration.advected {
        let is_added = |factor: usize| declaration.group.factor(factor).is_added;
        let value = match w.seen {
            View::Configuration(of) | View::Relative { of, .. } if is_added(of) => {
                random.matrix(declaration.group.factor(of).dimension(), 1)
            }
            View::Configuration(_) | View::Relative { .. } => exponential(&random.matrix(3, 1)),
            View::From(_) => random.matrix(3, 1).scaled(1.5 + random.signed()),
        };
        env.insert(w.plain_name(), value);
    }
    env
}

/// The derived terms in numbers, at these values of the names.
fn found(declaration: &Declaration, env: &Env) -> Option<Vec<f64>> {
    let mut errors = Errors::default();
    let mut tree = check::check(declaration, &mut errors)?;
    if let Some(asked) = declaration.discretisation() {
        tree = discretised(declaration, &tree, asked, &mut errors)?;
    }
    let readings = lower::readings(declaration, &tree, &mut errors)?;
    let Choice { derived, lowered, kernel } = cheapest(readings, derive, declaration, &tree, &mut errors)?;
    let Beginning { mut graph, given } = kernel.beginning;
    let Derivation { right_momentum, left_momentum, diamond, momentum, symbols, energy, .. } = &derived;
    let terms = [right_momentum, left_momentum, diamond, momentum];
    let terms = terms.map(|term| components(&mut graph, &derived, &given, term));
    let mut outputs: Vec<_> = (0..terms[3].len()).flat_map(|k| terms.each_ref().map(|term| term[k])).collect();
    match declaration.role {
        Role::Force => outputs.clone_from(&terms[3]),
        _ => outputs.push(Scalariser::new(&mut graph, symbols, &given).scalar(energy)),
    }
    let mut inputs = BTreeMap::new();
    for (name, symbol) in lowered.names {
        let name = match name {
            Name::Increment(factor) => declaration.factors[factor].name.clone(),
            Name::Step => "h".to_owned(),
            Name::Advected(index) => declaration.advected[index].plain_name(),
            Name::Field(index) => declaration.fields[index].plain_name(),
            Name::DisplacementBefore(_) => "eta".to_owned(),
            Name::DisplacementAfter(_) => "eta_next".to_owned(),
            Name::Velocity(_) => continue,
        };
        inputs.insert(symbol, env[&name].clone());
    }
    for (own, one) in declaration.factors.iter().zip(&derived.directions.factors) {
        let f = &env[&own.name];
        let Some(inverse) = env.get(&inverse_of(&own.name)) else {
            inputs.extend([(one.increment, f.clone()), (one.small, f.clone())]);
            continue;
        };
        let identity = Matrix::identity(f.rows);
        inputs.extend([(one.increment, f.clone()), (one.small, f.minus(&identity))]);
        inputs.extend([(one.inverse, inverse.clone()), (one.small_inverse, inverse.minus(&identity))]);
    }
    Some(evaluated(&graph, &outputs, &|input: Input| inputs[&input.symbol].at(input.row, input.column)))
}

/// The values of advected parameters of two bodies, at these positions of the bodies.
fn seen(declaration: &Declaration, env: &Env, places: &[Matrix; 4]) -> Env {
    let mut env = env.clone();
    for w in &declaration.advected {
        let value = match w.seen {
            View::Configuration(of) => places[of].clone(),
            View::Relative { of, from } if of % 2 == 1 => places[of].minus(&places[from]),
            View::Relative { of, from } => places[from].transpose().times(&places[of]),
            View::From(_) => continue,
        };
        env.insert(w.plain_name(), value);
    }
    env
}

/// The derived slopes of a constraint, and those by differences of its text.
fn slopes(random: &mut Random, declaration: &Declaration, text: &Expr, env: &Env) -> Option<[Vec<f64>; 2]> {
    let mut errors = Errors::default();
    let ConstraintSlopes { lowered, graph, entries, .. } =
        held(declaration, check::functions(declaration, &mut errors)?, &mut errors)?;
    let places: [Matrix; 4] = std::array::from_fn(|factor| {
        let any = random.matrix(3, 1);
        if factor % 2 == 0 { exponential(&any) } else { any }
    });
    let value = |places: &[Matrix; 4]| Some(value(text, &seen(declaration, env, places))?.entries);
    let (rows, mut expected) = (value(&places)?.len(), Vec::new());
    for factor in 0..4 {
        for row in 0..rows {
            for k in 0..3 {
                expected.push(slope(|e| {
                    let (mut moved, along) = (places.clone(), Matrix::unit(k, 3).scaled(e));
                    moved[factor] = if factor % 2 == 0 {
                        exponential(&along).times(&places[factor])
                    } else {
                        places[factor].plus(&along)
                    };
                    value(&moved)?.get(row).copied()
                })?);
            }
        }
    }
    let mut inputs = BTreeMap::new();
    for (body, places) in lowered.declared.bodies.iter().zip(places.chunks(2)) {
        inputs.extend([(body.attitude, places[0].clone()), (body.position, places[1].clone())]);
    }
    for (name, symbol) in &lowered.names {
        if let Name::Field(index) = name {
            inputs.insert(*symbol, env[&declaration.fields[*index].plain_name()].clone());
        }
    }
    let outputs = entries.concat().concat();
    let found = evaluated(&graph, &outputs, &|input: Input| inputs[&input.symbol].at(input.row, input.column));
    Some([found, expected])
}

/// Whether the derived terms have the numbers of the text; none if the text has no value.
fn agrees(random: &mut Random, role: Role, (arguments, item): (&str, &str), text: &Expr) -> Option<bool> {
    let declaration = parse::declaration(role, &tokens(arguments), &tokens(item), &mut Errors::default())?;
    let declaration = Declaration { is_text: true, ..declaration };
    // Roots may have values for small increments alone, so that draws alternate between two sizes.
    (0..30).find_map(|draw| {
        let env = environment(random, &declaration, if draw % 2 == 0 { 0.4 } else { 0.02 });
        let [found, expected] = if role == Role::Constraint {
            slopes(random, &declaration, text, &env)?
        } else {
            let expected = expected(&declaration, text, &env)?;
            expected
                .iter()
                .all(|x| x.is_finite())
                .then(|| found(&declaration, &env))
                .flatten()
                .map(|found| [found, expected])?
        };
        let scale = 1e-3 + expected.iter().map(|x| x.abs()).sum::<f64>();
        let is_same = |(x, y): (&f64, &f64)| (x - y).abs() <= 1e-7 * scale;
        scale.is_finite().then(|| found.len() == expected.len() && found.iter().zip(&expected).all(is_same))
    })
}

/// The message of a refusal, if there is one; `is_late` also reads the text as a library does at run time.
fn refusal(role: Role, arguments: &str, item: &str, is_late: bool) -> Option<String> {
    if is_late && role != Role::Constraint {
        let text = format!("#[{}({arguments})] {item}", role.attribute());
        return staged(&tokens(&text), MOST_WORK).err().map(|refusal| format!("{refusal:?}"));
    }
    let expansion = liestep_derivation::expand(role, tokens(arguments), &tokens(item));
    let message = || expansion.to_string().split("compile_error ! {").nth(1)?.split('}').next().map(str::to_owned);
    is_refused(&expansion).then(|| message().unwrap_or_default())
}

/// The processor time of this thread, or the elapsed time if the system doesn't report that: work of other programs
/// isn't in it.
fn worked(clock: Instant) -> Duration {
    let told = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse().ok());
    nanoseconds.map_or_else(|| clock.elapsed(), Duration::from_nanos)
}

/// Compiles crates of a hundred declarations, with their roles.
fn compile(declarations: &[String]) {
    let core = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../core");
    let folder = env::temp_dir().join(format!("liestep-generated-{}", std::process::id()));
    fs::create_dir_all(folder.join("src")).expect("a folder");
    let manifest = format!(
        "[package]\nname = \"generated\"\nedition = \"2024\"\n[workspace]\n[dependencies]\nliestep = {{ path = \"{}\" }}\n\
         nalgebra = {{ version = \"0.35\", default-features = false, features = [\"std\"] }}\n",
        core.display()
    );
    fs::write(folder.join("Cargo.toml"), manifest).expect("a file");
    fs::copy(core.join("../Cargo.lock"), folder.join("Cargo.lock")).expect("a file");
    let uses = "use liestep::groups::{R1, R3, SE2, SO3}; use liestep::mechanics::Inertia; use liestep::{NonstandardInertia, constraint, force, lagrangian}; use nalgebra::{Matrix3, Vector3};";
    for chunk in declarations.chunks(100) {
        let module = |(at, text): (usize, &String)| format!("pub mod m{at} {{ {uses} {text} }}\n");
        let text: String = chunk.iter().enumerate().map(module).collect();
        fs::write(folder.join("src/lib.rs"), format!("#![allow(non_snake_case, unused)]\n{text}")).expect("a file");
        let cargo = Command::new(env!("CARGO")).args(["check", "--quiet", "--offline"]).current_dir(&folder).output();
        let output = cargo.expect("cargo");
        assert!(output.status.success(), "in {}:\n{}", folder.display(), String::from_utf8_lossy(&output.stderr));
    }
    fs::remove_dir_all(folder).expect("the folder is ours");
}

/// Right declarations of each kind in turn are certified, and those on products to which small errors are added
/// elsewhere.
#[test]
fn right_declarations_are_certified() {
    for number in 0..48 {
        let (mut random, kind) = (Random::new(number), &KINDS[usize::try_from(number).expect("small") % KINDS.len()]);
        let (arguments, item) = declaration(kind, &right(&mut random, kind));
        let expansion = liestep_derivation::expand(kind.role, tokens(&arguments), &tokens(&item));
        assert!(!is_refused(&expansion), "{number}: {arguments} {item}: {expansion}");
        let text = expansion.to_string();
        assert!(
            text.contains("with a probability below 2⁻¹") && !text.contains("not certified"),
            "{number}: {arguments}"
        );
    }
}

#[test]
#[ignore = "some minutes; LIESTEP_SEED and LIESTEP_COUNT say which and how many, how many are compiled says LIESTEP_COMPILED: with 0 all are mutated, and read late"]
fn right_and_wrong_declarations() {
    let asked = |name: &str, usual: u64| env::var(name).map_or(usual, |text| text.parse().expect("a whole number"));
    let (seed, count) = (asked("LIESTEP_SEED", 1), asked("LIESTEP_COUNT", 3_000));
    let (mut refused, mut accepted, mut compared, mut wrong, mut idle) = (Vec::new(), Vec::new(), 0, Vec::new(), 0);
    // If rustc compiles none of the declarations, all are wrong ones, and are read as at run time.
    let (compiled, mut slowest) = (asked("LIESTEP_COMPILED", count), (Duration::ZERO, String::new()));
    let clock = Instant::now();
    for number in 0..count {
        let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
        let kind = &KINDS[random.below(KINDS.len())];
        let Kind { role, head, tail, .. } = *kind;
        let number = if compiled == 0 { number | 1 } else { number };
        let (mut arguments, item) = declaration(kind, &right(&mut random, kind));
        let mut any = || random.below(1 << 20);
        if number % 4 == 1 {
            let mutation = match any() % 4 {
                0 => Mutation::Delete(any()),
                1 => Mutation::Exchange(any(), any()),
                2 => Mutation::Replace(any(), WORDS[any() % WORDS.len()]),
                _ => Mutation::Insert(any(), WORDS[any() % WORDS.len()]),
            };
            let text = &arguments[head.len()..arguments.len() - tail.len()];
            arguments = format!("{head}{}{tail}", mutated(text, &[mutation]));
        } else if number % 4 == 3 {
            let mistakes = MISTAKES.iter().cycle().skip(any() % MISTAKES.len());
            let (from, to) = mistakes.into_iter().find(|(from, _)| arguments.contains(from)).expect("a group");
            arguments = arguments.replacen(from, to, 1);
        }
        let before = worked(clock);
        let refusal = refusal(role, &arguments, &item, compiled == 0);
        slowest = slowest.max((worked(clock).saturating_sub(before), arguments.clone()));
        match refusal {
            // A random term may be zero, as `w.dot(&w.cross(&a))` is.
            Some(message) if number % 2 == 0 && message.contains("this term is zero") => idle += 1,
            Some(message) if number % 2 == 0 => refused.push(format!("{message}: {arguments} {item}")),
            Some(message) => {
                println!("{message} of\n    {arguments}");
                if message.len() < 5 || message.contains("please report") {
                    wrong.push(format!("{message}: {arguments} {item}"));
                }
            }
            None => {
                let derives = if role == Role::Constraint { "#[derive(Clone, Copy, Debug, PartialEq)]" } else { "" };
                accepted.push(format!("#[{}({arguments})] {derives} pub {item}", role.attribute()));
                let text = arguments.strip_prefix(head).and_then(|text| text.strip_suffix(tail));
                let text = text.and_then(|text| syn::parse_str(text).ok());
                match text.and_then(|text| agrees(&mut random, role, (&arguments, &item), &text)) {
                    Some(true) => compared += 1,
                    Some(false) => wrong.push(format!("{number}, other numbers: {arguments} {item}")),
                    None => wrong.push(format!("{number}, no numbers: {arguments} {item}")),
                }
            }
        }
    }
    println!(
        "seed {seed}: {} of {count} accepted, {compared} compared, {slowest:?} at most, right ones refused: {refused:#?}",
        accepted.len()
    );
    assert!(50 * idle <= count, "{idle} of {count} have a term that is zero");
    assert!(wrong.is_empty() && refused.len() as u64 <= 3 * count.div_ceil(3_000), "{wrong:#?} {refused:#?}");
    // The bound on work holds for declarations read at run time alone.
    assert!(cfg!(debug_assertions) || compiled > 0 || slowest.0 < Duration::from_secs(1), "{slowest:?}");
    accepted.truncate(usize::try_from(compiled).expect("small"));
    compile(&accepted);
}
