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

pub fn parse_layer(text: &str) -> Result<enfilade_frame::Layer, String> {
    let known = || enfilade_frame::LAYERS.iter().map(|spec| spec.name).collect::<Vec<_>>().join(", ");
    enfilade_frame::Layer::from_name(text.trim()).ok_or_else(|| format!("the layers are: {}", known()))
}

/// A share of one, or a percentage.
pub fn parse_share(text: &str) -> Result<f32, String> {
    enfilade_options::text::parse_share(text).map(|share| share as f32)
}

/// Shares from..to, of which one may be left out.
pub fn parse_overlap(text: &str) -> Result<[f32; 2], String> {
    let bound = |text: &str, default: f32| if text.trim().is_empty() { Ok(default) } else { parse_share(text) };
    let parsed = text.split_once("..").and_then(|(least, most)| Some([bound(least, 0.0).ok()?, bound(most, 1.0).ok()?]));
    let expected = "expected two shares from 0 to 1, as in 0.2..0.7, 20%.. or ..0.5";
    parsed.filter(|[least, most]| 0.0 <= *least && least <= most && *most <= 1.0).ok_or_else(|| expected.into())
}

/// A camera and the number of one of its frames.
pub fn parse_frame(text: &str) -> Result<(String, u32), String> {
    let parsed = text.split_once('/').and_then(|(camera, number)| Some((camera.to_string(), number.parse().ok()?)));
    parsed.ok_or_else(|| "expected a camera and the number of a frame, as in cam_00/3".into())
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
        assert_eq!((parse_share("2%"), parse_share("0.02")), (Ok(0.02), Ok(0.02)));
        assert!(parse_share("two").is_err());
        assert_eq!(
            (parse_overlap("0.2..0.7"), parse_overlap("20%.."), parse_overlap("..0.5")),
            (Ok([0.2, 0.7]), Ok([0.2, 1.0]), Ok([0.0, 0.5]))
        );
        assert!(["0.2", "0.7..0.2", "0..2", "a..b"].iter().all(|text| parse_overlap(text).is_err()));
        assert_eq!(parse_frame("cam_00/3"), Ok(("cam_00".into(), 3)));
        assert!(parse_frame("3").is_err() && parse_frame("cam_00/three").is_err());
        assert_eq!((parse_range("0..10"), parse_range("5.."), parse_range("7")), (Ok(0..10), Ok(5..u32::MAX), Ok(7..8)));
        assert!(parse_range("3..3").is_err() && parse_range("a..b").is_err() && parse_layer("colour").is_err());
    }
}
