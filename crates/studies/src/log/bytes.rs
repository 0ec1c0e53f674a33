//! How far a file is read.

use std::io::{self, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts the bytes that are read of a file, on whatever thread that happens.
#[derive(Clone, Debug, Default)]
pub(super) struct Counted(Arc<AtomicU64>);

/// A reader whose bytes are counted.
pub(super) struct Reader<R> {
    inner: R,
    count: Counted,
}

impl Counted {
    /// `inner` with its bytes counted here.
    pub fn of<R: Read>(&self, inner: R) -> Reader<R> {
        Reader { inner, count: self.clone() }
    }

    /// Bytes read so far.
    pub fn bytes(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl<R: Read> Read for Reader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let taken = self.inner.read(buffer)?;
        self.count.0.fetch_add(taken as u64, Ordering::Relaxed);
        Ok(taken)
    }
}
