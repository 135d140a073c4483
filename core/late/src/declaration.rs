//! Declarations read from texts, each derived once.

use std::any::Any;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use liestep::SetupError;
use liestep::mechanics::Parts;
use liestep_derivation::{MOST_WORK, ParameterKind, Program, Refusal, StagedDeclaration, Stages, staged};
use proc_macro2::{LexError, Span, TokenStream};

use crate::code::Backend;
use crate::error::{LateError, Mistake};
use crate::sum::summed;

/// A declaration with the programs of its stages. Each text is derived once and stored as long as the process runs.
#[derive(Debug)]
pub struct Declaration {
    staged: StagedDeclaration,
    /// The texts of all terms.
    texts: Vec<String>,
    pub(crate) parts: Parts,
    /// The code of the programs by each back end.
    made: Mutex<Vec<Arc<dyn Any + Send + Sync>>>,
}

/// Dereferences to the derivation.
impl Deref for Declaration {
    type Target = StagedDeclaration;

    fn deref(&self) -> &StagedDeclaration {
        &self.staged
    }
}

#[derive(Debug)]
pub(crate) struct Ready<C> {
    pub(crate) code: C,
    pub(crate) outputs: usize,
}

/// The programs as code of a back end.
pub(crate) fn ready<B: Backend<f64>>(programs: &Stages<Program>) -> Result<Stages<Ready<B::Code>>, LateError> {
    let mut list = Vec::new();
    programs.try_map(|program| {
        list.push(program);
        Ok::<_, LateError>(())
    })?;
    let mut each = ready_each::<B>(&list)?.into_iter();
    programs.try_map(|_| each.next().ok_or(LateError::TooLarge))
}

pub(crate) fn ready_each<B: Backend<f64>>(programs: &[&Program]) -> Result<Vec<Ready<B::Code>>, LateError> {
    let each = B::codes(programs)?.into_iter().zip(programs);
    Ok(each.map(|(code, program)| Ready { code, outputs: program.outputs.len() }).collect())
}

/// A longer text is no Lagrangian that a person has typed.
const LONGEST: usize = 64 * 1024;
/// The most declarations; a large one takes some 100 kB.
const MOST: usize = 10_000;

/// The declarations of the process, by their texts.
static KEPT: LazyLock<Mutex<BTreeMap<String, &'static Declaration>>> = LazyLock::new(Mutex::default);

/// The number of stored declarations, sums among them. A text is derived and stored once, however often it is declared, and
/// a sum once for each order of its terms; a process may store 10,000. One of a body takes 25 kB, which the ignored test in
/// `core/late/tests/hostile.rs` measures.
#[must_use]
pub fn kept() -> usize {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).len()
}

/// A mistake at a place of a text.
fn placed(message: String, span: Span) -> Mistake {
    let place = span.start();
    Mistake { message, line: place.line, column: place.column + 1 }
}

/// The result of what is made of a text's tokens.
fn lexed<T>(text: &str, made: impl FnOnce(&TokenStream) -> Result<T, LateError>) -> Result<T, LateError> {
    if text.len() > LONGEST {
        return Err(LateError::TooLong(LONGEST));
    }
    let tokens = text.parse().map_err(|error: LexError| {
        let message = "a bracket isn't closed or opened, or a sign has no meaning here".to_owned();
        LateError::Mistakes(vec![placed(message, error.span())])
    });
    let found = tokens.and_then(|tokens| made(&tokens));
    // The texts of the tokens' places would be stored, too.
    proc_macro2::extra::invalidate_current_thread_spans();
    found
}

impl Declaration {
    /// Derives a struct with `#[lagrangian(…)]`, `#[force(…)]`, `#[nonholonomic(…)]` or `#[hamiltonian(…)]`, and checks the
    /// derivation.
    ///
    /// # Errors
    ///
    /// The mistakes of the text, each with its line and column, or the reason why it can't be stored.
    pub fn parse(text: &str) -> Result<&'static Self, LateError> {
        Self::kept(text, || vec![text.to_owned()], || Self::derived(text))
    }

    /// Reads a part of a declaration as tokens: a bracket that it leaves open would be closed by one behind it.
    ///
    /// # Errors
    ///
    /// The bracket or the sign that has no meaning, with its line and column in the part.
    pub fn lex(part: &str) -> Result<(), LateError> {
        lexed(part, |_| Ok(()))
    }

    /// An attitude displaced by small coordinates of the algebra, `g (I + ξ̂)`, by which the growth of rounding errors is
    /// measured; the entries of the attitude and of the result are the matrices of the factors, row by row.
    #[must_use]
    pub fn displaced(&self, attitude: &[f64], coordinates: &[f64]) -> Vec<f64> {
        let (mut displaced, mut first, mut rest) = (attitude.to_vec(), 0, coordinates);
        for factor in &self.factors {
            let entries = factor.generators.first().map_or(0, Vec::len);
            let rows = (1..=entries).find(|rows| rows * rows >= entries).unwrap_or(1);
            let (own, behind) = rest.split_at(factor.generators.len().min(rest.len()));
            for (generator, xi) in factor.generators.iter().zip(own) {
                for at in 0..entries {
                    let products =
                        (0..rows).map(|k| attitude[first + at / rows * rows + k] * generator[k * rows + at % rows]);
                    displaced[first + at] += products.sum::<f64>() * xi;
                }
            }
            (first, rest) = (first + entries, behind);
        }
        displaced
    }

    /// The sum of declarations on one group as one declaration, whose programs add the outputs of theirs. On SO(3) it
    /// has the bits of the same sum of compiled effects; if the retraction's tangent is taken after the sum, it
    /// differs by roundings.
    ///
    /// The parameter `m` of a term `Gravity` is called `Gravity.m`; numbers and advected parameters stand in the order
    /// of the terms. A Jacobian is taken in every solve, unless there is one term only.
    ///
    /// # Errors
    ///
    /// The terms are on several groups, or there are none.
    pub fn sum(terms: &[&'static Self]) -> Result<&'static Self, LateError> {
        if let [only] = terms {
            return Ok(only);
        }
        // Addresses identify declarations.
        let places: Vec<*const Self> = terms.iter().map(|&term| &raw const *term).collect();
        let texts = || terms.iter().flat_map(|term| term.texts.iter().cloned()).collect();
        let staged: Vec<&StagedDeclaration> = terms.iter().map(|term| &term.staged).collect();
        Self::kept(&format!("{places:?}"), texts, || summed(&staged))
    }

    /// The stored declaration of this name, or a new one.
    fn kept(
        name: &str,
        texts: impl FnOnce() -> Vec<String>,
        make: impl FnOnce() -> Result<StagedDeclaration, LateError>,
    ) -> Result<&'static Self, LateError> {
        let known = || KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(declaration) = known().get(name) {
            return Ok(declaration);
        }
        if known().len() >= MOST {
            return Err(LateError::TooMany(MOST));
        }
        let declaration = Self::of(make()?, texts());
        // If two threads have derived a declaration at once, the first result is stored and the second dropped.
        Ok(known().entry(name.to_owned()).or_insert_with(|| Box::leak(Box::new(declaration))))
    }

    fn derived(text: &str) -> Result<StagedDeclaration, LateError> {
        let refused = |refusal| match refusal {
            Refusal::Mistakes(all) => {
                LateError::Mistakes(all.into_iter().map(|one| placed(one.message, one.span)).collect())
            }
            Refusal::TooMuchWork => LateError::TooMuchWork,
        };
        lexed(text, |tokens| staged(tokens, MOST_WORK).map_err(refused)).map(|(staged, _)| staged)
    }

    fn of(staged: StagedDeclaration, texts: Vec<String>) -> Self {
        let [unknown, kick_before, kick_after] = staged.parts;
        Self { parts: Parts { unknown, kick_before, kick_after }, made: Mutex::default(), texts, staged }
    }

    /// The code that is made of the declaration, made once.
    pub(crate) fn once<M: Any + Send + Sync>(
        &self,
        make: impl FnOnce() -> Result<M, LateError>,
    ) -> Result<Arc<M>, LateError> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = made.iter().find_map(|one| Arc::clone(one).downcast::<M>().ok()) {
            return Ok(known);
        }
        let all = Arc::new(make()?);
        made.push(Arc::clone(&all) as Arc<dyn Any + Send + Sync>);
        Ok(all)
    }

    /// The text of each term, as it was declared.
    #[must_use]
    pub fn texts(&self) -> &[String] {
        &self.texts
    }

    /// The group as it is written in Rust.
    #[must_use]
    pub fn group(&self) -> String {
        let names: Vec<&str> = self.factors.iter().map(|factor| factor.name.as_str()).collect();
        if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
    }

    /// The place of a parameter's first number among all numbers, and how many it has.
    pub(crate) fn place(&self, index: usize) -> (usize, usize) {
        let lengths = || self.parameters.iter().map(|parameter| parameter.kind.len());
        (lengths().take(index).sum(), lengths().nth(index).unwrap_or(0))
    }

    /// Checks the numbers of all parameters.
    #[allow(clippy::float_cmp)] // a tensor is symmetric to the bit
    pub(crate) fn check(&'static self, numbers: &[f64]) -> Result<(), SetupError> {
        for (index, parameter) in self.parameters.iter().enumerate() {
            let (start, length) = self.place(index);
            let (field, value) = (parameter.name.as_str(), &numbers[start..start + length]);
            if !value.iter().all(|number| number.is_finite()) {
                return Err(SetupError::Parameter { field, cause: "is not finite, or wasn't given" });
            }
            let is_inertia = parameter.kind == ParameterKind::Inertia;
            if is_inertia && (0..9).any(|entry| value[entry] != value[entry % 3 * 3 + entry / 3]) {
                return Err(SetupError::Parameter { field, cause: "is not symmetric" });
            }
        }
        Ok(())
    }

    /// Sets a parameter among the numbers of all: a matrix row by row, an inertia also by its three moments, and a diagonal
    /// one also by its tensor.
    ///
    /// # Errors
    ///
    /// No parameter has this name, or it has another number of numbers.
    pub fn set(&self, numbers: &mut [f64], name: &str, value: &[f64]) -> Result<(), LateError> {
        let parameters = &self.parameters;
        let Some(index) = parameters.iter().position(|known| known.name == name) else {
            let known: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
            return Err(LateError::Unknown { name: name.to_owned(), known: known.join(", ") });
        };
        let (start, expected) = self.place(index);
        let found = value.len();
        let wrong = || LateError::Size { name: name.to_owned(), expected, found };
        let place = numbers.get_mut(start..start + expected).ok_or_else(wrong)?;
        let on_diagonal = |entry: usize| entry.is_multiple_of(4);
        match (parameters[index].kind, found) {
            (_, found) if found == expected => place.copy_from_slice(value),
            (ParameterKind::Inertia, 3) => {
                let entry = |at| if on_diagonal(at) { value[at / 4] } else { 0.0 };
                place.iter_mut().enumerate().for_each(|(at, number)| *number = entry(at));
            }
            (ParameterKind::DiagonalInertia, 9) if (0..9).all(|at| on_diagonal(at) || value[at] == 0.0) => {
                place.iter_mut().zip(value.iter().step_by(4)).for_each(|(number, &value)| *number = value);
            }
            _ => return Err(wrong()),
        }
        Ok(())
    }

    /// The number of numbers of all parameters.
    pub(crate) fn count(&self) -> usize {
        self.parameters.iter().map(|parameter| parameter.kind.len()).sum()
    }

    /// The numbers of all parameters, by their names; those that aren't given are NaN, which no stepper accepts.
    ///
    /// # Errors
    ///
    /// No parameter has a name, or it has another number of numbers.
    pub fn numbers(&self, values: &[(&str, &[f64])]) -> Result<Vec<f64>, LateError> {
        let mut numbers = vec![f64::NAN; self.count()];
        values.iter().try_for_each(|(name, value)| self.set(&mut numbers, name, value))?;
        Ok(numbers)
    }

    /// The numbers of all parameters, from those that an effect [describes](crate::numbers): a diagonal inertia by its
    /// tensor.
    ///
    /// # Errors
    ///
    /// The number of numbers is another.
    pub fn described(&self, numbers: &[f64]) -> Result<Vec<f64>, LateError> {
        // Every fourth entry of a tensor is on its diagonal.
        let described = self.parameters.iter().map(|parameter| match parameter.kind {
            ParameterKind::DiagonalInertia => (9, 4),
            kind => (kind.len(), 1),
        });
        let (expected, found) = (described.clone().map(|(length, _)| length).sum(), numbers.len());
        if expected != found {
            return Err(LateError::Size { name: self.name.clone(), expected, found });
        }
        let (mut numbers, mut stored) = (numbers.iter().copied(), Vec::with_capacity(self.count()));
        described.for_each(|(length, stride)| stored.extend(numbers.by_ref().take(length).step_by(stride)));
        Ok(stored)
    }
}
