//! The meaning of `Ns` and `Ks` in files of Blender's own exporters, by the versions in the heads of the files.
//!
//! | version | head of the library | `Ns` |
//! |---|---|---|
//! | 3.2 and newer | `# Blender 4.5.0 MTL File: …` | 1000·(1 − roughness)² |
//! | 3.1 | `# Blender 3.1.0 MTL File: …` | 900·(1 − roughness)² |
//! | 2.80 to 3.1 (and newer, as "legacy") | `# Blender MTL File: …` | 900·(1 − roughness)² |
//! | 2.79 and older | the same; the OBJ file begins with `# Blender v2.79 …` | (hardness − 1)/0.51, of an exponent from 1 to 511 |
//!
//! From 2.80 on, `Ks` is half the strength of the highlight. Sources: `export_obj.py` of the add-on `io_scene_obj`, and
//! `obj_export_mtl.cc`.

/// The meaning of the numbers of a library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Gloss {
    /// Blinn's exponent, as the format defines.
    Exponent,
    /// Blender's hardness, by version 2.79 and older.
    Hardness,
    /// Blender's roughness; `Ns` of a smooth surface.
    Roughness(f32),
}

/// `Ns` of what has no roughness, before Blender 3.2 and since.
const BEFORE: f32 = 900.0;
const SINCE: f32 = 1000.0;

impl Gloss {
    /// The meaning in a library, by its text and by the version of Blender in the head of the OBJ file that names it.
    pub(super) fn of(library: &str, obj: Option<[u32; 2]>) -> Self {
        let head = library.lines().next().unwrap_or_default();
        if !head.starts_with("# Blender ") || !head.contains("MTL File") {
            return Self::Exponent;
        }
        match (version(head), obj) {
            (Some(since), _) if since >= [3, 2] => Self::Roughness(SINCE),
            (None, Some(before)) if before < [2, 80] => Self::Hardness,
            _ => Self::Roughness(BEFORE),
        }
    }
}

/// The version of Blender in the first line of a file: "# Blender v2.93.1 OBJ File: …", "# Blender 4.5.0 MTL File: …".
pub(super) fn version(head: &str) -> Option<[u32; 2]> {
    let word = head.strip_prefix("# Blender ")?.split_whitespace().next()?;
    let mut numbers = word.trim_start_matches('v').split('.');
    let mut next = || numbers.next()?.parse().ok();
    Some([next()?, next()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_tell_what_gloss_means() {
        let old = "# Blender MTL File: 'room.blend'\n# Material Count: 1\n";
        let obj = |head: &str| version(head);
        assert_eq!(Gloss::of(old, None), Gloss::Roughness(900.0));
        assert_eq!(Gloss::of(old, obj("# Blender v2.93.1 OBJ File: 'room.blend'")), Gloss::Roughness(900.0));
        assert_eq!(Gloss::of(old, obj("# Blender v2.79 (sub 0) OBJ File: ''")), Gloss::Hardness);
        assert_eq!(Gloss::of(old, obj("# Blender v2.9 OBJ File: ''")), Gloss::Hardness, "no version after 2.80 has one digit");
        assert_eq!(Gloss::of("# Blender 3.1.2 MTL File: 'a'\n", None), Gloss::Roughness(900.0));
        assert_eq!(Gloss::of("# Blender 3.2.0 MTL File: 'a'\n", obj("# Blender 3.2.0")), Gloss::Roughness(1000.0));
        assert_eq!(Gloss::of("# Blender 4.2.1 LTS MTL File: 'a'\n", None), Gloss::Roughness(1000.0));
        assert_eq!(Gloss::of("# 3ds Max\n# Blender MTL File\n", None), Gloss::Exponent);
        assert_eq!(Gloss::of("", None), Gloss::Exponent);
    }
}
