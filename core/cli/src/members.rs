//! The scenes of members, by whose orbit, wheels and angles their columns are read.

use std::cell::RefCell;
use std::sync::Arc;

use liestep::motion::{AnyStepper, Moment};
use liestep_ensemble::{Member, Run};
use liestep_scene::{Column, Scene, SceneEnsemble, Spread};

/// The scene of a file, and the draws of a member's own scene where columns depend on what is drawn.
pub(crate) struct Scenes {
    file: Scene,
    drawn: Option<SceneEnsemble>,
    seed: u64,
}

/// A member by its number, with its scene; none for a member that can't exist.
type MemberScene = (Arc<Scenes>, u64, Option<Scene>);

thread_local! {
    /// The last member of this thread.
    static LAST: RefCell<Option<MemberScene>> = const { RefCell::new(None) };
}

impl Scenes {
    pub(crate) fn new(file: &Scene, drawn: &SceneEnsemble) -> Arc<Self> {
        let own = drawn.draws_what_columns_read().then(|| drawn.clone());
        Arc::new(Self { file: file.clone(), drawn: own, seed: drawn.seed })
    }

    /// The scene of the file, which is that of all members but for drawn numbers.
    pub(crate) fn file(&self) -> &Scene {
        &self.file
    }

    /// The numbers of these columns of a member now; none where the member can't exist.
    pub(crate) fn numbers(self: &Arc<Self>, run: &Run<'_, AnyStepper>, columns: &[Column]) -> Vec<f64> {
        let now = Moment::of_step(run.stepper, run.state);
        let Some(drawn) = &self.drawn else { return self.file.numbers(columns, &now) };
        LAST.with_borrow_mut(|last| {
            let (_, _, scene) = match last.take() {
                Some(known) if Arc::ptr_eq(&known.0, self) && known.1 == run.member => last.insert(known),
                _ => {
                    let member = Member::of(run.member, self.seed);
                    let scene = drawn.member(&mut |name: &str, spread: Spread| number(&member, name, spread)).ok();
                    last.insert((Arc::clone(self), run.member, scene))
                }
            };
            scene.as_ref().map_or_else(Vec::new, |scene| scene.numbers(columns, &now))
        })
    }
}

/// The number that a member draws.
pub(crate) fn number(member: &Member<'_>, name: &str, spread: Spread) -> f64 {
    match spread {
        Spread::Uniform { from, to } => member.uniform(name, from..to),
        Spread::Normal { mean, deviation } => member.normal(name, mean, deviation),
    }
}
