//! The cost of a step of every method in `accuracy-cost`, with steps of `h = 0.01 s`.
//!
//! Valgrind supports AVX2 if the machine does, and Gauss collocation uses it: its stages are in vector registers, so
//! that eight cost less than six under gravity. Without vectorisation they would cost twice as much.

use core::hint::black_box;
use std::rc::Rc;

use accuracy_cost::methods::{self, Method, PreparedRun};
use accuracy_cost::scenes::Scene;

use crate::kernel::{Effort, Group, Kernel};

const STEP: f64 = 0.01;
/// A count takes at most a second of the most expensive method.
const EFFORT: Effort = Effort { batch: 500, rounds: 40, counted: 500 };

pub(crate) fn groups() -> Vec<Group> {
    let group = |scene: Scene| {
        let scene = Rc::new(scene);
        let methods = methods::all(&scene).into_iter().filter(Method::steps_are_equal);
        Group::new(scene.short, EFFORT, methods.map(|method| kernel(&scene, method)))
    };
    Scene::all().into_iter().map(group).collect()
}

fn kernel(scene: &Rc<Scene>, method: Method) -> Kernel {
    let (scene, method) = (Rc::clone(scene), Rc::new(method));
    Kernel::new(method.name.clone(), move || {
        let (scene, method) = (Rc::clone(&scene), Rc::clone(&method));
        // The stepper is constructed once for all batches.
        let mut ready: Option<(u32, PreparedRun)> = None;
        Ok(move |steps: u32| {
            let run = match ready.take() {
                Some((prepared, run)) if prepared == steps => run,
                _ => (method.prepare)(&scene, f64::from(steps) * STEP, STEP)
                    .ok_or_else(|| format!("{} can't be set up", method.name))?,
            };
            black_box(run()).ok_or_else(|| format!("a step of {} failed", method.name))?;
            ready = Some((steps, run));
            Ok(0)
        })
    })
}
