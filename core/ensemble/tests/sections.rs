//! The crossings recorded at sections are those found in a run of each member alone, to the bit.

#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // hundreds of steps

use liestep::motion::Moment;
use liestep::recording::{Event, sections};
use liestep_ensemble::{Ensemble, Failure, MemberFailure, Reduction, Section, Shard, Status, Store, Summary, Table};
use nalgebra::Vector3;

use crate::common::{Top, made, message, top, tops, with_columns};
use crate::{assert_unlike, the_same};

const MEMBERS: u64 = 50;
const STEPS: u64 = 150;

/// Two sections: the first axis rises through the horizontal plane; the third passes an upright plane, with a bound.
fn with_sections(ensemble: Ensemble<Top>) -> Ensemble<Top> {
    let horizon = Section::new(Event::rising(), sections::plane(Vector3::x(), Vector3::z()));
    let upright = Section::new(Event::crossing().curvature(300.0), sections::plane(Vector3::z(), Vector3::y()));
    ensemble
        .section(horizon.keep(["t", "spin"], kept).reduce("spins", Reduction::Moments, |now| now.velocity().z))
        .section(upright.keep(["t2", "spin2"], kept))
}

fn kept(now: &Moment<'_, Top>) -> [f64; 2] {
    [now.time(), now.velocity().z]
}

/// Members, and the bits of their recorded values.
type MemberBits = Vec<(u64, Vec<u64>)>;

fn found(shards: &[Shard], section: usize) -> MemberBits {
    let of_shard = |shard: &Shard| -> MemberBits {
        let crossings = &shard.rows.crossings[section];
        let kept = |place: usize| crossings.columns.iter().map(|column| column[place].to_bits()).collect();
        crossings.row.iter().enumerate().map(|(place, row)| (shard.rows.member[*row], kept(place))).collect()
    };
    shards.iter().flat_map(of_shard).collect()
}

fn chunks(ensemble: &Ensemble<Top>) -> Vec<Shard> {
    (0..ensemble.chunks()).map(|chunk| ensemble.chunk(chunk, &|| false).unwrap()).collect()
}

#[test]
fn crossings_are_those_of_each_member_alone() {
    let mut expected: [MemberBits; 2] = [vec![], vec![]];
    for (member, made) in made(MEMBERS) {
        let Ok((stepper, mut state)) = made else { continue };
        let [mut first, mut second] = [vec![], vec![]];
        let bits = |now: &Moment<'_, Top>| (member, kept(now).map(f64::to_bits).to_vec());
        let run = stepper
            .observed(&mut state)
            .event(Event::rising(), sections::plane(Vector3::x(), Vector3::z()), |now| first.push(bits(now)))
            .event(Event::crossing().curvature(300.0), sections::plane(Vector3::z(), Vector3::y()), |now| {
                second.push(bits(now));
            });
        let _ = run.steps(STEPS);
        expected[0].append(&mut first);
        expected[1].append(&mut second);
    }
    assert!(expected.iter().all(|crossings| crossings.len() > 20), "{}, {}", expected[0].len(), expected[1].len());
    let shards = chunks(&with_sections(tops(MEMBERS, STEPS)));
    assert_eq!([0, 1].map(|section| found(&shards, section)), expected);
    // More rows change only the row to which a crossing belongs.
    let shards = chunks(&with_sections(tops(MEMBERS, STEPS)).every(40));
    assert_eq!([0, 1].map(|section| found(&shards, section)), expected);
    for Shard { rows, .. } in &shards {
        for crossings in &rows.crossings {
            for (row, time) in crossings.row.iter().zip(&crossings.columns[0]) {
                let step = |row: usize| rows.step[row] as f64 * 0.02;
                let is_first = *row == 0 || rows.member[row - 1] != rows.member[*row];
                assert!(*time <= step(*row) && (is_first || *time > step(row - 1)), "{time} in row {row}");
            }
        }
    }
}

#[test]
fn files_with_sections_are_the_same_for_threads_shares_and_one_by_one() {
    let ensemble = with_sections(tops(MEMBERS, STEPS));
    let alone = with_sections(with_columns(Ensemble::one_by_one("tops", MEMBERS, STEPS, top)));
    let (folder, report) = the_same("sections", [&ensemble, &alone], [2, 1, 0]);
    let store = Store::folder(&folder.0).unwrap();
    // Shards are read as written, and a reader of numbers leaves lists out.
    let shards: Vec<Shard> = ensemble.shards(&store).unwrap().map(Result::unwrap).collect();
    // In text NaN equals NaN.
    assert!(format!("{shards:?}") == format!("{:?}", chunks(&ensemble)));
    let table = Table::read(&store.files().unwrap()[0].1).unwrap();
    assert!(table.column("spin").is_none() && table.column("energy").is_some());
    // The reductions are those of the crossings in the files.
    let spins: Vec<f64> = shards.iter().flat_map(|shard| shard.rows.crossings[0].columns[1].clone()).collect();
    let Some(Summary::Moments(moments)) = report.reduced("spins") else { panic!("{report:?}") };
    let mean = spins.iter().sum::<f64>() / spins.len() as f64;
    assert_eq!(moments.count, spins.len() as u64);
    assert!((moments.mean - mean).abs() < 1e-13, "{moments:?}, {mean}");
}

/// A zero at the end of a step is one crossing; a zero at the start, or one that no sign follows, is none.
#[test]
fn a_zero_at_the_end_of_a_step_is_one_crossing() {
    let times = |zero: f64, event: Event| {
        let section = Section::new(event, move |now: &Moment<'_, Top>| now.time() - zero);
        let shard = tops(1, STEPS).every(10).section(section.keep(["t"], |now| [now.time()])).chunk(0, &|| false);
        let crossings = &shard.unwrap().rows.crossings[0];
        (crossings.row.clone(), crossings.columns[0].clone())
    };
    assert_eq!(times(0.0, Event::crossing()), (vec![], vec![]));
    assert_eq!(times(0.02 * STEPS as f64, Event::crossing()), (vec![], vec![]));
    assert_eq!(times(0.2, Event::falling()), (vec![], vec![]));
    for event in [Event::rising(), Event::rising().curvature(1e-3)] {
        let (row, found) = times(0.2, event);
        // The row of step 10 was written before the sign was known.
        assert_eq!((row, found.len()), (vec![2], 1), "{event:?}");
        assert!((found[0] - 0.2).abs() < 1e-15);
    }
}

#[test]
fn a_function_without_a_value_stops_its_member() {
    const FIRST: u64 = 50;
    let has_none = |now: &Moment<'_, Top>| now.time() > (FIRST as f64 - 0.5) * 0.02 && now.velocity().z < 4.5;
    let section = |event| {
        let function = move |now: &Moment<'_, Top>| if has_none(now) { f64::NAN } else { 1.0 };
        Section::new(event, function).keep(["t"], |now| [now.time()])
    };
    let undisturbed = tops(12, STEPS).every(1).chunk(0, &|| false).unwrap();
    // Recorded velocities meet the condition of the event, too.
    let spins = Section::new(Event::crossing(), |_: &Moment<'_, Top>| 1.0);
    let watched = tops(12, STEPS).every(1).section(spins).keep(["w"], |run| [run.stepper.velocity(run.state).z]);
    let watched = watched.chunk(0, &|| false).unwrap().rows;
    let first_without = |member: u64| {
        let steps = watched.member.iter().zip(&watched.step).zip(&watched.columns[4]);
        let lost = |((of, step), w): &((&u64, &u64), &f64)| **of == member && **step >= FIRST && **w < 4.5;
        steps.into_iter().find(lost).map(|((_, step), _)| *step)
    };
    for event in [Event::crossing(), Event::crossing().curvature(1.0)] {
        let shard = tops(12, STEPS).section(section(event)).chunk(0, &|| false).unwrap();
        let is_lost = |failed: &&MemberFailure| matches!(failed.failure, Failure::Other(_));
        let lost: Vec<_> = shard.outcome.failures.iter().filter(is_lost).collect();
        assert!((1..10).contains(&lost.len()), "{lost:?}");
        assert_eq!(shard.outcome.finished + lost.len() as u64, undisturbed.outcome.finished, "{lost:?}");
        for failed in lost {
            assert!(failed.failure.to_string().contains("no value at t = "), "{failed:?}");
            assert_eq!(Some(failed.steps), first_without(failed.member), "{failed:?}");
            let row = shard.rows.member.iter().position(|member| *member == failed.member).unwrap();
            assert_eq!((shard.rows.status[row], shard.rows.step[row]), (Status::Stopped, failed.steps));
        }
    }
    // The function has no value at one step only: between two signs, or right after a zero.
    for zero in [0, 1] {
        let only =
            Section::new(Event::crossing(), move |now: &Moment<'_, Top>| match (now.time() / 0.02).round() as u64 {
                40 => f64::NAN,
                step if step + zero == 40 => 0.0,
                _ => 1.0,
            });
        let shard = tops(2, STEPS).section(only).chunk(0, &|| false).unwrap();
        let steps: Vec<u64> = shard.outcome.failures.iter().map(|failed| failed.steps).collect();
        assert_eq!((shard.outcome.finished, steps), (0, vec![40, 40]));
    }
    // A function that has no value from the start on.
    let never = Section::new(Event::crossing(), |_: &Moment<'_, Top>| f64::NAN);
    let shard = tops(2, STEPS).section(never).chunk(0, &|| false).unwrap();
    assert_eq!((shard.outcome.finished, shard.outcome.failures.len(), shard.outcome.failures[0].steps), (0, 2, 0));
}

/// First crossings, in any direction and without a bound, are those of each member alone, whether sections record only
/// them or end members. Lanes have the same bits.
#[test]
fn first_passages_are_those_of_each_member_alone() {
    let (mut expected, mut fell) = (Vec::new(), 0);
    for (member, made) in made(MEMBERS) {
        let Ok((stepper, mut state)) = made else { continue };
        let mut all = Vec::new();
        let run = stepper.observed(&mut state);
        let _ = run
            .event(Event::crossing(), sections::plane(Vector3::x(), Vector3::z()), |now| {
                all.push((vec![now.time().to_bits()], now.rising() == Some(false)));
            })
            .steps(STEPS);
        if let Some((time, falls)) = all.into_iter().next() {
            fell += usize::from(falls);
            expected.push((member, time));
        }
    }
    assert!(expected.len() > 20 && fell > 20, "{} and {fell}", expected.len());
    let section = |in_lanes: bool| {
        let plane = Section::new(Event::crossing(), sections::plane(Vector3::x(), Vector3::z()));
        let plane = plane.keep(["t"], |now: &Moment<'_, Top>| [now.time()]);
        let plane = plane.reduce("passage", Reduction::Quantiles, |now: &Moment<'_, Top>| now.time());
        if in_lanes { plane.in_lanes(sections::plane(Vector3::x(), Vector3::z())) } else { plane }
    };
    for in_lanes in [false, true] {
        let shards = chunks(&tops(MEMBERS, STEPS).section(section(in_lanes).first()));
        assert_eq!(found(&shards, 0), expected);
        assert!(shards.iter().all(|shard| shard.outcome.left == 0));
        let shards = chunks(&tops(MEMBERS, STEPS).section(section(in_lanes).until()));
        assert_eq!(found(&shards, 0), expected);
        assert_eq!(shards.iter().map(|shard| shard.outcome.left).sum::<u64>(), expected.len() as u64);
        assert_passages(&shards);
        for Shard { rows, outcome, .. } in &shards {
            assert_eq!(outcome.finished + outcome.left + outcome.failed(), rows.member.len() as u64);
            let last = rows.member.iter().zip(&rows.step).zip(&rows.status);
            for ((member, step), status) in last.filter(|(_, status)| **status == Status::Left) {
                let (_, time) = expected.iter().find(|(passed, _)| passed == member).unwrap();
                let steps = f64::from_bits(time[0]) / 0.02;
                assert!(*step as f64 >= steps && (*step as f64) < steps + 1.0, "{member}: {step} {steps} {status:?}");
            }
        }
        // All crossings, and not only the first, agree in lanes.
        let shards = [false, true].map(|lanes| chunks(&tops(MEMBERS, STEPS).section(section(lanes))));
        for shards in &shards {
            assert_passages(shards);
        }
        let all = shards.map(|shards| found(&shards, 0));
        assert!(all[0] == all[1] && all[0].len() > expected.len());
    }
}

/// The passages of members that finished or left are those of the rows, whose first column is the time.
fn assert_passages(shards: &[Shard]) {
    for Shard { rows, outcome, .. } in shards {
        let has_ended = |member: u64| {
            let mut own = (0..rows.member.len()).filter(|row| rows.member[*row] == member);
            own.next_back().is_some_and(|row| matches!(rows.status[row], Status::Finished | Status::Left))
        };
        let crossings = &rows.crossings[0];
        let members = crossings.row.iter().map(|row| rows.member[*row]);
        let all: Vec<_> = members.zip(&crossings.columns[0]).filter(|(member, _)| has_ended(*member)).collect();
        let first: Vec<f64> = all.chunk_by(|(one, _), (next, _)| one == next).map(|passed| *passed[0].1).collect();
        let passages = &outcome.passages[0];
        assert_eq!((passages.times, passages.first.count), (all.len() as u64, first.len() as u64));
        assert!((passages.first.mean - first.iter().sum::<f64>() / first.len() as f64).abs() < 1e-13);
        assert_eq!(passages.first.largest.to_bits(), first.iter().copied().fold(0.0, f64::max).to_bits());
    }
}

#[test]
fn another_section_is_another_plan() {
    let section = |event, zero: f64| Section::new(event, move |now: &Moment<'_, Top>| now.momentum().z - zero);
    let plans = [
        tops(20, 100),
        tops(20, 100).section(section(Event::rising(), 0.0)),
        tops(20, 100).section(section(Event::falling(), 0.0)),
        tops(20, 100).section(section(Event::rising(), 1.0)),
        tops(20, 100).section(section(Event::rising(), 0.0).first()),
        tops(20, 100).section(section(Event::rising(), 0.0).until()),
        tops(20, 100).section(section(Event::rising(), 0.0).keep(["t"], |now| [now.time()])),
        tops(20, 100).section(section(Event::rising(), 0.0).reduce("t", Reduction::Moments, |now| 2.0 * now.time())),
    ];
    assert_unlike(&plans);
}

fn is_refused(section: impl FnOnce() -> Section<Top> + std::panic::UnwindSafe) -> String {
    message(|| tops(1, 1).section(section()))
}

#[test]
fn sections_have_names_of_their_own_and_end_nothing() {
    let section = || Section::<Top>::new(Event::rising(), |now: &Moment<'_, Top>| now.momentum().z);
    for name in ["member", "x"] {
        assert!(is_refused(move || section().keep([name], |_| [0.0])).contains(&format!("`{name}`")));
    }
    assert!(is_refused(move || section().keep(["t", "t"], |_| [0.0; 2])).contains("`t`"));
    assert!(is_refused(move || section().reduce("z", Reduction::Moments, |_| 0.0)).contains("`z`"));
    assert!(is_refused(|| Section::new(Event::rising().terminal(), |_: &Moment<'_, Top>| 0.0)).contains("terminal"));
}
