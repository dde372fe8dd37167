//! Sloping ceilings of drawn plans.

use crate::room::Room;
use enfilade_math::{DVec2, Vec2};
use enfilade_scene::{CeilingSlope, DrawnPlan};

/// Smallest and largest pitch, degrees.
const PITCHES: [f64; 2] = [5.0, 75.0];
/// Least height of a ceiling over the edge of the floor, metres: walls under a roof are knee walls at least this high.
const KNEE: f32 = 0.5;
/// Height of a ceiling under which people stand, metres, and the least share of a room's floor that has it.
const STANDING: (f32, f32) = (1.9, 0.3);

/// Puts rooms under the slopes of a plan.
///
/// # Errors
/// What is wrong with a slope, and what was expected.
pub fn put_under(rooms: &mut [Room], names: &[String], plan: &DrawnPlan) -> Result<(), String> {
    plan.slopes.iter().try_for_each(check)?;
    if let Some(of) = plan.slopes.iter().find(|of| of.room >= rooms.len()) {
        return Err(format!("a sloping ceiling is of room {}, but there are {}", of.room, rooms.len()));
    }
    for (number, room) in rooms.iter_mut().enumerate() {
        room.put_under(plan.slopes.iter().filter(|of| of.room == number).map(|of| of.slope));
        high_enough(room, &names[number])?;
    }
    let is_above_all = |of: &&CeilingSlope| !rooms.iter().flat_map(|room| &room.slopes).any(|incline| incline.slope == of.slope);
    match plan.slopes.iter().find(is_above_all) {
        Some(of) if plan.strict => Err(format!(
            "the slope that rises from {} at {} m with {} degrees is above the ceilings of all its rooms: lower it, or leave it out",
            DVec2::from(of.slope.from),
            of.slope.low_z_m,
            of.slope.pitch_deg
        )),
        _ => Ok(()),
    }
}

fn check(of: &CeilingSlope) -> Result<(), String> {
    let slope = &of.slope;
    let [from, to] = [slope.from, slope.to].map(DVec2::from);
    let [low, high] = PITCHES;
    if !(from.is_finite() && to.is_finite() && from.distance(to) > 0.01) {
        return Err(format!("a slope rises from a line between {from} and {to}, expected two points at least 1 cm apart"));
    }
    if !(low..=high).contains(&slope.pitch_deg) {
        return Err(format!("the slope that rises from {from} has {} degrees, expected {low} to {high}", slope.pitch_deg));
    }
    if !slope.low_z_m.is_finite() {
        return Err(format!("the slope that rises from {from} begins at {} m, expected its height above the floor", slope.low_z_m));
    }
    Ok(())
}

fn high_enough(room: &Room, name: &str) -> Result<(), String> {
    if room.slopes.is_empty() {
        return Ok(());
    }
    let corners = room.outline.edges().map(|[corner, _]| corner);
    let least = corners.min_by(|a, b| room.ceiling_at(*a).total_cmp(&room.ceiling_at(*b))).unwrap_or(Vec2::ZERO);
    if room.ceiling_at(least) < KNEE {
        return Err(format!(
            "the ceiling of room {name:?} is {:.2} m high at [{:.2}, {:.2}], expected at least {KNEE} m: begin it at a knee wall",
            room.ceiling_at(least),
            least.x,
            least.y
        ));
    }
    let (height, share) = STANDING;
    let found = room.share_above(height);
    if found < share {
        return Err(format!(
            "the ceiling of room {name:?} is at least {height} m high over {:.0} % of its floor, expected {:.0} %",
            100.0 * found,
            100.0 * share
        ));
    }
    Ok(())
}
