//! Lettering for contact sheets: our own stroke alphabet, drawn with round pens at any size.
//!
//! A glyph is a list of strokes on a grid where the baseline is y = 0, small letters reach 7, capitals 10 and descenders −3.
//! A stroke is a run of two-character points: x and y + 3, each a base-36 digit. It begins with `~` where the line is smooth
//! and with `o` where it is smooth and closed: then its points are the control polygon of a quadratic B-spline, which touches
//! the middle of every side. Without a sign its points are joined by straight lines. Latin letters with a mark are the letter and
//! the mark; what is in no table is drawn as a box.

use super::canvas::{Canvas, Color};

/// Capital height of the grid.
const CAPITAL: f32 = 10.0;
/// Height of small letters.
const SMALL: f32 = 7.0;
/// Horizontal middle of a letter, for marks.
const MIDDLE: f32 = 3.0;
/// Free space between two glyphs, in grid units.
const SPACING: f32 = 3.4;
/// Width of a blank.
const BLANK: f32 = 3.0;

/// How text looks.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Height of capitals, pixels.
    pub height: f32,
    /// Width of the pen over the height of capitals: 0.11 is regular, 0.16 bold.
    pub weight: f32,
    /// Colour.
    pub color: Color,
}

/// Width of `text` in pixels.
pub fn width(text: &str, style: Style) -> f32 {
    let units: f32 = text.chars().map(advance).sum();
    (units - SPACING).max(0.0) * style.height / CAPITAL + style.weight * style.height
}

/// Draws `text` with its baseline starting at (x, y).
pub fn draw(canvas: &mut Canvas, x: f32, y: f32, text: &str, style: Style) {
    for run in runs(x, y, text, style) {
        canvas.stroke(&run, 0.5 * style.weight * style.height, style.color);
    }
}

/// The ways of the pen's centre that write `text` with its baseline starting at (x, y). The pen is `weight` × `height` wide.
pub fn runs(x: f32, y: f32, text: &str, style: Style) -> Vec<Vec<[f32; 2]>> {
    let unit = style.height / CAPITAL;
    // The pen's edge, not its centre, is at x.
    let mut pen = x + 0.5 * style.weight * style.height;
    let mut runs = Vec::new();
    for c in text.chars() {
        runs.extend(strokes(c).iter().map(|stroke| stroke.iter().map(|p| [pen + p[0] * unit, y - p[1] * unit]).collect()));
        pen += advance(c) * unit;
    }
    runs
}

/// The text cut to at most `limit` pixels, ending in dots when cut.
pub fn fit(text: &str, style: Style, limit: f32) -> String {
    if width(text, style) <= limit {
        return text.to_string();
    }
    let mut kept: Vec<char> = text.chars().collect();
    loop {
        let candidate: String = kept.iter().collect::<String>().trim_end().to_string() + "...";
        if width(&candidate, style) <= limit || kept.pop().is_none() {
            return candidate;
        }
    }
}

/// From the start of a glyph to the start of the next, in grid units.
fn advance(c: char) -> f32 {
    let right = strokes(c).iter().flatten().map(|p| p[0]).fold(f32::NEG_INFINITY, f32::max);
    if right.is_finite() { right + SPACING } else { BLANK + SPACING }
}

/// The strokes of a character in grid units.
fn strokes(c: char) -> Vec<Vec<[f32; 2]>> {
    let Some((letter, mark)) = marked(c) else { return parse(glyph(c)) };
    let (mut strokes, mut mark) = (parse(glyph(letter)), parse(mark));
    let [left, right] = extent(&strokes);
    let is_above = mark.iter().flatten().all(|p| p[1] > 0.0);
    let up = if is_above && letter.is_uppercase() { CAPITAL - SMALL } else { 0.0 };
    let aside = 0.5 * (left + right) - MIDDLE;
    mark.iter_mut().flatten().for_each(|p| *p = [p[0] + aside, p[1] + up]);
    strokes.append(&mut mark);
    // A mark that is wider than its letter would overlap the letter before.
    let left = extent(&strokes)[0].min(0.0);
    strokes.iter_mut().flatten().for_each(|p| p[0] -= left);
    strokes
}

/// Least and greatest x.
fn extent(strokes: &[Vec<[f32; 2]>]) -> [f32; 2] {
    let xs = || strokes.iter().flatten().map(|p| p[0]);
    [xs().fold(f32::INFINITY, f32::min), xs().fold(f32::NEG_INFINITY, f32::max)]
}

/// The letter without its mark, and the mark.
fn marked(c: char) -> Option<(char, &'static str)> {
    let find = |&(mark, letters): &(&'static str, &str)| {
        let place = letters.chars().position(|letter| letter == c).filter(|place| place % 2 == 0)?;
        Some((letters.chars().nth(place + 1)?, mark))
    };
    if c.is_ascii() { None } else { MARKS.iter().find_map(find) }
}

fn parse(glyph: &str) -> Vec<Vec<[f32; 2]>> {
    glyph.split(' ').filter(|s| !s.is_empty()).map(parse_stroke).collect()
}

fn parse_stroke(text: &str) -> Vec<[f32; 2]> {
    let (kind, digits) = match text.as_bytes()[0] {
        sign @ (b'~' | b'o') if text.len() % 2 == 1 => (sign, &text[1..]),
        _ => (b' ', text),
    };
    let digit = |b: u8| (b as char).to_digit(36).map_or(0.0, |d| d as f32);
    let points: Vec<[f32; 2]> = digits.as_bytes().chunks(2).map(|p| [digit(p[0]), digit(p[1]) - 3.0]).collect();
    match kind {
        b'~' => smooth(points, false),
        b'o' => smooth(points, true),
        _ => points,
    }
}

/// Three rounds of Chaikin's corner cutting, which tends to the quadratic B-spline of the control polygon.
fn smooth(mut points: Vec<[f32; 2]>, closed: bool) -> Vec<[f32; 2]> {
    let between = |a: [f32; 2], b: [f32; 2], t: f32| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
    for _ in 0..3 {
        let n = points.len();
        let sides = if closed { n } else { n - 1 };
        let mut cut = Vec::with_capacity(2 * sides + 2);
        for i in 0..sides {
            let (a, b) = (points[i], points[(i + 1) % n]);
            let first = !closed && i == 0;
            let last = !closed && i + 1 == sides;
            cut.push(if first { a } else { between(a, b, 0.25) });
            cut.push(if last { b } else { between(a, b, 0.75) });
        }
        points = cut;
    }
    if closed {
        points.push(points[0]);
    }
    points
}

#[rustfmt::skip]
fn glyph(c: char) -> &'static str {
    match c {
        'A' => "034d83 1676", 'B' => "030d ~0d6d6808 ~08787303", 'C' => "~7b7d0d037375", 'D' => "030d ~0d7d7303",
        'E' => "6d0d0363 0858", 'F' => "6d0d03 0858", 'G' => "~7b7d0d037378 4878", 'H' => "030d 737d 0878", 'I' => "030d",
        'J' => "~5d530306", 'K' => "030d 6d06 2863", 'L' => "0d0363", 'M' => "030d468d83", 'N' => "030d737d", 'O' => "o03838d0d",
        'P' => "030d ~0d6d6707", 'Q' => "o03838d0d 5682", 'R' => "030d ~0d6d6707 3763", 'S' => "~6b6d0d0967630305",
        'T' => "0d6d 3d33", 'U' => "~0d03737d", 'V' => "0d438d", 'W' => "0d335b73ad", 'X' => "0d73 7d03", 'Y' => "0d488d 4843",
        'Z' => "0d7d0373",
        'a' => "o03636a0a 6a63", 'b' => "0d03 o03636a0a", 'c' => "~686a0a036365", 'd' => "6d63 o03636a0a", 'e' => "0767 ~676a0a036365",
        'f' => "~5d2d2a23 0a4a", 'g' => "o03636a0a ~6a636000", 'h' => "0d03 ~070a6a63", 'i' => "0a03 0d0d", 'j' => "~2a232000 2d2d",
        'k' => "0d03 5a05 2753", 'l' => "0d03", 'm' => "0a03 ~070a4a43 ~474a8a83", 'n' => "0a03 ~070a6a63", 'o' => "o03636a0a",
        'p' => "0a00 o03636a0a", 'q' => "6a60 o03636a0a", 'r' => "0a03 ~060a4a", 's' => "~595a0a0756530304", 't' => "~2d252353 0a5a",
        'u' => "~0a036367 6a63", 'v' => "0a336a", 'w' => "0a2349638a", 'x' => "0a53 5a03", 'y' => "0a33 6a20", 'z' => "0a5a0353",
        '0' => "o03636d0d", '1' => "0b3d33", '2' => "~0b0d6d6803 0363", '3' => "~0c0d6d6828 ~2868630305", '4' => "4d0666 4d43",
        '5' => "5d0d09 ~0969630304", '6' => "o03636909 ~5d0d06", '7' => "0d6d23", '8' => "o18585d1d o03636808",
        '9' => "o07676d0d ~6a6313",
        ' ' => "", '.' => "0303", ',' => "1301", ':' => "0303 0909", ';' => "1301 1909", '-' => "0747", '_' => "0161",
        '+' => "0767 3a34", '=' => "0565 0868", '/' => "025e", '\\' => "0e52", '(' => "~2e0b0522", ')' => "~0e2b2502",
        '[' => "2e0e0222", ']' => "0e2e2202", '{' => "~3e1e1a08 ~08161232", '}' => "~0e2e2a38 ~38262202", '%' => "o0a3a3d0d o53838656 038d",
        '\'' => "0d0b", '"' => "0d0b 2d2b", '!' => "0d06 0303", '?' => "~0b0d5d5a2826 2323", '#' => "233d 536d 0676 0a7a",
        '*' => "3d37 0c68 6c08", '&' => "~731a1d4d4a07035377", '@' => "o03838d0d o26565a2a", '<' => "5a0754", '>' => "0a5704",
        '|' => "0e01", '~' => "~082a4668", '^' => "0a3d6a", '$' => "~6b6d0d0967630305 3e32", '`' => "0d2b", '·' => "0707", '°' => "o0a3a3d0d",
        '²' => "~0c0d3d3a08 0838", '³' => "~0d3d3b1b ~1b3b3808", '–' => "0777", '—' => "07a7", '…' => "0303 3333 6363", '×' => "1955 1559",
        'ß' => "~030d5d5929 ~29696323", 'ı' => "0a03", 'ø' => "o03636a0a 036a", 'Ø' => "o03838d0d 038d", 'ł' => "2d23 074a",
        'Ł' => "2d2383 0749", 'đ' | 'ð' => "6d63 o03636a0a 4b8b", 'Đ' | 'Ð' => "030d ~0d7d7303 0848", 'þ' => "0d00 o03636a0a",
        'Þ' => "030d ~0b6b6505", 'æ' => "o03535a0a 5a53 57b7 ~b7ba5a53b3b5", 'œ' => "o03535a0a 57b7 ~b7ba5a53b3b5",
        'ď' => "6d63 o03636a0a 9d8b", 'ť' => "~2d252353 0a5a 6e5c", 'ľ' => "0d03 3d2b", 'Ľ' => "0d0363 4d3b",
        'Æ' => "035d 1656 5d53 5dad 5898 53a3", 'Œ' => "o03636d0d 6d63 6dbd 68a8 63b3",
        _ => UNKNOWN,
    }
}

/// A box.
const UNKNOWN: &str = "03636d0d03";

/// Marks as drawn at a small letter around [`MIDDLE`], and after each the letters that have it, each before the letter without it.
#[rustfmt::skip]
const MARKS: [(&str, &str); 13] = [
    ("2c4e", "áaéeíıóoúuýyćcńnśsźzŕrÁAÉEÍIÓOÚUÝYĆCŃNŚSŹZ"),
    ("2e4c", "àaèeìıòoùuÀAÈEÌIÒOÙU"),
    ("1c3e5c", "âaêeîıôoûuŵwŷyÂAÊEÎIÔOÛU"),
    ("1e3c5e", "čcěeňnřršsžzČCĎDĚEŇNŘRŠSŤTŽZ"),
    ("~0c2e4c6e", "ãañnõoÃAÑNÕO"),
    ("1d1d 5d5d", "äaëeïıöoüuÿyÄAËEÏIÖOÜUŸY"),
    ("o2c4c4e2e", "åaůuÅAŮU"),
    ("1d5d", "āaēeīıōoūuĀAĒEĪIŌOŪU"),
    ("~1e1c5c5e", "ăağgĂAĞG"),
    ("3d3d", "ėeżzĖEİIŻZ"),
    ("1c2e 4c5e", "őoűuŐOŰU"),
    ("~33425120", "çcşsșsţtțtÇCŞSȘSŢTȚT"),
    ("~53324050", "ąaęeįıųuĄAĘEĮIŲU"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    const STYLE: Style = Style { height: 10.0, weight: 0.12, color: [255, 255, 255] };

    #[test]
    fn every_printable_ascii_character_has_its_own_glyph() {
        let mut seen = std::collections::HashMap::new();
        for c in (33u8..127).map(char::from) {
            assert_ne!(glyph(c), glyph('\u{1}'), "{c}");
            let allowed = matches!(c, 'l' | 'I' | '|'); // the same bar at other heights
            if let Some(other) = seen.insert(glyph(c), c) {
                assert!(allowed, "{c} looks like {other}");
            }
            for p in strokes(c).iter().flatten() {
                assert!((0.0..=12.0).contains(&p[0]) && (-3.0..=11.0).contains(&p[1]), "{c}: {p:?}");
            }
        }
    }

    /// The characters beyond ASCII in the sources below a folder, comments apart.
    fn written(folder: &Path) -> BTreeSet<char> {
        let mut found = BTreeSet::new();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                found.extend(written(&path));
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            found.extend(code.filter_map(|line| line.split(" // ").next()).flat_map(str::chars).filter(|c| !c.is_ascii()));
        }
        found
    }

    #[test]
    fn every_character_that_this_crate_writes_has_a_glyph() {
        let written = written(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
        assert!("³°·".chars().all(|c| written.contains(&c)), "{written:?}");
        let boxes: Vec<&char> = written.iter().filter(|&&c| marked(c).is_none() && glyph(c) == UNKNOWN).collect();
        assert!(boxes.is_empty(), "{boxes:?}");
        // A missing letter is visibly missing.
        assert_eq!(glyph('\u{416}'), UNKNOWN);
    }

    #[test]
    fn letters_with_marks_are_their_letters_with_something_over_or_under_them() {
        let letters: Vec<char> = MARKS.iter().flat_map(|(_, letters)| letters.chars()).collect();
        for pair in letters.chunks(2) {
            let (c, letter) = (pair[0], pair[1]);
            let [with, without] = [c, letter].map(strokes);
            assert!(glyph(letter) != UNKNOWN && with.len() > without.len(), "{c}");
            assert!(extent(&with)[0] >= 0.0, "{c} stands in the letter before it");
            let top = if letter.is_uppercase() { CAPITAL } else { SMALL };
            let is_apart = |p: &[f32; 2]| if p[1] > 0.1 { p[1] > top + 1.0 } else { (-3.0..=0.1).contains(&p[1]) };
            assert!(with[without.len()..].iter().flatten().all(is_apart), "{c}: {with:?}");
        }
        let dots = &strokes('Ü')[1..];
        assert_eq!((dots.len(), dots[0][0][1]), (2, 13.0));
    }

    #[test]
    fn long_text_is_cut_to_fit() {
        let long = "a very long scene name";
        let cut = fit(long, STYLE, 80.0);
        assert!(cut.ends_with("...") && width(&cut, STYLE) <= 80.0 && cut.len() > 6, "{cut}");
        assert_eq!(fit("short", STYLE, 80.0), "short");
    }

    #[test]
    fn closed_splines_touch_the_sides_of_their_polygon() {
        let o = &strokes('o')[0];
        let top = o.iter().map(|p| p[1]).fold(f32::MIN, f32::max);
        assert!((top - 7.0).abs() < 0.1 && o.first() == o.last());
    }
}
