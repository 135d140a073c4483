//! DOP853 as the library `differential-equations` has it: its own step control, and one point of output.

use differential_equations::ode::ODE;
use differential_equations::prelude::{ExplicitRungeKutta, IVP};
use differential_equations::traits::State;
use workbench::top_equations::State as Numbers;

use super::rates::Rates;

/// Quaternion and momentum, with what the library does to a state written out for seven numbers.
#[derive(Clone, Copy, Debug)]
struct Seven(Numbers);

impl State<f64> for Seven {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get_component(&self, index: usize) -> f64 {
        self.0[index]
    }

    fn set_component(&mut self, index: usize, value: f64) {
        self.0[index] = value;
    }

    #[inline(always)]
    fn map_components_mut<F: FnMut(usize, &mut f64)>(&mut self, mut f: F) {
        for (i, value) in self.0.iter_mut().enumerate() {
            f(i, value);
        }
    }

    fn zeros_like(&self) -> Self {
        Self([0.0; 7])
    }

    fn zeros() -> Self {
        Self([0.0; 7])
    }

    #[inline(always)]
    fn mul_add_assign(&mut self, alpha: f64, other: &Self) {
        for (value, other) in self.0.iter_mut().zip(&other.0) {
            *value += alpha * other;
        }
    }

    #[inline(always)]
    fn add_scaled(&mut self, alpha: f64, other: &Self) -> &mut Self {
        self.mul_add_assign(alpha, other);
        self
    }

    #[inline(always)]
    fn scale_mut(&mut self, alpha: f64) {
        for value in &mut self.0 {
            *value *= alpha;
        }
    }
}

/// The equations, for the library.
struct Equations<E>(E);

impl<E: Rates> ODE<f64, Seven> for Equations<E> {
    #[inline(always)]
    fn diff(&self, _t: f64, y: &Seven, rate: &mut Seven) {
        rate.0 = self.0.rate(&y.0);
    }
}

/// From `y` over the time `t`; `None` where the library gives up.
pub fn integrate(equations: &impl Rates, t: f64, tolerance: f64, y: Numbers) -> Option<Numbers> {
    let method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance).max_steps(10_000_000);
    let solution = IVP::ode(&Equations(*equations), 0.0, t, Seven(y)).t_eval([t]).method(method).solve().ok()?;
    solution.y.last().map(|end| end.0)
}
