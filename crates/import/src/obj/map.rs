//! `map_…` statements of MTL: options and the path of a picture.

use super::text::unquoted;

/// Options whose value is a word.
const TEXTUAL: [&str; 7] = ["-clamp", "-blendu", "-blendv", "-cc", "-imfchan", "-type", "-colorspace"];
/// Options whose values are numbers.
const NUMERIC: [&str; 7] = ["-s", "-o", "-t", "-mm", "-bm", "-boost", "-texres"];

/// A `map_…` statement.
pub(super) struct Map<'m> {
    pub path: &'m str,
    pub scale: [f32; 2],
    pub offset: [f32; 2],
    pub clamp: bool,
    pub bump: f32,
    /// True if `-colorspace` states that colours are stored as they are.
    pub linear: bool,
    /// The channel that `-imfchan` chooses for a number.
    pub channel: Option<u8>,
    /// Options that have an effect but are not read.
    pub ignored: Vec<&'m str>,
}

impl<'m> Map<'m> {
    /// Splits a statement into its options and the path, which may contain spaces. `None` if there is no path. Options belong before the
    /// path; after it they are read if nothing else follows, as in three.js.
    pub(super) fn parse(statement: &'m str) -> Option<Self> {
        let mut map =
            Map { path: "", scale: [1.0; 2], offset: [0.0; 2], clamp: false, bump: 1.0, linear: false, channel: None, ignored: Vec::new() };
        let rest = map.options(statement.trim())?;
        let behind = rest.match_indices(char::is_whitespace).map(|(at, _)| rest.split_at(at)).find(|(_, tail)| are_options(tail.trim()));
        let (path, tail) = behind.unwrap_or((rest, ""));
        map.options(tail.trim());
        map.path = unquoted(path.trim_end());
        // Blender before 3.2 writes a dot for pictures without a file; a folder is no picture either.
        let is_folder = map.path.ends_with(['/', '\\']) || matches!(map.path, "." | "..");
        (!map.path.is_empty() && !is_folder).then_some(map)
    }

    /// Takes over the options at the beginning of a text, and gives what follows them. `None` where an option ends the text before its value.
    fn options(&mut self, text: &'m str) -> Option<&'m str> {
        let mut rest = text;
        while rest.starts_with('-') {
            let (option, after) = rest.split_once(char::is_whitespace)?;
            rest = after.trim_start();
            let max_values = match &*option.to_ascii_lowercase() {
                "-s" | "-o" | "-t" => 3,
                "-mm" => 2,
                _ => 1,
            };
            let takes_word = TEXTUAL.iter().any(|known| known.eq_ignore_ascii_case(option));
            let is_known = is_option(option);
            let (mut values, mut word) = (Vec::new(), "");
            while values.len() < max_values {
                let Some(next) = rest.split_whitespace().next() else { break };
                word = next;
                match word.parse::<f32>() {
                    Ok(value) => values.push(value),
                    Err(_) if takes_word => values.push(f32::from(u8::from(word.eq_ignore_ascii_case("on")))),
                    // A word between an unknown option and the file belongs to the option.
                    Err(_) if !is_known && values.is_empty() && !word.contains('.') && rest[word.len()..].contains('.') => values.push(0.0),
                    Err(_) => break,
                }
                rest = rest[word.len()..].trim_start();
            }
            self.set(option, word, &values);
        }
        Some(rest)
    }

    /// Takes over an option of these values, of which `word` is the last.
    fn set(&mut self, option: &'m str, word: &str, values: &[f32]) {
        let value = |i: usize, default: f32| values.get(i).copied().filter(|v| v.is_finite()).unwrap_or(default);
        let changes = match &*option.to_ascii_lowercase() {
            "-s" => {
                self.scale = [value(0, 1.0), value(1, 1.0)];
                false
            }
            "-o" => {
                self.offset = [value(0, 0.0), value(1, 0.0)];
                false
            }
            "-clamp" => {
                self.clamp = value(0, 0.0) > 0.0;
                false
            }
            "-bm" => {
                self.bump = value(0, 1.0);
                false
            }
            "-imfchan" => {
                self.channel = ["r", "g", "b", "m"].iter().position(|c| c.eq_ignore_ascii_case(word)).map(|c| c as u8);
                // Luminance is what a grey picture has in every channel.
                self.channel.is_none() && !word.eq_ignore_ascii_case("l")
            }
            "-colorspace" => {
                let name = word.to_ascii_lowercase();
                self.linear = ["linear", "raw", "non-color", "noncolor", "none"].iter().any(|known| name.starts_with(known));
                !self.linear && !name.starts_with("srgb")
            }
            // How a picture is filtered; blending is the rule.
            "-blendu" | "-blendv" | "-texres" | "-boost" | "-cc" => false,
            "-mm" => values.len() < 2 || values != [0.0, 1.0],
            "-t" => values.iter().any(|v| *v != 0.0),
            _ => true,
        };
        if changes {
            self.ignored.push(option);
        }
    }
}

/// True if a word is the name of an option.
fn is_option(word: &str) -> bool {
    TEXTUAL.iter().chain(&NUMERIC).any(|known| known.eq_ignore_ascii_case(word))
}

/// Whether a text is nothing but options with values.
fn are_options(text: &str) -> bool {
    let mut words = text.split_whitespace().peekable();
    let mut any = false;
    while let Some(option) = words.next() {
        let is_value = |word: &&str| word.parse::<f32>().is_ok() || !word.contains('.') && !is_option(word);
        if !is_option(option) || words.next_if(is_value).is_none() {
            return false;
        }
        while words.next_if(|word| word.parse::<f32>().is_ok()).is_some() {}
        any = true;
    }
    any
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn map_statements_have_options_and_paths_with_spaces() {
        let map = Map::parse("-s 2 3 1 -o 0.5 0 0 -clamp on -bm 0.3 my wood texture.png").unwrap();
        assert_eq!((map.path, map.scale, map.offset, map.clamp, map.bump), ("my wood texture.png", [2.0, 3.0], [0.5, 0.0], true, 0.3));
        assert_eq!(Map::parse("3 chairs.png").unwrap().path, "3 chairs.png");
        assert_eq!(Map::parse("-imfchan m \"my wood.png\"").map(|m| (m.path, m.channel)), Some(("my wood.png", Some(3))));
        for nothing in ["-bm 1", ".", "-s 2 2 2 .", "textures/", "C:\\textures\\"] {
            assert!(Map::parse(nothing).is_none(), "{nothing}");
        }
    }

    #[test]
    fn options_after_the_path_are_read_and_names_that_look_like_them_are_names() {
        let map = Map::parse("my a.png -s 2 3 1 -clamp on -bm 0.5").unwrap();
        assert_eq!((map.path, map.scale, map.clamp, map.bump), ("my a.png", [2.0, 3.0], true, 0.5));
        assert_eq!(Map::parse("-o 1 2 a.png -s 2 2").map(|map| (map.path, map.scale, map.offset)), Some(("a.png", [2.0; 2], [1.0, 2.0])));
        for name in ["wood -s 1.png", "wood -s.png", "a - b.png", "a -x 1", "tile -o"] {
            assert_eq!(Map::parse(name).map(|map| map.path), Some(name), "{name}");
        }
    }

    #[test]
    fn words_of_options_are_not_taken_for_names_of_files() {
        // tinyobjloader writes and reads -colorspace; the others are made up.
        for statement in
            ["-colorspace sRGB my wood.png", "-S 1 1 1 -CLAMP off my wood.png", "-uvset map1 my wood.png", "-gain 2 my wood.png"]
        {
            let map = Map::parse(statement).unwrap();
            assert_eq!((map.path, map.linear), ("my wood.png", false), "{statement}");
        }
        let map = Map::parse("-colorspace linear my wood.png").unwrap();
        assert_eq!((map.path, map.linear, map.ignored.len()), ("my wood.png", true, 0));
        assert_eq!(Map::parse("-colorspace ACEScg a.png").unwrap().ignored, ["-colorspace"]);
        assert_eq!(Map::parse("-bm wood 2.0.png").unwrap().path, "wood 2.0.png");
    }

    #[test]
    fn options_that_change_nothing_are_not_reported() {
        assert!(Map::parse("-mm 0 1 -t 0 0 0 -blendu on a.png").unwrap().ignored.is_empty());
        assert_eq!(Map::parse("-mm 0.2 1 -type sphere -imfchan z a.png").unwrap().ignored, ["-mm", "-type", "-imfchan"]);
    }
}
