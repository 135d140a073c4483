//! Derivatives by dual numbers.

use liestep_derivation::judged::verify::dual::Dual;
use liestep_derivation::judged::verify::number::Number as _;
use liestep_derivation::mathematics::symbolic::Function;

/// Derivatives by dual numbers agree with central differences.
#[test]
fn derivatives() {
    let functions = [Function::Sqrt, Function::Ln, Function::Exp, Function::Sin, Function::Cos];
    let families = [0, 1, 2, 5].into_iter().flat_map(|k| [Function::Stumpff(k), Function::LogRatio(k)]);
    let at = |x: f64| Dual { value: x, slope: 1.0 };
    let assert_slope = |f: &dyn Fn(Dual<f64>) -> Dual<f64>, name: &str| {
        let difference = (f(at(0.3 + 1e-5)).value - f(at(0.3 - 1e-5)).value) / 2e-5;
        let slope = f(at(0.3)).slope;
        assert!((slope - difference).abs() < 1e-7 * (1.0 + slope.abs()), "{name}: {slope} and {difference}");
    };
    for function in functions.into_iter().chain(families) {
        assert_slope(&|x| x.apply(function), &format!("{function:?}"));
    }
    for exponent in [-2, 0, 1, 3] {
        assert_slope(&|x| x.power(exponent), "power");
    }
    assert_slope(&|x| (x * x - Dual::ONE) / (x + x), "quotient");
}
