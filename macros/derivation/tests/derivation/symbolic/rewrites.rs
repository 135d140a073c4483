//! Each rewrite on numbers, and on numbers that break its hypothesis, where it has to be wrong: otherwise the test
//! would pass without the rewrite.

use crate::common::numeric::{Matrix, Values, value};
use crate::common::random::{Random, World};
use liestep_derivation::mathematics::symbolic::word::canonical_trace;
use liestep_derivation::mathematics::symbolic::{
    Expression, Factor, Function, Rational, Stage, Structure, SymbolId, Symbols,
};

/// Compares an expression in normal form with numbers, where its hypothesis holds and where it is broken.
struct Law {
    world: World,
    broken: Values,
}

impl Law {
    /// A law about one symbol, whose structure the broken values lack.
    fn about(seed: u64, promised: fn(&World) -> SymbolId) -> Self {
        let mut random = Random::new(seed);
        let world = World::new(&mut random);
        let mut broken = world.values.clone();
        let id = promised(&world);
        broken.insert(id, random.matrix(3, 3));
        Self { world, broken }
    }

    fn holds_only_with_promise(&self, expression: &Expression, direct: impl Fn(&Values) -> Matrix) {
        let symbols = &self.world.symbols;
        let found = value(expression, symbols, &self.world.values);
        let expected = direct(&self.world.values);
        assert!(found.agrees(&expected, 1e-12), "{found:?} instead of {expected:?}");
        let (found, expected) = (value(expression, symbols, &self.broken), direct(&self.broken));
        assert!(!found.agrees(&expected, 1e-3), "holds without its hypothesis: {found:?}");
    }
}

fn seeds() -> impl Iterator<Item = u64> {
    1..=50
}

#[test]
fn inverse_neighbours_cancel() {
    for seed in seeds() {
        let law = Law::about(seed, |world| world.f);
        let w = &law.world;
        let [f, a, s] = [w.f, w.a, w.symmetric].map(|id| w.expression(id));
        let f_t = f.transpose(&w.symbols);
        let times = |x: &Expression, y: &Expression| x.times(y, &w.symbols);
        let inner = times(&times(&a, &times(&f_t, &f)), &s);
        assert_eq!(inner, times(&a, &s));
        assert_eq!(times(&f, &f_t), Expression::identity(3));
        law.holds_only_with_promise(&inner, |v| {
            v[&w.a].times(&v[&w.f].transpose()).times(&v[&w.f]).times(&v[&w.symmetric])
        });
        law.holds_only_with_promise(&times(&f, &f_t), |v| v[&w.f].times(&v[&w.f].transpose()));
        // A rotation and its transpose cancel across the ends of a trace.
        let cyclic = times(&times(&f, &a), &f_t).trace(&w.symbols);
        assert_eq!(cyclic, a.trace(&w.symbols));
        law.holds_only_with_promise(&cyclic, |v| {
            Matrix::scalar(v[&w.f].times(&v[&w.a]).times(&v[&w.f].transpose()).trace())
        });
    }
}

#[test]
fn a_general_matrix_does_not_cancel() {
    let w = World::new(&mut Random::new(1));
    let a = w.expression(w.a);
    let product = a.transpose(&w.symbols).times(&a, &w.symbols);
    assert_ne!(product, Expression::identity(3));
    assert!(value(&product, &w.symbols, &w.values).agrees(&w.values[&w.a].transpose().times(&w.values[&w.a]), 1e-14));
}

#[test]
fn traces_rotate() {
    for seed in seeds() {
        let w = World::new(&mut Random::new(seed));
        let [f, a, b] = [w.f, w.a, w.b].map(|id| w.expression(id));
        let product = |x: &Expression, y: &Expression, z: &Expression| x.times(y, &w.symbols).times(z, &w.symbols);
        let (one, other, wrong) = (product(&f, &a, &b), product(&b, &f, &a), product(&a, &f, &b));
        let trace = |x: &Expression| x.trace(&w.symbols);
        assert_eq!(trace(&one), trace(&other));
        let number = |x: &Expression| value(x, &w.symbols, &w.values);
        assert!(number(&trace(&one)).agrees(&number(&trace(&other)), 1e-12));
        assert!(number(&trace(&one)).agrees(&Matrix::scalar(number(&one).trace()), 1e-12));
        // The control: another order of factors has another trace, and without the trace the rotated product is another
        // matrix.
        assert_ne!(trace(&one), trace(&wrong));
        assert!(!number(&trace(&one)).agrees(&number(&trace(&wrong)), 1e-3));
        assert_ne!(one, other);
        assert!(!number(&one).agrees(&number(&other), 1e-3));
    }
}

#[test]
fn a_trace_equals_that_of_the_transpose() {
    for seed in seeds() {
        let w = World::new(&mut Random::new(seed));
        let [f, a, b] = [w.f, w.a, w.b].map(|id| w.expression(id));
        let product = f.times(&a, &w.symbols).times(&b, &w.symbols);
        let turned = product.transpose(&w.symbols);
        assert_eq!(product.trace(&w.symbols), turned.trace(&w.symbols));
        // The control: transposing the factors without reversing them gives another number.
        let [f_t, a_t, b_t] = [&f, &a, &b].map(|x| x.transpose(&w.symbols));
        let unreversed = f_t.times(&a_t, &w.symbols).times(&b_t, &w.symbols).trace(&w.symbols);
        assert_ne!(product.trace(&w.symbols), unreversed);
        let number = |x: &Expression| value(x, &w.symbols, &w.values);
        assert!(number(&turned).agrees(&number(&product).transpose(), 1e-12));
        assert!(!number(&unreversed).agrees(&number(&product.trace(&w.symbols)), 1e-3));
    }
}

#[test]
fn declared_symmetry() {
    for (seed, promised) in seeds().flat_map(|seed| {
        let diagonal: fn(&World) -> SymbolId = |world| world.diagonal;
        [(seed, (|world| world.symmetric) as fn(&World) -> SymbolId), (seed, diagonal)]
    }) {
        let law = Law::about(seed, promised);
        let w = &law.world;
        let id = promised(w);
        let turned = w.expression(id).transpose(&w.symbols);
        assert_eq!(turned, w.expression(id));
        law.holds_only_with_promise(&turned, |v| v[&id].transpose());
        // vee(S) = 0, and tr(F S) = tr(Fᵀ S).
        let vee = w.expression(id).vee(&w.symbols);
        assert!(vee.is_zero());
        law.holds_only_with_promise(&vee, |v| v[&id].vee());
        let f_t = w.expression(w.f).transpose(&w.symbols);
        let trace = f_t.times(&w.expression(id), &w.symbols).trace(&w.symbols);
        assert_eq!(trace, w.expression(w.f).times(&w.expression(id), &w.symbols).trace(&w.symbols));
        law.holds_only_with_promise(&trace.clone().scaled(Rational::integer(2)), |v| {
            Matrix::scalar(v[&w.f].plus(&v[&w.f].transpose()).times(&v[&id]).trace())
        });
    }
}

#[test]
fn declared_skewness() {
    for seed in seeds() {
        let law = Law::about(seed, |world| world.e);
        let w = &law.world;
        let [e, s, u] = [w.e, w.symmetric, w.u].map(|id| w.expression(id));
        let turned = e.transpose(&w.symbols);
        assert_eq!(turned, e.clone().scaled(-Rational::ONE));
        law.holds_only_with_promise(&turned, |v| v[&w.e].transpose());
        let trace = e.trace(&w.symbols);
        let product = e.times(&s, &w.symbols).trace(&w.symbols);
        let form = u.transpose(&w.symbols).times(&e, &w.symbols).times(&u, &w.symbols);
        assert!(trace.is_zero() && product.is_zero() && form.is_zero());
        law.holds_only_with_promise(&trace, |v| Matrix::scalar(v[&w.e].trace()));
        law.holds_only_with_promise(&product, |v| Matrix::scalar(v[&w.e].times(&v[&w.symmetric]).trace()));
        law.holds_only_with_promise(&form, |v| v[&w.u].transpose().times(&v[&w.e]).times(&v[&w.u]));
    }
}

/// `u · (v × w)`, with another matrix than `v̂` in the middle as the control.
#[test]
fn triple_products_are_sorted() {
    for seed in seeds() {
        let mut random = Random::new(seed);
        let w = World::new(&mut random);
        let triple = |ids: [SymbolId; 3]| {
            let [x, y, z] = ids.map(|id| w.expression(id));
            x.transpose(&w.symbols).times(&y.hat(&w.symbols), &w.symbols).times(&z, &w.symbols)
        };
        let one = triple([w.u, w.v, w.w]);
        assert_eq!(one.len(), 1);
        for rotated in [[w.v, w.w, w.u], [w.w, w.u, w.v]] {
            assert_eq!(triple(rotated), one);
        }
        for exchanged in [[w.v, w.u, w.w], [w.u, w.w, w.v], [w.w, w.v, w.u]] {
            assert_eq!(triple(exchanged), one.clone().scaled(-Rational::ONE));
        }
        for repeated in [[w.u, w.u, w.v], [w.u, w.v, w.u], [w.v, w.u, w.u]] {
            assert!(triple(repeated).is_zero());
        }
        let [x, y, z] = [w.u, w.v, w.w].map(|id| &w.values[&id]);
        let form = |middle: &Matrix, left: &Matrix, right: &Matrix| left.transpose().times(middle).times(right);
        assert!(value(&one, &w.symbols, &w.values).agrees(&form(&y.hat(), x, z), 1e-12));
        let general = random.matrix(3, 3);
        assert!(!form(&general, x, z).agrees(&form(&general, z, x).scaled(-1.0), 1e-3));
        assert!(form(&general, x, x).size() > 1e-4);
    }
}

/// Triple products of words instead of symbols, on either side of the hat and inside.
#[test]
fn triple_products_of_words() {
    for seed in seeds() {
        let w = World::new(&mut Random::new(seed));
        let [f, a, s, u, v, z] = [w.f, w.a, w.symmetric, w.u, w.v, w.w].map(|id| w.expression(id));
        let (fu, av, sz) = (f.times(&u, &w.symbols), a.times(&v, &w.symbols), s.times(&z, &w.symbols));
        let triple = |x: &Expression, y: &Expression, z: &Expression| {
            x.transpose(&w.symbols).times(&y.hat(&w.symbols), &w.symbols).times(z, &w.symbols)
        };
        assert_eq!(triple(&fu, &av, &sz), triple(&av, &sz, &fu));
        assert_eq!(triple(&fu, &av, &sz), triple(&sz, &av, &fu).scaled(-Rational::ONE));
        let number = |x: &Expression| value(x, &w.symbols, &w.values);
        let direct = number(&fu).transpose().times(&number(&av).hat()).times(&number(&sz));
        assert!(number(&triple(&fu, &av, &sz)).agrees(&direct, 1e-12));
    }
}

/// `Fᵀ û F = (Fᵀu)^` needs a determinant of one: under a reflection the sign changes.
#[test]
fn hats_turn_with_rotations() {
    for seed in seeds() {
        let mut law = Law::about(seed, |world| world.f);
        let reflection = law.world.values[&law.world.f].scaled(-1.0);
        law.broken.insert(law.world.f, reflection);
        let w = &law.world;
        let (f, u) = (w.expression(w.f), w.expression(w.u));
        let f_t = f.transpose(&w.symbols);
        let turned = f_t.times(&u.hat(&w.symbols), &w.symbols).times(&f, &w.symbols);
        assert_eq!(turned, f_t.times(&u, &w.symbols).hat(&w.symbols));
        law.holds_only_with_promise(&turned, |v| v[&w.f].transpose().times(&v[&w.u].hat()).times(&v[&w.f]));
        let turned = f.times(&u.hat(&w.symbols), &w.symbols).times(&f_t, &w.symbols);
        assert_eq!(turned, f.times(&u, &w.symbols).hat(&w.symbols));
        law.holds_only_with_promise(&turned, |v| v[&w.f].times(&v[&w.u].hat()).times(&v[&w.f].transpose()));
    }
    // An orthogonal matrix may have the determinant −1.
    let mut symbols = Symbols::default();
    let f = symbols.add("F", (3, 3), Structure::Orthogonal, Stage::Iteration);
    let u = symbols.add("u", (3, 1), Structure::General, Stage::Step);
    let [f, u] = [f, u].map(|id| Expression::symbol(id, &symbols));
    let f_t = f.transpose(&symbols);
    let turned = f_t.times(&u.hat(&symbols), &symbols).times(&f, &symbols);
    assert_eq!(turned.longest_word(), 4);
    assert_ne!(turned, f_t.times(&u, &symbols).hat(&symbols));
}

#[test]
fn hat_and_vee_undo_each_other() {
    for seed in seeds() {
        let w = World::new(&mut Random::new(seed));
        let (a, u) = (w.expression(w.a), w.expression(w.u));
        assert_eq!(u.hat(&w.symbols).vee(&w.symbols), u);
        let skew = a.vee(&w.symbols).hat(&w.symbols);
        assert_eq!(skew, a.clone().skew_part(&w.symbols));
        let number = |x: &Expression| value(x, &w.symbols, &w.values);
        assert!(number(&skew).agrees(&number(&a).vee().hat(), 1e-14));
        // The control: for a matrix that isn't skew, hat(vee) is the skew part only.
        assert!(!number(&skew).agrees(&number(&a), 1e-3));
        // vee(Aᵀ) = −vee(A).
        assert_eq!(a.transpose(&w.symbols).vee(&w.symbols), a.vee(&w.symbols).scaled(-Rational::ONE));
    }
}

#[test]
fn outer_products_are_cut() {
    for seed in seeds() {
        let w = World::new(&mut Random::new(seed));
        let [a, u, v] = [w.a, w.u, w.v].map(|id| w.expression(id));
        let outer = u.times(&v.transpose(&w.symbols), &w.symbols).times(&a, &w.symbols);
        let form = v.transpose(&w.symbols).times(&a, &w.symbols).times(&u, &w.symbols);
        let exchanged = u.transpose(&w.symbols).times(&a, &w.symbols).times(&v, &w.symbols);
        let trace = outer.trace(&w.symbols);
        assert_eq!(trace, form);
        let number = |x: &Expression| value(x, &w.symbols, &w.values);
        let [a, u, v] = [w.a, w.u, w.v].map(|id| &w.values[&id]);
        assert!(number(&trace).agrees(&Matrix::scalar(u.times(&v.transpose()).times(a).trace()), 1e-12));
        assert!(!number(&exchanged).agrees(&number(&form), 1e-3));
        // The word is cut in its middle: u (vᵀ A u) vᵀ.
        let middle = [w.u, w.v, w.a].map(|id| w.expression(id));
        let [x, y, m] = &middle;
        let y_t = y.transpose(&w.symbols);
        let long = [&y_t, m, x, &y_t].iter().fold(x.clone(), |product, next| product.times(next, &w.symbols));
        let direct = [&v.transpose(), a, u, &v.transpose()].iter().fold(u.clone(), |product, next| product.times(next));
        assert!(number(&long).agrees(&direct, 1e-12));
        assert!(long.terms().all(|(monomial, _)| monomial.scalars.len() == 1 && monomial.word.len() == 2));
    }
}

#[test]
fn units_pick_entries() {
    let w = World::new(&mut Random::new(3));
    let unit = |index, transposed| {
        let shape = if transposed { (1, 3) } else { (3, 1) };
        Expression::from_word(vec![Factor::Unit { index, size: 3, transposed }], shape, &w.symbols)
    };
    for (row, column) in (0..9).map(|at| (at / 3, at % 3)) {
        let entry = unit(row, true).times(&w.expression(w.a), &w.symbols).times(&unit(column, false), &w.symbols);
        let found = value(&entry, &w.symbols, &w.values).at(0, 0);
        assert!((found - w.values[&w.a].at(row, column)).abs() < 1e-15);
        if row != column {
            assert!((found - w.values[&w.a].at(column, row)).abs() > 1e-3);
        }
        assert_eq!(unit(row, true).transpose(&w.symbols), unit(row, false));
    }
}

#[test]
fn powers() {
    for seed in seeds() {
        let w = World::new(&mut Random::new(seed));
        let (h, k) = (w.expression(w.h), w.expression(w.k));
        let sum = h.clone().plus(k.clone().scaled(Rational::integer(2)));
        let number = |x: &Expression| value(x, &w.symbols, &w.values).at(0, 0);
        for exponent in -6..=6 {
            for base in [&h, &sum, &h.times(&k, &w.symbols).scaled(Rational::new(-2, 3))] {
                let expected = number(base).powi(exponent);
                let found = number(&base.clone().power(exponent, &w.symbols));
                assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} instead of {expected}");
                let wrong = number(base).powi(exponent + 1);
                assert!((found - wrong).abs() > 1e-6 * wrong.abs());
            }
        }
        let cancelled = h.clone().power(3, &w.symbols).times(&h.clone().power(-3, &w.symbols), &w.symbols);
        assert_eq!(cancelled, Expression::identity(1));
        let closed = sum.clone().power(-2, &w.symbols).times(&sum.clone().power(-3, &w.symbols), &w.symbols);
        assert_eq!(closed, sum.power(-5, &w.symbols));
    }
}

#[test]
fn scalars_fold() {
    let w = World::new(&mut Random::new(1));
    let (h, a) = (w.expression(w.h), w.expression(w.a));
    let third = |x: &Expression| x.clone().scaled(Rational::new(1, 3));
    assert_eq!(third(&a).plus(third(&a)).plus(third(&a)), a);
    assert!(a.clone().minus(a.clone()).is_zero());
    assert_eq!(h.times(&a, &w.symbols), a.times(&h, &w.symbols));
    assert_eq!(a.times(&Expression::identity(3), &w.symbols), a);
    assert_eq!(Expression::identity(3).trace(&w.symbols), Expression::rational(Rational::integer(3)));
    // A quotient of two different scalars stays.
    let k = w.expression(w.k);
    assert_ne!(h.times(&k.clone().power(-1, &w.symbols), &w.symbols), Expression::identity(1));
    let sine = |x: &Expression| Expression::function(Function::Sin, x.clone());
    assert!(sine(&h).minus(sine(&h)).is_zero());
    assert!(!sine(&h).minus(sine(&k)).is_zero());
}

#[test]
fn canonical_forms_do_not_depend_on_where_a_trace_begins() {
    let w = World::new(&mut Random::new(1));
    let word = [w.f, w.a, w.b, w.e, w.symmetric].map(Factor::symbol);
    let expected = canonical_trace(word.to_vec(), &w.symbols);
    for start in 1..word.len() {
        let (tail, head) = word.split_at(start);
        assert_eq!(canonical_trace([head, tail].concat(), &w.symbols), expected);
    }
}
