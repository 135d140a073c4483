//! What is asked of a kernel and of a processor, as equations for their shares.

use nalgebra::{DMatrix, DVector};
use workbench::double_double::DoubleDouble;

use crate::words::{Algebra, Number, Part, Words};

/// The equations of one kind of kernels or processors of an even order.
pub(crate) struct Problem {
    pub(crate) order: usize,
    pub(crate) wanted: Wanted,
    algebra: Algebra,
}

/// What is looked for.
#[derive(Clone, Debug)]
pub(crate) enum Wanted {
    Kernel(Form),
    Processor {
        kernel: Vec<Part<DoubleDouble>>,
        /// How many drifts it has with a kick after each; then there is one drift more.
        stages: usize,
        /// Whether the first of its drifts is none.
        kick_first: bool,
    },
}

/// A kernel that is the same from both ends.
#[derive(Clone, Debug)]
pub(crate) struct Form {
    pub(crate) kick_first: bool,
    /// Drifts and kicks up to the middle one.
    pub(crate) half: usize,
    /// Which of the half's kicks have a gradient, by their number among all drifts and kicks.
    pub(crate) gradients: Vec<usize>,
}

impl Form {
    fn is_kick(&self, place: usize) -> bool {
        self.kick_first == place.is_multiple_of(2)
    }

    /// All parts, of the half's shares and gradients.
    fn parts<T: Number>(&self, shares: &[T]) -> Vec<Part<T>> {
        let part = |place: usize| {
            if !self.is_kick(place) {
                return Part::Drift(shares[place]);
            }
            let gradient = self.gradients.iter().position(|with| *with == place);
            Part::Kick(shares[place], gradient.map_or(T::from(0.0), |k| shares[self.half + k]))
        };
        (0..self.half).chain((0..self.half - 1).rev()).map(part).collect()
    }
}

impl Problem {
    pub(crate) fn new(order: usize, wanted: Wanted) -> Self {
        Self { order, wanted, algebra: Algebra::new() }
    }

    /// What is looked for, as drifts and kicks.
    pub(crate) fn parts<T: Number>(&self, unknowns: &[T]) -> Vec<Part<T>> {
        match &self.wanted {
            Wanted::Kernel(form) => form.parts(unknowns),
            Wanted::Processor { stages, kick_first, .. } => {
                let none = [T::from(0.0)];
                let mut shares = none[..usize::from(*kick_first)].iter().chain(unknowns).copied();
                let mut next = || shares.next().expect("as many as there are unknowns");
                let mut parts: Vec<_> =
                    (0..*stages).flat_map(|_| [Part::Drift(next()), Part::Kick(next(), next())]).collect();
                parts.push(Part::Drift(next()));
                parts
            }
        }
    }

    /// How many shares of flows and of gradients there are.
    pub(crate) fn shares(&self) -> usize {
        match &self.wanted {
            Wanted::Kernel(form) => form.half + form.gradients.len(),
            Wanted::Processor { stages, kick_first, .. } => 3 * stages + 1 - usize::from(*kick_first),
        }
    }

    /// The shares; after those of a kernel, what makes its error good as far as a processor can.
    pub(crate) fn unknowns(&self) -> usize {
        match &self.wanted {
            Wanted::Kernel(_) => self.shares() + self.removable().count(),
            Wanted::Processor { .. } => self.shares(),
        }
    }

    /// What a processor of a kernel can be the exponential of: elements with an even number of letters, as a kernel is
    /// the same from both ends.
    fn removable(&self) -> impl Iterator<Item = &crate::words::Element> {
        (2..=self.order).step_by(2).flat_map(|n| &self.algebra.basis[n])
    }

    /// The logarithm of `χ⁻¹ K χ`, which should be `A + B`.
    fn logarithm<T: Number>(&self, unknowns: &[T]) -> Words<T> {
        let (kernel, processor) = match &self.wanted {
            Wanted::Kernel(_) => {
                let others = &unknowns[self.shares()..];
                (Words::of(&self.parts(unknowns)), Words::exponential(self.removable().zip(others.iter().copied())))
            }
            Wanted::Processor { kernel, .. } => (
                Words::of(&kernel.iter().map(|part| part.rounded()).collect::<Vec<_>>()),
                Words::of(&self.parts(unknowns)),
            ),
        };
        processor.inverse().times(&kernel).times(&processor).logarithm()
    }

    /// What the order asks to be zero, and after it the error of the next order.
    pub(crate) fn missed(&self, unknowns: &[f64]) -> (DVector<f64>, DVector<f64>) {
        let logarithm = self.logarithm(unknowns);
        let part = |n: usize| {
            let mut part = self.algebra.coordinates(&logarithm, n);
            if n == 1 {
                part.add_scalar_mut(-1.0);
            }
            part
        };
        let within: Vec<f64> = (1..=self.order).flat_map(|n| part(n).data.as_vec().clone()).collect();
        (within.into(), part(self.order + 1))
    }

    /// The unknowns with 30 digits: those nearest to these with which nothing is missed.
    pub(crate) fn polished(&self, unknowns: &[f64]) -> Option<Vec<DoubleDouble>> {
        // With elements that vanish the words are all zero, and all of them have whole coefficients.
        let vanishing: Vec<_> = (1..=self.order).flat_map(|n| &self.algebra.vanishing[n]).collect();
        let words = |x: &[DoubleDouble]| -> Vec<DoubleDouble> {
            let (shares, others) = x.split_at(unknowns.len());
            let mut words = self.logarithm(shares);
            words.add(vanishing.iter().copied().zip(others.iter().copied()));
            (1..=self.order)
                .flat_map(|n| {
                    let exact = DoubleDouble::from(f64::from(u8::from(n == 1)));
                    words.part(n).iter().map(move |x| *x - exact).collect::<Vec<_>>()
                })
                .collect()
        };
        let mut x: Vec<DoubleDouble> = unknowns.iter().map(|x| (*x).into()).collect();
        x.resize(unknowns.len() + vanishing.len(), 0.0.into());
        // First what vanishes, so that the unknowns aren't changed for that.
        for first in [unknowns.len(), 0] {
            let column = |k: usize| -> DVector<f64> {
                let [plus, minus] = [1e-5, -1e-5].map(|change: f64| {
                    let mut moved = x.clone();
                    moved[k] += change.into();
                    words(&moved)
                });
                plus.iter().zip(&minus).map(|(a, b)| (*a - *b).rounded() / 2e-5).collect::<Vec<_>>().into()
            };
            let columns: Vec<_> = (first..x.len()).map(column).collect();
            if columns.is_empty() {
                continue;
            }
            let inverse = DMatrix::from_columns(&columns).pseudo_inverse(1e-7).ok()?;
            for _ in 0..40 {
                let missed: DVector<f64> = words(&x).iter().map(|x| x.rounded()).collect::<Vec<_>>().into();
                if missed.amax() < 3e-31 {
                    x.truncate(unknowns.len());
                    return Some(x);
                }
                for (x, change) in x[first..].iter_mut().zip((&inverse * missed).iter()) {
                    *x -= (*change).into();
                }
            }
        }
        None
    }
}
