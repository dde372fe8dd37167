//! What is behind the walls of drawn rooms: other rooms, or the outside.

use super::measures::{INNER_WALL, OUTER_WALL};
use super::outlines::{OPPOSITE, behind};
use crate::room::Back;
use crate::room::outline::Outline;
use enfilade_math::Vec2;

/// Pieces of wall shorter than this belong to the piece beside them, metres: ends of walls that meet this one from behind.
const SHORTEST: f32 = 0.6;
/// Thinnest half of a wall, metres.
const THINNEST: f32 = 0.04;

/// The pieces of a room's wall by what is behind them.
pub fn backs(outlines: &[Outline], room: usize, wall: usize) -> Vec<Back> {
    let [from, to] = outlines[room].edge(wall);
    let (length, along) = (from.distance(to), (to - from).normalize_or_zero());
    let outward = -along.perp();
    let mut cuts: Vec<f32> = vec![0.0, length];
    let corners = outlines.iter().flat_map(|outline| (0..outline.count()).map(|i| outline.corner(i)));
    cuts.extend(corners.map(|p| (p - from).dot(along)).filter(|s| *s > 0.01 && *s < length - 0.01));
    cuts.sort_by(f32::total_cmp);
    cuts.dedup_by(|a, b| *a - *b < 0.01);
    let mut pieces: Vec<Back> = Vec::new();
    for ends in cuts.windows(2) {
        let x = [ends[0] - 0.5 * length, ends[1] - 0.5 * length];
        let piece = piece(outlines, room, outward, [ends[0], ends[1]].map(|s| from + along * s), x);
        match pieces.last_mut() {
            Some(last) if (last.outer, last.beyond) == (piece.outer, piece.beyond) && (last.thickness - piece.thickness).abs() < 0.005 => {
                last.x[1] = piece.x[1];
            }
            _ => pieces.push(piece),
        }
    }
    merged(pieces)
}

fn piece(outlines: &[Outline], own: usize, outward: Vec2, [a, b]: [Vec2; 2], x: [f32; 2]) -> Back {
    let at = |t: f32| behind(outlines, a.lerp(b, t), outward);
    let found = [0.02, 0.5, 0.98].map(at);
    let Some(nearest) = found.iter().flatten().copied().min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Back { x, thickness: OUTER_WALL, outer: true, beyond: None };
    };
    let (thickness, room, edge) = found[1].unwrap_or(nearest);
    let [c, d] = outlines[room].edge(edge);
    let parallel = (d - c).normalize_or_zero().perp().dot(outward) > -OPPOSITE && room != own;
    let thickness = thickness.min(nearest.0).max(2.0 * THINNEST);
    Back { x, thickness, outer: false, beyond: parallel.then_some(room) }
}

/// Gives short pieces to the longer one beside them, the thinner one of two.
fn merged(mut pieces: Vec<Back>) -> Vec<Back> {
    let length = |piece: &Back| piece.x[1] - piece.x[0];
    while pieces.len() > 1 {
        let Some(short) =
            (0..pieces.len()).filter(|&i| length(&pieces[i]) < SHORTEST).min_by(|&a, &b| length(&pieces[a]).total_cmp(&length(&pieces[b])))
        else {
            break;
        };
        let beside = [short.checked_sub(1), Some(short + 1).filter(|next| *next < pieces.len())];
        let Some(into) = beside.into_iter().flatten().min_by(|&a, &b| pieces[a].thickness.total_cmp(&pieces[b].thickness)) else { break };
        let gone = pieces[short];
        let kept = &mut pieces[into];
        kept.x = [kept.x[0].min(gone.x[0]), kept.x[1].max(gone.x[1])];
        // A short piece of the outside behind an inner wall is only as thick as that; a neighbour nearer than a wall is deep wins.
        if !gone.outer {
            kept.thickness = kept.thickness.min(gone.thickness.max(INNER_WALL * 0.5));
        }
        pieces.remove(short);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec2;

    fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> Outline {
        Outline::new([[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(DVec2::from).to_vec())
    }

    #[test]
    fn a_long_wall_has_a_piece_for_each_room_behind_it_and_for_the_outside() {
        // Two rooms north of a long one, 0.1 m behind it and 0.1 m apart, which end before it does.
        let rooms = [rectangle([0.0, 0.0], [8.0, 3.0]), rectangle([0.0, 3.1], [3.0, 6.0]), rectangle([3.1, 3.1], [6.0, 6.0])];
        let found: Vec<(Option<usize>, bool, f32, f32)> = backs(&rooms, 0, 2)
            .iter()
            .map(|b| (b.beyond, b.outer, (100.0 * b.thickness).round(), (b.x[1] - b.x[0] + 0.05).floor()))
            .collect();
        // From the east: outside, the second room, the first.
        assert_eq!(found, [(None, true, 36.0, 2.0), (Some(2), false, 10.0, 3.0), (Some(1), false, 10.0, 3.0)]);
        assert_eq!(backs(&rooms, 0, 0), [Back { x: [-4.0, 4.0], thickness: OUTER_WALL, outer: true, beyond: None }]);
    }
}
