//! IES photometric files: ANSI/IES LM-63 of 1986, 1991, 1995, 2002 and 2019.
//!
//! | part | support |
//! |---|---|
//! | identification, keywords | skipped; the first line states the edition, none means 1986 |
//! | `TILT` | `NONE`; the factors of `INCLUDE` and of a file are not used, with a warning: they depend on how the luminaire hangs |
//! | photometric type | C; A and B, for headlamps and floodlights, are an error |
//! | candela multiplier, ballast factor | multiply all intensities, and until 1991 the ballast-lamp factor too |
//! | lamps, lumens, units, dimensions, watts | read, not used: the luminaire is a point |

use crate::ImportError;
use enfilade_scene::PhotometricWeb;
use std::path::Path;

/// More angles than this are a mistake, not a luminaire.
const MAX_ANGLES: usize = 100_000;

/// A photometric web and what was not used of its file.
#[derive(Debug)]
pub(crate) struct Profile {
    pub web: PhotometricWeb,
    pub warnings: Vec<String>,
}

/// Reads a photometric file. `file` and `place` locate the bytes in messages; the line is added to the place.
///
/// # Errors
/// When it is not LM-63, cut short, of an unsupported type, or has numbers that make no sense.
pub(crate) fn parse(bytes: &[u8], file: &Path, place: &str) -> Result<Profile, ImportError> {
    let text = enfilade_scene::decoded_text(bytes);
    let mut numbers = Numbers { file, place, line: 1, rest: Vec::new(), last_line: text.lines().count() };
    let mut warnings = Vec::new();
    let edition = Edition::of(text.lines().next().unwrap_or(""));
    let Some((tilt_line, tilt)) = text.lines().enumerate().find_map(|(i, line)| Some((i, line.trim().strip_prefix("TILT=")?.trim())))
    else {
        return Err(numbers.error("found no line TILT=…, expected an IES photometric file (LM-63); check that it is one"));
    };
    numbers.rest = text
        .lines()
        .enumerate()
        .skip(tilt_line + 1)
        .flat_map(|(i, line)| line.split(|c: char| c.is_whitespace() || c == ',').filter(|t| !t.is_empty()).map(move |t| (i + 1, t)))
        .collect();
    numbers.rest.reverse();
    numbers.line = tilt_line + 1;
    if tilt == "INCLUDE" {
        numbers.next("the lamp's position")?;
        let pairs = numbers.count("the number of tilt angles")?;
        for _ in 0..2 * pairs {
            numbers.next("a tilt angle or factor")?;
        }
    }
    if tilt != "NONE" {
        warnings.push(format!("TILT={tilt} was not used: the light is as strong as measured, however the luminaire hangs"));
    }

    numbers.next("the number of lamps")?;
    numbers.next("the lumens per lamp")?;
    let multiplier = numbers.next("the candela multiplier")?;
    let vertical_count = numbers.count("the number of vertical angles")?;
    let horizontal_count = numbers.count("the number of horizontal angles")?;
    let photometric_type = numbers.next("the photometric type")?;
    if photometric_type != 1.0 {
        return Err(numbers.error(format!(
            "found photometric type {photometric_type} (1 is C, 2 is B, 3 is A), expected type C; convert the file to type C"
        )));
    }
    for what in ["the units type", "the width", "the length", "the height"] {
        numbers.next(what)?;
    }
    let ballast = numbers.next("the ballast factor")?;
    let ballast_lamp = numbers.next("the ballast-lamp photometric factor")?;
    numbers.next("the input watts")?;
    let factor = multiplier * ballast * if edition == Edition::Until1991 { ballast_lamp } else { 1.0 };
    if !(factor > 0.0 && factor.is_finite()) {
        return Err(numbers.error(format!(
            "found candela multiplier {multiplier}, ballast factor {ballast} and ballast-lamp factor {ballast_lamp}, expected positive numbers"
        )));
    }
    let vertical = numbers.take(vertical_count, "a vertical angle")?;
    let horizontal = numbers.take(horizontal_count, "a horizontal angle")?;
    let candela = numbers.take(vertical_count * horizontal_count, "an intensity")?.into_iter().map(|c| c * factor).collect();
    let web =
        PhotometricWeb::new(vertical, horizontal, candela).map_err(|problem| numbers.error(format!("{problem}; correct the file")))?;
    if let Some((line, extra)) = numbers.rest.last() {
        warnings.push(format!("line {line}: {extra:?} and what follows is beyond the last intensity and was left out"));
    }
    Ok(Profile { web, warnings })
}

/// The editions of the format, as far as they differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edition {
    /// 1986, without identification, and 1991.
    Until1991,
    Later,
}

impl Edition {
    fn of(first_line: &str) -> Self {
        let line = first_line.trim();
        let later = line.starts_with("IESNA:LM-63-") || line.starts_with("IES:LM-63-");
        if later { Self::Later } else { Self::Until1991 }
    }
}

/// The numbers after the TILT line, last first.
struct Numbers<'a> {
    file: &'a Path,
    place: &'a str,
    /// Line of the number read last.
    line: usize,
    rest: Vec<(usize, &'a str)>,
    last_line: usize,
}

impl Numbers<'_> {
    fn error(&self, problem: impl Into<String>) -> ImportError {
        let line = format!("line {}", self.line);
        let place = if self.place.is_empty() { line } else { format!("{}, {line}", self.place) };
        ImportError::malformed(self.file, place, problem)
    }

    fn next(&mut self, what: &str) -> Result<f32, ImportError> {
        let Some((line, token)) = self.rest.pop() else {
            self.line = self.last_line;
            return Err(self.error(format!("the file ends where {what} was expected; it was cut short, so get it again")));
        };
        self.line = line;
        match token.parse::<f32>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(format!("found {token:?}, expected {what}, a number; correct the file"))),
        }
    }

    fn count(&mut self, what: &str) -> Result<usize, ImportError> {
        let number = self.next(what)?;
        let whole = number >= 1.0 && number <= MAX_ANGLES as f32 && number.fract() == 0.0;
        if whole {
            Ok(number as usize)
        } else {
            Err(self.error(format!("found {number}, expected {what}, a whole number from 1; correct the file")))
        }
    }

    fn take(&mut self, count: usize, what: &str) -> Result<Vec<f32>, ImportError> {
        // Checked first, so that a wrong count allocates nothing.
        if count > self.rest.len() {
            self.line = self.last_line;
            return Err(self.error(format!("the file ends before {count} times {what}; it was cut short, so get it again")));
        }
        (0..count).map(|_| self.next(what)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec3;

    const DOWNLIGHT: &str = "IESNA:LM-63-2002\n[TEST] 1234\n[MANUFAC] none\nTILT=NONE\n1 1000 2.0 3 1 1 2 0.1 0.1 0.0\n0.5 1.0 12\n\
                             0 45 90\n0\n100 60\n0\n";

    fn parse_text(text: &str) -> Result<Profile, String> {
        parse(text.as_bytes(), "lamp.ies".as_ref(), "").map_err(|e| e.to_string())
    }

    #[test]
    fn intensities_are_multiplied_by_their_factors() {
        let profile = parse_text(DOWNLIGHT).unwrap();
        assert!(profile.warnings.is_empty());
        // 100 cd × 2.0 × ballast 0.5.
        assert_eq!(profile.web.candela(Vec3::NEG_Z), 100.0);
        assert!((profile.web.candela(Vec3::new(1.0, 0.0, -1.0).normalize()) - 60.0).abs() < 1e-3);
        assert_eq!(profile.web.candela(Vec3::Z), 0.0);
        // The third factor counted until 1991 only.
        for (first_line, expected) in [("IESNA91", 25.0), ("", 25.0), ("IES:LM-63-2019", 100.0), ("IESNA:LM-63-1995", 100.0)] {
            let text = DOWNLIGHT.replace("IESNA:LM-63-2002", first_line).replace("0.5 1.0 12", "0.5 0.25 12");
            assert_eq!(parse_text(&text).unwrap().web.candela(Vec3::NEG_Z), expected, "{first_line}");
        }
    }

    #[test]
    fn tilt_factors_are_read_and_reported() {
        let text = DOWNLIGHT.replace("TILT=NONE", "TILT=INCLUDE\n1\n3\n0 90 180\n1.0 0.9\n0.95");
        let profile = parse_text(&text).unwrap();
        assert!(profile.warnings[0].contains("TILT=INCLUDE was not used"));
        assert_eq!(profile.web.candela(Vec3::NEG_Z), 100.0);
    }

    #[test]
    fn broken_files_are_refused_with_line_and_reason() {
        for (from, to, expected) in [
            ("TILT=NONE\n", "", "lamp.ies: line 1: found no line TILT=…, expected an IES photometric file"),
            ("100 60\n0\n", "100 60\n", "line 9: the file ends before 3 times an intensity"),
            ("100 60", "100 sixty", "line 9: found \"sixty\", expected an intensity, a number"),
            (" 3 1 1 2 ", " 3 1 2 2 ", "line 5: found photometric type 2 (1 is C, 2 is B, 3 is A), expected type C; convert"),
            (" 3 1 1 2 ", " 3.5 1 1 2 ", "line 5: found 3.5, expected the number of vertical angles, a whole number"),
            (" 3 1 1 2 ", " 3e4 1 1 2 ", "line 10: the file ends before 30000 times a vertical angle"),
            ("0 45 90", "0 90 45", "vertical angles must rise"),
            ("0.5 1.0 12", "-0.5 1.0 12", "line 6: found candela multiplier 2, ballast factor -0.5"),
            ("100 60", "100 -60", "-60 is no intensity; correct the file"),
            ("0.5 1.0 12\n0 45 90\n0\n100 60\n0\n", "", "line 5: the file ends where the ballast factor was expected"),
        ] {
            let error = parse_text(&DOWNLIGHT.replace(from, to)).unwrap_err();
            assert!(error.contains(expected), "{error}\nexpected {expected}");
        }
        let mut noise = enfilade_math::Rng::new(1);
        for cut in 0..DOWNLIGHT.len() {
            let mut bytes = DOWNLIGHT.as_bytes()[..cut].to_vec();
            let _ = parse(&bytes, "a".as_ref(), "");
            if let Some(byte) = bytes.last_mut() {
                *byte = noise.next_u64() as u8;
            }
            let _ = parse(&bytes, "a".as_ref(), "lights[0]");
        }
    }
}
