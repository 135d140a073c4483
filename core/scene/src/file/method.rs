//! The methods that a file can name.

use liestep::methods::{CompositionScheme, ProcessedScheme, SplittingScheme};
use serde::Deserialize;

/// The stepping method, by the names of [`liestep::methods`].
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Method {
    /// The scene's own step.
    #[default]
    Step,
    Composition(Named<CompositionScheme>),
    /// A splitting with the exact motion of the free body.
    Splitting(Named<SplittingScheme>),
    /// A splitting with the exact motion of the free body, with a processor.
    Processed(Named<ProcessedScheme>),
    /// A collocation, by its number of stages.
    Collocation(Stages),
}

impl Method {
    /// The method of an offer for an accuracy, by the offer's name.
    pub(crate) fn of_offer(name: &str) -> Option<Self> {
        fn named<S: Scheme>(name: &str) -> Option<Named<S>> {
            S::ALL.iter().find(|scheme| scheme.called() == name).copied().map(Named)
        }
        match (name, name.strip_prefix("exact, ")) {
            ("its own step", _) => Some(Self::Step),
            ("exact", _) => Some(Self::Splitting(Named(SplittingScheme::STRANG))),
            ("Gauss, 4 stages", _) => Some(Self::Collocation(Stages::Four)),
            ("Gauss, 8 stages", _) => Some(Self::Collocation(Stages::Eight)),
            (_, Some(split)) => named(split).map(Self::Splitting).or_else(|| named(split).map(Self::Processed)),
            _ => named(name).map(Self::Composition),
        }
    }

    /// The kind of method in words, with an article.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Step => "a step",
            Self::Composition(_) => "a composition",
            Self::Splitting(_) | Self::Processed(_) => "a splitting",
            Self::Collocation(_) => "a collocation",
        }
    }
}

/// A scheme by its name.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "String", bound = "S: Scheme")]
pub(crate) struct Named<S: Scheme>(pub(crate) S);

pub(crate) trait Scheme: Copy + 'static {
    const ALL: &'static [Self];

    fn called(&self) -> &'static str;
}

impl<S: Scheme> TryFrom<String> for Named<S> {
    type Error = String;

    fn try_from(wanted: String) -> Result<Self, String> {
        S::ALL.iter().find(|scheme| scheme.called().eq_ignore_ascii_case(&wanted)).copied().map(Self).ok_or_else(|| {
            let names: Vec<_> = S::ALL.iter().map(|scheme| format!("`{}`", scheme.called())).collect();
            format!("unknown scheme `{wanted}`, expected one of {}", names.join(", "))
        })
    }
}

macro_rules! schemes {
    ($($scheme:ident)+) => {$(
        impl Scheme for $scheme {
            const ALL: &'static [Self] = &$scheme::ALL;

            fn called(&self) -> &'static str {
                self.name()
            }
        }
    )+};
}

schemes! { CompositionScheme SplittingScheme ProcessedScheme }

/// The numbers of stages that fill the machine's vectors.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
pub(crate) enum Stages {
    Four,
    Eight,
}

impl Stages {
    pub(crate) fn order(self) -> u32 {
        match self {
            Self::Four => 8,
            Self::Eight => 16,
        }
    }
}

impl TryFrom<i64> for Stages {
    type Error = &'static str;

    fn try_from(stages: i64) -> Result<Self, &'static str> {
        match stages {
            4 => Ok(Self::Four),
            8 => Ok(Self::Eight),
            _ => Err("a collocation has 4 or 8 stages"),
        }
    }
}
