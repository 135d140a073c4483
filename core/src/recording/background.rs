//! A sink in a thread of its own.

use alloc::vec::Vec;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{JoinHandle, spawn};

use super::recorder::{Column, RecordError, Sink, SinkError};

/// A sink that writes in a thread of its own, so that a run waits only if it makes rows faster than they are written.
///
/// At most four blocks wait to be written, so memory doesn't grow. An error of the sink is reported with a later block,
/// or at the end. If this is dropped before its end the sink isn't ended either.
#[derive(Debug)]
pub struct Background<S> {
    /// The channel to the thread, until the table is finished.
    work: Option<SyncSender<Work>>,
    /// Written blocks, whose memory is reused.
    written: Receiver<Vec<f64>>,
    thread: Option<JoinHandle<(S, Result<(), SinkError>)>>,
    /// The sink, returned by the thread.
    sink: Option<S>,
}

enum Work {
    Begin(Vec<Column>),
    Write(Vec<f64>),
    End,
}

/// Limit of the waiting blocks.
const MOST_WAITING: usize = 4;

impl<S: Sink + Send + 'static> Background<S> {
    /// Starts a thread that writes to the sink.
    pub fn new(mut sink: S) -> Self {
        let (work, waiting) = sync_channel(MOST_WAITING);
        let (back, written) = sync_channel(MOST_WAITING + 1);
        let thread = spawn(move || {
            let written = write_all(&mut sink, &waiting, &back);
            (sink, written)
        });
        Self { work: Some(work), written, thread: Some(thread), sink: None }
    }

    /// Returns the sink.
    ///
    /// # Errors
    ///
    /// If the table isn't finished.
    pub fn into_inner(self) -> Result<S, RecordError> {
        self.sink.ok_or_else(|| RecordError::Sink { cause: "the table isn't finished".into() })
    }

    fn send(&mut self, work: Work) -> Result<(), SinkError> {
        match &self.work {
            Some(sender) if sender.send(work).is_ok() => Ok(()),
            // The thread's result has the reason.
            _ => self.join(),
        }
    }

    fn join(&mut self) -> Result<(), SinkError> {
        self.work = None;
        let Some(thread) = self.thread.take() else { return Err("the table is finished".into()) };
        let (sink, written) = thread.join().map_err(|_| "the thread that writes the table has panicked")?;
        self.sink = Some(sink);
        written
    }
}

fn write_all(sink: &mut impl Sink, waiting: &Receiver<Work>, back: &SyncSender<Vec<f64>>) -> Result<(), SinkError> {
    for work in waiting {
        match work {
            Work::Begin(columns) => sink.begin(&columns)?,
            Work::Write(rows) => {
                sink.write(&rows)?;
                // A full channel refuses the block.
                let _ = back.try_send(rows);
            }
            Work::End => return sink.end(),
        }
    }
    // A sink dropped before its end isn't ended, so that the table doesn't look complete.
    Ok(())
}

impl<S: Sink + Send + 'static> Sink for Background<S> {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        self.send(Work::Begin(columns.to_vec()))
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        let mut block = self.written.try_recv().unwrap_or_default();
        block.clear();
        block.extend_from_slice(rows);
        self.send(Work::Write(block))
    }

    fn end(&mut self) -> Result<(), SinkError> {
        if let Some(work) = &self.work {
            // The thread's result has the reason.
            let _ = work.send(Work::End);
        }
        self.join()
    }
}
