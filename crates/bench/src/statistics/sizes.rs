//! Sizes of things: by class, and of families whose usual measures are published.

use super::measure::{Measured, Object};
use super::published::{SIZE_SOURCES, SIZES};
use super::spread::Spread;
use enfilade_scene::NYU40;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Width, depth and height of all objects that `chosen` picks.
fn sizes(homes: &[Measured], chosen: impl Fn(&Object) -> bool) -> [Spread; 3] {
    let of = |axis: usize| homes.iter().flat_map(|home| &home.objects).filter(|o| chosen(o)).map(|o| f64::from(o.size_m[axis])).collect();
    [of(0), of(1), of(2)]
}

/// "0.76 (0.60–0.95)": median, and the tenth and ninetieth of a hundred.
fn cell(spread: &Spread) -> String {
    let [low, middle, high] = [0.1, 0.5, 0.9].map(|q| spread.quantile(q));
    format!("{middle:.2} ({low:.2}–{high:.2})")
}

/// Tables of sizes as Markdown.
pub fn tables(homes: &[Measured]) -> String {
    let mut text = String::from(
        "\n## Sizes\n\nWidth, depth and height, in metres, of the box around an object, aligned with the object: median (10 %–90 %).\n\n\
         | class | instances | width | depth | height |\n|---|---|---|---|---|\n",
    );
    for class in NYU40 {
        let sizes = sizes(homes, |object| object.semantic == class.id);
        if sizes[0].count() > 0 {
            let _ = writeln!(text, "| {} | {} | {} |", class.name, sizes[0].count(), sizes.each_ref().map(cell).join(" | "));
        }
    }
    text += "\nFamilies whose usual sizes are published; the published size is below ours.\n\n\
             | family | instances | width | depth | height | |\n|---|---|---|---|---|---|\n";
    for published in &SIZES {
        let ours = sizes(homes, |object| object.family == published.family);
        if ours[0].count() == 0 {
            continue;
        }
        let cells: Vec<String> =
            ours.iter().zip(published.size_m).map(|(ours, known)| format!("{}<br>{}", cell(ours), measure(known))).collect();
        let remark = format!("{} {}", published.comment, published.source);
        let _ = writeln!(text, "| {} | {} | {} | {remark} |", published.family, ours[0].count(), cells.join(" | "));
    }
    text + "\n" + SIZE_SOURCES + "\n"
}

fn measure(known: Option<[f64; 2]>) -> String {
    match known {
        None => "–".into(),
        Some([from, to]) if from == to => format!("{from:.2}"),
        Some([from, to]) => format!("{from:.2}–{to:.2}"),
    }
}

/// Sizes for programs: [10 %, median, 90 %] of width, depth and height.
pub fn figures(homes: &[Measured]) -> Value {
    let class = |class: &enfilade_scene::SemanticClass| {
        let sizes = sizes(homes, |object| object.semantic == class.id);
        let [width, depth, height] = sizes.each_ref().map(|spread| [0.1, 0.5, 0.9].map(|q| spread.quantile(q)));
        json!({ "class": class.name, "count": sizes[0].count(), "width_m": width, "depth_m": depth, "height_m": height })
    };
    NYU40.iter().map(class).collect()
}
