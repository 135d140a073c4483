//! Declarations that are too large get an error, quickly, on an ordinary stack.

use std::time::{Duration, Instant};

use liestep_derivation::program::kernel;

use crate::common::{derived, expanded, is_refused};

/// The default stack of a thread, in bytes.
const STACK: usize = 2 << 20;
/// The time after which an expansion counts as a hang, on a machine shared with twenty others: the largest accepted
/// declaration takes some seconds of its own.
const PATIENCE: Duration = Duration::from_secs(600);

const ITEM: &str =
    "struct Top { J_d: NonstandardInertia, A: Matrix3<f64>, k: f64, rho: Vector3<f64>, up: Vector3<f64> }";
const KINETIC: &str = "(J_d.trace() - (F * J_d).trace()) / h + h * k * w.dot(&(A * rho))";

/// Expands on a small stack, and returns whether the declaration was refused.
fn refused(l_d: &str) -> bool {
    let start = Instant::now();
    let arguments = format!("group = SO3, advected(w = up), l_d = {l_d}");
    let expansion = move || is_refused(&expanded(&arguments, ITEM));
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(expansion).expect("a thread");
    let refused = thread.join().expect("no panic");
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    refused
}

fn with_term(term: &str) -> String {
    format!("{{ {term} }}")
}

#[test]
fn nested_tokens() {
    let brackets = [["(", ")"], ["{", "}"], ["vee(", ")"], ["[", "]"], ["rho[", "]"], ["-(", ")"]];
    let prefixes = "-~!~&~*~..~&mut ~k = ~|k| ~return ~break ~if k {} else ~- #[a] ~k::<~k as fn() -> ~async move ~k < ~k.k::<~let k = ~k as &'a ~k += ~match k ~unsafe ";
    let closed = brackets.iter().map(|[open, close]| (*open, *close));
    for (open, close) in closed.chain(prefixes.split('~').map(|open| (open, ""))) {
        for count in [20, 60, 400, 2_000, 100_000] {
            // The compiler's lexer has its own limit for brackets, and that of this test would recurse.
            if !close.is_empty() && count > 400 {
                continue;
            }
            let nested = format!("{}k{}", open.repeat(count), close.repeat(count));
            let result = refused(&with_term(&format!("{KINETIC} + h * {nested}")));
            assert!(result || count <= 20, "{open} {count}");
            refused(&nested);
        }
    }
}

#[test]
fn long_sums_and_products() {
    for (operator, operand) in [("+", "k"), ("-", "k"), ("*", "k"), ("/", "k"), ("+", "F[(0, 1)]"), ("*", "F.trace()")]
    {
        for count in [100, 900, 2_400, 50_000] {
            let term = vec![operand; count].join(operator);
            let result = refused(&with_term(&format!("{KINETIC} + h * ({term})")));
            assert!(result || count <= 100);
        }
    }
    let calls = ".sin()".repeat(3_000);
    assert!(refused(&with_term(&format!("{KINETIC} + h * k{calls}"))));
    let transposes = ".transpose()".repeat(3_000);
    assert!(refused(&with_term(&format!("{KINETIC} + h * A{transposes}.trace()"))));
}

/// A chain of `let`s, each of which doubles the one before: `let b = a ∘ a; let c = b ∘ b; …`.
fn doubling(first: &str, step: impl Fn(&str) -> String, last: impl Fn(&str) -> String, count: usize) -> String {
    let lets = (0..count).map(|at| format!("let a{} = {};", at + 1, step(&format!("a{at}"))));
    let lets = lets.collect::<Vec<_>>().join(" ");
    format!("{{ let a0 = {first}; {lets} {KINETIC} + h * {} }}", last(&format!("a{count}")))
}

#[test]
fn doubling_bindings() {
    for count in [3, 4, 6, 20, 60, 200] {
        let plain = |a: &str| a.to_owned();
        let trace = |a: &str| format!("{a}.trace()");
        let square = |a: &str| format!("{a} * {a}");
        let cases = [
            doubling("k", square, plain, count),
            doubling("k + F.trace()", square, plain, count),
            doubling("F * A", square, trace, count),
            doubling("F + A", square, trace, count),
            doubling("F * A", |a| format!("{a} * A * {a}.transpose()"), trace, count),
            doubling("w.dot(&(F * rho))", |a| format!("{a}.sin() * {a}.cos()"), plain, count),
            doubling("w.dot(&(F * rho))", |a| format!("{a}.sin() + {a}.cos()"), plain, count),
            doubling("w.dot(&(F * rho))", |a| format!("1.0 / (3.0 + {a} * {a})"), plain, count),
            doubling("F * rho", |a| format!("{a}.cross(&(A * {a}))"), |a| format!("{a}.dot(&w)"), count),
            doubling("F * rho", |a| format!("{a}.component_mul(&{a})"), |a| format!("{a}.dot(&w)"), count),
            doubling("F * rho", |a| format!("vee(A * {a}.cross_matrix() * A)"), |a| format!("{a}.dot(&w)"), count),
            doubling("3.0 * k", |a| format!("{a}.powi(16)"), plain, count),
            doubling("F.trace()", |a| format!("{a}.powi(16)"), plain, count),
            doubling("F.trace()", |a| format!("{a}.powi(-16)"), plain, count),
            doubling("k + F.trace()", |a| format!("{a}.powi(16)"), plain, count),
            doubling("k + F.trace()", |a| format!("{a}.powi(4)"), plain, count),
            doubling("k + F.trace()", |a| format!("({a}.powi(-3) + 1.0)"), plain, count),
            doubling("1.5", |a| format!("{a} * {a}"), plain, count),
            doubling("F.trace()", |a| format!("(2.0 + {a}).sqrt()"), plain, count),
        ];
        for case in cases {
            let result = refused(&case);
            assert!(result || count <= 60, "{count}");
        }
    }
}

#[test]
fn many_factors() {
    for count in [1, 2, 4, 8, 16, 24, 40, 100] {
        for unit in ["F * A", "F * J_d", "(F + A)", "F.transpose() * A * F"] {
            let product = vec![unit; count].join(" * ");
            let result = refused(&with_term(&format!("{KINETIC} + h * ({product}).trace()")));
            assert!(if count < 3 { !result } else { result || count < 40 }, "{count} {unit}");
        }
        for unit in ["F.trace()", "w.dot(&(F * A * rho))"] {
            let product = vec![unit; count].join(" * ");
            let result = refused(&with_term(&format!("{KINETIC} + h * {product}")));
            assert!(!result || count > 2, "{count} {unit}");
        }
    }
}

/// A rotation of the first two rows and all shifts: emitted code grows like the fourth power of the rows.
#[test]
fn groups_of_many_rows() {
    let operations = |rows: usize| {
        let generator = |entries: &[(usize, usize, &str)]| {
            let entry = |i, j| entries.iter().find(|one| (one.0, one.1) == (i, j)).map_or("0.0", |one| one.2);
            let row = |i| format!("[{}]", (0..rows).map(|j| entry(i, j)).collect::<Vec<_>>().join(", "));
            format!("[{}]", (0..rows).map(row).collect::<Vec<_>>().join(", "))
        };
        let shifts = (0..rows - 1).map(|i| generator(&[(i, rows - 1, "1.0")]));
        let generators: Vec<String> = shifts.chain([generator(&[(0, 1, "-1.0"), (1, 0, "1.0")])]).collect();
        let l_d = "((F - I) * J * J.transpose() * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(&(F * r))";
        let group = format!("group = Mine, generators = [{}]", generators.join(", "));
        let arguments = format!("{group}, advected(w = up), l_d = {l_d}");
        let vector = format!("SVector<f64, {rows}>");
        let item = format!("struct Body {{ J: SMatrix<f64, {rows}, {rows}>, r: {vector}, up: {vector} }}");
        let expansion = expanded(&arguments, &item);
        assert!(!is_refused(&expansion), "{rows}: {expansion}");
        kernel(&derived(&arguments, &item)).cost()
    };
    let least = operations(4);
    for rows in 5..=8 {
        let found = operations(rows);
        assert!(found * 4_usize.pow(4) <= least * rows.pow(4), "{found} of {rows} rows, {least} of four");
    }
}

#[test]
fn large_literals() {
    for literal in ["1e300", "1e-300", "1e38", "1e999999999999", "123456789012345678901234567890123456789.0", "0.1e-37"]
    {
        for term in [format!("{literal} * k"), format!("k.powi(2) * {literal} * {literal}"), format!("k / {literal}")] {
            refused(&with_term(&format!("{KINETIC} + h * {term}")));
        }
    }
    assert!(refused(&with_term(&format!("{KINETIC} + h * k * {}.0", "9".repeat(4_000)))));
    assert!(refused(&with_term(&format!("{KINETIC} + h * k.powi({})", "9".repeat(4_000)))));
    assert!(refused(&with_term(&format!("{KINETIC} + h * rho[{}]", "9".repeat(40)))));
}

#[test]
fn many_fields_and_keys() {
    let fields = (0..3_000).map(|at| format!("k{at}: f64")).collect::<Vec<_>>().join(", ");
    let item = format!("struct Top {{ J_d: NonstandardInertia, {fields} }}");
    let start = Instant::now();
    let expansion = expanded("group = SO3, l_d = (F * J_d).trace() / h", &item);
    assert!(is_refused(&expansion) && start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    let groups = "group = SO3, ".repeat(1_000);
    assert!(is_refused(&expanded(&format!("{groups} l_d = {KINETIC}"), ITEM)));
}
