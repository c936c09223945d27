//! Work on all cores whose results come one by one and in order, of which no more than a window waits.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Results that may wait for an earlier one, for each thread.
const WINDOW_PER_THREAD: usize = 16;

/// What the threads share.
struct State<T> {
    /// The first piece of work that nobody took.
    next: usize,
    /// How many results were handed on.
    taken: usize,
    waiting: BTreeMap<usize, T>,
    /// Whether the one who takes the results has gone, or a thread has panicked.
    is_over: bool,
}

/// Ends everybody's waiting, however a thread ends.
struct Ending<'a, T>(&'a Mutex<State<T>>, &'a Condvar);

impl<T> Drop for Ending<'_, T> {
    fn drop(&mut self) {
        lock(self.0).is_over = true;
        self.1.notify_all();
    }
}

/// Computes `work(0)` to `work(count - 1)` on so many threads, and gives each result to `take`, in
/// order, as soon as it and all before it are there.
///
/// # Errors
/// The first error of `take`, after which no further work begins.
pub(crate) fn for_each<T: Send, E>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(usize, T) -> Result<(), E>,
) -> Result<(), E> {
    let window = WINDOW_PER_THREAD * threads.max(1);
    let state = Mutex::new(State { next: 0, taken: 0, waiting: BTreeMap::new(), is_over: false });
    let changed = Condvar::new();
    let run = || loop {
        let mut shared = lock(&state);
        while !shared.is_over && shared.next < count && shared.next >= shared.taken + window {
            shared = changed.wait(shared).unwrap_or_else(PoisonError::into_inner);
        }
        if shared.is_over || shared.next >= count {
            return;
        }
        let index = shared.next;
        shared.next += 1;
        drop(shared);
        let panicking = Ending(&state, &changed);
        let result = work(index);
        std::mem::forget(panicking);
        lock(&state).waiting.insert(index, result);
        changed.notify_all();
    };
    std::thread::scope(|scope| {
        for _ in 0..threads.max(1).min(count) {
            scope.spawn(run);
        }
        let _ending = Ending(&state, &changed);
        for index in 0..count {
            let mut shared = lock(&state);
            let result = loop {
                if let Some(result) = shared.waiting.remove(&index) {
                    break result;
                }
                if shared.is_over {
                    // A thread has panicked: the scope passes that on.
                    return Ok(());
                }
                shared = changed.wait(shared).unwrap_or_else(PoisonError::into_inner);
            };
            shared.taken = index + 1;
            drop(shared);
            changed.notify_all();
            take(index, result)?;
        }
        Ok(())
    })
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn results_come_in_order_and_no_more_than_a_window_waits() {
        for threads in [1, 3] {
            let (begun, mut taken) = (AtomicUsize::new(0), Vec::new());
            let work = |index: usize| {
                begun.fetch_add(1, Ordering::SeqCst);
                if index == 0 {
                    // The others must wait for the first.
                    std::thread::sleep(std::time::Duration::from_millis(50));
                    assert!(begun.load(Ordering::SeqCst) <= WINDOW_PER_THREAD * threads);
                }
                index * index
            };
            let outcome = for_each(200, threads, work, |index, square| {
                taken.push((index, square));
                Ok::<(), ()>(())
            });
            assert_eq!(outcome, Ok(()));
            assert_eq!(taken, (0..200).map(|i| (i, i * i)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn an_error_of_the_reader_ends_the_work() {
        let begun = AtomicUsize::new(0);
        let work = |_| begun.fetch_add(1, Ordering::SeqCst);
        let outcome = for_each(100_000, 2, work, |i, _| if i < 5 { Ok(()) } else { Err(i) });
        assert_eq!(outcome, Err(5));
        assert!(begun.load(Ordering::SeqCst) < 1000);
        assert_eq!(for_each(0, 2, |i| i, |_, _| Err("there is nothing")), Ok(()));
    }
}
