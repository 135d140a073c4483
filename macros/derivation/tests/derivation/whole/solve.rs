//! Newton's iterations: the elimination of any system, and the derivative of the retraction.

use liestep_derivation::judged::verify::dual::Dual;
use liestep_derivation::judged::verify::number::Number;
use liestep_derivation::judged::verify::residue::Residue;
use liestep_derivation::judged::verify::value::Value;
use liestep_derivation::whole::{Value as Symbol, Words};
use liestep_derivation::{Array, Program, Source, StagedDeclaration};

use super::common::{Generators, StepInputs, affine, are_equal, declared, groups, named, run, sl3, so};

/// Asserts that the solution satisfies `J u = r`, and that the determinants are those of the blocks.
fn solves(name: &str, staged: &StagedDeclaration, is_zero: impl Fn(usize, usize) -> bool) {
    let mut next = Residue::stream(17);
    let moving = StepInputs::of(staged, &mut next);
    let (n, dets) = (moving.step.sizes.n, moving.step.sizes.dets);
    let mut constants: Vec<Residue> = (0..n + n * n).map(|_| next()).collect();
    for at in (0..n * n).filter(|at| is_zero(at / n, at % n)) {
        constants[n + at] = Residue::ZERO;
    }
    let jacobian = Value { rows: n, columns: n, entries: constants[n..].to_vec() };
    let moving = moving.with(Array::Constants, &constants);
    let found = moving.numbers.run(&moving.step.programs.iterate);
    let check = |found: &[Residue], residual: &[Residue]| {
        let update: Vec<Residue> = moving.half.iter().zip(found).map(|(&half, &next)| half - next).collect();
        assert!(are_equal(&jacobian.times(&Value::column(&update)), &Value::column(residual)), "{name}");
        let square = |x: &[Residue]| x.iter().fold(Residue::ZERO, |sum, &x| sum + x * x);
        assert_eq!(found[n..n + 2], [square(&update), square(&found[..n])], "{name}");
    };
    let residual = |constants: &[Residue]| {
        let image = jacobian.times(&Value::column(&moving.half));
        constants.iter().zip(&image.entries).map(|(&c, &image)| c + image).collect::<Vec<Residue>>()
    };
    check(&found, &residual(&constants[..n]));
    assert_eq!(found.len(), n + 2 + 2 * dets + n * n, "{name}");
    // A second solve has another residual and the old factors.
    let other: Vec<Residue> = (0..n).map(|_| next()).collect();
    let others = [other.as_slice(), &constants[n..]].concat();
    let again = moving.numbers.with(Array::Factors, &found[n + 2..]).with(Array::Constants, &others);
    check(&again.run(&moving.step.programs.again), &residual(&other));
    let rest = moving.numbers.run(&moving.step.programs.rest);
    assert_eq!(rest[0], jacobian.trace(), "{name}");
    assert_eq!(rest[1..], found[n + 2..n + 2 + 2 * dets], "{name}");
    let product = |first: usize| (0..dets).fold(Residue::ONE, |product, k| product * rest[1 + 2 * k + first]);
    let reciprocal = jacobian.inverse();
    let minor = Value::new(n - 1, n - 1, |i, j| jacobian.at(i + 1, j + 1));
    let determinant = if n == 1 { jacobian.at(0, 0) } else { determinant_of(&minor) / reciprocal.at(0, 0) };
    assert_eq!(product(0), determinant, "{name}");
    let diagonal = (0..n).fold(Residue::ONE, |product, k| product * jacobian.at(k, k));
    assert!(dets == 1 || product(1) == diagonal, "{name}");
}

fn determinant_of(m: &Value<Residue>) -> Residue {
    match m.rows {
        0 => Residue::ONE,
        1 => m.at(0, 0),
        n => determinant_of(&Value::new(n - 1, n - 1, |i, j| m.at(i + 1, j + 1))) / m.inverse().at(0, 0),
    }
}

#[test]
fn systems_of_one_factor() {
    for (name, generators) in groups() {
        solves(name, &declared(&[generators], Vec::new()), |_, _| false);
    }
}

#[test]
fn systems_of_several_factors() {
    let three: [Generators; 3] = [named("SO3"), named("SO3"), named("R3")];
    solves("all together", &declared(&three, Vec::new()), |_, _| false);
    let block = |ends: &'static [usize]| move |at: usize| ends.iter().filter(|&&end| end <= at).count();
    let apart = |factors: &[Generators], ends: &'static [usize]| {
        let staged = StagedDeclaration { blocks: ends.to_vec(), ..declared(factors, Vec::new()) };
        solves(&format!("{ends:?}"), &staged, |i, j| block(ends)(i) != block(ends)(j));
    };
    apart(&three, &[3, 6]);
    apart(&three, &[6]);
    apart(&[named("SO2"), named("SE2"), so(4), named("R1")], &[1, 4]);
    // Three blocks, of one, two and four components.
    apart(&[named("R1"), named("R2"), so(4)], &[1, 3]);
}

/// A declaration with the residual `Σ c_ik D_k` of the entries of all `F − I`, and its derivative along `exp(t E_j) F`.
fn of_increments(factors: &[Generators]) -> StagedDeclaration {
    let staged = declared(factors, Vec::new());
    let n: usize = factors.iter().map(Vec::len).sum();
    let entries: usize = factors.iter().map(|one| one[0].len()).sum();
    let coefficient = |i: usize, at: usize| Symbol::Input(Source::new(Array::Parameters, i * entries + at));
    let increment = |at: usize| Symbol::Input(Source::new(Array::Increment, at));
    let mut words = Words::default();
    let d: Vec<Symbol> = (0..entries).map(increment).collect();
    let row = |i: usize| (0..entries).map(|at| coefficient(i, at)).collect::<Vec<Symbol>>();
    let mut outputs: Vec<Symbol> = (0..n).map(|i| words.dot(&row(i), &d)).collect();
    let residual = words.program(&outputs);
    let mut columns = Vec::new();
    let mut first = 0;
    for generators in factors {
        let size = generators[0].len().isqrt();
        for e in generators {
            let mut column = vec![Symbol::ZERO; entries];
            for at in 0..size * size {
                let (i, j) = (at / size, at % size);
                let own: Vec<Symbol> = (0..size).map(|k| Symbol::of(e[i * size + k])).collect();
                let f: Vec<Symbol> =
                    (0..size).map(|k| words.add(increment(first + k * size + j), Symbol::one_if(k == j))).collect();
                column[first + at] = words.dot(&own, &f);
            }
            columns.push(column);
        }
        first += size * size;
    }
    for i in 0..n {
        outputs.extend(columns.iter().map(|column| words.dot(&row(i), column)));
    }
    let mut staged = StagedDeclaration { in_increment: true, ..staged };
    staged.programs.newton_system = words.program(&outputs);
    staged.programs.newton_residual = residual;
    staged
}

/// A Newton iteration solves the linearised equation: the derivative by half the coordinates is that of dual numbers.
fn is_linearised(name: &str, factors: &[Generators]) {
    let staged = of_increments(factors);
    let mut next = Residue::stream(19);
    let moving = StepInputs::of(&staged, &mut next);
    let sizes = moving.step.sizes.clone();
    let (n, coefficients) = (sizes.n, (0..sizes.n * sizes.entries).map(|_| next()).collect::<Vec<Residue>>());
    let moving = moving.with(Array::Parameters, &coefficients);
    // The residual of dual half coordinates, through the attitude after a step from the identity.
    let along = |direction: usize| -> Vec<Dual<Residue>> {
        let half = |at: usize| Dual {
            value: moving.half[at],
            slope: if at == direction { Residue::ONE } else { Residue::ZERO },
        };
        let identity: Vec<bool> = moving.step.factors.iter().flat_map(|f| identity(f.size())).collect();
        let one = |at: usize| if identity[at] { Dual::ONE } else { Dual::ZERO };
        let end = run(&moving.step.programs.finish, |source| match source.array {
            Array::Half => half(source.at),
            Array::Attitude => one(source.at),
            _ => Dual::ZERO,
        });
        let d: Vec<Dual<Residue>> = (0..sizes.entries).map(|at| end[at] - one(at)).collect();
        run(&staged.programs.newton_residual, |source| match source.array {
            Array::Increment => d[source.at],
            _ => Dual::constant(coefficients[source.at]),
        })
    };
    let slopes: Vec<Vec<Dual<Residue>>> = (0..n).map(along).collect();
    let jacobian = Value::new(n, n, |i, j| slopes[j][i].slope);
    let found = moving.numbers.run(&moving.step.programs.iterate);
    let update: Vec<Residue> = moving.half.iter().zip(&found).map(|(&half, &next)| half - next).collect();
    let residual: Vec<Residue> = slopes[0].iter().map(|entry| entry.value).collect();
    assert!(are_equal(&jacobian.times(&Value::column(&update)), &Value::column(&residual)), "{name}");
}

fn identity(size: usize) -> impl Iterator<Item = bool> {
    (0..size * size).map(move |at| at / size == at % size)
}

#[test]
fn tangents_are_derivatives() {
    for (name, generators) in groups() {
        is_linearised(name, &[generators]);
    }
    is_linearised("a product", &[named("SO3"), sl3(), affine(2), named("R2")]);
}

/// A solve of three components has the library's order of operations: the determinant by the first column.
#[test]
fn a_system_of_three_has_few_operations() {
    let staged = declared(&[named("SO3")], Vec::new());
    let count = |program: &Program| program.operations.len();
    let programs = StepInputs::of(&staged, Residue::stream(1)).step.programs;
    // Counts of operations: the residual has three rows of six; nine minors have three operations each, and the
    // determinant five; a solution has the reciprocal and three rows of six, and both squares five.
    assert_eq!((count(&programs.iterate), count(&programs.again)), (18 + 32 + 32, 18 + 32));
}
