//! The path data and the lists of numbers of SVG.

use crate::plans::curves::{Arc, bezier, flattened};
use enfilade_math::DVec2;

/// Reads path data from the left.
struct Scanner<'t> {
    rest: &'t str,
}

impl<'t> Scanner<'t> {
    fn skip_separators(&mut self) {
        self.rest = self.rest.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
    }

    /// The next command, if one comes next.
    fn command(&mut self) -> Option<char> {
        self.skip_separators();
        let command = self.rest.chars().next().filter(char::is_ascii_alphabetic)?;
        self.rest = &self.rest[1..];
        Some(command)
    }

    fn is_at_number(&mut self) -> bool {
        self.skip_separators();
        self.rest.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
    }

    /// A number, which ends where the next begins: `1-2.5.5` are three.
    fn number(&mut self) -> Result<f64, String> {
        self.skip_separators();
        let (mut end, mut has_point, mut before) = (0, false, ' ');
        for c in self.rest.chars() {
            let continues = match c {
                '0'..='9' => true,
                '.' => !std::mem::replace(&mut has_point, true),
                'e' | 'E' => end > 0 && !matches!(before, 'e' | 'E'),
                '+' | '-' => end == 0 || matches!(before, 'e' | 'E'),
                _ => false,
            };
            // After an exponent has begun there is no point.
            has_point |= matches!(c, 'e' | 'E');
            if !continues {
                break;
            }
            (end, before) = (end + 1, c);
        }
        let (word, rest) = self.rest.split_at(end);
        let found = word.parse::<f64>().ok().filter(|n| n.is_finite());
        let found = found.ok_or_else(|| format!("found {:?}, expected a number", excerpt(self.rest)))?;
        self.rest = rest;
        Ok(found)
    }

    fn pair(&mut self) -> Result<DVec2, String> {
        Ok(DVec2::new(self.number()?, self.number()?))
    }

    /// A flag of an arc: one digit, which may touch what follows.
    fn flag(&mut self) -> Result<bool, String> {
        self.skip_separators();
        let flag = match self.rest.chars().next() {
            Some('0') => false,
            Some('1') => true,
            _ => return Err(format!("found {:?}, expected a flag of an arc, 0 or 1", excerpt(self.rest))),
        };
        self.rest = &self.rest[1..];
        Ok(flag)
    }
}

/// The beginning of a text, for messages.
fn excerpt(text: &str) -> String {
    text.chars().take_while(|c| !c.is_whitespace() && *c != ',').take(12).collect()
}

/// Numbers that spaces, commas or signs separate.
pub(super) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let mut scanner = Scanner { rest: text };
    let mut all = Vec::new();
    loop {
        scanner.skip_separators();
        if scanner.rest.is_empty() {
            return Ok(all);
        }
        all.push(scanner.number()?);
    }
}

/// The corners of a path's first outline, and whether it has more. Curves become pieces that are within `near` of them.
pub(super) fn outline(d: &str, near: f64) -> Result<(Vec<DVec2>, bool), String> {
    let mut scanner = Scanner { rest: d };
    let mut pen = Pen { corners: Vec::new(), handle: None, near };
    let mut command = None;
    loop {
        if let Some(next) = scanner.command() {
            command = Some(next);
        } else if !scanner.is_at_number() {
            let rest = excerpt(scanner.rest);
            return if rest.is_empty() { Ok((pen.corners, false)) } else { Err(format!("found {rest:?} in a path, expected a command")) };
        }
        let Some(now) = command else { return Err("a path begins without a command, expected M".into()) };
        match now.to_ascii_uppercase() {
            'Z' => return Ok((pen.corners, scanner.command().is_some())),
            'M' if !pen.corners.is_empty() => return Ok((pen.corners, true)),
            _ => pen.draw(now, &mut scanner)?,
        }
        // What follows the point of a move is lines.
        command = match now {
            'M' => Some('L'),
            'm' => Some('l'),
            other => Some(other),
        };
    }
}

struct Pen {
    corners: Vec<DVec2>,
    /// The last control point of a curve, which a smooth curve mirrors, and its degree.
    handle: Option<(DVec2, usize)>,
    near: f64,
}

impl Pen {
    fn at(&self) -> DVec2 {
        self.corners.last().copied().unwrap_or(DVec2::ZERO)
    }

    fn draw(&mut self, command: char, scanner: &mut Scanner) -> Result<(), String> {
        let at = self.at();
        let origin = if command.is_ascii_lowercase() { at } else { DVec2::ZERO };
        let mirrored = |handle: Option<(DVec2, usize)>, degree| handle.filter(|(_, of)| *of == degree).map_or(at, |(p, _)| 2.0 * at - p);
        let handle = self.handle.take();
        match command.to_ascii_uppercase() {
            'M' | 'L' => self.corners.push(origin + scanner.pair()?),
            'H' => self.corners.push(DVec2::new(origin.x + scanner.number()?, at.y)),
            'V' => self.corners.push(DVec2::new(at.x, origin.y + scanner.number()?)),
            'C' => {
                let points = [at, origin + scanner.pair()?, origin + scanner.pair()?, origin + scanner.pair()?];
                self.bend(&points);
            }
            'S' => self.bend(&[at, mirrored(handle, 3), origin + scanner.pair()?, origin + scanner.pair()?]),
            'Q' => self.bend(&[at, origin + scanner.pair()?, origin + scanner.pair()?]),
            'T' => self.bend(&[at, mirrored(handle, 2), origin + scanner.pair()?]),
            'A' => {
                let (radii, turn) = (scanner.pair()?, scanner.number()?.to_radians());
                let flags = [scanner.flag()?, scanner.flag()?];
                let to = origin + scanner.pair()?;
                match Arc::of_svg([at, to], radii, turn, flags) {
                    Some(arc) => self.corners.extend(flattened(&|t| arc.at(t), self.near)),
                    None => self.corners.push(to),
                }
            }
            _ => return Err(format!("the path has the command {command:?}, expected M, L, H, V, C, S, Q, T, A or Z")),
        }
        Ok(())
    }

    fn bend(&mut self, points: &[DVec2]) {
        self.handle = Some((points[points.len() - 2], points.len() - 1));
        self.corners.extend(flattened(&|t| bezier(points, t), self.near));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plans::loops::area;

    fn corners(d: &str) -> Vec<DVec2> {
        outline(d, 0.005).unwrap().0
    }

    #[test]
    fn numbers_end_where_the_next_begins() {
        assert_eq!(numbers("1-2.5.5,3e-1 +4").unwrap(), [1.0, -2.5, 0.5, 0.3, 4.0]);
        assert_eq!(numbers("1,two").unwrap_err(), "found \"two\", expected a number");
    }

    #[test]
    fn circles_of_arcs_and_of_curves_have_their_area() {
        let round = std::f64::consts::PI * 4.0;
        let k = 2.0 * 0.552_284_75;
        let quarters = format!("M2 0 C2 {k} {k} 2 0 2 S-2 {k} -2 0 S-{k} -2 0-2 S2-{k} 2 0z");
        // Two half circles, the second with flags that touch, and four Bézier curves, of which three mirror the last handle.
        for d in ["M2 0A2 2 0 0 1-2 0a2 2 0 014 0z", &quarters] {
            let found = area(&corners(d)).abs();
            assert!((found - round).abs() < 1e-3 * round, "{d}: {found}");
        }
    }

    #[test]
    fn parabolas_have_two_thirds_of_their_boxes() {
        // Under one parabola, and under one that goes up and one that goes down as much.
        let parabola = area(&corners("M0 0q2 4 4 0z")).abs();
        assert!((parabola - 2.0 / 3.0 * 4.0 * 2.0).abs() < 1e-3 * parabola, "{parabola}");
        let wave = corners("M0 0Q1 2 2 0T4 0V-3H0z");
        assert!((area(&wave).abs() - 12.0).abs() < 0.012, "{}", area(&wave));
    }

    #[test]
    fn what_is_no_path_is_told() {
        assert!(outline("M0 0 L1 0 X2 2", 0.005).unwrap_err().contains("command 'X'"));
        assert!(outline("0 0 1 1", 0.005).unwrap_err().contains("begins without a command"));
        assert!(outline("M0 0 A1 1 0 2 1 3 3", 0.005).unwrap_err().contains("expected a flag"));
        assert!(outline("M0 0 H1 V1 z M5 5 h1", 0.005).unwrap().1);
        assert!(!outline("M0 0 H1 V1 z", 0.005).unwrap().1);
    }
}
