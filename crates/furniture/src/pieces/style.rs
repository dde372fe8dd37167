//! Tables of styles: a row is a weight and a style, and rows are drawn in proportion to their weights.

use enfilade_math::Rng;

/// A style from a table of weights and styles, drawn in proportion to the weights.
pub fn drawn<T: Copy>(table: &[(u32, T)], rng: &mut Rng) -> T {
    let total: u32 = table.iter().map(|(weight, _)| weight).sum();
    let mut rest = rng.below(total as usize) as u32;
    for &(weight, style) in table {
        if rest < weight {
            return style;
        }
        rest -= weight;
    }
    unreachable!("the weights add up to {total}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn styles_are_as_frequent_as_their_weights_say() {
        let mut rng = Rng::new(1);
        let mut counts = [0; 3];
        (0..4000).for_each(|_| counts[drawn(&[(1, 0), (0, 1), (3, 2)], &mut rng)] += 1);
        assert_eq!(counts[1], 0);
        // Four standard deviations of a binomial with n = 4000 and p = 1/4 are 110.
        assert!((counts[0] - 1000i32).abs() < 110, "{counts:?}");
    }
}
