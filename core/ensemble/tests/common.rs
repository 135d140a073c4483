//! The fixtures of the tests: a small ensemble of tops, some of which fail, and folders.

#![allow(dead_code, unreachable_pub, missing_docs)] // each test uses a part of it

use std::collections::BTreeMap;
use std::panic::{UnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::{SO3, Stepper};
use liestep_ensemble::{Ensemble, Failure, Member, Reduction};
use nalgebra::Vector3;

pub type Top = Stepper<Sum<PrincipalBody, Gravity>>;
pub type State = <Top as liestep::motion::Integrator>::State;

/// A top with random moments and spin. Member 3 is no body, and members 5, 15, 25 … fall too fast for the step.
pub fn top(member: &Member<'_>) -> MemberStart {
    let third = if member.number() == 3 { 9.0 } else { member.normal("J_3", 4.0, 0.1) };
    let body =
        PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.1, third))? };
    let m = if member.number() % 10 == 5 { 1e3 } else { 1.0 };
    let stepper = Stepper::new(body + Gravity { m, g: 9.81, rho: Vector3::z(), up: Vector3::z() }, 0.02)?;
    let tilted = SO3::exp(Vector3::x() * member.uniform("tilt", 0.2..0.6));
    let state = stepper.start(tilted, Vector3::new(0.1, 0.0, member.uniform("spin", 1.0..8.0)))?;
    Ok((stepper, state))
}

/// A member, if it can be constructed.
pub type MemberStart = Result<(Top, State), Failure>;

/// The members of [`tops`] as constructed.
pub fn made(members: u64) -> Vec<(u64, MemberStart)> {
    // An ensemble of no steps passes its members on.
    let starts = Arc::new(Mutex::new(Vec::new()));
    let kept = Arc::clone(&starts);
    let probe = Ensemble::new("tops", members, 0, move |member| {
        let made = top(member);
        kept.lock().unwrap().push((member.number(), made.clone()));
        made
    });
    let _ = probe.seed(7).chunks_of(members).chunk(0, &|| false);
    // The chunk's sample and the plan's fingerprint construct the first member, too, before and after.
    let mut starts = starts.lock().unwrap().split_off(1);
    starts.truncate(usize::try_from(members).unwrap());
    starts
}

/// The panic of an ensemble that is refused.
pub fn message(of: impl FnOnce() -> Ensemble<Top> + UnwindSafe) -> String {
    let payload = catch_unwind(of).map(drop).unwrap_err();
    let text = payload.downcast_ref::<String>().cloned();
    text.unwrap_or_else(|| (*payload.downcast_ref::<&str>().unwrap()).to_owned())
}

pub fn axis(state: &State) -> [f64; 3] {
    (state.attitude().as_matrix() * Vector3::z()).into()
}

/// Tops in chunks of twenty, which isn't a multiple of the lanes.
pub fn tops(members: u64, steps: u64) -> Ensemble<Top> {
    with_columns(Ensemble::new("tops", members, steps, top))
}

pub fn with_columns(ensemble: Ensemble<Top>) -> Ensemble<Top> {
    ensemble
        .seed(7)
        .chunks_of(20)
        .keep(["x", "y", "z"], |run| axis(run.state))
        .keep(["energy"], |run| [run.stepper.energy(run.state)])
        .reduce("z", Reduction::Moments, |run| axis(run.state)[2])
        .reduce("zs", Reduction::Histogram { range: -1.0..1.0, bins: 8 }, |run| axis(run.state)[2])
}

/// An empty folder of this process; removed when dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("liestep-ensemble-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// All files below a folder with their contents.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            let inner = contents(&path).into_iter();
            found.extend(inner.map(|(name, bytes)| (Path::new(path.file_name().unwrap()).join(name), bytes)));
        } else {
            found.insert(path.file_name().unwrap().into(), std::fs::read(&path).unwrap());
        }
    }
    found
}
