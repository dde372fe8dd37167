//! Maps over many items on rayon's threads.
//!
//! Rayon's own iterators are compiled again for every closure, some ten thousand lines of intermediate code each, which was two fifths of
//! the planner's compiled code. Here items are cut into pieces, the code that distributes pieces to threads is compiled once, and only the
//! loop over a piece is compiled per closure. The cost per item is the same. Values come in the order of the items, whatever the number of
//! threads.
//!
//! ```
//! let squares = enfilade_parallel::map(&[1, 2, 3], |n| n * n);
//! assert_eq!(squares, [1, 4, 9]);
//! ```
//!
//! Use rayon itself for loops over pixels that write in place, and for sorting and reducing.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Pieces for each thread: many enough that no thread waits long for the last ones.
const PIECES: usize = 32;

/// Maps every item by `value`.
pub fn map<'s, S: Sync, T: Send>(items: &'s [S], value: impl Fn(&'s S) -> T + Sync) -> Vec<T> {
    in_pieces(items.len(), |piece| items[piece].iter().map(&value).collect())
}

/// Maps every number below `count` by `value`.
pub fn map_up_to<T: Send>(count: usize, value: impl Fn(usize) -> T + Sync) -> Vec<T> {
    in_pieces(count, |piece| piece.map(&value).collect())
}

/// Maps every item by `values` and concatenates the results: lists, or an `Option` where some items are left out.
pub fn flat_map<'s, S: Sync, V: IntoIterator<Item: Send>>(items: &'s [S], values: impl Fn(&'s S) -> V + Sync) -> Vec<V::Item> {
    in_pieces(items.len(), |piece| items[piece].iter().flat_map(&values).collect())
}

/// Maps every number below `count` by `values` and concatenates the results, as [`flat_map`].
pub fn flat_map_up_to<V: IntoIterator<Item: Send>>(count: usize, values: impl Fn(usize) -> V + Sync) -> Vec<V::Item> {
    in_pieces(count, |piece| piece.flat_map(&values).collect())
}

/// Maps every item by `value`.
///
/// # Errors
/// Of the errors that occurred, the first in the order of the items; items that have not begun by then are skipped.
pub fn try_map<'s, S: Sync, T: Send, E: Send>(items: &'s [S], value: impl Fn(&'s S) -> Result<T, E> + Sync) -> Result<Vec<T>, E> {
    try_map_up_to(items.len(), |i| value(&items[i]))
}

/// Maps every number below `count` by `value`.
///
/// # Errors
/// As [`try_map`].
pub fn try_map_up_to<T: Send, E: Send>(count: usize, value: impl Fn(usize) -> Result<T, E> + Sync) -> Result<Vec<T>, E> {
    let failed = AtomicBool::new(false);
    let one = |i| {
        let made = (!failed.load(Ordering::Relaxed)).then(|| value(i))?;
        failed.fetch_or(made.is_err(), Ordering::Relaxed);
        Some(made)
    };
    in_pieces(count, |piece| piece.map_while(one).collect()).into_iter().collect()
}

/// Does `work` for every item.
pub fn each<'s, S: Sync>(items: &'s [S], work: impl Fn(&'s S) + Sync) {
    let size = size(items.len());
    hand_out(items.len().div_ceil(size), &|k| items[piece(k, size, items.len())].iter().for_each(&work));
}

/// Concatenates the results of `make` for consecutive ranges that cover all numbers below `count`.
fn in_pieces<T: Send>(count: usize, make: impl Fn(Range<usize>) -> Vec<T> + Sync) -> Vec<T> {
    let size = size(count);
    let made: Vec<Mutex<Vec<T>>> = (0..count.div_ceil(size)).map(|_| Mutex::default()).collect();
    hand_out(made.len(), &|k| {
        let values = make(piece(k, size, count));
        *made[k].lock().unwrap_or_else(PoisonError::into_inner) = values;
    });
    let mut pieces: Vec<Vec<T>> = made.into_iter().map(|piece| piece.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
    let mut all = Vec::with_capacity(pieces.iter().map(Vec::len).sum());
    pieces.iter_mut().for_each(|piece| all.append(piece));
    all
}

/// How many of `count` numbers a piece has.
fn size(count: usize) -> usize {
    count.div_ceil(PIECES * rayon::current_num_threads()).max(1)
}

/// Piece `k` of the numbers below `count`.
fn piece(k: usize, size: usize, count: usize) -> Range<usize> {
    k * size..((k + 1) * size).min(count)
}

/// Hands pieces to threads: the one place that is compiled for rayon.
fn hand_out(pieces: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..pieces).into_par_iter().with_max_len(1).for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_in_order_for_any_number_of_items() {
        for count in [0, 1, 2, 63, 64, 65, 1000] {
            let expected: Vec<usize> = (0..count).map(|i| 3 * i).collect();
            assert_eq!(map_up_to(count, |i| 3 * i), expected);
            assert_eq!(map(&expected, |value| value / 3), (0..count).collect::<Vec<_>>());
            let halves = flat_map_up_to(count, |i| (i % 2 == 0).then_some(i));
            assert_eq!(halves, (0..count).step_by(2).collect::<Vec<_>>());
            assert_eq!(flat_map(&halves, |&i| [i, i]).len(), 2 * halves.len());
        }
    }

    #[test]
    fn each_item_is_worked_on_once() {
        let seen: Vec<Mutex<usize>> = (0..333).map(|_| Mutex::new(0)).collect();
        each(&seen, |times| *times.lock().unwrap() += 1);
        assert!(seen.into_iter().all(|times| times.into_inner().unwrap() == 1));
    }

    #[test]
    fn an_error_is_given_and_ends_what_has_not_begun() {
        let fails = |i: usize| if i == 700 { Err(i) } else { Ok(i) };
        assert_eq!(try_map_up_to(1000, fails), Err(700));
        assert_eq!(try_map_up_to(700, fails).unwrap().len(), 700);
        assert_eq!(try_map(&[5, 700], |&i| fails(i)), Err(700));
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let begun = Mutex::new(0);
        let counted = |i: usize| {
            *begun.lock().unwrap() += 1;
            fails(i)
        };
        assert_eq!(one.install(|| try_map_up_to(1000, counted)), Err(700));
        assert!(*begun.lock().unwrap() < 1000);
    }
}
