//! Random declarations, half of them right: these are accepted, the others refused by a message, and what is accepted has
//! the numbers of its text, which is evaluated apart. What some of them expand to is one crate, which rustc has to accept.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use syn::{BinOp, Expr, ExprLit, Lit, Local, Pat, Stmt};

use super::fuzz::{Mutation, mutated};
use super::{is_refused, tokens};
use crate::declared::errors::Errors;
use crate::declared::{Name, Role, check, lower, parse};
use crate::judged::{Chosen, cheapest, discretised};
use crate::mathematics::derive::{Derived, derive};
use crate::mathematics::symbolic::tests::numeric::Matrix;
use crate::mathematics::symbolic::tests::random::{Random, exponential};
use crate::program::{Given, Graph, Input, Scalariser, components, with_lets};

/// Head, kinetic part or resistance, and tail of a declaration; what a term is multiplied by, and vectors that move.
type Kind = (&'static str, &'static str, &'static str, &'static str, [&'static str; 3]);

#[rustfmt::skip]
const KINDS: [Kind; 6] = [
    ("group = SO3, advected(w = up), l_d = ", "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)", "", "h * ",
        ["(F * a)", "(F.transpose() * w)", "(A * (F * b))"]),
    ("group = SE2, advected(w = up), l_d = ", "((F - I) * A * A.transpose() * (F - I).transpose()).trace() / (2.0 * h)", "",
        "h * ", ["(F * a)", "(inverse(F) * w)", "(A * (F * b))"]),
    ("group(F = SO3, d = R3), advected(w = up.seen_from(F), R = F.seen_from(space), x = d.seen_from(space)), l_d = ",
        "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + k * d.norm_squared() / h - h * x.dot(&(R * w))", "",
        "h * ", ["(F * a)", "(R.transpose() * (x + d))", "(F.transpose() * w)"]),
    ("group = SO3, velocity = xi, advected(w = up), l = ", "0.5 * xi.dot(&(J * xi))", ", discretise = trapezoid(Cayley)",
        "", ["(A * w)", "a", "w"]),
    ("group = SO3, velocity = xi, advected(w = up), l = ", "0.5 * xi.dot(&(J * xi)) + w.dot(&xi)",
        ", discretise = chord(Cayley)", "", ["(A * w)", "a", "w"]),
    ("group = SO3, advected(w = up), work = ", "-k * vee(F).dot(&(eta + eta_next))", "", "h * ",
        ["(F * a)", "(F.transpose() * w)", "(A * w)"]),
];
const FORCE: usize = 5;
#[rustfmt::skip]
const FIELDS: [(&str, &str); 7] = [
    ("J", "NonstandardInertia<f64>"), ("A", "Matrix3<f64>"), ("a", "Vector3<f64>"), ("b", "Vector3<f64>"),
    ("up", "Vector3<f64>"), ("k", "f64"), ("m", "f64"),
];
/// What is wrong, wherever it stands for the other.
#[rustfmt::skip]
const MISTAKES: [(&str, &str); 24] = [
    (" - h * ", " - "), (" - h * ", " - h * h * "), (".dot(&", ".dot("), ("2.0 * h", "2 * h"), ("* J *", "* K *"),
    ("advected(", "advectd("), ("SO3", "SO4"), ("w = up", "w = above"), (".trace()", ".tracee()"), (".dot(", ".dott("),
    ("h * ", "h * h.ln() * "), ("k * ", "F * "), ("&w", "&(w / (k - k))"), (" - h * ", " - h * (F - I).norm() * "),
    (" - ", " - ; "), ("discretise", "discretize"), ("Cayley", "Kayley"), ("velocity = xi", "velocity = zeta"),
    ("eta_next", "eta_after"), (".cross(&", ".dot(&"), (".dot(&eta)", ".dot(&eta).powi(2)"), ("group", "grup"),
    ("advected(w = up", "advected(w = up, w = up"), (" * ", " * * "),
];

/// What is written for something else.
const WORDS: [&str; 14] = ["F", "w", "a", "b", "k", "h", "+", "-", "*", "I", "J", "2.0", "( F * a )", "/"];

fn vector(random: &mut Random, kind: usize, depth: usize) -> String {
    let deeper = |random: &mut Random| vector(random, kind, depth - 1);
    match random.below(if depth == 0 { 4 } else { 7 }) {
        0 => "w".to_owned(),
        1 => ["a", "b"][random.below(2)].to_owned(),
        2 | 3 => KINDS[kind].4[random.below(3)].to_owned(),
        4 => format!("({} {} {})", deeper(random), ["+", "-"][random.below(2)], deeper(random)),
        5 => format!("{}.cross(&{})", deeper(random), deeper(random)),
        _ => format!("({} * {})", scalar(random, kind, 0), deeper(random)),
    }
}

fn scalar(random: &mut Random, kind: usize, depth: usize) -> String {
    let deeper = |random: &mut Random| scalar(random, kind, depth - 1);
    match random.below(if depth == 0 { 2 } else { 8 }) {
        0 => ["k", "m"][random.below(2)].to_owned(),
        1 => format!("{}.dot(&{})", vector(random, kind, depth), vector(random, kind, depth)),
        2 => format!("({} {} {})", deeper(random), ["+", "-", "*"][random.below(3)], deeper(random)),
        3 => format!("({}).{}()", deeper(random), ["sin", "cos"][random.below(2)]),
        4 => format!("(1.0 + {}.norm_squared()).{}()", vector(random, kind, 1), ["sqrt", "ln"][random.below(2)]),
        5 => format!("({}).powi({})", deeper(random), 2 + random.below(2)),
        6 => format!("{} / (2.0 + {}.norm_squared())", deeper(random), vector(random, kind, 1)),
        _ => format!("(0.1 * {}).exp()", deeper(random)),
    }
}

fn right(random: &mut Random, kind: usize) -> String {
    let (_, energy, _, weight, _) = KINDS[kind];
    let mut terms = vec![energy.to_owned()];
    for _ in 0..=random.below(3) {
        let (scalar, one, other) = (scalar(random, kind, 2), vector(random, kind, 1), vector(random, kind, 2));
        terms.push(match kind {
            FORCE => format!(" - h * {scalar} * ({one} + w).dot(&eta)"),
            _ => format!(" - {weight}({scalar} * w.dot(&a) + w.dot(&{other}).sin())"),
        });
    }
    let sum = terms.concat();
    let with_name = [sum.replace("dot(&a)", "dot(&y)"), sum.replace(" + w)", " + y)")];
    match random.below(3) {
        0 => format!("{{ let y = {}; {} }}", vector(random, kind, 1), with_name[usize::from(kind == FORCE)]),
        _ => sum,
    }
}

/// With the fields that stand in it.
fn declaration(kind: usize, expression: &str) -> (String, String) {
    let (head, _, tail, ..) = KINDS[kind];
    let arguments = format!("{head}{expression}{tail}");
    let words: Vec<&str> = arguments.split(|letter: char| !letter.is_alphanumeric() && letter != '_').collect();
    let fields = FIELDS.iter().filter(|(name, _)| words.contains(name)).map(|(name, ty)| format!("{name}: {ty}"));
    (arguments.clone(), format!("struct Body {{ {} }}", fields.collect::<Vec<_>>().join(", ")))
}

/// Values of names.
type Env = BTreeMap<String, Matrix>;

/// With another value.
fn with(env: &Env, name: &str, value: Matrix) -> Env {
    let mut env = env.clone();
    env.insert(name.to_owned(), value);
    env
}

/// The value of Rust text; nothing where it has no meaning.
fn value(expression: &Expr, env: &Env) -> Option<Matrix> {
    let of = |expression: &Expr| value(expression, env);
    let number = |x: &Matrix| (x.entries.len() == 1).then(|| x.at(0, 0));
    let same = |x: &Matrix, y: &Matrix| (x.rows, x.columns) == (y.rows, y.columns);
    Some(match expression {
        Expr::Paren(inner) => of(&inner.expr)?,
        Expr::Reference(inner) => of(&inner.expr)?,
        Expr::Path(path) => env.get(&path.path.get_ident()?.to_string())?.clone(),
        Expr::Lit(ExprLit { lit: Lit::Float(number), .. }) => Matrix::scalar(number.base10_parse().ok()?),
        Expr::Unary(unary) => of(&unary.expr)?.scaled(-1.0),
        Expr::Binary(binary) => match (&binary.op, of(&binary.left)?, of(&binary.right)?) {
            (BinOp::Add(_), a, b) if same(&a, &b) => a.plus(&b),
            (BinOp::Sub(_), a, b) if same(&a, &b) => a.minus(&b),
            (BinOp::Mul(_), a, b) if number(&a).or(number(&b)).is_some() || a.columns == b.rows => a.times(&b),
            (BinOp::Div(_), a, b) => a.scaled(1.0 / number(&b)?),
            _ => return None,
        },
        Expr::Block(block) => {
            let mut env = env.clone();
            for statement in &block.block.stmts {
                match statement {
                    Stmt::Local(Local { pat: Pat::Ident(name), init: Some(init), .. }) => {
                        env = with(&env, &name.ident.to_string(), value(&init.expr, &env)?);
                    }
                    Stmt::Expr(expression, None) => return value(expression, &env),
                    _ => return None,
                }
            }
            return None;
        }
        Expr::Call(call) => {
            let Expr::Path(path) = &*call.func else { return None };
            match (path.path.get_ident()?.to_string().as_str(), of(call.args.first()?)?) {
                ("vee", of) => of.vee(),
                ("inverse", of) if of.entries == env["F"].entries => env["inverse of F"].clone(),
                _ => return None,
            }
        }
        Expr::MethodCall(call) => {
            let (receiver, first) = (of(&call.receiver)?, call.args.first());
            let (x, other) = (number(&receiver), first.and_then(of).filter(|other| same(&receiver, other)));
            match call.method.to_string().as_str() {
                "transpose" => receiver.transpose(),
                "trace" if receiver.rows == receiver.columns => Matrix::scalar(receiver.trace()),
                "norm_squared" => Matrix::scalar(receiver.transpose().times(&receiver).trace()),
                "dot" => Matrix::scalar(receiver.transpose().times(&other?).trace()),
                "cross" => receiver.hat().times(&other?),
                "powi" => match first? {
                    Expr::Lit(ExprLit { lit: Lit::Int(n), .. }) => Matrix::scalar(x?.powi(n.base10_parse().ok()?)),
                    _ => return None,
                },
                "sqrt" => Matrix::scalar(x?.sqrt()),
                "sin" => Matrix::scalar(x?.sin()),
                "cos" => Matrix::scalar(x?.cos()),
                "exp" => Matrix::scalar(x?.exp()),
                "ln" => Matrix::scalar(x?.ln()),
                _ => return None,
            }
        }
        _ => return None,
    })
}

fn exp(x: &Matrix) -> Matrix {
    let next = |(sum, power): (Matrix, Matrix), order: i32| {
        let power = power.times(x).scaled(1.0 / f64::from(order));
        (sum.plus(&power), power)
    };
    (1..25).fold((Matrix::identity(3), Matrix::identity(3)), next).0
}

/// With `exp(x) F exp(y)` for `F`.
fn turned(env: &Env, x: &Matrix, y: &Matrix) -> Env {
    let inverse = exp(&y.scaled(-1.0)).times(&env["inverse of F"]).times(&exp(&x.scaled(-1.0)));
    with(&with(env, "F", exp(x).times(&env["F"]).times(&exp(y))), "inverse of F", inverse)
}

/// With all that is advected moved by `exp(x)`; a plain vector is a covector.
fn carried(env: &Env, x: &Matrix) -> Env {
    let back = exp(&x.scaled(-1.0));
    with(&with(env, "w", back.transpose().times(&env["w"])), "R", env["R"].times(&back))
}

/// `l_d`, or what `discretise` makes of `l`.
fn lagrangian(kind: usize, text: &Expr, env: &Env) -> Option<f64> {
    let at = |env: &Env| value(text, env).filter(|value| value.entries.len() == 1).map(|value| value.at(0, 0));
    let (f, h) = (&env["F"], env["h"].at(0, 0));
    if !KINDS[kind].0.contains("xi") {
        return at(env);
    }
    let env = with(env, "xi", f.vee().scaled(4.0 / (1.0 + f.trace()) / h));
    let at = |w: &Matrix| at(&with(&env, "w", w.clone()));
    let (w, next) = (&env["w"], f.transpose().times(&env["w"]));
    let is_trapezoid = KINDS[kind].2.contains("trapezoid");
    Some(h * if is_trapezoid { 0.5 * (at(w)? + at(&next)?) } else { at(&w.plus(&next).scaled(0.5))? })
}

/// By a formula of fourth order.
fn slope(f: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let difference = |e: f64| Some((f(e)? - f(-e)?) / (2.0 * e));
    Some((4.0 * difference(1e-3)? - difference(2e-3)?) / 3.0)
}

/// Both momentum maps, the diamond and the momentum of the text along all generators, and its energy.
fn expected(kind: usize, generators: &[Matrix], text: &Expr, env: &Env) -> Option<Vec<f64>> {
    let at = |env: &Env| lagrangian(kind, text, env);
    let zero = |columns| Matrix::new(3, columns, |_, _| 0.0);
    let mut all = Vec::new();
    for generator in generators {
        let along = |e: f64| generator.scaled(e);
        all.push(slope(|e| at(&turned(env, &along(e), &zero(3))))?);
        all.push(slope(|e| at(&turned(env, &zero(3), &along(e))))?);
        all.push(-slope(|e| at(&carried(env, &along(e))))?);
        all.push(slope(|e| at(&carried(&turned(env, &along(e), &zero(3)), &along(e))))?);
    }
    for k in (0..3).filter(|_| KINDS[kind].0.contains("d = R3")) {
        let moved = |env: &Env, name: &str, e: f64| with(env, name, env[name].plus(&Matrix::unit(k, 3).scaled(e)));
        let right = slope(|e| at(&moved(env, "d", e)))?;
        all.extend([right, right, slope(|e| at(&moved(env, "x", e)))?]);
        all.push(slope(|e| at(&moved(&moved(env, "d", e), "x", -e)))?);
    }
    if kind == FORCE {
        let still = with(env, "eta_next", zero(1));
        return (0..3).map(|k| Some(-at(&with(&still, "eta", Matrix::unit(k, 3)))?)).collect();
    }
    all.push(-slope(|e| at(&with(env, "h", Matrix::scalar(0.1 + 0.01 * e))))? / 0.01);
    Some(all)
}

/// Whether what is derived has the numbers of the text; nothing where the text has none.
fn agrees(random: &mut Random, kind: usize, (arguments, item): (&str, &str), text: &Expr) -> Option<bool> {
    let role = if kind == FORCE { Role::Force } else { Role::Lagrangian };
    let mut errors = Errors::default();
    let declaration = parse::declaration(role, &tokens(arguments), &tokens(item), &mut errors)?;
    let mut tree = check::check(&declaration, &mut errors)?;
    if let Some(asked) = declaration.discretisation() {
        tree = discretised(&declaration, &tree, asked, &mut errors)?;
    }
    let readings = lower::readings(&declaration, &tree, &mut errors)?;
    let Chosen { derived, lowered, .. } = cheapest(readings, derive, &declaration, &tree, &mut errors)?;

    let (identity, any) = (Matrix::identity(3), random.matrix(3, 3));
    let mut env: Env = [("I", identity.clone()), ("F", identity.clone()), ("inverse of F", identity.clone())]
        .into_iter()
        .chain(["w", "x", "d", "eta", "eta_next", "a", "b", "up"].map(|name| (name, random.matrix(3, 1))))
        .chain([("h", 0.1), ("k", 1.1), ("m", 0.7)].map(|(name, x)| (name, Matrix::scalar(x))))
        .chain([("R", exponential(&random.matrix(3, 1))), ("J", any.times(&any.transpose())), ("A", any)])
        .map(|(name, value)| (name.to_owned(), value))
        .collect();
    let generators = &declaration.group.factor(0).generators;
    let generators = generators.iter().map(|entries| Matrix::new(3, 3, |i, j| entries[3 * i + j].to_f64()));
    let generators: Vec<Matrix> = generators.collect();
    for generator in &generators {
        env = turned(&env, &generator.scaled(0.4 * random.signed()), &identity.scaled(0.0));
    }

    let mut graph = Graph::default();
    let given = with_lets(&mut graph, &derived, Given::new());
    let Derived { right_momentum, left_momentum, diamond, momentum, symbols, energy, .. } = &derived;
    let terms = [right_momentum, left_momentum, diamond, momentum];
    let terms = terms.map(|term| components(&mut graph, &derived, &given, term));
    let mut outputs: Vec<_> = (0..terms[3].len()).flat_map(|k| terms.each_ref().map(|term| term[k])).collect();
    match kind {
        FORCE => outputs.clone_from(&terms[3]),
        _ => outputs.push(Scalariser { graph: &mut graph, symbols, given }.scalar(energy)),
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
    let (f, inverse, factors) = (&env["F"], &env["inverse of F"], &derived.directions.factors);
    inputs.extend([(factors[0].increment, f.clone()), (factors[0].small, f.minus(&identity))]);
    inputs.extend([(factors[0].inverse, inverse.clone()), (factors[0].small_inverse, inverse.minus(&identity))]);
    inputs.extend(factors.get(1).map(|second| (second.small, env["d"].clone())));
    let found = graph.evaluate(&outputs, &|input: Input| inputs[&input.symbol].at(input.row, input.column));
    let expected = expected(kind, &generators, text, &env)?;
    let scale = lagrangian(kind, text, &env)?.abs() + expected.iter().map(|x| x.abs()).sum::<f64>();
    let is_same = |(x, y): (&f64, &f64)| (x - y).abs() <= 1e-7 * scale;
    scale.is_finite().then(|| found.len() == expected.len() && found.iter().zip(&expected).all(is_same))
}

/// The message, if there is one.
fn refusal(kind: usize, arguments: &str, item: &str) -> Option<String> {
    let role = if kind == FORCE { Role::Force } else { Role::Lagrangian };
    let expansion = crate::expand::expand(role, tokens(arguments), &tokens(item));
    let message = || expansion.to_string().split("compile_error ! {").nth(1)?.split('}').next().map(str::to_owned);
    is_refused(&expansion).then(|| message().unwrap_or_default())
}

/// A crate of declarations, with their roles, which has to compile.
fn compile(declarations: &[String]) {
    let core = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../core");
    let folder = env::temp_dir().join(format!("liestep-generated-{}", std::process::id()));
    fs::create_dir_all(folder.join("src")).expect("a folder");
    let manifest = format!(
        "[package]\nname = \"generated\"\nedition = \"2024\"\n[workspace]\n[dependencies]\nliestep = {{ path = {core:?} }}\n\
         nalgebra = {{ version = \"0.35\", default-features = false, features = [\"std\"] }}\n"
    );
    fs::write(folder.join("Cargo.toml"), manifest).expect("a file");
    fs::copy(core.join("../Cargo.lock"), folder.join("Cargo.lock")).expect("a file");
    let uses = "use liestep::{NonstandardInertia, force, lagrangian}; use nalgebra::{Matrix3, Vector3};";
    let module = |(at, text): (usize, &String)| format!("pub mod m{at} {{ {uses} {text} }}\n");
    let text: String = declarations.iter().enumerate().map(module).collect();
    fs::write(folder.join("src/lib.rs"), format!("#![allow(non_snake_case, unused)]\n{text}")).expect("a file");
    let cargo = Command::new(env!("CARGO")).args(["check", "--quiet", "--offline"]).current_dir(&folder).output();
    let output = cargo.expect("cargo");
    assert!(output.status.success(), "in {}:\n{}", folder.display(), String::from_utf8_lossy(&output.stderr));
    fs::remove_dir_all(folder).expect("the folder is ours");
}

#[test]
#[ignore = "some minutes; LIESTEP_SEED and LIESTEP_COUNT say which and how many"]
fn right_and_wrong_declarations() {
    let number = |name: &str, usual: u64| env::var(name).map_or(usual, |text| text.parse().expect("a whole number"));
    let (seed, count) = (number("LIESTEP_SEED", 1), number("LIESTEP_COUNT", 3_000));
    let (mut refused, mut accepted, mut compared, mut wrong) = (Vec::new(), Vec::new(), 0, Vec::new());
    for number in 0..count {
        let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
        let kind = random.below(KINDS.len());
        let (mut arguments, item) = declaration(kind, &right(&mut random, kind));
        let (head, tail) = (KINDS[kind].0, KINDS[kind].2);
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
        match refusal(kind, &arguments, &item) {
            Some(message) if number % 2 == 0 => refused.push(format!("{message}: {arguments} {item}")),
            Some(message) => {
                println!("{message} of\n    {arguments}");
                if message.len() < 5 || message.contains("please report") {
                    wrong.push(format!("{message}: {arguments} {item}"));
                }
            }
            None => {
                let role = if kind == FORCE { "force" } else { "lagrangian" };
                accepted.push(format!("#[{role}({arguments})] pub {item}"));
                let text = arguments.strip_prefix(head).and_then(|text| text.strip_suffix(tail));
                let text = text.and_then(|text| syn::parse_str(text).ok());
                match text.and_then(|text| agrees(&mut random, kind, (&arguments, &item), &text)) {
                    Some(true) => compared += 1,
                    Some(false) => wrong.push(format!("{number}, other numbers: {arguments} {item}")),
                    None => println!("{number}, no numbers: {arguments} {item}"),
                }
            }
        }
    }
    println!(
        "seed {seed}: {} of {count} accepted, {compared} compared, right ones refused: {refused:#?}",
        accepted.len()
    );
    assert!(wrong.is_empty() && refused.len() <= 3, "{wrong:#?} {refused:#?}");
    accepted.truncate(100);
    compile(&accepted);
}
