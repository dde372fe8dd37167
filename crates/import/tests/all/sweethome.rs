//! Homes and furniture libraries of Sweet Home 3D, made on the spot.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec2, Vec3};
use enfilade_scene::{Alpha, Bsdf, Environment, Light, Part, TextureRef};
use std::io::{Cursor, Write};
use zip::write::{SimpleFileOptions, ZipWriter};

fn zip(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// A corner with three legs of one unit, whose ends distinguish the axes.
const TRIPOD: &str = "mtllib tripod.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl oak\nf 1 2 3\nf 1 3 4\nf 1 4 2\n";
const MTL: &[u8] = b"newmtl oak\nKd 0.4 0.3 0.2\n";

/// A room of 4 by 3 metres between the middles of walls 20 cm thick and 250 cm high.
fn walls(first: &str) -> String {
    let corners = [(0, 0), (400, 0), (400, 300), (0, 300)];
    let wall = |i: usize| {
        let ((x, y), (to_x, to_y)) = (corners[i], corners[(i + 1) % 4]);
        let (before, after) = ((i + 3) % 4, (i + 1) % 4);
        let more = if i == 0 { first } else { "/>" };
        format!(
            "<wall id='w{i}' wallAtStart='w{before}' wallAtEnd='w{after}' xStart='{x}' yStart='{y}' xEnd='{to_x}' yEnd='{to_y}' \
             height='250' thickness='20' leftSideColor='FFFF0000'{more}\n"
        )
    };
    (0..4).map(wall).collect()
}

const ROOM: &str = "<room id='r' name='Kitchen' floorColor='FF808080'><point x='10' y='10'/><point x='390' y='10'/><point x='390' y='290'/><point x='10' y='290'/></room>";

fn home(body: &str) -> Vec<u8> {
    home_with(body, &[])
}

/// A home with more files in its archive.
fn home_with(body: &str, more: &[(&str, &[u8])]) -> Vec<u8> {
    let xml = format!("<?xml version='1.0'?>\n<home version='7000' wallHeight='250'>\n{body}</home>");
    let picture = png(2, 2, [0, 255, 0, 255]);
    let own: [(&str, &[u8]); 4] =
        [("Home.xml", xml.as_bytes()), ("1/tripod.obj", TRIPOD.as_bytes()), ("1/tripod.mtl", MTL), ("2", &picture)];
    zip(&[&own[..], more].concat())
}

fn load(body: &str) -> Imported {
    load_with(body, &[])
}

fn load_with(body: &str, more: &[(&str, &[u8])]) -> Imported {
    let folder = Folder::new();
    folder.write("a.sh3d", home_with(body, more));
    let imported = folder.load("a.sh3d").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(imported.inputs, [folder.path("a.sh3d")]);
    imported
}

fn part<'i>(imported: &'i Imported, name: &str) -> &'i Part {
    let all: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    imported.scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} among {all:?}"))
}

fn points(imported: &Imported, name: &str) -> Vec<Vec3> {
    imported.scene.world_positions(part(imported, name)).collect()
}

/// The area of a part's faces, each counted by the sign of its normal along `toward`.
fn area(imported: &Imported, name: &str, toward: Vec3) -> f32 {
    let part = part(imported, name);
    let triangles = imported.scene.meshes[part.mesh as usize].triangles.len();
    let corners = (0..triangles).map(|t| imported.scene.world_corners(part, t));
    corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(toward)).sum()
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)))
}

fn near(a: f32, b: f32) {
    assert!((a - b).abs() < 1e-4, "{a} is not {b}");
}

#[test]
fn joined_walls_meet_in_their_corners_and_face_outward() {
    let imported = load(&(walls("/>") + ROOM));
    let (min, max) = bounds(&points(&imported, "wall_1.left"));
    // The outer side: 420 cm long at the plan's y of −10, which is 10 cm up the world's y.
    assert!((min - Vec3::new(-0.1, 0.0, 0.0)).length() < 1e-5 && (max - Vec3::new(4.1, 0.1, 2.5)).length() < 1e-5, "{min} {max}");
    // The side itself, and half of the slanting end at each corner, which cancel each other out across but not along.
    near(area(&imported, "wall_1.left", Vec3::Y), 4.2 * 2.5 - 2.0 * 0.1 * 2.5);
    near(area(&imported, "wall_1.right", Vec3::NEG_Y), 3.8 * 2.5 + 2.0 * 0.1 * 2.5);
    near(area(&imported, "Kitchen.floor", Vec3::Z), 3.8 * 2.8);
    near(area(&imported, "Kitchen.ceiling", Vec3::NEG_Z), 3.8 * 2.8);
    near(points(&imported, "Kitchen.ceiling")[0].z, 2.5);
    let material = |name| &imported.scene.materials[part(&imported, name).material as usize].bsdf;
    assert_eq!(material("wall_1.left"), &Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() });
    assert_eq!(material("wall_1.right"), &Bsdf::Diffuse { reflectance: Rgb::splat(0.8).into() });
}

#[test]
fn doors_cut_through_both_sides_and_show_the_inside_of_the_wall() {
    let door = "<doorOrWindow name='Door' model='1/tripod.obj' x='200' y='2' width='100' depth='10' height='200' cutOutShape='M0,0 v1 h1 v-1 z'/>\n";
    let imported = load(&(door.to_string() + &walls("/>")));
    let whole = load(&walls("/>"));
    for (side, toward) in [("wall_1.left", Vec3::Y), ("wall_1.right", Vec3::NEG_Y)] {
        near(area(&whole, side, toward) - area(&imported, side, toward), 2.0);
        near(area(&whole, "wall_2.left", toward), area(&imported, "wall_2.left", toward));
    }
    // Two jambs of 20 by 200 cm and a head of 100 by 20; no sill on the floor.
    let triangles = |i: &Imported| i.scene.meshes[part(i, "wall_1.top").mesh as usize].triangles.len();
    assert_eq!(triangles(&imported) - triangles(&whole), 6);
    assert!(points(&imported, "wall_1.left").iter().any(|p| (*p - Vec3::new(1.5, 0.1, 2.0)).length() < 1e-5));
}

#[test]
fn windows_take_the_stated_part_of_their_size() {
    let window = "<doorOrWindow name='W' model='1/tripod.obj' x='200' y='0' elevation='100' width='100' depth='20' height='100' \
                  wallWidth='0.5' wallLeft='0.25' wallHeight='0.5' wallTop='0.25'/>\n";
    let imported = load(&(window.to_string() + &walls("/>")));
    near(area(&load(&walls("/>")), "wall_1.left", Vec3::Y) - area(&imported, "wall_1.left", Vec3::Y), 0.25);
    assert!(points(&imported, "wall_1.left").iter().any(|p| (*p - Vec3::new(1.75, 0.1, 1.75)).length() < 1e-5));
}

#[test]
fn round_walls_and_sloping_ones_have_their_height_and_length() {
    // Half a circle of radius one metre to the left; its outer side is as long as half the circumference.
    let imported = load(
        "<wall id='w' xStart='0' yStart='0' xEnd='200' yEnd='0' height='100' heightAtEnd='200' thickness='10' arcExtent='3.1415927'/>",
    );
    let left = points(&imported, "wall_1.left");
    let (min, max) = bounds(&left);
    assert!((max.y - 1.05).abs() < 5e-3 && (min.x + 0.05).abs() < 1e-3 && (max.x - 2.05).abs() < 1e-3 && max.z == 2.0, "{min} {max}");
    let part = part(&imported, "wall_1.left");
    let triangles = imported.scene.meshes[part.mesh as usize].triangles.len();
    let corners = (0..triangles).map(|t| imported.scene.world_corners(part, t));
    let total: f32 = corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
    let expected = std::f32::consts::PI * 1.05 * 1.5 + 0.05 * 3.0;
    assert!((total - expected).abs() < 0.02 * expected, "{total} {expected}");
}

#[test]
fn pieces_are_scaled_mirrored_turned_and_painted() {
    let piece = "<pieceOfFurniture catalogId='t#tripod' name='Tripod' model='1/tripod.obj' x='200' y='100' elevation='10' angle='1.5707963' \
                 width='100' depth='50' height='80' modelMirrored='true'><material name='oak' color='FF00FF00'/></pieceOfFurniture>";
    let imported =
        load(&format!("{piece}\n<furnitureGroup name='G'>{}</furnitureGroup>", piece.replace("modelMirrored='true'", "color='00FFFFFF'")));
    let found = points(&imported, "Tripod (t#tripod)");
    // The end at x: half of (100, −80, −50) cm from the middle, mirrored, turned to (25, −40, −50), moved to (225, 10, 50).
    assert!(found.iter().any(|p| (*p - Vec3::new(2.25, -0.5, 0.1)).length() < 1e-5), "{found:?}");
    let (min, max) = bounds(&found);
    assert!((max - min - Vec3::new(0.5, 1.0, 0.8)).length() < 1e-5);
    let bsdf = |name| &imported.scene.materials[part(&imported, name).material as usize].bsdf;
    assert_eq!(bsdf("Tripod (t#tripod)"), &Bsdf::Diffuse { reflectance: Rgb::new(0.0, 1.0, 0.0).into() });
    assert_eq!(bsdf("Tripod_2 (t#tripod)"), &Bsdf::Diffuse { reflectance: Rgb::WHITE.into() });
    assert!(part(&imported, "Tripod_2 (t#tripod)").world_from_mesh.matrix3.determinant() > 0.0);
}

#[test]
fn levels_lift_and_hide_what_is_on_them() {
    let levels = "<level id='a' name='0' elevation='0' floorThickness='12' height='250'/>\n\
                  <level id='b' name='1' elevation='262' floorThickness='12' height='250'/>\n\
                  <level id='c' name='2' elevation='524' floorThickness='12' height='250' visible='false'/>\n";
    let piece = |level| {
        format!("<pieceOfFurniture name='T' level='{level}' model='1/tripod.obj' x='0' y='0' width='10' depth='10' height='10'/>\n")
    };
    let wall = "<wall id='w' level='b' xStart='0' yStart='0' xEnd='100' yEnd='0' height='200' thickness='10'/>\n";
    let imported = load(&format!("{levels}{}{}{wall}", piece("b"), piece("c")));
    let (min, max) = bounds(&points(&imported, "wall_1.left"));
    assert!((min.z - 2.5).abs() < 1e-5 && (max.z - 4.62).abs() < 1e-5, "{min} {max}");
    near(bounds(&points(&imported, "T")).0.z, 2.62);
    assert_eq!(imported.scene.parts.iter().filter(|p| p.name.starts_with('T')).count(), 1);
    assert!(warnings(&imported).contains("1 levels are hidden"));
}

#[test]
fn lamps_cameras_and_sky_are_where_the_file_has_them() {
    let body = "<environment skyColor='00FFFFFF' ceillingLightColor='00000000' lightColor='00D0D0D0' photoWidth='400' photoHeight='200'/>\n\
                <observerCamera attribute='observerCamera' lens='PINHOLE' x='200' y='150' z='170' yaw='0' pitch='0' fieldOfView='1.0'/>\n\
                <light name='Lamp' model='1/tripod.obj' x='100' y='100' elevation='200' width='20' depth='20' height='10' power='0.5'>\
                <lightSource x='0.5' y='0.5' z='0' color='FFFFFFFF' diameter='0.2'/></light>\n";
    let imported = load(body);
    let camera = &imported.scene.cameras[0];
    assert!((camera.position.as_vec3() - Vec3::new(2.0, -1.5, 1.7)).length() < 1e-6 && camera.aspect == 2.0 && camera.fov_x_rad == 1.0);
    // Yaw 0 looks down the plan.
    assert!((camera.world_from_camera.z_axis.as_vec3() - Vec3::Y).length() < 1e-6, "{camera:?}");
    let Light::Point { position, intensity, .. } = &imported.scene.lights[0] else { panic!("no lamp") };
    assert!((*position - Vec3::new(1.0, -1.0, 2.0)).length() < 1e-5, "{position}");
    let expected = 5.0 * 0.25 * std::f32::consts::PI * 255.0 * 208.0 * 1e-4;
    assert!((intensity.r - expected).abs() < 1e-3 * expected, "{intensity:?} {expected}");
    assert_eq!(imported.scene.environment, Some(Environment::Constant { radiance: Rgb::WHITE }));
}

/// The piece of Sweet Home 3D's coloured sources of light is a model of lines alone, and other lamps have shapes that mark their bulbs.
#[test]
fn sources_of_light_shine_but_what_marks_them_is_not_seen() {
    let light = |model: &str| {
        format!(
            "<light name='Lamp' model='{model}' x='100' y='100' elevation='200' width='20' depth='20' height='10'>\
             <lightSource x='0.5' y='0.5' z='0.5' color='FFFFFFFF'/></light>\n"
        )
    };
    let lines = b"g sweethome3d_light_source\nv 0 0 0\nv 1 1 1\nl 1 2\n";
    let bulb = b"v 0 0 0\nv 1 0 0\nv 0 1 1\ng sweethome3d_light_bulb\nf 1 2 3\ng shade\nf 3 2 1\n";
    let lamps = [light("lines.obj"), light("bulb.obj"), light("")].concat();
    let imported = load_with(&(walls("/>") + &lamps), &[("lines.obj", lines), ("bulb.obj", bulb)]);
    let seen: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).filter(|name| name.starts_with("Lamp")).collect();
    assert_eq!(seen, ["Lamp_2.shade"]);
    assert_eq!(imported.scene.lights.len(), 3);
    for light in &imported.scene.lights {
        let Light::Point { position, .. } = light else { panic!("{light:?}") };
        assert!((*position - Vec3::new(1.0, -1.0, 2.05)).length() < 1e-5, "{position}");
    }
    assert!(!warnings(&imported).contains("a box"), "{}", warnings(&imported));
}

#[test]
fn ceiling_lights_hang_below_the_ceiling_of_the_highest_level() {
    let height = |walls: &str| {
        let Light::Point { position, .. } = load(&format!("{walls}{ROOM}")).scene.lights[0].clone() else { panic!("no light") };
        position.z
    };
    near(height(&walls("/>").replace("height='250'", "height='200'")), 1.75);
    // Without walls they hang below the home's own height of walls.
    let xml = format!("<?xml version='1.0'?>\n<home version='7000' wallHeight='300'>\n{ROOM}</home>");
    let folder = Folder::new();
    folder.write("a.sh3d", zip(&[("Home.xml", xml.as_bytes())]));
    let imported = folder.load("a.sh3d").unwrap();
    let Light::Point { position, .. } = &imported.scene.lights[0] else { panic!("no light") };
    near(position.z, 2.75);
    near(points(&imported, "Kitchen.ceiling")[0].z, 3.0);
}

#[test]
fn panes_are_glass_and_mirrors_reflect_whatever_their_materials_say() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 1\nusemtl flltgrey\ng frame\nf 1 2 3\ng sweethome3d_window_pane_1\nf 1 2 3\n\
                g sweethome3d_window_mirror\nf 1 2 3\nusemtl glasstransparent\ng sweethome3d_window_pane_2\nf 1 2 3\n";
    let window = |more: &str| {
        format!("<pieceOfFurniture name='W' model='w.obj' x='0' y='0' width='10' depth='10' height='10' {more}</pieceOfFurniture>\n")
    };
    let pieces = [">", "color='FF00FF00'>", "><material name='flltgrey' color='FF00FF00'/>", "><texture image='2'/>"].map(window).concat();
    let imported = load_with(&pieces, &[("w.obj", obj)]);
    let material = |piece: &str, part: &str| &imported.scene.materials[self::part(&imported, &format!("{piece}.{part}")).material as usize];
    let green = Rgb::new(0.0, 1.0, 0.0);
    let glass = |tint: Rgb| Bsdf::ThinDielectric { eta: 1.5, transmittance: tint.map(|c| 0.5 + 0.5 * c).into() };
    let mirror = |reflectance: Rgb| Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: reflectance.into(), alpha: 0.0.into() };
    let grey = Rgb::splat(0.825);
    // A colour or picture of the whole window leaves its panes alone; a picture leaves its mirrors alone.
    for (piece, frame, pane, reflected) in
        [("W", Some(grey), grey, grey), ("W_2", Some(green), grey, green), ("W_3", Some(green), green, green), ("W_4", None, grey, grey)]
    {
        if let Some(frame) = frame {
            assert_eq!(material(piece, "frame").bsdf, Bsdf::Diffuse { reflectance: frame.into() }, "{piece}");
        }
        assert!(material(piece, "sweethome3d_window_pane_1").bsdf.is_pane(), "{piece}");
        assert_eq!(material(piece, "sweethome3d_window_pane_1").bsdf, glass(pane), "{piece}");
        assert_eq!(material(piece, "sweethome3d_window_mirror").bsdf, mirror(reflected), "{piece}");
    }
    // What lets light through already stays as it is.
    assert!(matches!(material("W", "sweethome3d_window_pane_2").alpha, Alpha::Blend { opacity } if opacity.factor == 0.25));
}

#[test]
fn shelf_units_are_pieces_and_kinds_that_are_not_known_are_told_once() {
    let piece = |tag: &str| format!("<{tag} name='{tag}' model='1/tripod.obj' x='0' y='0' width='100' depth='50' height='80'/>\n");
    let imported = load(&[piece("shelfUnit"), piece("gadget"), piece("gadget")].concat());
    let (min, max) = bounds(&points(&imported, "shelfUnit"));
    assert!((max - min - Vec3::new(1.0, 0.5, 0.8)).length() < 1e-5);
    assert_eq!(warnings(&imported).matches("<gadget>: this kind of furniture is not known").count(), 1, "{}", warnings(&imported));
}

/// A door that is open by a quarter turn is as deep as it is wide; the size that the home states is the open door's.
#[test]
fn open_doors_are_turned_on_their_hinges_before_they_are_sized() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 2 0\nv 1 2 0\ng frame\nf 1 2 3\ng sweethome3d_opening_on_hinge_1\nf 1 2 4\n\
                g sweethome3d_opening_on_hinge_10\nf 2 1 3\n";
    let quarter = "0 0 1 0 0 1 0 0 -1 0 0 0";
    let door = |name: &str, matrix: &str| {
        format!(
            "<pieceOfFurniture name='Door' model='door.obj' x='0' y='0' width='100' depth='100' height='200'>\
             <transformation name='{name}' matrix='{matrix}'/></pieceOfFurniture>"
        )
    };
    let imported = load_with(&door("sweethome3d_hinge_1", quarter), &[("door.obj", obj)]);
    let near_box = |part: &str, min: Vec3, max: Vec3| {
        let (a, b) = bounds(&points(&imported, part));
        assert!((a - min).length() < 1e-5 && (b - max).length() < 1e-5, "{part}: {a} {b}");
    };
    near_box("Door.sweethome3d_opening_on_hinge_1", Vec3::new(-0.5, -0.5, 0.0), Vec3::new(-0.5, 0.5, 2.0));
    for still in ["Door.frame", "Door.sweethome3d_opening_on_hinge_10"] {
        near_box(still, Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, -0.5, 2.0));
    }
    assert!(!warnings(&imported).contains("moved"), "{}", warnings(&imported));
    let bent = load_with(&door("sweethome3d_mannequin_neck", quarter), &[("door.obj", obj)]);
    assert!(warnings(&bent).contains("moved at \"sweethome3d_mannequin_neck\", which is no hinge"), "{}", warnings(&bent));
    let folder = Folder::new();
    let message = folder.write("a.sh3d", home_with(&door("sweethome3d_hinge_1", "1 0 0"), &[("door.obj", obj)])).error("a.sh3d");
    assert!(message.contains("<transformation>: found 3 numbers in matrix, expected twelve"), "{message}");
}

/// Sweet Home 3D lays the picture of a single material by the model's own coordinates, whatever its size in centimetres.
#[test]
fn pictures_of_single_materials_follow_the_models_own_coordinates() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 1\nvt 0 0\nvt 2 0\nvt 0 2\nusemtl white\nf 1/1 2/2 3/3\n";
    let piece = |paint: &str| {
        format!("<pieceOfFurniture name='P' model='p.obj' x='0' y='0' width='100' depth='50' height='80'>{paint}</pieceOfFurniture>\n")
    };
    let texture = |more: &str| format!("<texture name='T' width='50' height='25' image='2' {more}/>");
    let single = |texture: String| piece(&format!("<material name='white'>{texture}</material>"));
    let pieces = [single(texture("")), single(texture("scale='2' xOffset='0.25'")), piece(&texture(""))].concat();
    let imported = load_with(&pieces, &[("p.obj", obj)]);
    let laid = |name: &str| -> (Vec<Vec2>, TextureRef) {
        let part = part(&imported, name);
        let material = &imported.scene.materials[part.material as usize];
        let mut pictures = Vec::new();
        material.textures(|texture| pictures.push(*texture));
        (imported.scene.meshes[part.mesh as usize].uvs.clone(), pictures[0])
    };
    let own = vec![Vec2::ZERO, Vec2::new(2.0, 0.0), Vec2::new(0.0, 2.0)];
    let (uvs, picture) = laid("P");
    assert_eq!((&uvs, picture.uv_transform), (&own, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    let (uvs, picture) = laid("P_2");
    assert_eq!((&uvs, picture.uv_transform), (&own, [[0.5, 0.0, -0.25], [0.0, 0.5, 0.0]]));
    let (uvs, picture) = laid("P_3");
    assert!(uvs != own && picture.uv_transform == [[1.0 / 50.0, 0.0, 0.0], [0.0, 1.0 / 25.0, 0.0]], "{uvs:?} {picture:?}");
}

#[test]
fn pictures_lie_on_walls_in_centimetres() {
    let texture = "><texture attribute='rightSideTexture' name='Tiles' width='50' height='25' image='2'/></wall>";
    let imported = load(&walls(texture));
    let material = &imported.scene.materials[part(&imported, "wall_1.right").material as usize];
    let Bsdf::Diffuse { reflectance } = &material.bsdf else { panic!("not diffuse") };
    let picture = reflectance.texture.expect("a picture");
    assert_eq!(imported.scene.images[picture.image as usize].texel(0, 0).0, Rgb::new(0.0, 1.0, 0.0));
    assert_eq!(picture.uv_transform, [[1.0 / 50.0, 0.0, 0.0], [0.0, 1.0 / 25.0, 0.0]]);
    let mesh = &imported.scene.meshes[part(&imported, "wall_1.right").mesh as usize];
    let highest = mesh.uvs.iter().fold(0.0f32, |m, uv| m.max(uv.y));
    assert_eq!((material.name.as_str(), highest), ("Tiles", 250.0));
}

#[test]
fn what_cannot_be_read_says_where_and_what_to_do() {
    let folder = Folder::new();
    let error = |name: &str, bytes: Vec<u8>| folder.write(name, bytes).error(name);
    assert!(error("a.sh3d", zip(&[("Home", b"java")])).contains("a.sh3d: Home: the home is stored as Java objects alone"));
    assert!(error("b.sh3d", zip(&[("x", b"y")])).contains("b.sh3d: whole file: found neither Home.xml nor"));
    assert!(error("c.sh3d", b"no zip".to_vec()).contains("c.sh3d: whole file: not an archive"));
    let whole = home(&walls("/>"));
    assert!(error("d.sh3d", whole[..whole.len() / 2].to_vec()).contains("not an archive"));
    let message = error("e.sh3d", home("<wall id='w' xStart='zero' yStart='0' xEnd='1' yEnd='0' thickness='1'/>"));
    assert_eq!(
        message,
        "e.sh3d/Home.xml: line 3 <wall>: found xStart=\"zero\", expected a finite number; fix the file or save the home again"
    );
    assert!(error("f.sh3d", home("<wall")).contains("f.sh3d/Home.xml: line 3"));
    let deep = "<furnitureGroup name='g'>".repeat(100) + &"</furnitureGroup>".repeat(100);
    assert!(error("g.sh3d", home(&deep)).contains("groups are nested too deep"));
}

#[test]
fn models_that_cannot_be_used_become_boxes() {
    let piece = |model| format!("<pieceOfFurniture name='P' model='{model}' x='0' y='0' width='100' depth='50' height='80'/>");
    let imported = load(&piece("9/gone.obj"));
    assert!(warnings(&imported).contains("the model 9/gone.obj is not in the archive; a box"), "{}", warnings(&imported));
    let (min, max) = bounds(&points(&imported, "P"));
    assert!((max - min - Vec3::new(1.0, 0.5, 0.8)).length() < 1e-5);
}

#[test]
fn libraries_stand_in_rows_with_their_names_and_sizes() {
    let list = "name#1=Stool\nid#1=t#stool\ncategory#1=Living\nmodel#1=/m/tripod.obj\nwidth#1=40\ndepth#1=30\nheight#1=50\n\
                name#2=Door\nmodel#2=/m/gone.obj\nwidth#2=90\ndepth#2=10\nheight#2=200\nname#3=Bad\nmodel#3=/m/tripod.obj\nwidth#3=0\n";
    let entries: [(&str, &[u8]); 3] =
        [("PluginFurnitureCatalog.properties", list.as_bytes()), ("m/tripod.obj", TRIPOD.as_bytes()), ("m/tripod.mtl", MTL)];
    let folder = Folder::new();
    folder.write("few.sh3f", zip(&entries));
    let imported = folder.load("few.sh3f").unwrap();
    let (min, max) = bounds(&points(&imported, "Stool (t#stool)"));
    assert!(min.length() < 1.0 && (max - min - Vec3::new(0.4, 0.3, 0.5)).length() < 1e-5, "{min} {max}");
    let told = warnings(&imported);
    assert!(told.contains("the model m/gone.obj is not in the archive") && told.contains("width#3 (Bad): found \"0\""), "{told}");
}

#[test]
fn pictures_of_models_are_called_by_their_places_in_the_archive() {
    let piece = "<pieceOfFurniture name='Chair' model='3/chair.obj' x='200' y='150' width='10' depth='10' height='10'/>";
    let chair = TRIPOD.replace("tripod", "chair");
    let picture = png(2, 2, [9, 9, 9, 255]);
    let more: [(&str, &[u8]); 3] =
        [("3/chair.obj", chair.as_bytes()), ("3/chair.mtl", b"newmtl oak\nmap_Kd oak.png\n"), ("3/oak.png", &picture)];
    let scene = load_with(piece, &more).scene;
    assert_eq!(scene.images.iter().map(|image| image.name.as_str()).collect::<Vec<_>>(), ["3/oak.png"]);
    assert_eq!(scene, load_with(piece, &more).scene);
}

#[test]
fn materials_that_only_java_3d_knows_are_as_it_has_them() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl flltgrey\nf 1 3 2\nusemtl silver\nf 1 2 3\nusemtl unheard_of\nf 1 2 3\n\
               usemtl glassblutint\nf 1 2 3\nusemtl smoked_glass\nf 1 2 3\n";
    let xml = "<?xml version='1.0'?>\n<home version='7000' wallHeight='250'>\n\
               <pieceOfFurniture name='Thing' model='thing.obj' x='0' y='0' width='10' depth='10' height='10'/></home>";
    let folder = Folder::new();
    folder.write("a.sh3d", zip(&[("Home.xml", xml.as_bytes()), ("thing.obj", obj.as_bytes())]));
    let imported = folder.load("a.sh3d").unwrap();
    let bsdf = |name: &str| imported.scene.materials.iter().find(|m| m.name == name).map(|m| &m.bsdf);
    let diffuse = |value: f32| Some(Bsdf::Diffuse { reflectance: Rgb::splat(value).into() });
    assert_eq!(bsdf("flltgrey").cloned(), diffuse(0.825));
    assert_eq!(bsdf("unheard_of").cloned(), diffuse(0.5));
    for (name, kd) in [("silver", Rgb::splat(0.616)), ("default", Rgb::new(0.71, 0.702, 0.653))] {
        assert!(matches!(bsdf(name), Some(Bsdf::Principled(p)) if p.base_color.factor == kd), "{name}: {:?}", bsdf(name));
    }
    // Their `d` is opacity.
    for (name, expected) in [("glassblutint", 0.67), ("smoked_glass", 0.02)] {
        let alpha = imported.scene.materials.iter().find(|m| m.name == name).map(|m| &m.alpha);
        assert!(matches!(alpha, Some(Alpha::Blend { opacity }) if opacity.factor == expected), "{name}: {alpha:?}");
    }
    let told = warnings(&imported);
    assert!(told.matches("no material library").count() == 1 && told.contains("unheard_of"), "{told}");
}
