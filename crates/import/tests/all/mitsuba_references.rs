//! References of the shapes of a Mitsuba scene.

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::Rgb;

fn load(body: &str) -> Imported {
    Folder::new().write("a.xml", format!("<scene version=\"3.0.0\">{body}</scene>")).load("a.xml").unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn area_emitters_of_the_scene_are_for_shapes_to_refer_to() {
    let lamp = r#"<emitter type="area" id="lamp"><rgb name="radiance" value="3"/></emitter>"#;
    for reference in [r#"<ref id="lamp"/></shape>"#, r#"<ref id="other"/></shape><alias id="lamp" as="other"/>"#] {
        let imported = load(&format!(r#"{lamp}<shape type="sphere">{reference}"#));
        assert_eq!((imported.scene.materials[0].emission.factor, warnings(&imported).as_str()), (Rgb::splat(3.0), ""));
    }
    let told = warnings(&load(&format!(r#"{lamp}<shape type="sphere"/>"#)));
    assert!(told.contains("no shape refers to the area emitter; it was left out"), "{told}");
}
