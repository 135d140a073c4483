//! The parts of an ensemble's plan: chunks, columns, reductions, members of a table, scenes, shares.

use core::time::Duration;

use liestep::effects::RigidBody;
use liestep::methods::CompositionScheme;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use liestep_ensemble::{Ensemble, Fault, Local, Progress, Reduction, Store, Table, share_of};
use nalgebra::Vector3;

use super::common::{Folder, contents, message, top, tops};
use super::{MEMBERS, STEPS, run};

/// Default chunks are full lanes, or fewer members than lanes, and hold a million rows at most.
#[test]
fn chunks_hold_a_million_rows_at_most() {
    for (steps, every, members) in [(1 << 22, 1 << 22, 8), (1 << 18, 1, 3), (1 << 30, 1, 1)] {
        let chunks = Ensemble::new("tops", 24, steps, top).every(every).chunks();
        assert_eq!(chunks, 24_u64.div_ceil(members), "{steps} steps, every {every}");
    }
}

/// Chunks are work for many workers, unless there is hardly any; a dearer method has smaller ones; very many members go to a
/// few thousand files.
#[test]
fn chunks_know_workers_and_what_a_step_costs() {
    let chunks = |members, steps| Ensemble::new("tops", members, steps, top).chunks();
    assert_eq!([chunks(100, 1_000), chunks(20_000, 1_000), chunks(64_000, 1 << 20)], [13, 116, 1_616]);
    assert!((2_000..8_000).contains(&chunks(1_000_000_000, 1_000)), "{}", chunks(1_000_000_000, 1_000));
    let composed = Ensemble::new("tops", 20_000, 1_000, |member| {
        let (stepper, state) = top(member)?;
        let stepper = Stepper::composed(*stepper.scene(), 0.02, CompositionScheme::KAHAN_LI_8)?;
        let state = stepper.start(state.attitude(), Vector3::zeros())?;
        Ok((stepper, state))
    });
    // The composition has seventeen stages, a second's work of which are 16 times fewer members.
    assert!((150..=260).contains(&composed.chunks()), "{}", composed.chunks());
}

/// Members one by one can be shared, the first of them alone.
#[test]
fn chunks_of_members_one_by_one_can_be_shared() {
    for (members, steps, chunks) in
        [(0, 1, 0), (1, 1, 1), (24, 1 << 20, 24), (200, 4800, 59), (200, 1 << 20, 130), (6400, 1, 138)]
    {
        assert_eq!(Ensemble::one_by_one("tops", members, steps, top).chunks(), chunks, "{members} of {steps} steps");
    }
}

/// Columns named at run time are as others; places that aren't filled are NaN.
#[test]
fn columns_are_named_when_the_program_runs() {
    let fixed = tops(20, STEPS).keep(["t", "none"], |run| [run.stepper.time(run.state), f64::NAN]);
    let named = tops(20, STEPS).keep_named(&["t", "none"], |run, row| row[0] = run.stepper.time(run.state));
    assert_eq!(fixed.fingerprint(), named.fingerprint());
    assert!(message(|| tops(1, 1).keep_named(&["a", "a"], |_, _| ())).contains("`a`"));
}

#[test]
fn columns_and_reductions_have_names_of_their_own() {
    for name in ["member", "step", "status", "x", "energy"] {
        let said = message(|| tops(1, 1).keep([name], |_| [0.0]));
        assert!(said.contains(&format!("`{name}`")), "{said}");
    }
    assert!(message(|| tops(1, 1).keep(["a", "a"], |_| [0.0; 2])).contains("`a`"));
    assert!(message(|| tops(1, 1).reduce("z", Reduction::Moments, |_| 0.0)).contains("`z`"));
    let histogram =
        |range, bins| message(move || tops(1, 1).reduce("h", Reduction::Histogram { range, bins }, |_| 0.0));
    assert!(histogram(0.0..1.0, 0).contains("bin"));
    for range in [1.0..0.0, 0.0..0.0, 0.0..f64::NAN, f64::NEG_INFINITY..0.0, f64::MIN..f64::MAX] {
        let said = histogram(range.clone(), 4);
        assert!(said.contains("`h`") && said.contains("range"), "{said}");
    }
}

/// Each row of a table is a member; a member beyond the last row fails with a message.
#[test]
fn members_are_read_from_a_table() {
    let spins = Table::new([("spin".to_owned(), vec![5.0, 6.0, 7.0])]).unwrap();
    let ensemble = Ensemble::new("spins", 4, 10, |member| {
        let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.0, 3.0))? };
        let stepper = Stepper::new(body, 0.01)?;
        let state = stepper.start(SO3::identity(), Vector3::z() * member.cell("spin")?)?;
        Ok((stepper, state))
    });
    let ensemble = ensemble.over(spins).keep(["spin"], |run| [run.stepper.velocity(run.state).z]);
    let shard = ensemble.chunk(0, &|| false).unwrap();
    for (found, expected) in shard.rows.columns[0].iter().zip([5.0_f64, 6.0, 7.0]) {
        assert!((found - expected).abs() < 1e-13);
    }
    let [failed] = shard.outcome.failures.as_slice() else { panic!("{:?}", shard.outcome) };
    assert!(failed.member == 3 && failed.failure.to_string().contains("no row 3"), "{failed:?}");
    let uneven = Table::new([("a".to_owned(), vec![1.0]), ("b".to_owned(), vec![])]);
    assert!(uneven.is_err_and(|error| error.to_string().contains("`b`")));
    assert!(Table::read("Cargo.toml").is_err_and(|error| error.to_string().contains("Cargo.toml")));
}

/// A declaration for `f64` alone, and compositions that can't share a batch.
#[test]
fn other_scenes_and_methods() {
    #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
    #[derive(Clone)]
    struct Body {
        J_d: NonstandardInertia,
    }

    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0)).unwrap();
    let alone = Ensemble::one_by_one("bodies", 3, 100, move |member| {
        let stepper = Stepper::new(Body { J_d }, 0.01)?;
        let state = stepper.start(SO3::identity(), member.direction("Omega"))?;
        Ok((stepper, state))
    });
    let energy = alone.chunks_of(3).keep(["energy"], |run| [run.stepper.energy(run.state)]).every(50);
    let energy = energy.chunk(0, &|| false).unwrap();
    let energy = &energy.rows.columns[0];
    assert!(energy.chunks(3).all(|run| (run[0] - run[2]).abs() < 1e-14), "{energy:?}");
    let composed = |alone: bool| {
        let make = move |member: &liestep_ensemble::Member<'_>| {
            // Two schemes alternate, so that neighbours differ.
            let schemes = [CompositionScheme::SUZUKI_4, CompositionScheme::KAHAN_LI_6];
            let scheme = schemes[usize::from(member.number() % 3 == 1)];
            let stepper = Stepper::composed(RigidBody { J_d }, 0.02, scheme)?;
            let state = stepper.start(SO3::identity(), member.direction("Omega") * 3.0)?;
            Ok((stepper, state))
        };
        let made = if alone {
            Ensemble::one_by_one("composed", 20, 50, make)
        } else {
            Ensemble::new("composed", 20, 50, make)
        };
        made.chunks_of(20).keep(["x", "y", "z"], |run| run.state.momentum().into()).chunk(0, &|| false).unwrap()
    };
    assert_eq!(composed(false), composed(true));
}

/// A file has its chunk's number in its name and inside.
#[test]
fn a_shard_of_another_number_is_damaged() {
    let (ensemble, folder) = (tops(MEMBERS, STEPS), Folder::new("renamed"));
    let engine = Local::threads(2);
    run(&ensemble, &engine, &folder);
    let store = Store::folder(&folder.0).unwrap().verified();
    let (_, path) = store.files().unwrap().remove(2);
    let name = path.file_name().unwrap().to_str().unwrap().replace("00000002-", "00000005-");
    let renamed = path.with_file_name(name);
    std::fs::copy(&path, &renamed).unwrap();
    assert_eq!(Store::read(&renamed), Err(Fault::Altered(renamed.clone())));
    assert_eq!(ensemble.run(&engine, &store).unwrap().faults, [Fault::Altered(renamed.clone())]);
    assert!(!renamed.exists());
}

/// Helpers compute the missing chunks of other shares, and no chunk is computed twice.
#[test]
fn who_is_done_helps_others() {
    let (ensemble, folder, whole) = (tops(MEMBERS, STEPS), Folder::new("helped"), Folder::new("whole"));
    let expected = run(&ensemble, &Local::threads(2), &whole);
    assert_eq!(run(&ensemble, &Local::threads(1).share(1, 3), &folder).made, 2);
    let helped = run(&ensemble, &Local::threads(2).share(2, 3).helping(), &folder);
    assert_eq!((helped.made, helped.missing, helped.outcome.finished), (5, 0, expected.outcome.finished));
    assert!(contents(&folder.0) == contents(&whole.0));
}

/// A share of many reads the heads of its own chunks only, and no rows.
#[test]
fn a_share_sums_its_own_chunks_until_all_are_there() {
    let (ensemble, folder) = (tops(MEMBERS, STEPS), Folder::new("sums-of-shares"));
    let of_share = |share| run(&ensemble, &Local::threads(1).share(share, 3), &folder);
    let counted = [1, 2, 0]
        .map(|share| (of_share(share).missing, of_share(share).outcome.finished + of_share(share).outcome.failed()));
    assert_eq!(counted, [(5, 40), (3, 40), (0, MEMBERS)]);
}

/// A full folder is summed from one small file without reading heads; a verified store reads all bytes.
#[test]
fn a_whole_folder_is_told_of_from_its_sum() {
    let (ensemble, folder) = (tops(1003, 2).chunks_of(1), Folder::new("sums-of-folders"));
    let made = run(&ensemble, &Local::threads(2), &folder);
    assert_eq!((made.made, made.missing, made.outcome.finished + made.outcome.failed()), (1003, 0, 1003));
    let shards: Vec<_> = ensemble.shards(&Store::folder(&folder.0).unwrap()).unwrap().flatten().collect();
    assert_eq!(shards.iter().map(|shard| shard.outcome.finished).sum::<u64>(), made.outcome.finished);
    let store = Store::folder(&folder.0).unwrap();
    let sum = folder.0.join("00000.toml");
    assert!(sum.exists() && !folder.0.join("00001.toml").exists());
    let (_, path) = store.files().unwrap().remove(500);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, b"ARROW1").unwrap();
    assert_eq!(run(&ensemble, &Local::threads(1), &folder).outcome, made.outcome);
    // Heads are read if the sum is missing or belongs to other files.
    for text in ["", &std::fs::read_to_string(&sum).unwrap().replace("names = ", "names = 1")] {
        std::fs::write(&path, &whole).unwrap();
        std::fs::write(&sum, text).unwrap();
        assert_eq!(run(&ensemble, &Local::threads(1), &folder).outcome, made.outcome);
    }
    std::fs::write(&path, b"ARROW1").unwrap();
    let again = ensemble.run(&Local::threads(1), &store.verified()).unwrap();
    assert_eq!((again.made, &again.faults[..], again.outcome), (1, &[Fault::Altered(path)][..], made.outcome));
}

#[test]
fn progress_says_what_is_left() {
    let said = |seconds| Progress { done: 57, chunks: 400, remaining: Duration::from_secs(seconds) }.to_string();
    assert_eq!(said(119), "57 of 400 chunks, about 119 s left");
    assert_eq!([said(120), said(7200)].map(|said| said[18..].to_owned()), ["about 2 min left", "about 2 h left"]);
}

#[test]
fn shares_are_read_from_command_lines() {
    assert_eq!(share_of("2/8"), Ok((2, 8)));
    for wrong in ["8/8", "1", "a/b", "-1/2", "1/0", ""] {
        assert!(share_of(wrong).is_err_and(|message| message.contains("i/n")), "{wrong}");
    }
}
