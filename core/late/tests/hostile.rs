//! Untrusted texts, and numbers that don't fit.

use std::time::{Duration, Instant};

use liestep::SetupError;
use liestep::with::Method;
use liestep_late::{Backend, Declaration, Function, Interpreter, LateError, Operation, Program, Whole, WholeError};

const KINETIC: &str = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";

fn body(more: &str) -> String {
    format!("#[lagrangian(group = SO3, l_d = {KINETIC}{more})] struct Body {{ J_d: NonstandardInertia, k: f64 }}")
}

/// The mistakes of a wrong text.
fn mistakes(text: &str) -> Vec<liestep_late::Mistake> {
    match Declaration::parse(text) {
        Err(LateError::Mistakes(mistakes)) => mistakes,
        other => panic!("{other:?}: {text}"),
    }
}

/// An expression is read as mathematics: paths, macros, closures that escape, blocks and items have no meaning in it.
#[test]
fn a_text_names_nothing_outside_itself() {
    let outside = [
        "std::process::exit(1)",
        "std::fs::read(\"/etc/passwd\").unwrap().len() as f64",
        "include_str!(\"/etc/passwd\").len()",
        "panic!()",
        "unsafe { *(0 as *const f64) }",
        "{ fn f() -> f64 { loop {} } f() }",
        "loop {}",
        "(|| k)()",
        "k.exit(1)",
        "crate::secret",
        "env!(\"HOME\").len() as f64",
    ];
    for expression in outside {
        let found = mistakes(&body(&format!(" + h * {expression}")));
        assert!(found.iter().all(|mistake| !mistake.message.contains("please report")), "{expression}: {found:?}");
    }
    for text in
        ["", "fn main() {}", "struct Body { k: f64 }", "#[lagrangian] struct Body { k: f64 }", "#[", "}", "\u{0}"]
    {
        assert!(!mistakes(text).is_empty(), "{text:?}");
    }
}

/// Texts that are too large are refused within a short time.
#[test]
fn large_and_deep_texts_are_refused() {
    let clock = Instant::now();
    let long = body(&" + h * k".repeat(20_000));
    assert!(matches!(Declaration::parse(&long), Err(LateError::TooLong(_))), "{}", long.len());
    let deep = body(&format!(" + h * {}k{}", "(".repeat(3_000), ")".repeat(3_000)));
    assert!(Declaration::parse(&deep).is_err());
    let powers = body(&format!(" + h * k{}", ".powi(9)".repeat(200)));
    assert!(Declaration::parse(&powers).is_err());
    let documented = format!("{}{}", "/// A line.\n".repeat(100), body(" - h * k * F.trace()"));
    let parsed = Declaration::parse(&documented);
    assert!(parsed.is_ok(), "{:?}", parsed.err());
    assert!(clock.elapsed() < Duration::from_secs(60), "{:?}", clock.elapsed());
}

/// A long text that is right: a potential of thirty-six products of powers has more than 2,000 tokens.
#[test]
fn a_potential_of_many_terms_is_derived() {
    let terms = (0..36).map(|k| {
        let (n, m) = (k % 6 + 1, k / 6 + 1);
        format!(
            " - 0.{k} * h / 2 * (w.dot(a).powi({n}) * w.dot(b).powi({m})
                + (F.transpose() * w).dot(a).powi({n}) * (F.transpose() * w).dot(b).powi({m}))"
        )
    });
    let text = format!(
        "#[lagrangian(group = SO3, advected(w = up), l_d = {KINETIC}{})]
        struct Body {{ J_d: NonstandardInertia, a: Vector3<f64>, b: Vector3<f64>, up: Vector3<f64> }}",
        terms.collect::<String>()
    );
    let declaration = Declaration::parse(&text).expect("a declaration");
    assert!(declaration.is_quadratic && declaration.is_self_adjoint);
}

/// A chain of operators nests its first term, in brackets, too.
#[test]
fn long_chains_are_refused() {
    let chain = |count: usize| format!("k{}", " + k".repeat(count));
    for bomb in [format!("({})", chain(1_500)), format!("({}){}", chain(700), " * k".repeat(700))] {
        let found = mistakes(&body(&format!(" + h * {bomb}")));
        assert!(found[0].message.contains("2000 tokens in a chain"), "{found:?}");
    }
}

/// The `&` and the decimal points that a compiler requires are optional; whole numbers stay whole where they have to.
#[test]
fn liberties_of_notation() {
    let written = |l_d: &str| {
        let text = format!(
            "#[lagrangian(group = SO3, advected(w = up), l_d = {l_d})]
            struct Body {{ J_d: NonstandardInertia, rho: Vector3<f64>, up: Vector3<f64> }}"
        );
        Declaration::parse(&text).expect("a declaration").derivation.clone()
    };
    let strict =
        "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 1.0 / 2.0 * h * w.dot(&(rho + F * rho)).powi(2)";
    let free = "((F - I) * J_d * (F - I).transpose()).trace() / (2 * h) - 1/2 * h * w.dot(rho + F * rho).powi(2)";
    assert_eq!(written(strict), written(free));
    let found = mistakes(&body(" + h * k.powi(2.0)"));
    assert!(found[0].message.contains("whole number"), "{found:?}");
}

/// A matrix with more columns than rows isn't read as a square one.
#[test]
fn matrices_are_square() {
    let found = mistakes(
        "#[lagrangian(group = SO3, l_d = ((F - I) * C * C.transpose() * (F - I).transpose()).trace() / h)]
        struct Body { C: SMatrix<f64, 2, 3> }",
    );
    assert!(found[0].message.contains("this type has no meaning"), "{found:?}");
    assert!(found.iter().all(|mistake| !mistake.message.contains("please report")), "{found:?}");
}

#[test]
fn mistakes_have_places() {
    let text = "#[lagrangian(\n    group = SO3,\n    l_d = w.dot(&rho) * h,\n)]\nstruct Body { rho: Vector3<f64> }";
    let found = mistakes(text);
    assert_eq!((found[0].line, found[0].column), (3, 11), "{found:?}");
    assert!(found[0].message.contains("`w`"), "{found:?}");
    assert!(LateError::Mistakes(found).to_string().starts_with("3:11: "));
    assert_eq!(mistakes("#[lagrangian(group = SO3, l_d = (F)] struct Body {}")[0].line, 1);
}

/// A text is derived once, and all threads share the declaration.
#[test]
fn threads_declare_at_once() {
    let text = body(" - h * k * F.trace()");
    let found: Vec<usize> = std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..4).map(|_| scope.spawn(|| std::ptr::from_ref(Declaration::parse(&text).unwrap()) as usize)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(found.iter().all(|&place| place == found[0]) && liestep_late::kept() >= 1);
}

#[test]
fn what_does_not_fit_is_told() {
    let says = |error: LateError, parts: &[&str]| {
        let message = error.to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    };
    let declaration = Declaration::parse(&body(" - h * k * F.trace()")).unwrap();
    says(declaration.numbers(&[("q", &[1.0])]).unwrap_err(), &["`q`", "J_d, k"]);
    says(declaration.numbers(&[("k", &[1.0, 2.0])]).unwrap_err(), &["`k`", "1 numbers", "2 were"]);
    let refused = |values: &[(&str, &[f64])]| {
        let numbers = declaration.numbers(values).unwrap();
        match Whole::<Interpreter>::of(declaration, &numbers, 0.01, Method::default()) {
            Err(WholeError::Setup(error)) => error,
            other => panic!("{other:?}"),
        }
    };
    let missing = refused(&[("J_d", &[2.0, 2.0, 1.0])]);
    assert!(matches!(missing, SetupError::Parameter { field: "k", .. }), "{missing}");
    let skew = refused(&[("k", &[1.0]), ("J_d", &[2.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0])]);
    assert!(matches!(skew, SetupError::Parameter { field: "J_d", .. }), "{skew}");
    let carried =
        "#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(&up))] struct Pull { up: Vector3<f64> }";
    let _ = mistakes(carried);
    let carried = "#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(&a))] struct Pull { a: Vector3<f64>, up: Vector3<f64> }";
    let pull = Declaration::parse(carried).unwrap();
    let numbers = pull.numbers(&[("a", &[1.0, 0.0, 0.0]), ("up", &[0.0, 0.0, 1.0])]).unwrap();
    match Whole::<Interpreter>::of(pull, &numbers, 0.01, Method::default()) {
        Err(WholeError::Declaration(error)) => says(error, &["kinetic part"]),
        other => panic!("{other:?}"),
    }
}

/// Products of sums whose expansion takes too long are refused, by a count of operations.
#[test]
fn what_takes_too_long_is_given_up() {
    let sum = (0..30).map(|k| format!("(F * a).dot(&(A * (F * (F * a)) * {k}.5))")).collect::<Vec<_>>().join(" + ");
    let text = format!(
        "#[lagrangian(group = SO3, advected(w = up), l_d = {KINETIC} - h * ({sum}) * ({sum}) * ({sum}) * w.dot(&a))]
        struct Body {{ J_d: NonstandardInertia, A: Matrix3<f64>, a: Vector3<f64>, up: Vector3<f64> }}"
    );
    let clock = Instant::now();
    let refused = Declaration::parse(&text);
    assert!(clock.elapsed() < Duration::from_secs(60), "{:?}", clock.elapsed());
    if let Err(error) = refused {
        assert!(!error.to_string().is_empty());
    }
}

/// Functions of a higher order that the library lacks are reported by their names.
#[test]
fn missing_functions_are_told() {
    for function in [Function::Stumpff(11), Function::Stumpff(0), Function::LogRatio(7)] {
        let operations = vec![Operation::Apply(function, 0)];
        let program = Program { inputs: Vec::new(), literals: vec![1.0], operations, outputs: vec![1] };
        let refused = <Interpreter as Backend<f64>>::codes(&[&program]).unwrap_err();
        assert!(matches!(&refused, LateError::Function(name) if *name == format!("{function:?}")), "{refused}");
    }
}

/// Memory of a thousand declarations; `-- --ignored` measures it.
#[test]
#[ignore = "takes minutes: `cargo test --release -p liestep-late --test hostile a_thousand -- --ignored --nocapture`"]
fn a_thousand_declarations_are_kept_in_bounded_memory() {
    let resident = || {
        let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
        pages.split(' ').nth(1)?.parse::<usize>().ok().map(|pages| pages * 4)
    };
    let Some(before) = resident() else {
        println!("skipped: this system doesn't tell the memory of a process");
        return;
    };
    for number in 0..1_000 {
        Declaration::parse(&body(&format!(" - {number}.5 * h * k * F.trace()"))).unwrap();
    }
    let kept = resident().unwrap_or(before) - before;
    println!("a thousand declarations of a body: {kept} kB");
    assert!(kept < 200_000, "{kept} kB");
}
