//! How far a way is free.

/// The farthest free state on the way from 0 to `limit`, and what ends the way there.
///
/// States are tried one after the other, at most `step` apart, and the last step before a hit is halved so many times. `limit` itself is
/// tried in any case.
pub fn free_way<T>(limit: f64, step: f64, halvings: usize, hit: impl Fn(f64) -> Option<T>) -> (f64, Option<T>) {
    let count = (limit.abs() / step).ceil().max(1.0) as usize;
    let state = |k: usize| if k == count { limit } else { limit.signum() * step * k as f64 };
    let Some((first, mut by)) = (1..=count).find_map(|k| Some((k, hit(state(k))?))) else { return (limit, None) };
    let (mut free, mut blocked) = (if first == 1 { 0.0 } else { state(first - 1) }, state(first));
    for _ in 0..halvings {
        let middle = 0.5 * (free + blocked);
        match hit(middle) {
            None => free = middle,
            Some(other) => (blocked, by) = (middle, other),
        }
    }
    (free, Some(by))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_ends_within_a_halved_step_of_what_is_first_in_it() {
        let walls = |at: f64| [("far", 0.9), ("near", 0.52)].into_iter().find(|(_, wall)| at.abs() >= *wall).map(|(name, _)| name);
        for limit in [2.0, -2.0f64] {
            let (free, by) = free_way(limit, 0.1, 5, walls);
            assert_eq!(by, Some("near"));
            assert!(free.abs() < 0.52 && free.abs() > 0.52 - 0.1 / 32.0 && free.signum() == limit.signum(), "{free}");
        }
        assert_eq!(free_way(0.35, 0.1, 5, walls), (0.35, None));
        assert_eq!(free_way(0.0, 0.1, 5, |_| Some(())), (0.0, Some(())));
    }
}
