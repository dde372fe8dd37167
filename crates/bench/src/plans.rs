//! `plans [FIRST] [COUNT] -o FILE.svg [--building NAME] [--rooms a,b,c]` draws floor plans of consecutive seeds from above, with the furniture in them.

use enfilade_home::room::{Filling, Room};
use enfilade_home::{FloorPlan, Home, HomeConfig, RoomKind, home};
use enfilade_math::Vec2;
use std::fmt::Write;

/// Drawn pixels per metre.
const SCALE: f32 = 34.0;
/// Edge of the square that each plan is drawn in, metres.
const TILE: f32 = 15.0;
/// Plans beside each other.
const COLUMNS: usize = 4;

/// Runs the instrument.
pub fn run() -> std::io::Result<()> {
    let args: Vec<String> = crate::arguments::arguments().collect();
    let value = |flag: &str| args.iter().position(|a| a == flag).and_then(|i| args.get(i + 1)).cloned();
    let numbers: Vec<u64> = args.iter().map_while(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(12));
    let rooms: Vec<RoomKind> = value("--rooms").iter().flat_map(|text| text.split(',')).filter_map(RoomKind::from_name).collect();
    let building = crate::arguments::building(value("--building").as_deref())?;
    let rows = (count as usize).div_ceil(COLUMNS);
    let (width, height) = (TILE * SCALE * COLUMNS as f32, TILE * SCALE * rows as f32);
    let mut svg = format!("<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' font-family='sans-serif'>\n");
    svg += &format!("<rect width='{width}' height='{height}' fill='white'/>\n");
    for k in 0..count as usize {
        let home = home(&HomeConfig { seed: first + k as u64, building, rooms: rooms.clone(), ..HomeConfig::default() });
        let at = Vec2::new((k % COLUMNS) as f32 + 0.5, (k / COLUMNS) as f32 + 0.5) * TILE * SCALE;
        let _ = writeln!(svg, "<g transform='translate({},{}) scale({SCALE},-{SCALE})' stroke-width='0.02'>", at.x, at.y);
        draw(&mut svg, &home);
        let _ = writeln!(
            svg,
            "</g><text x='{}' y='{}' font-size='16'>seed {}</text>",
            at.x - 0.48 * TILE * SCALE,
            at.y - 0.46 * TILE * SCALE,
            first + k as u64
        );
    }
    svg += "</svg>\n";
    std::fs::write(value("-o").unwrap_or_else(|| "plans.svg".into()), svg)
}

fn draw(svg: &mut String, home: &Home) {
    let FloorPlan { rooms, whole, .. } = &home.plan;
    let outer = rooms.first().map_or(0.3, |room| room.outer_wall);
    rectangle(svg, whole.min - outer, whole.max + outer, "#555");
    for room in rooms {
        let corners: String = room.outline.corners.iter().map(|p| format!("{},{} ", p.x, p.y)).collect();
        let _ = writeln!(svg, "<polygon points='{corners}' fill='{}'/>", if room.kind.wet() { "#dfe9f0" } else { "#f7f2e8" });
        openings(svg, room);
    }
    things(svg, home);
    for room in rooms {
        let (c, area) = (room.center, room.area);
        let _ = writeln!(
            svg,
            "<text transform='translate({},{}) scale(1,-1)' font-size='0.34' text-anchor='middle' fill='#a00'>{} {area:.1}</text>",
            c.x,
            c.y,
            room.kind.name()
        );
    }
    for camera in &home.scene.cameras {
        let (p, z) = (camera.position, -camera.world_from_camera.z_axis);
        let _ = writeln!(
            svg,
            "<circle cx='{}' cy='{}' r='0.09' fill='#06c'/><path d='M{} {} l{} {}' stroke='#06c' stroke-width='0.04'/>",
            p.x,
            p.y,
            p.x,
            p.y,
            0.5 * z.x,
            0.5 * z.y
        );
    }
}

fn rectangle(svg: &mut String, min: Vec2, max: Vec2, fill: &str) {
    let size = max - min;
    let _ = writeln!(svg, "<rect x='{}' y='{}' width='{}' height='{}' fill='{fill}'/>", min.x, min.y, size.x, size.y);
}

fn openings(svg: &mut String, room: &Room) {
    for o in &room.openings {
        let [a, b] = o.x.map(|x| room.before(o.wall, x, 0.0));
        let depth = if o.is_way() { 0.5 * room.thickness(o) + 0.01 } else { room.outer_wall };
        let back = -room.inward(o.wall) * depth;
        let corners: String = [a, b, b + back, a + back].iter().map(|p| format!("{},{} ", p.x, p.y)).collect();
        let _ = writeln!(svg, "<polygon points='{corners}' fill='{}'/>", if o.is_way() { "#f7f2e8" } else { "#9cf" });
        if let Filling::Door(leaf) = o.filling {
            let hinge = if leaf.hinge > 0.0 { b } else { a };
            let tip = hinge + Vec2::from_angle(-leaf.hinge * leaf.open_rad).rotate(-leaf.hinge * room.face(o.wall).along()) * o.size().x;
            let _ = writeln!(svg, "<path d='M{} {} L{} {}' stroke='#840' stroke-width='0.05'/>", hinge.x, hinge.y, tip.x, tip.y);
        }
    }
}

/// The outline from above of every part below the lintels, as the box around it.
fn things(svg: &mut String, home: &Home) {
    let scene = &home.scene;
    for (part, label) in scene.parts.iter().zip(&home.labels.parts) {
        if label.instance < 0 || part.name.starts_with("skirting") || part.name.starts_with("door") || part.name.starts_with("window") {
            continue;
        }
        let (min, max) = scene.world_positions(part).fold((Vec2::MAX, Vec2::MIN), |(a, b), p| (a.min(p.truncate()), b.max(p.truncate())));
        let hue = (u32::from(label.semantic as u16) * 67) % 360;
        let size = max - min;
        let _ = writeln!(
            svg,
            "<rect x='{}' y='{}' width='{}' height='{}' fill='hsl({hue},45%,60%)' fill-opacity='0.35' stroke='#333' stroke-width='0.008'/>",
            min.x, min.y, size.x, size.y
        );
    }
}
