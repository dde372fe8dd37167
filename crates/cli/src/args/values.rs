//! Values of flags, as people write them.

/// Frame numbers: `a..b` without b, `a..`, `..b`, or one number.
pub fn parse_range(text: &str) -> Result<std::ops::Range<u32>, String> {
    let number = |text: &str, default: u32| if text.trim().is_empty() { Ok(default) } else { text.trim().parse() };
    let parsed = match text.split_once("..") {
        Some((first, end)) => number(first, 0).and_then(|first| Ok(first..number(end, u32::MAX)?)),
        None => text.trim().parse().map(|only: u32| only..only.saturating_add(1)),
    };
    let expected = "expected frame numbers, as in 0..10, 5.. or 7";
    parsed.ok().filter(|range| !range.is_empty()).ok_or_else(|| expected.into())
}

pub fn parse_shares(text: &str) -> Result<[f64; 3], String> {
    let shares: Option<Vec<f64>> = text.split(',').map(|share| share.trim().parse().ok()).collect();
    shares.and_then(|shares| shares.try_into().ok()).ok_or_else(|| "expected three numbers, as in 80,10,10".into())
}

pub fn parse_pixel(text: &str) -> Result<(u32, u32), String> {
    let parsed = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    parsed.ok_or_else(|| "expected column and row, as in 160,120".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_pixels_are_read() {
        assert_eq!(parse_pixel("3, 4"), Ok((3, 4)));
        assert!(parse_pixel("3").is_err());
        assert_eq!(parse_shares("80,10, 10"), Ok([80.0, 10.0, 10.0]));
        assert!(parse_shares("80,20").is_err() && parse_shares("a,b,c").is_err());
        assert_eq!((parse_range("0..10"), parse_range("5.."), parse_range("7")), (Ok(0..10), Ok(5..u32::MAX), Ok(7..8)));
        assert!(parse_range("3..3").is_err() && parse_range("a..b").is_err());
    }
}
