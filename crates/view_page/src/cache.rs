//! A cache of what was read lately, up to a number of bytes.

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

/// Values by key. When they take too many bytes, the least recently used ones are dropped.
///
/// A value is kept with the stamp of the file that it was made from, and made again when the stamp differs. If several requests ask for the
/// same key at the same time, the value is made once.
pub struct Cache<K, V> {
    max_bytes: usize,
    entries: Mutex<Entries<K, V>>,
}

struct Entries<K, V> {
    clock: u64,
    by_key: HashMap<K, Entry<V>>,
}

/// A value that is here or is being made, and when it was last used.
struct Entry<V> {
    used: u64,
    bytes: usize,
    slot: Slot<V>,
}

/// Slot of a value. Locked while the value is being made.
type Slot<V> = Arc<Mutex<Option<(Stamp, Arc<V>)>>>;

/// Length and time of change of the file that a value was made from.
pub type Stamp = (u64, Option<std::time::SystemTime>);

impl<K: Eq + Hash + Clone, V: Weight> Cache<K, V> {
    /// An empty cache.
    pub fn new(max_bytes: usize) -> Self {
        Self { max_bytes, entries: Mutex::new(Entries { clock: 0, by_key: HashMap::new() }) }
    }

    /// The value of `key` for a file with this stamp; `make` makes it if it is not here.
    ///
    /// # Errors
    /// The errors of `make`; then nothing is kept.
    pub fn get<E>(&self, key: &K, stamp: Stamp, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        let slot = {
            let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
            entries.clock += 1;
            let clock = entries.clock;
            let entry = entries.by_key.entry(key.clone()).or_insert_with(|| Entry { used: 0, bytes: 0, slot: Arc::default() });
            entry.used = clock;
            Arc::clone(&entry.slot)
        };
        // A second request for the same value waits here until the first has made it.
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

    /// Removes an entry whose value could not be made, so that requests for missing files fill no memory.
    fn forget(&self, key: &K, slot: &Slot<V>) {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        if entries.by_key.get(key).is_some_and(|entry| Arc::ptr_eq(&entry.slot, slot)) {
            entries.by_key.remove(key);
        }
    }

    fn make_room(&self, key: &K, bytes: usize) {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(entry) = entries.by_key.get_mut(key) {
            entry.bytes = bytes;
        }
        let mut total: usize = entries.by_key.values().map(|entry| entry.bytes).sum();
        while total > self.max_bytes {
            let others = entries.by_key.iter().filter(|(other, entry)| *other != key && entry.bytes > 0);
            let Some(oldest) = others.min_by_key(|(_, entry)| entry.used).map(|(other, _)| other.clone()) else { break };
            total -= entries.by_key.remove(&oldest).map_or(0, |entry| entry.bytes);
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
