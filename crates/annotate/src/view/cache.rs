//! What was read lately, up to so many bytes.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

/// How many bytes a value takes.
pub trait Weight {
    /// Bytes.
    fn weight(&self) -> usize;
}

impl Weight for Vec<u8> {
    fn weight(&self) -> usize {
        self.len()
    }
}

/// Values by key; the one that was asked for the longest ago goes first when they become too many bytes.
///
/// A value is kept with the stamp of what it was made from, and made again when the stamp differs. Requests for the same key at
/// the same time make it once.
pub struct Cache<K, V> {
    most_bytes: usize,
    shelf: Mutex<Shelf<K, V>>,
}

struct Shelf<K, V> {
    clock: u64,
    places: HashMap<K, Place<V>>,
}

/// A value's place, which is there before the value is.
struct Place<V> {
    used: u64,
    bytes: usize,
    slot: Slot<V>,
}

/// Locked while the value is being made.
type Slot<V> = Arc<Mutex<Option<(Stamp, Arc<V>)>>>;

/// Length and time of change of the file that a value was made from.
pub type Stamp = (u64, Option<std::time::SystemTime>);

impl<K: Eq + Hash + Clone, V: Weight> Cache<K, V> {
    /// An empty one.
    pub fn new(most_bytes: usize) -> Self {
        Self { most_bytes, shelf: Mutex::new(Shelf { clock: 0, places: HashMap::new() }) }
    }

    /// The value of `key` as of `stamp`, by `make` where it is not there.
    ///
    /// # Errors
    /// Those of `make`; then nothing is kept.
    pub fn get<E>(&self, key: &K, stamp: Stamp, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        let slot = {
            let mut shelf = self.shelf.lock().unwrap_or_else(PoisonError::into_inner);
            shelf.clock += 1;
            let clock = shelf.clock;
            let place = shelf.places.entry(key.clone()).or_insert_with(|| Place { used: 0, bytes: 0, slot: Arc::default() });
            place.used = clock;
            Arc::clone(&place.slot)
        };
        // Whoever comes second waits here, and finds the value.
        let mut held = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((found, value)) = held.as_ref()
            && *found == stamp
        {
            return Ok(Arc::clone(value));
        }
        let made = make().inspect_err(|_| self.forget(key, &slot))?;
        let value = Arc::new(made);
        *held = Some((stamp, Arc::clone(&value)));
        drop(held);
        self.make_room(key, value.weight());
        Ok(value)
    }

    /// Takes away a place that has no value, so that asking for what is not there fills no memory.
    fn forget(&self, key: &K, slot: &Slot<V>) {
        let mut shelf = self.shelf.lock().unwrap_or_else(PoisonError::into_inner);
        if shelf.places.get(key).is_some_and(|place| Arc::ptr_eq(&place.slot, slot)) {
            shelf.places.remove(key);
        }
    }

    fn make_room(&self, key: &K, bytes: usize) {
        let mut shelf = self.shelf.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(place) = shelf.places.get_mut(key) {
            place.bytes = bytes;
        }
        let mut total: usize = shelf.places.values().map(|place| place.bytes).sum();
        while total > self.most_bytes {
            let others = shelf.places.iter().filter(|(other, place)| *other != key && place.bytes > 0);
            let Some(oldest) = others.min_by_key(|(_, place)| place.used).map(|(other, _)| other.clone()) else { break };
            total -= shelf.places.remove(&oldest).map_or(0, |place| place.bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STAMP: Stamp = (1, None);

    fn made(cache: &Cache<u32, Vec<u8>>, key: u32, stamp: Stamp) -> bool {
        let mut made = false;
        let value = cache.get(&key, stamp, || {
            made = true;
            Ok::<_, ()>(vec![key as u8; 10])
        });
        assert_eq!(*value.unwrap(), vec![key as u8; 10]);
        made
    }

    #[test]
    fn a_value_is_made_once_until_its_file_changes() {
        let cache = Cache::new(100);
        assert!(made(&cache, 1, STAMP));
        assert!(!made(&cache, 1, STAMP));
        assert!(made(&cache, 1, (2, None)));
        assert!(!made(&cache, 1, (2, None)));
    }

    #[test]
    fn the_one_unused_for_longest_goes_first() {
        let cache = Cache::new(30);
        for key in 1..=3 {
            assert!(made(&cache, key, STAMP));
        }
        assert!(!made(&cache, 1, STAMP));
        assert!(made(&cache, 4, STAMP));
        assert!(!made(&cache, 1, STAMP) && !made(&cache, 3, STAMP) && !made(&cache, 4, STAMP));
        assert!(made(&cache, 2, STAMP));
    }

    #[test]
    fn a_failure_is_not_kept() {
        let cache: Cache<u32, Vec<u8>> = Cache::new(30);
        assert_eq!(cache.get(&1, STAMP, || Err("no")), Err("no"));
        assert!(made(&cache, 1, STAMP));
    }
}
