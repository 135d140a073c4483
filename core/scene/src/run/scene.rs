//! Runs of scenes, and what is told about them.

use std::error::Error;

use liestep::motion::{AnyStepper, Moment};
use liestep::recording::Sink;
use nalgebra::Vector3;

use crate::file::column::Column;
use crate::file::control::{Wheel, entries};
use crate::file::mistake::Mistake;
use crate::file::scene::Scene;
use crate::run::choose;
use crate::run::data::Whole;
use crate::run::make::{Listeners, Run, Watch};
use crate::run::sample::sample;
use crate::run::simulate::MemberStart;

impl Scene {
    /// Simulates the scene.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the scene can't be started or a step fails.
    pub fn run(&self) -> Result<Run, Mistake> {
        self.run_with(&mut |_| (), None)
    }

    /// Simulates the scene. `progress` is called up to a hundred times with the completed share of the run, from
    /// 0 to 1. The table has the time and the scene's [columns](Self::columns), with a row for each `every`-th step and for
    /// the last. Rows are written during the run, so that a run that fails leaves those up to then.
    ///
    /// ```
    /// # fn recorded(scene: &liestep_scene::Scene) -> Result<(), Box<dyn std::error::Error>> {
    /// use liestep::recording::Csv;
    ///
    /// scene.run_with(&mut |_| (), Some(&mut Csv::create("top.csv")?))?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run), and one of the kind [`Table`](crate::Kind::Table) where a row can't be
    /// written.
    pub fn run_with<'a>(
        &self,
        progress: &'a mut dyn FnMut(f64),
        table: Option<&'a mut dyn Sink>,
    ) -> Result<Run, Mistake> {
        self.file.simulate(Listeners { progress, table }).map_err(|stop| self.file.mistake(stop))
    }

    /// Simulates the scene up to a number of steps. A scene with an accuracy is simulated to its end, as its step isn't
    /// known before.
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run).
    pub fn first(&self, most: u32) -> Result<Run, Mistake> {
        self.file.first(most).map_err(|stop| self.file.mistake(stop))
    }

    /// The stepper of the scene, with its initial state.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the scene can't be started.
    pub fn stepper(&self) -> Result<MemberStart, Mistake> {
        self.file.started().map_err(|stop| self.file.mistake(stop))
    }

    /// The scene's step as data, for members of its ensemble in lanes. `None` for several bodies, for another method, for varying
    /// steps, and for effects along orbits.
    #[must_use]
    pub fn whole(&self) -> Option<Whole> {
        choose::whole(&self.file)
    }

    /// The stepper and the initial state for lanes, from the step of a file that differs from this one in numbers
    /// alone.
    ///
    /// # Errors
    ///
    /// The errors of [`stepper`](Self::stepper).
    pub fn in_lanes(&self, whole: &Whole) -> Result<MemberStart, Mistake> {
        choose::member(&self.file, whole).map_err(|stop| self.file.mistake(stop))
    }

    /// The numbers of these columns at a moment, one after the other. The sign of a quaternion is arbitrary.
    #[must_use]
    pub fn numbers(&self, columns: &[Column], now: &Moment<'_, AnyStepper>) -> Vec<f64> {
        let now = sample(&self.file, now);
        Column::row(columns, &now, &now)
    }

    /// The wheels by their names, with their speeds relative to their bodies, rad/s, from the numbers of a state of
    /// [`stepper`](Self::stepper) and its velocity.
    #[must_use]
    pub fn wheels(&self, numbers: &[f64], velocity: &[f64]) -> Vec<(&str, f64)> {
        let bodies = self.file.system.as_ref().map_or(1, |system| system.names().count());
        let part = |wheel: &Wheel, k: usize| {
            velocity.get(wheel.body * velocity.len() / bodies + k).copied().unwrap_or(f64::NAN)
        };
        let mut all = Vec::new();
        for (number, wheel) in self.file.wheel.iter().enumerate() {
            let turning = Vector3::from_fn(|k, _| part(wheel, k)).dot(&wheel.axis);
            let momentum = numbers.get(self.memory(numbers) + number).copied().unwrap_or(f64::NAN);
            all.push((wheel.name.as_str(), momentum / wheel.inertia - turning));
        }
        all
    }

    /// Sets the torque, N m, that a program adds to that of a wheel's motor in the steps from a state of
    /// [`stepper`](Self::stepper) on, whose numbers these are; the limits of the wheel hold for their sum.
    ///
    /// # Errors
    ///
    /// The reason why a program can't drive this wheel.
    pub fn drive_wheel(&self, name: &str, torque: f64, numbers: &mut [f64]) -> Result<(), &'static str> {
        let number = self.file.wheel.iter().position(|wheel| wheel.name == name).ok_or("isn't the name of a wheel")?;
        if self.file.wheel[number].controller().is_some() {
            return Err("is driven by its law: give it a number as its `torque`, or none");
        }
        let place = self.memory(numbers) + self.file.wheel.len() + number;
        *numbers.get_mut(place).ok_or("has no place in these numbers")? = torque;
        Ok(())
    }

    /// The place of the wheels' momenta among the numbers of a state; the torques of their motors follow.
    fn memory(&self, numbers: &[f64]) -> usize {
        numbers.len().saturating_sub(1 + entries(&self.file.control, &self.file.wheel))
    }

    /// The events to be detected, in the order of their [names](Self::events).
    #[must_use]
    pub fn watches(&self) -> Vec<Watch> {
        self.file.watches()
    }

    /// The events of a run as comma-separated values: name, 1 where the quantity rose and 0 where it fell, time, and
    /// the scene's columns.
    ///
    /// # Errors
    ///
    /// None, as it is written to memory.
    pub fn event_table(&self, run: &Run) -> Result<String, Box<dyn Error + Send + Sync>> {
        run.event_table(self.columns(), self.events())
    }

    /// Lines about the start and the end of a run, its events, and the table of the choice if there was one.
    #[must_use]
    pub fn summary(&self, run: &Run) -> String {
        let events = run.events_in_words(self.events());
        let file = &self.file;
        let ends = |first: &_, last: &_| file.ends_in_words(run, [first, last]) + &events;
        let terms = file.sum() + &file.orbits(run);
        let ends = run.summary(&file.title, &terms, file.group.unit_of_energy(), ends);
        let choice = run.choice.as_ref().map(|choice| {
            let (error, accuracy, method) = (choice.error, choice.accuracy.tolerance, choice.chosen().scheme);
            if self.schedule().is_left_open {
                format!("  the end is off by at most about {error:.0e}, by a method for {accuracy:e}: {method}\n")
            } else {
                choice.to_string()
            }
        });
        format!("{ends}{}{}", choice.unwrap_or_default(), self.changes(run))
    }

    /// Differences between the nearest start and the file, a line for each of several bodies that has one.
    #[must_use]
    pub fn changes(&self, run: &Run) -> String {
        let of_system = self.file.system.as_ref().filter(|_| self.file.run.nearest);
        of_system.map_or_else(String::new, |system| system.changes(run))
    }
}
