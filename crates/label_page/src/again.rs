//! "The same again": copies of labelled pieces are found by their shape, and labelled alike.
//!
//! A copy has a piece for each of the pieces, of the same shape, and one motion, which may mirror, takes all of them there. Where a program
//! placed one mesh several times, the motion follows from corresponding corners; else [`Points`] finds it.

use super::action::{Context, Refusal};
use super::congruence::{Points, TOLERANCE, TOLERANCE_M, frame};
use super::pieces::Pieces;
use enfilade_label::annotation::Edit;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::PartLabel;
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// Corners nearer to a line than this share of the size determine no rotation.
const FLAT: f64 = 1e-3;

impl Context<'_> {
    /// The edit that labels the copies of pieces.
    ///
    /// # Errors
    /// When the pieces have no classes, there is no copy without classes, or there are not enough instance numbers.
    pub(super) fn same_again(&self, group: &[u32]) -> Result<Edit, Refusal> {
        let list = self.pieces.list();
        let label = |piece: u32| list[piece as usize].label;
        if let Some(bare) = group.iter().find(|&&piece| label(piece).semantic < 1) {
            let error = format!("{:?} has no class to give to copies", list[*bare as usize].name);
            return Err(Refusal::conflict(error, "label the selection first"));
        }
        let Some(first) = group.first() else { return Err(Refusal::request("pieces is empty; expected the pieces to look for")) };
        let name = &list[*first as usize].name;
        let all = copies(self.pieces, group);
        let found: Vec<&Vec<u32>> = all.iter().filter(|copy| copy.iter().all(|&piece| label(piece).semantic < 1)).collect();
        if found.is_empty() {
            let error = match all.len() {
                0 => format!("there is no copy of {name:?}"),
                many => format!("all {many} copies of {name:?} have classes already"),
            };
            return Err(Refusal::conflict(error, "copies have the same shapes in the same arrangement, or its mirror image"));
        }
        let numbers: BTreeSet<i16> = group.iter().map(|&piece| label(piece).instance).filter(|&instance| instance >= 1).collect();
        let wanted = numbers.len() * found.len();
        let mut next = self.instances(wanted)?;
        let (mut pieces, mut labels): (Vec<u32>, Vec<PartLabel>) = (Vec::new(), Vec::new());
        for copy in &found {
            let own: BTreeMap<i16, i16> = numbers.iter().copied().zip(next..).collect();
            next += numbers.len() as i16;
            pieces.extend(copy.iter());
            labels.extend(group.iter().map(|&piece| {
                let PartLabel { semantic, instance } = label(piece);
                PartLabel { semantic, instance: own.get(&instance).copied().unwrap_or(PartLabel::NONE.instance) }
            }));
        }
        let (semantic, instance) = labels.iter().map(|label| (label.semantic, label.instance)).unzip();
        let copies = if found.len() == 1 { "1 copy".into() } else { format!("{} copies", found.len()) };
        let description = format!("The same again: {copies} of {name}");
        Ok(Edit::Label { description, pieces, semantic, instance, next_instance: self.next_instance + wanted as i32 })
    }
}

/// The copies of a group of pieces, moved or mirrored: in each the piece for every piece of the group, in its order. No two share a piece.
fn copies(pieces: &Pieces, group: &[u32]) -> Vec<Vec<u32>> {
    let list = pieces.list();
    let key = |piece: u32| list[piece as usize].measure.geometry_key;
    let mut of_shape: HashMap<u32, Vec<u32>> = HashMap::new();
    (0..list.len() as u32).filter(|piece| !group.contains(piece)).for_each(|piece| of_shape.entry(key(piece)).or_default().push(piece));
    let others = |piece: u32| of_shape.get(&key(piece)).map_or(&[][..], Vec::as_slice);
    // The shape that is rarest elsewhere leaves the fewest places to look at; of those the one with most faces.
    let anchor = group.iter().copied().min_by_key(|&piece| (others(piece).len(), usize::MAX - list[piece as usize].faces.len(), piece));
    let Some(anchor) = anchor else { return Vec::new() };
    let shapes = Shapes { pieces, known: RefCell::default() };
    let mut used: BTreeSet<u32> = BTreeSet::new();
    let mut found = Vec::new();
    for &there in others(anchor) {
        let copy_by = |motion: DAffine3| {
            let mut copy = Vec::new();
            for &piece in group {
                let free = |other: &&u32| !used.contains(other) && !copy.contains(*other);
                let low = shapes.lowest(piece, &motion);
                let near = |other: &&u32| is_near(list[**other as usize].measure.min, low);
                let fits = |other: &u32| shapes.are_taken(piece, *other, &motion, anchor);
                let candidates = if piece == anchor { std::slice::from_ref(&there) } else { others(piece) };
                copy.push(candidates.iter().filter(free).filter(near).copied().find(fits)?);
            }
            Some(copy)
        };
        let in_order = motion(&shapes.of(anchor).corners, &shapes.of(there).corners);
        let copy = in_order.and_then(copy_by).or_else(|| shapes.motions(anchor, there).into_iter().find_map(copy_by));
        if let Some(copy) = copy {
            used.extend(&copy);
            found.push(copy);
        }
    }
    found
}

/// The shapes of pieces, each computed once, when it is needed.
struct Shapes<'p> {
    pieces: &'p Pieces,
    known: RefCell<HashMap<u32, Rc<Shape>>>,
}

/// A shape in the world.
struct Shape {
    /// Corners of the faces, in order.
    corners: Vec<DVec3>,
    points: OnceCell<Points>,
}

impl Shape {
    fn points(&self) -> &Points {
        self.points.get_or_init(|| Points::of(&self.corners))
    }
}

impl Shapes<'_> {
    fn of(&self, piece: u32) -> Rc<Shape> {
        let make = || {
            let of_face = |&face: &u32| self.pieces.scene().corners[face as usize];
            let faces = &self.pieces.list()[piece as usize].faces;
            let corners = faces.iter().flat_map(of_face).map(|corner| corner.as_dvec3()).collect();
            Rc::new(Shape { corners, points: OnceCell::new() })
        };
        self.known.borrow_mut().entry(piece).or_insert_with(make).clone()
    }

    /// The lower corner of the bounds of a moved piece.
    fn lowest(&self, piece: u32, motion: &DAffine3) -> DVec3 {
        self.of(piece).corners.iter().fold(DVec3::INFINITY, |low, &corner| low.min(motion.transform_point3(corner)))
    }

    /// True where the motion takes a piece to another, corner by corner or, if its faces are in another order, as a whole.
    fn are_taken(&self, piece: u32, other: u32, motion: &DAffine3, anchor: u32) -> bool {
        let (from, to) = (self.of(piece), self.of(other));
        is_moved(&from.corners, &to.corners, motion, self.of(anchor).corners[0]) || from.points().are_taken_to(to.points(), motion)
    }

    /// The motions that take a piece to another, in whatever order their faces are.
    fn motions(&self, piece: u32, other: u32) -> Vec<DAffine3> {
        self.of(piece).points().motions_to(self.of(other).points())
    }
}

/// True where the lower corner of a piece's bounds is about where that of the moved corners is: most pieces are told apart by this alone.
fn is_near(min: [f32; 3], low: DVec3) -> bool {
    low.distance(DVec3::from_array(min.map(f64::from))) < 4.0 * TOLERANCE_M + TOLERANCE * low.length()
}

/// True where the motion takes each corner to its counterpart.
fn is_moved(from: &[DVec3], to: &[DVec3], motion: &DAffine3, origin: DVec3) -> bool {
    let fits = |(&a, &b): (&DVec3, &DVec3)| motion.transform_point3(a).distance(b) <= TOLERANCE_M + TOLERANCE * a.distance(origin);
    from.len() == to.len() && from.iter().zip(to).all(fits)
}

/// The rigid motion that takes corners to their counterparts; `None` where they determine none.
fn motion(from: &[DVec3], to: &[DVec3]) -> Option<DAffine3> {
    let first = *from.first().filter(|_| from.len() == to.len())?;
    let farthest = |far: &dyn Fn(DVec3) -> f64| (0..from.len()).max_by(|&a, &b| far(from[a]).total_cmp(&far(from[b])));
    let second = farthest(&|corner| corner.distance_squared(first))?;
    let along = (from[second] - first).try_normalize()?;
    let third = farthest(&|corner| (corner - first).reject_from_normalized(along).length_squared())?;
    if (from[third] - first).reject_from_normalized(along).length() < FLAT * from[second].distance(first) {
        return None;
    }
    let rotation = frame(to[second] - to[0], to[third] - to[0])? * frame(from[second] - first, from[third] - first)?.transpose();
    Some(DAffine3::from_mat3_translation(rotation, to[0] - rotation * first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DMat3;

    #[test]
    fn a_motion_is_found_by_corners_and_a_mirror_is_none() {
        let from = [DVec3::ZERO, DVec3::X, DVec3::new(0.2, 2.0, 0.1), DVec3::new(0.5, 0.5, 1.0)];
        let moved = DAffine3::from_mat3_translation(DMat3::from_rotation_z(1.2) * DMat3::from_rotation_x(0.3), DVec3::new(5.0, -2.0, 1.0));
        let to = from.map(|corner| moved.transform_point3(corner));
        let found = motion(&from, &to).unwrap();
        assert!(is_moved(&from, &to, &found, from[0]) && found.abs_diff_eq(moved, 1e-12));
        let mirrored = from.map(|corner| corner * DVec3::new(1.0, 1.0, -1.0));
        assert!(motion(&from, &mirrored).is_none_or(|found| !is_moved(&from, &mirrored, &found, from[0])));
        assert!(motion(&[DVec3::ZERO, DVec3::X, DVec3::X], &[DVec3::ZERO, DVec3::Y, DVec3::Y]).is_none(), "a line turns freely");
    }
}
