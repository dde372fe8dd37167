//! usda: the text encoding.

mod lexer;
mod metadata;
mod parser;
mod values;

use super::layer::Layer;
use parser::Parser;

/// Reads a layer from text.
///
/// # Errors
/// The line, and the fault there.
pub(super) fn parse(text: &str) -> Result<Layer, (String, String)> {
    let first = text.lines().next().unwrap_or("").trim();
    if !first.trim_start_matches('\u{feff}').starts_with("#usda") {
        let found: String = first.chars().take(40).collect();
        return Err(("line 1".into(), format!("found {found:?}, expected `#usda 1.0`; check that this is a USD layer as text")));
    }
    let mut parser = Parser::new(text.trim_start_matches('\u{feff}'));
    match parser.file() {
        Ok(()) => Ok(parser.layer),
        Err(problem) => Err((format!("line {}", parser.line), problem)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::layer::field;
    use super::*;

    const ROOM: &str = r#"#usda 1.0
(
    "a room"
    defaultPrim = "World"
    metersPerUnit = 1
    subLayers = [ @a.usda@ (offset = 2), @b.usd@ ]
)
def Xform "World" (
    prepend references = [@c.usda@</X>, </Y>]
    delete inherits = </_class>
    variants = { string color = "red" }
    prepend variantSets = "color"
    customData = { dictionary a = { int[] b = [1, 2] } }
) {
    uniform token[] xformOpOrder = ["xformOp:translate"]
    double3 xformOp:translate = (1, 2, 3)
    double3 xformOp:translate.timeSamples = { 2: (4, 5, 6), 1: (7, 8, 9), }
    matrix4d m = ( (1,0,0,0), (0,1,0,0), (0,0,1,0), (5,6,7,1) )
    rel material:binding = </World/Looks/M> ( bindMaterialAs = "strongerThanDescendants" )
    token outputs:surface.connect = <Looks/M.outputs:surface>
    int[] empty = []
    variantSet "color" = {
        "red" { def Cube "C" { double size = 3 } }
        "blue" ( active = false ) { }
    }
}
"#;

    #[test]
    fn a_layer_as_text_becomes_fields_by_paths() {
        let layer = parse(ROOM).unwrap();
        let get = |path, name| layer.get(path, name).unwrap_or_else(|| panic!("{path} has no {name}"));
        assert_eq!(get("/", field::SUBLAYERS).as_texts().len(), 2);
        let references = get("/World", field::REFERENCES).as_list();
        assert_eq!((references.prepended[0].asset.as_str(), references.prepended[0].path.as_str()), ("c.usda", "/X"));
        assert_eq!(references.prepended[1].path, "/Y");
        assert_eq!(get("/World", field::INHERITS).as_list().deleted[0].path, "/_class");
        assert_eq!(get("/World.xformOp:translate", field::DEFAULT).as_tuple(), Some([1.0, 2.0, 3.0]));
        let super::super::value::Value::Samples(samples) = get("/World.xformOp:translate", field::SAMPLES) else { panic!("no samples") };
        assert_eq!((samples.codes.as_slice(), samples.values[0].as_tuple()), (&[1.0, 2.0][..], Some([7.0, 8.0, 9.0])));
        assert_eq!(get("/World.m", field::DEFAULT).as_tuple::<16>().unwrap()[12..15], [5.0, 6.0, 7.0]);
        assert_eq!(get("/World.material:binding", "bindMaterialAs").as_text(), Some("strongerThanDescendants"));
        assert_eq!(get("/World.outputs:surface", field::CONNECTIONS).as_list().explicit.unwrap()[0].path, "/World/Looks/M.outputs:surface");
        assert_eq!(get("/World.empty", field::DEFAULT).as_numbers(1), Some(&[][..]));
        assert_eq!(get("/World{color=red}C.size", field::DEFAULT).as_number(), Some(3.0));
        assert_eq!(get("/World{color=red}", field::CHILDREN).as_text(), Some("C"));
        assert_eq!(get("/World{color=blue}", "active").as_bool(), Some(false));
    }

    #[test]
    fn broken_text_is_refused_with_its_line_wherever_it_is_cut() {
        let error = parse(&ROOM.replace("double3 xformOp:translate = (1, 2, 3)", "double3 xformOp:translate = (1 2, 3)")).unwrap_err();
        assert_eq!(error.0, "line 16");
        assert!(error.1.contains("found the number 2, expected `,` or `)`"), "{}", error.1);
        for end in (0..ROOM.len() - 3).filter(|end| ROOM.is_char_boundary(*end)) {
            let _ = parse(&ROOM[..end]);
        }
        assert!(parse("#usda 1.0\ndef \"A\" {").unwrap_err().1.contains("cut short"));
        let deep = format!("#usda 1.0\n{}", "def \"A\" {".repeat(5000));
        assert!(parse(&deep).unwrap_err().1.contains("nested more than"));
        let deep = format!("#usda 1.0\ndef \"A\" {{ int a = {}", "(".repeat(5000));
        assert!(parse(&deep).unwrap_err().1.contains("nested too deeply"));
    }
}
