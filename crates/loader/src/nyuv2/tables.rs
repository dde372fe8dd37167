//! The training and test images of NYUv2, and the mapping of its classes; `data/nyuv2/README.md` names the sources.

use std::sync::LazyLock;

/// Images in the published file.
pub const PUBLISHED_IMAGES: usize = 1449;

static SPLIT: LazyLock<Vec<bool>> = LazyLock::new(|| rows(include_str!("../../data/nyuv2/split.csv"), |row| row[1] == "test"));
static CLASSES_894: LazyLock<Vec<(&str, i16)>> =
    LazyLock::new(|| rows(include_str!("../../data/nyuv2/classes894.csv"), |row| (row[1], number(row[2]))));
static CLASSES_40: LazyLock<Vec<(&str, i16)>> =
    LazyLock::new(|| rows(include_str!("../../data/nyuv2/classes40.csv"), |row| (row[1], number(row[2]))));
static CLASSES_13: LazyLock<Vec<&str>> = LazyLock::new(|| rows(include_str!("../../data/nyuv2/classes13.csv"), |row| row[1]));

/// A side of the published split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NyuSide {
    /// 795 images.
    Train,
    /// 654 images.
    Test,
}

/// Which set of classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NyuClasses {
    /// The 894 of the file.
    All,
    /// NYU40 (Gupta et al. 2013).
    Forty,
    /// NYU13 (Couprie et al. 2013).
    Thirteen,
}

impl NyuClasses {
    /// The set of that many classes.
    pub fn of(count: usize) -> Option<Self> {
        [Self::All, Self::Forty, Self::Thirteen].into_iter().find(|classes| classes.names().len() == count)
    }

    /// Names of the classes, starting with class 1.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            Self::All => CLASSES_894.iter().map(|row| row.0).collect(),
            Self::Forty => CLASSES_40.iter().map(|row| row.0).collect(),
            Self::Thirteen => CLASSES_13.clone(),
        }
    }

    /// The class that class `label` of the file counts as; −1 for 0, which is "unlabelled", and for what is no class.
    pub fn of_label(self, label: u16) -> i16 {
        let Some(&(_, nyu40)) = usize::from(label).checked_sub(1).and_then(|row| CLASSES_894.get(row)) else { return -1 };
        match self {
            Self::All => label as i16,
            Self::Forty => nyu40,
            Self::Thirteen => nyu13_of_nyu40(nyu40),
        }
    }
}

/// The class of NYU13 that a class of NYU40 counts as; −1 for all other numbers.
///
/// ```
/// use enfilade_loader::{NyuClasses, nyu13_of_nyu40};
/// assert_eq!(NyuClasses::Forty.names()[5 - 1], "chair");
/// assert_eq!(nyu13_of_nyu40(5), 4);
/// assert_eq!(NyuClasses::Thirteen.names()[4 - 1], "chair");
/// ```
pub fn nyu13_of_nyu40(nyu40: i16) -> i16 {
    usize::try_from(nyu40).ok().and_then(|class| class.checked_sub(1)).and_then(|row| CLASSES_40.get(row)).map_or(-1, |row| row.1)
}

/// The side of an image, counted from 0; `None` beyond the published images.
pub fn side_of(image: usize) -> Option<NyuSide> {
    SPLIT.get(image).map(|&test| if test { NyuSide::Test } else { NyuSide::Train })
}

/// The rows of a table whose first column counts them from 1.
fn rows<T>(table: &'static str, row: impl Fn(&[&'static str]) -> T) -> Vec<T> {
    table.lines().skip(1).map(|line| row(&line.split(',').collect::<Vec<_>>())).collect()
}

/// A number of a table, which a test has seen.
fn number(text: &str) -> i16 {
    text.parse().unwrap_or(-1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::NYU40;
    use std::collections::BTreeSet;

    #[test]
    fn the_split_is_the_published_one() {
        let sides: Vec<_> = (0..PUBLISHED_IMAGES).filter_map(side_of).collect();
        let of = |side| sides.iter().filter(|&&found| found == side).count();
        assert_eq!([of(NyuSide::Train), of(NyuSide::Test)], [795, 654]);
        // The first of each, counted from 1.
        let first = |side| (0..PUBLISHED_IMAGES).filter(move |&image| side_of(image) == Some(side)).map(|image| image + 1).take(5);
        assert!(first(NyuSide::Train).eq([3, 4, 5, 6, 7]) && first(NyuSide::Test).eq([1, 2, 9, 14, 15]));
        assert_eq!(side_of(PUBLISHED_IMAGES), None);
    }

    #[test]
    fn there_are_894_40_and_13_classes_and_all_are_used() {
        for (classes, count) in [(NyuClasses::All, 894), (NyuClasses::Forty, 40), (NyuClasses::Thirteen, 13)] {
            assert_eq!((classes.names().len(), NyuClasses::of(count)), (count, Some(classes)));
            let used: BTreeSet<i16> = (1..=894).map(|label| classes.of_label(label)).collect();
            assert!(used.into_iter().eq(1..=count as i16), "{classes:?}");
            assert_eq!([0, 895, u16::MAX].map(|label| classes.of_label(label)), [-1; 3]);
        }
        assert_eq!(NyuClasses::of(14), None);
    }

    #[test]
    fn tables_count_their_rows() {
        for table in ["split", "classes894", "classes40", "classes13"] {
            let path = format!("{}/data/nyuv2/{table}.csv", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(path).unwrap();
            let firsts: Vec<usize> = text.lines().skip(1).map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
            assert!(firsts.iter().copied().eq(1..=firsts.len()), "{table}");
        }
    }

    #[test]
    fn the_thirteen_classes_are_those_of_the_published_table() {
        let published = [
            12, 5, 6, 1, 4, 9, 10, 12, 13, 6, 8, 6, 13, 10, 6, 13, 6, 7, 7, 5, 7, 3, 2, 6, 11, 7, 7, 7, 7, 7, 7, 6, 7, 7, 7, 7, 7, 7, 6, 7,
        ];
        assert!((1..=40).map(nyu13_of_nyu40).eq(published));
        assert_eq!([-1, 0, 41].map(nyu13_of_nyu40), [-1; 3]);
    }

    #[test]
    fn the_forty_classes_are_those_of_datasets() {
        let plain = |name: &str| name.replace(' ', "").replace("refridgerator", "refrigerator");
        assert!(NyuClasses::Forty.names().into_iter().map(plain).eq(NYU40.iter().map(|class| class.name.to_string())));
    }

    #[test]
    fn classes_of_one_name_keep_their_meaning() {
        let fine = NyuClasses::All.names();
        let label = |name: &str| 1 + fine.iter().position(|&found| found == name).unwrap() as u16;
        for (name, forty, thirteen) in
            [("wall", "wall", "wall"), ("chair", "chair", "chair"), ("dresser", "dresser", "furniture"), ("lamp", "lamp", "objects")]
        {
            let name_of = |classes: NyuClasses| classes.names()[classes.of_label(label(name)) as usize - 1];
            assert_eq!([name_of(NyuClasses::Forty), name_of(NyuClasses::Thirteen)], [forty, thirteen]);
        }
    }
}
