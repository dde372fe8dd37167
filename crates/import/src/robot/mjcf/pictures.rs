//! Textures of a model: pictures of files, and those that MuJoCo makes itself.

use super::settings::Settings;
use super::tree::Element;
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::Use;
use crate::robot::shapes::find;
use enfilade_scene::{Image, Pixels};
use std::collections::BTreeMap;

/// Names of the files of a cube's sides, in the order of their places in a picture of all six.
const SIDES: [&str; 6] = ["fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"];
/// Letters of these sides in a grid.
const LETTERS: [char; 6] = ['R', 'L', 'U', 'D', 'F', 'B'];
/// Sides of a made picture that states none, and the largest, texels.
const SIDE: u32 = 256;
const LARGEST: u32 = 1024;

/// A texture of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Picture {
    pub image: u32,
    pub layout: Layout,
    /// Whether columns and rows are reversed.
    pub flips: [bool; 2],
}

/// How a picture lies on a thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Layout {
    /// By the thing's own texture coordinates, else from above.
    Flat,
    /// On each of the six sides of the box around it.
    Cube,
    /// On the six sides, a sixth of its height for each: +x, −x, +y, −y, +z, −z.
    Sides,
}

/// The textures of a model, by name; each is made once, when it is used.
pub(super) struct Pictures {
    elements: BTreeMap<String, Element>,
    known: BTreeMap<String, Option<Picture>>,
}

impl Pictures {
    /// The textures that a model declares.
    ///
    /// # Errors
    /// When one is of a class that is not there.
    pub(super) fn of(root: &Element, settings: &Settings) -> Result<Self, ImportError> {
        let mut elements = BTreeMap::new();
        for (name, texture) in settings.assets(root, "texture")? {
            elements.insert(name.unwrap_or_default(), texture);
        }
        Ok(Self { elements, known: BTreeMap::new() })
    }

    /// The texture that `user` names; `None`, with a warning, if it cannot be had and the options allow that.
    ///
    /// # Errors
    /// When there is no such texture, or its picture is missing and has to be there.
    pub(super) fn get(
        &mut self,
        name: &str,
        user: &Element,
        settings: &Settings,
        a: &mut Assembly,
    ) -> Result<Option<Picture>, ImportError> {
        if let Some(known) = self.known.get(name) {
            return Ok(*known);
        }
        let element = self.elements.get(name).ok_or_else(|| user.wrong(format!("there is no texture {name:?} among the assets")))?.clone();
        let picture = picture(&element, user, settings, a)?;
        self.known.insert(name.into(), picture);
        Ok(picture)
    }
}

fn picture(element: &Element, user: &Element, settings: &Settings, a: &mut Assembly) -> Result<Option<Picture>, ImportError> {
    let flat = element.text("type") == Some("2d");
    let flips = ["hflip", "vflip"].map(|flip| element.flag(flip) == Some(true));
    let of_user = format!("{} {:?}", user.tag, user.name());
    if SIDES.iter().any(|side| element.text(side).is_some()) {
        let place = element.place(a);
        a.warn(place, "a cube of six files is not read (a grid in one file is); the plain colour was used");
        return Ok(None);
    }
    if let Some(path) = element.text("file") {
        let path = settings.texture_file(path);
        let scene = a.file().to_path_buf();
        let file = find(&path, &scene, a);
        let file = file.map_or(path, |file| std::path::absolute(&file).unwrap_or(file).to_string_lossy().into_owned());
        let image = a.image(&Source::File(&file), Use::Color, &of_user)?;
        let Some(image) = image else { return Ok(None) };
        let grid = element.text("gridlayout").filter(|grid| !flat && grid.chars().any(|cell| cell != '.'));
        let Some(grid) = grid else { return Ok(Some(Picture { image, layout: if flat { Layout::Flat } else { Layout::Cube }, flips })) };
        let [rows, columns] = element.vector::<2>("gridsize")?.map_or([1, 1], |sides| sides.map(|side| side.clamp(1.0, 12.0) as u32));
        let sides = sides_of(a.image_at(image), [rows, columns], grid);
        return Ok(Some(Picture { image: a.push_image(sides), layout: Layout::Sides, flips }));
    }
    let made = Made::of(element)?;
    let Some((image, layout)) = made.picture(flat) else {
        let place = element.place(a);
        a.warn(place, "it has neither a file nor a built-in pattern that is known; the plain colour was used");
        return Ok(None);
    };
    Ok(Some(Picture { image: a.push_image(image), layout, flips }))
}

/// The six sides of a cube among the cells of a picture, one below the other; a letter for each cell says which it is.
fn sides_of(image: &Image, [rows, columns]: [u32; 2], grid: &str) -> Image {
    let (side, cells) = ((image.width / columns).min(image.height / rows).max(1), grid.chars().collect::<Vec<char>>());
    let corner = |letter: char| {
        let cell = cells.iter().position(|cell| *cell == letter)? as u32;
        Some([cell % columns * side, cell / columns * side]).filter(|[x, y]| x + side <= image.width && y + side <= image.height)
    };
    let corners: Vec<Option<[u32; 2]>> = LETTERS.iter().map(|letter| corner(*letter)).collect();
    let places = (0..6 * side).flat_map(|y| (0..side).map(move |x| (x, y)));
    let source = places.map(|(x, y)| {
        let [left, top] = corners[(y / side) as usize]?;
        Some(((top + y % side) * image.width + left + x) as usize)
    });
    let pixels = match &image.pixels {
        Pixels::Rgba8 { srgb, texels } => {
            Pixels::Rgba8 { srgb: *srgb, texels: source.map(|at| at.map_or([128, 128, 128, 255], |at| texels[at])).collect() }
        }
        Pixels::RgbF32(texels) => Pixels::RgbF32(source.map(|at| at.map_or([0.5; 3], |at| texels[at])).collect()),
    };
    Image { name: format!("{} (sides)", image.name), width: side, height: 6 * side, pixels }
}

/// A picture that MuJoCo makes.
struct Made<'e> {
    name: String,
    pattern: &'e str,
    mark: &'e str,
    size: [u32; 2],
    colors: [[u8; 3]; 3],
}

impl<'e> Made<'e> {
    fn of(element: &'e Element) -> Result<Self, ImportError> {
        let color = |attribute: &str, default: f64| {
            let found = element.vector::<3>(attribute)?.unwrap_or([default; 3]);
            Ok::<_, ImportError>(found.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8))
        };
        let side = |attribute: &str| {
            let found = element.number(attribute)?.filter(|side| *side >= 1.0);
            Ok::<_, ImportError>(found.map_or(SIDE, |side| (side as u32).min(LARGEST)))
        };
        Ok(Self {
            name: format!("texture {}", element.name()),
            pattern: element.text("builtin").unwrap_or("none"),
            mark: element.text("mark").unwrap_or("none"),
            size: [side("width")?, side("height")?],
            colors: [color("rgb1", 0.8)?, color("rgb2", 0.5)?, color("markrgb", 0.0)?],
        })
    }

    /// The picture and its layout; `None` of an unknown pattern.
    fn picture(&self, flat: bool) -> Option<(Image, Layout)> {
        let [width, height] = if flat { self.size } else { [self.size[0]; 2] };
        let layout = match (flat, self.pattern) {
            (true, _) => Layout::Flat,
            (false, "gradient") => Layout::Sides,
            (false, _) => Layout::Cube,
        };
        let sides = if layout == Layout::Sides { 6 } else { 1 };
        let mut texels = Vec::with_capacity((width * height * sides) as usize);
        for side in 0..sides {
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let [r, g, b] = self.marked(x, y, [width, height]).map_or_else(|| self.texel(x, y, [width, height], layout, side), Some)?;
                texels.push([r, g, b, 255]);
            }
        }
        let pixels = Pixels::Rgba8 { srgb: true, texels };
        Some((Image { name: self.name.clone(), width, height: height * sides, pixels }, layout))
    }

    fn texel(&self, x: u32, y: u32, [width, height]: [u32; 2], layout: Layout, side: u32) -> Option<[u8; 3]> {
        let [first, second, _] = self.colors;
        let at = |place: u32, of: u32| 2.0 * f64::from(place) / f64::from(of.max(2) - 1) - 1.0;
        // From −1 to 1 the share of the second colour rises in an S, as in MuJoCo.
        let share = |place: f64| 1.0 / (1.0 + (-6.0 * place).exp());
        match (self.pattern, layout) {
            ("flat", _) => Some(first),
            ("checker", _) => Some(if (2 * x < width) == (2 * y < height) { first } else { second }),
            ("gradient", Layout::Sides) => {
                // By the direction's part along y, which is up in MuJoCo's cubes.
                let (across, down) = (at(x, width), at(y, height));
                let up = [-down, -down, 1.0, -1.0, -down, -down][side as usize] / (1.0 + across * across + down * down).sqrt();
                Some(mixed(first, second, 0.5 * (1.0 - up)))
            }
            ("gradient", _) => {
                let place = at(x, width).hypot(at(y, height));
                Some(mixed(first, second, share(2.0 * place.min(1.0) - 1.0)))
            }
            _ => None,
        }
    }

    /// The mark at a texel, unless there is none.
    fn marked(&self, x: u32, y: u32, [width, height]: [u32; 2]) -> Option<[u8; 3]> {
        let is_marked = match self.mark {
            "edge" => x == 0 || y == 0 || x + 1 == width || y + 1 == height,
            "cross" => x == width / 2 || y == height / 2,
            _ => false,
        };
        is_marked.then_some(self.colors[2])
    }
}

fn mixed(first: [u8; 3], second: [u8; 3], share: f64) -> [u8; 3] {
    std::array::from_fn(|i| (f64::from(first[i]) + (f64::from(second[i]) - f64::from(first[i])) * share).round() as u8)
}
