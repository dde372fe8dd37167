//! Pix3D's nine categories, and which of them Hypersim's classes become.

/// Pix3D's categories in the order of Mesh R-CNN's numbers, which count from 1.
pub const CATEGORIES: [&str; 9] = ["bed", "bookcase", "chair", "desk", "misc", "sofa", "table", "tool", "wardrobe"];

/// The category of a name, 1 to 9.
pub fn category_id(name: &str) -> Option<u32> {
    (1..).zip(CATEGORIES).find(|(_, known)| *known == name).map(|(id, _)| id)
}

/// The category that an NYU40 class becomes; `None` for classes that take no part. Roberts et al. 2021, supplementary material.
///
/// ```
/// use enfilade_shapes::{CATEGORIES, category_from_nyu40};
/// let bookshelf = category_from_nyu40(10).unwrap();
/// assert_eq!(CATEGORIES[bookshelf as usize - 1], "bookcase");
/// assert_eq!(category_from_nyu40(1), None, "walls have no shape to predict");
/// ```
pub fn category_from_nyu40(semantic: i16) -> Option<u32> {
    let name = match semantic {
        4 => "bed",
        5 => "chair",
        6 => "sofa",
        7 | 32 => "table",
        10 => "bookcase",
        14 => "desk",
        17 => "wardrobe",
        18 | 24 | 25 | 29 | 34 => "misc",
        _ => return None,
    };
    category_id(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn categories_have_mesh_r_cnns_numbers() {
        let ids: Vec<_> = CATEGORIES.iter().map(|name| category_id(name).unwrap()).collect();
        assert_eq!(ids, (1..=9).collect::<Vec<_>>());
        assert_eq!(
            (category_id("bed"), category_id("misc"), category_id("wardrobe"), category_id("lamp")),
            (Some(1), Some(5), Some(9), None)
        );
    }

    #[test]
    fn thirteen_classes_take_part() {
        let named = |semantic| category_from_nyu40(semantic).map(|id| CATEGORIES[id as usize - 1]);
        assert_eq!((1..=40).filter(|&class| named(class).is_some()).count(), 13);
        let same = [(4, "bed"), (5, "chair"), (6, "sofa"), (7, "table"), (14, "desk")];
        let renamed = [(10, "bookcase"), (17, "wardrobe"), (32, "table")];
        let misc = [18, 24, 25, 29, 34].map(|class| (class, "misc"));
        for (class, name) in same.into_iter().chain(renamed).chain(misc) {
            assert_eq!(named(class), Some(name));
        }
        assert_eq!((named(-1), named(0), named(41)), (None, None, None));
    }
}
