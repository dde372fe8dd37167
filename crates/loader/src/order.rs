//! The order of samples, and other choices that seed and epoch make.

use enfilade_math::hash_u64;

/// The numbers below `count` in an order that seed and epoch decide.
///
/// ```
/// use enfilade_loader::shuffled;
/// let mut order = shuffled(5, 7, 0);
/// assert_eq!(order, shuffled(5, 7, 0));
/// assert_ne!(order, shuffled(5, 7, 1), "each epoch has an order of its own");
/// order.sort();
/// assert_eq!(order, [0, 1, 2, 3, 4]);
/// ```
pub fn shuffled(count: usize, seed: u64, epoch: u64) -> Vec<usize> {
    let key = hash_u64(hash_u64(seed) ^ epoch);
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        let random = hash_u64(key ^ hash_u64(last as u64));
        order.swap(last, below(random, last + 1));
    }
    order
}

/// A number below `count` from 64 random bits, as [`Rng::below`](enfilade_math::Rng::below) makes it from its own.
pub(crate) fn below(random: u64, count: usize) -> usize {
    ((u128::from(random) * count as u128) >> 64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_permutations_that_seed_and_epoch_decide() {
        let mut order = shuffled(100, 1, 0);
        assert_eq!(order, shuffled(100, 1, 0));
        assert!(order != shuffled(100, 1, 1) && order != shuffled(100, 2, 0));
        order.sort_unstable();
        assert_eq!(order, (0..100).collect::<Vec<_>>());
    }
}
