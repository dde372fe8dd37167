//! Notes on an entry of a material library whose statements are not read, or not as written.

use super::library::{Entry, Numbers};

/// Statements of one number.
const NUMBERS: [&str; 9] = ["ns", "ni", "d", "tr", "illum", "pr", "pm", "pc", "pcr"];
/// Statements of a colour or a number.
const COLORS: [&str; 5] = ["kd", "ks", "ke", "tf", "ps"];
/// Statements of shares of light.
const SHARES: [&str; 3] = ["kd", "ks", "tf"];
/// A share above this is no rounding error.
const MOST: f32 = 1.001;
/// Statements of a picture.
const MAPS: [&str; 9] = ["map_kd", "map_ks", "map_ke", "map_d", "map_pr", "map_pm", "norm", "map_bump", "bump"];
/// Statements that light transport makes superfluous: ambient light, the sharpness of reflections, smoothing of textures.
const WITHOUT_EFFECT: [&str; 4] = ["ka", "map_ka", "sharpness", "map_aat"];

/// Messages about statements of an entry that are not read, or not as written.
pub(super) fn notes(entry: &Entry) -> Vec<String> {
    let known = |key: &str| NUMBERS.contains(&key) || COLORS.contains(&key);
    let mut notes = Vec::new();
    for (key, statement) in &entry.statements {
        let key = key.as_str();
        if MAPS.contains(&key) {
            notes.extend(of_map(entry, key));
        } else if known(key) {
            notes.extend(of_numbers(key, statement));
        } else if !WITHOUT_EFFECT.contains(&key) && entry.number(key) != Some(0.0) {
            // An anisotropy of zero is none.
            notes.push(format!("{key} ignored"));
        }
    }
    notes
}

fn of_numbers(key: &str, statement: &str) -> Option<String> {
    match Numbers::parse(statement) {
        Numbers::Spectral => {
            Some(format!("{key} ignored: found a file of spectral samples, expected three numbers for red, green and blue"))
        }
        Numbers::Xyz(_) if COLORS.contains(&key) => None,
        Numbers::Other | Numbers::Xyz(_) => {
            Some(format!("{key} ignored: found {statement:?}, expected numbers such as 0.5; correct the material library"))
        }
        Numbers::These(_) if statement.starts_with("-halo") => {
            Some(format!("{key} -halo, which depends on the direction, was read as the same in all directions"))
        }
        Numbers::These(values) if SHARES.contains(&key) && values.iter().any(|v| *v > MOST) => {
            Some(format!("{key}: found {statement:?}, expected 0 to 1; what is above was taken as 1: divide colours of 0 to 255 by 255"))
        }
        Numbers::These(_) => None,
    }
}

fn of_map(entry: &Entry, key: &str) -> Option<String> {
    let Some(map) = entry.map(key) else {
        return Some(format!("{key} ignored: it names no picture"));
    };
    let is_number = matches!(key, "map_d" | "map_pr" | "map_pm");
    let channel = map.channel.filter(|_| !is_number).map(|_| "-imfchan");
    let ignored: Vec<&str> = map.ignored.iter().copied().chain(channel).collect();
    (!ignored.is_empty()).then(|| format!("{key}: options {} ignored", ignored.join(", ")))
}
