//! Numbers as people write them on the command line.

/// Units that a number may be written with on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// No unit.
    None,
    /// A share of one, or per cent.
    Share,
    /// Seconds, minutes or hours; the flag leaves out `_s` of the option's name.
    Time,
    /// Metres without a letter; the flag leaves out `_m`.
    Meters,
    /// Degrees without a sign; the flag leaves out `_deg`.
    Degrees,
    /// Mebibytes without letters; the flag leaves out `_mib`.
    Mebibytes,
}

impl Unit {
    /// End of an option's name that its flag leaves out.
    pub(crate) const fn suffix(self) -> &'static str {
        match self {
            Self::None | Self::Share => "",
            Self::Time => "_s",
            Self::Meters => "_m",
            Self::Degrees => "_deg",
            Self::Mebibytes => "_mib",
        }
    }

    /// Examples of intervals, with and without both ends.
    pub(crate) const fn intervals(self) -> &'static str {
        match self {
            Self::Share => "0.2..0.7, 30%.. or ..0.5",
            Self::Degrees => "10..90, 10.. or ..90",
            _ => "0.3..2, 0.3.. or ..2",
        }
    }
}

/// Width and height, as in `640x480`.
///
/// # Errors
/// What was expected.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    parsed.ok_or_else(|| "expected width and height, as in 640x480".into())
}

/// A share of one, or a percentage.
///
/// # Errors
/// What was expected.
pub fn parse_share(text: &str) -> Result<f64, String> {
    let parsed = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse().map(|v: f64| v / 100.0),
        None => text.trim().parse(),
    };
    parsed.map_err(|_| "expected a share or a percentage, as in 0.02 or 2%".into())
}

/// Seconds, of a time such as `90s`, `5m` or `1h`.
///
/// # Errors
/// What was expected.
pub fn parse_time(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)];
    let parsed = units.iter().find_map(|(unit, seconds)| Some(text.strip_suffix(unit)?.trim().parse::<f64>().ok()? * seconds));
    parsed.filter(|s| s.is_finite()).ok_or_else(|| "expected a time, as in 90s, 5m or 1h".into())
}

/// Two numbers with `..` between them; `None` is an end that is left out.
pub(crate) fn parse_interval(text: &str, number: impl Fn(&str) -> Option<f64>) -> Option<[Option<f64>; 2]> {
    let end = |text: &str| if text.trim().is_empty() { Some(None) } else { number(text).map(Some) };
    let (least, most) = text.split_once("..")?;
    Some([end(least)?, end(most)?])
}

/// A camera and the number of one of its frames, as in `cam_00/3`.
///
/// # Errors
/// What was expected.
pub fn parse_frame(text: &str) -> Result<(String, u32), String> {
    let parsed = text.split_once('/').and_then(|(camera, number)| Some((camera.to_string(), number.parse().ok()?)));
    parsed.ok_or_else(|| FRAME.into())
}

/// The message on how a frame is written.
pub(crate) const FRAME: &str = "expected a camera and the number of a frame, as in cam_00/3";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_shares_and_times_are_read() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        assert!(parse_size("640").is_err() && parse_size("axb").is_err());
        assert_eq!((parse_share("2%"), parse_share("0.02")), (Ok(0.02), Ok(0.02)));
        assert!(parse_share("two").is_err());
        assert_eq!((parse_time("90s"), parse_time("1.5m"), parse_time("1h"), parse_time("7")), (Ok(90.0), Ok(90.0), Ok(3600.0), Ok(7.0)));
        assert!(parse_time("soon").is_err() && parse_time("inf").is_err());
    }

    #[test]
    fn frames_are_read() {
        assert_eq!(parse_frame("cam_00/3"), Ok(("cam_00".into(), 3)));
        assert!(parse_frame("3").is_err() && parse_frame("cam_00/three").is_err());
    }
}
