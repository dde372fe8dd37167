//! Claims about poses made by hand.

use super::*;

const CSV: &str = "frame, position_x, position_y, position_z, look_at_x, look_at_y, look_at_z, roll_deg\n\
                   0, 3.0, 2.5, 1.5, 3.0, 4.0, 1.2, 0\n\
                   10, 3.5, 2.0, 1.4, 3.0, 4.0, 1.2, 3\n\
                   16, 3.6, 1.5, 1.5, 2.0, 4.0, 1.3, -2\n";

const JSON: &str = r#"[{"frame": 0, "position": [3.0, 2.5, 1.5], "look_at": [3.0, 4.0, 1.2]},
    {"frame": 10, "position": [3.5, 2.0, 1.4], "look_at": [3.0, 4.0, 1.2], "roll_deg": 3},
    {"frame": 16, "position": [3.6, 1.5, 1.5], "look_at": [2.0, 4.0, 1.3], "roll_deg": -2}]"#;

#[test]
fn tables_of_both_kinds_are_read_and_every_frame_between_their_poses_is_there() {
    let keyframes = parse_keyframes("path.csv", CSV).unwrap();
    assert_eq!(keyframes, parse_keyframes("PATH.JSON", JSON).unwrap());
    // As spreadsheets write them where the comma is the decimal point, and with tabs.
    let semicolons = CSV.replace(", ", ";").replace('.', ",");
    assert_eq!(keyframes, parse_keyframes("path.csv", &semicolons).unwrap());
    assert_eq!(keyframes, parse_keyframes("path.csv", &CSV.replace(", ", "\t")).unwrap());
    let room = furnished_room();
    let (space, heard) = (carved(&room), Heard::default());
    let planned = follow(&room.world, &room.bvh, &space, &keyframes, "cam_04", &quick(), &heard).unwrap();
    let poses = &planned.trajectory.poses;
    assert_eq!((planned.trajectory.name.as_str(), poses.len()), ("cam_04", 17));
    for keyframe in &keyframes {
        let pose = poses[keyframe.frame as usize];
        assert_eq!((pose.frame, pose.position, pose.look_at), (keyframe.frame, keyframe.position, keyframe.look_at));
        assert!((pose.roll_rad() - keyframe.roll_rad).abs() < 1e-12);
    }
    // Between them the path bends evenly and the roll turns evenly.
    let bend = |i: usize| poses[i + 1].position - 2.0 * poses[i].position + poses[i - 1].position;
    assert!((2..15).all(|i| (bend(i) - bend(i + 1 - 1)).length() < 0.01));
    assert!((poses[5].roll_rad() - 1.5f64.to_radians()).abs() < 1e-12);
    poses.iter().for_each(|pose| assert_keeps_rules(&room, &space, &quick(), pose));
    assert_eq!(heard.lines().join("\n"), "");
}

#[test]
fn tables_as_pandas_and_spreadsheets_write_them_are_read() {
    let expected = parse_keyframes("path.csv", CSV).unwrap();
    let header = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg";
    let numbered: String =
        CSV.lines().enumerate().map(|(i, line)| format!("{},{line}\n", if i == 0 { String::new() } else { i.to_string() })).collect();
    for text in [
        format!("\u{feff}{CSV}"),
        numbered,
        CSV.replace("\n10,", "\n10.0,").replace("\n0,", "\n0.0,"),
        CSV.replace('\n', "\n,,,,,,,\n\n"),
        CSV.replace("frame", "Frame").replace("position_x", "POSITION_X"),
        CSV.replacen(CSV.lines().next().unwrap(), header, 1),
    ] {
        assert_eq!(parse_keyframes("path.csv", &text).unwrap_or_else(|e| panic!("{e}: {text}")), expected, "{text}");
    }
    assert_eq!(parse_keyframes("a.json", &format!("\u{feff}{}", JSON.replace("\"frame\": 10", "\"frame\": 10.0"))).unwrap(), expected);
    assert!(parse_keyframes("path.csv", &CSV.replace("\n10,", "\n10.5,")).is_err());
    assert!(parse_keyframes("path.csv", &CSV.replace("roll_deg", "rol")).is_err());
}

#[test]
fn a_written_trajectory_comes_back_as_it_was() {
    let room = furnished_room();
    let space = carved(&room);
    let walk = trajectory(&room, &space, &start(), 0, &PlanConfig { frames: 6, ..quick() }, &Quiet).unwrap();
    let row = |pose: &Pose| {
        let (p, t, y) = (pose.position, pose.look_at, pose.world_from_camera.y_axis);
        format!("{},{},{},{},{},{},{},{},{},{}\n", pose.frame, p.x, p.y, p.z, t.x, t.y, t.z, y.x, y.y, y.z)
    };
    let header = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,up_x,up_y,up_z\n";
    let text: String = std::iter::once(header.to_string()).chain(walk.poses.iter().map(row)).collect();
    let keyframes = parse_keyframes("walk.csv", &text).unwrap();
    let again = follow(&room.world, &room.bvh, &space, &keyframes, "cam_00", &quick(), &Quiet).unwrap().trajectory;
    for (a, b) in again.poses.iter().zip(&walk.poses) {
        assert_eq!((a.frame, a.position, a.look_at), (b.frame, b.position, b.look_at));
        assert!((a.world_from_camera - b.world_from_camera).to_cols_array().iter().all(|v| v.abs() < 1e-9));
    }
}

#[test]
fn frames_in_a_wall_are_named_and_left_as_they_are() {
    let room = furnished_room();
    let (space, heard) = (carved(&room), Heard::default());
    let text = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z\n0,3,2.5,1.5,3,4,1.2\n2,7,2.5,1.5,3,4,1.2\n";
    let keyframes = parse_keyframes("path.csv", text).unwrap();
    let planned = follow(&room.world, &room.bvh, &space, &keyframes, "cam_00", &quick(), &heard).unwrap();
    assert_eq!(planned.trajectory.poses[2].position, DVec3::new(7.0, 2.5, 1.5));
    let places: Vec<u32> = planned.report.relaxed.iter().filter(|r| r.fault == Fault::Place).map(|r| r.frame).collect();
    assert_eq!(places, [2]);
    let warnings = heard.lines().join("\n");
    assert!(warnings.contains("1 of 3 views are not from free space with 0.2 m to every surface (frames 2)"), "{warnings}");
    assert!(warnings.contains("1 ways from one frame to the next pass through a surface (those to frames 2)"), "{warnings}");
}

#[test]
fn wrong_tables_say_where_and_what() {
    let error = |file: &str, text: &str| parse_keyframes(file, text).unwrap_err().to_string();
    let csv = |rows: &str| error("path.csv", &format!("frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z\n{rows}"));
    assert_eq!(
        csv("0,0,0,1,1,0,1\n0,0,0,1,2,0,1\n"),
        "path.csv, pose 2: found frame 0; expected frames that ascend from 0 and stay below 10000"
    );
    assert!(csv("3,0,0,1,1,0,1\n").starts_with("path.csv, pose 1: found frame 3; expected frames that ascend from 0"));
    assert!(csv("0,0,0,1,0,0,3\n").contains("pose 1: found a view from [0, 0, 1] to [0, 0, 3]; expected two different points"));
    assert!(csv("0,0,zero,1,0,0,3\n").contains("pose 1: found ") && csv("").contains("expected a pose"));
    assert!(csv("0,0,inf,1,0,0,3\n").contains("expected finite numbers"));
    assert!(error("p.csv", "frame,x,y,z\n0,1,2,3\n").contains("expected the columns frame, position_x"));
    assert!(error("p.json", "{}").starts_with("p.json, pose 1: found invalid type"));
    assert!(error("p.json", "[{\"frame\": 0, \"position\": [0, 0, 1]}]").contains("missing field `look_at`"));
    let both = r#"[{"frame": 0, "position": [0, 0, 1], "look_at": [1, 0, 1], "roll_deg": 2, "up": [0, 0, 1]}]"#;
    assert!(error("p.json", both).contains("both a roll and an up vector; expected one of them"));
}

#[test]
fn given_poses_are_kept_even_straight_down_and_faults_are_named() {
    let room = furnished_room();
    let space = carved(&room);
    let config = PlanConfig { mode: Mode::Cameras(CamerasConfig { fps: 10.0 }), ..quick() };
    assert_eq!((config.mode.fps(), config.validate()), (Some(10.0), Ok(())));
    // A camera that looks straight down and turns, as one on a hand may.
    let down = |frame: u32| {
        let position = DVec3::new(3.0, 2.5, 1.5);
        let axes = DMat3::from_rotation_z(0.1 * f64::from(frame));
        Pose { frame, position, look_at: position - DVec3::Z, world_from_camera: axes }
    };
    let poses: Vec<Pose> = (0..4).map(down).collect();
    let planned = film(&room.world, &room.bvh, &space, poses.clone(), "cam_02", &config, &Quiet).unwrap();
    assert_eq!((planned.trajectory.poses, planned.report.mode.as_str(), planned.report.roll_limit_deg), (poses, "cameras", None));
    let none = film(&room.world, &room.bvh, &space, Vec::new(), "cam_02", &config, &Quiet).unwrap_err().to_string();
    assert!(none.contains("expected at least one pose"), "{none}");
}
