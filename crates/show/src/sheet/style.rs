//! Styles of the texts of a sheet, by their role.

use super::lettering::Style;

pub const SUBTITLE: Style = Style { height: 13.0, weight: 0.11, color: [168, 170, 174] };
pub const CAPTION: Style = Style { height: 11.0, weight: 0.115, color: [214, 214, 210] };
pub const DETAIL: Style = Style { height: 11.0, weight: 0.105, color: [142, 144, 150] };
