//! The memory of machine code: few mappings, however many programs there are; pages that are given back; and frames that stay
//! within the stack of a small thread.

use std::thread;

use liestep_late::{Array, Backend, Interpreter, Operation, Program, Source};
use liestep_machine::{MOST_MEMORY, Machine, used_memory};

/// The number of mappings of memory of this process.
fn mappings() -> Option<usize> {
    Some(std::fs::read_to_string("/proc/self/maps").ok()?.lines().count())
}

fn compiled(program: &Program) -> <Machine as Backend<f64>>::Code {
    let code = <Machine as Backend<f64>>::codes(&[program]).expect("code").remove(0);
    <Machine as Backend<f64>>::prepare(&code);
    code
}

/// `number · x`.
fn product(number: f64) -> Program {
    let inputs = vec![Source { array: Array::Half, at: 0 }];
    Program { inputs, literals: vec![number], operations: vec![Operation::Multiply(0, 1)], outputs: vec![2] }
}

fn run<B: Backend<f64>>(code: &B::Code, half: &[f64], outputs: usize) -> Vec<f64> {
    let mut found = vec![0.0; outputs];
    B::run(code, &[], [(Array::Half, half)], &mut found);
    found
}

/// Sums of all products of `count` numbers, in an order that keeps many of them: `Σ_k (x_k + 1) · Π (x_j + 1)`.
fn wide(count: u32) -> Program {
    let inputs = (0..count as usize).map(|at| Source { array: Array::Half, at }).collect();
    let mut operations: Vec<Operation> = (0..count).map(|at| Operation::Add(at, count)).collect();
    let first = count + 1;
    // The first results are read last.
    let mut sum = first + count - 1;
    for at in (0..count - 1).rev() {
        operations.push(Operation::Add(sum, first + at));
        sum = first + u32::try_from(operations.len()).unwrap() - 1;
    }
    Program { inputs, literals: vec![1.0], operations, outputs: vec![sum] }
}

/// One test, as all threads share the arena.
#[test]
fn code_has_one_arena_and_bounded_frames() {
    let before = used_memory();
    drop(compiled(&product(1.0)));
    assert_eq!(used_memory(), before, "code that is dropped gives its pages back");

    let maps = mappings();
    let all: Vec<_> = (0..10_000_u32).map(|number| compiled(&product(number.into()))).collect();
    let taken = used_memory() - before;
    assert!((10_000 * 64..=MOST_MEMORY).contains(&taken), "{taken} bytes");
    for (number, code) in (0..).zip(&all).step_by(997) {
        assert_eq!(run::<Machine>(code, &[0.5], 1), [0.5 * f64::from(number)]);
    }
    if let (Some(maps), Some(now)) = (maps, mappings()) {
        println!("{taken} bytes, {maps} mappings before and {now} after");
        assert!(now < maps + 50, "10,000 programs add {} mappings", now - maps);
    } else {
        println!("mappings are not counted: this system doesn't list them");
    }
    let threads: Vec<_> = (0..64).map(|_| thread::Builder::new().spawn(|| 1).expect("a thread")).collect();
    assert_eq!(threads.into_iter().map(|thread| thread.join().expect("an end")).sum::<i32>(), 64);
    // Every second piece of code leaves a hole, which another one fills.
    let kept: Vec<_> = all.into_iter().step_by(2).collect();
    let half = used_memory();
    let again: Vec<_> = (0..5_000_u32).map(|number| compiled(&product(f64::from(number) + 0.5))).collect();
    assert_eq!((used_memory() - before, used_memory() - half), (taken, taken / 2));
    assert_eq!(run::<Machine>(&again[7], &[2.0], 1), [15.0]);
    assert_eq!(run::<Machine>(&kept[7], &[2.0], 1), [28.0]);
    drop((kept, again));
    assert_eq!(used_memory(), before);

    // Beyond its end programs stay interpreted.
    let (mut all, mut last) = (Vec::new(), usize::MAX);
    while last != used_memory() {
        last = used_memory();
        all.push(compiled(&product(f64::from(u32::try_from(all.len()).unwrap()))));
    }
    let page = MOST_MEMORY / (all.len() - 1);
    assert!(used_memory() + page > MOST_MEMORY, "{} bytes for {} programs", used_memory(), all.len());
    for number in [1, all.len() - 1] {
        assert_eq!(run::<Machine>(&all[number], &[0.5], 1), [0.5 * f64::from(u32::try_from(number).unwrap())]);
    }
    drop(all);
    assert_eq!(used_memory(), before);

    // A frame of many pages, on a thread whose stack is hardly larger.
    for (count, is_compiled) in [(1_000, true), (7_000, true), (20_000, false)] {
        let program = wide(count);
        let half: Vec<f64> = (0..count).map(f64::from).collect();
        let code = <Interpreter as Backend<f64>>::codes(&[&program]).expect("code").remove(0);
        let expected = run::<Interpreter>(&code, &half, 1);
        let compiled = compiled(&program);
        assert_eq!(used_memory() > before, is_compiled, "{count}");
        let stack = thread::Builder::new().stack_size(256 << 10);
        let found = stack.spawn(move || run::<Machine>(&compiled, &half, 1)).expect("a thread").join().expect("an end");
        assert_eq!(found, expected, "{count}");
    }
}
