//! Meshes that change their shape over time, as shapes at moments between which every vertex goes straight.

use super::Side;
use crate::assembly::TimedShapes;
use enfilade_geometry::Mesh;
use enfilade_math::DAffine3;
use enfilade_scene::Shape;
use std::sync::Arc;

/// Pieces are not cut shorter, seconds.
const SHORTEST_S: f64 = 1.0 / 240.0;
/// Most vertices of all shapes of a mesh: about half a gigabyte.
const MOST_VERTICES: usize = 20_000_000;
/// Most shapes of a mesh: five minutes at sixty a second.
const MOST_SHAPES: usize = 20_000;

/// What becomes of a mesh whose shape may change.
pub(crate) enum Shapes {
    /// A mesh with one shape.
    Constant,
    Timed(TimedShapes),
    /// Why it cannot be followed; a clause that begins with "it" or "its".
    Refused(String),
}

/// The shapes of a mesh at `moments`, in any order, and at as many more as vertices need to be no farther than `length` from their straight
/// ways, in the mesh's units, halfway from one to the next. `jumps` is true if shapes before and after a moment may differ.
///
/// # Errors
/// When a shape cannot be made.
pub(crate) fn shapes<E>(
    mut moments: Vec<f64>,
    jumps: bool,
    length: f64,
    mut shape: impl FnMut(f64, Side) -> Result<Shape, E>,
) -> Result<Shapes, E> {
    moments.sort_by(f64::total_cmp);
    moments.dedup();
    let too_many = |count: usize, vertices: usize| {
        let told = || {
            format!("it has more than {MOST_SHAPES} states, or {MOST_VERTICES} vertices in all of them; export fewer, or simplify the mesh")
        };
        (count > MOST_SHAPES || count.saturating_mul(vertices) > MOST_VERTICES).then(told)
    };
    if let Some(problem) = too_many(moments.len(), 1) {
        return Ok(Shapes::Refused(problem));
    }
    let (mut times_s, mut all): (Vec<f64>, Vec<Arc<Shape>>) = (Vec::new(), Vec::new());
    for (at, &time_s) in moments.iter().enumerate() {
        let before = Arc::new(shape(time_s, Side::Before)?);
        if let Some(&from_s) = at.checked_sub(1).and_then(|at| moments.get(at)) {
            let mut open = vec![(time_s, before.clone())];
            let mut last = (from_s, all[all.len() - 1].clone());
            // From the last shape on, halved until it is straight to the next one.
            while let Some((to_s, to)) = open.last().cloned() {
                let middle_s = 0.5 * (last.0 + to_s);
                if to_s - last.0 > SHORTEST_S && too_many(all.len() + open.len(), to.positions.len()).is_none() {
                    let middle = shape(middle_s, Side::After)?;
                    if !is_near(&last.1.between(&to, 0.5), &middle, length) {
                        open.push((middle_s, middle.into()));
                        continue;
                    }
                }
                open.pop();
                times_s.push(to_s);
                all.push(to.clone());
                last = (to_s, to);
            }
        } else {
            times_s.push(time_s);
            all.push(before.clone());
        }
        let after = if jumps { Some(shape(time_s, Side::After)?) } else { None };
        if let Some(after) = after.filter(|after| *after != *before) {
            times_s.push(time_s);
            all.push(after.into());
        }
        if let Some(problem) = too_many(all.len(), before.positions.len()) {
            return Ok(Shapes::Refused(problem));
        }
    }
    let Some(first) = all.first() else { return Ok(Shapes::Constant) };
    let is_whole = |shape: &Arc<Shape>| {
        let vectors = shape.positions.iter().chain(&shape.normals);
        (shape.positions.len(), shape.normals.len()) == (first.positions.len(), first.normals.len())
            && vectors.into_iter().all(|v| v.is_finite())
    };
    if let Some(at) = all.iter().position(|shape| !is_whole(shape)) {
        return Ok(Shapes::Refused(format!("its vertices at {} s are not finite", times_s[at])));
    }
    Ok(if all.iter().all(|shape| shape == first) { Shapes::Constant } else { Shapes::Timed((times_s, all)) })
}

/// Places the vertices of a mesh. True if that mirrors it.
pub(crate) fn place(mesh: &mut Mesh, map: &DAffine3) -> bool {
    let normals = map.matrix3.inverse().transpose();
    mesh.positions.iter_mut().for_each(|p| *p = map.transform_point3(p.as_dvec3()).as_vec3());
    mesh.normals.iter_mut().for_each(|n| *n = (normals * n.as_dvec3()).normalize_or_zero().as_vec3());
    map.matrix3.determinant() < 0.0
}

fn is_near(a: &Shape, b: &Shape, length: f64) -> bool {
    a.positions.iter().zip(&b.positions).all(|(a, b)| f64::from(a.distance(*b)) <= length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec3;

    #[test]
    fn shapes_are_as_close_as_straight_ways_need_and_jumps_stay_jumps() {
        let at = |x: f32, y: f32| Shape { positions: vec![Vec3::new(x, y, 0.0)], normals: Vec::new() };
        // A circle of one metre, 1.5 rad a second; then a jump.
        let circle = |time_s: f64, side: Side| {
            let angle = 1.5 * time_s as f32;
            let is_after = time_s > 1.0 || time_s == 1.0 && side == Side::After;
            Ok::<_, ()>(if is_after { at(7.0, 0.0) } else { at(angle.cos(), angle.sin()) })
        };
        let Ok(Shapes::Timed((times_s, all))) = shapes(vec![1.0, 0.0, 2.0], true, 1e-4, circle) else { panic!() };
        assert!(times_s.is_sorted() && (40..140).contains(&times_s.len()), "{} states", times_s.len());
        let jump = times_s.iter().position(|t| *t == 1.0).unwrap();
        assert_eq!((times_s[jump + 1], all[jump + 1].positions[0].x), (1.0, 7.0));
        for i in 1..=jump {
            let middle = 0.5 * (times_s[i - 1] + times_s[i]);
            let angle = 1.5 * middle as f32;
            let found = all[i - 1].between(&all[i], 0.5).positions[0];
            assert!(found.distance(Vec3::new(angle.cos(), angle.sin(), 0.0)) <= 1.1e-4);
        }
    }

    #[test]
    fn what_keeps_its_shape_does_not_deform_and_what_is_not_finite_is_refused() {
        let still = |_: f64, _: Side| Ok::<_, ()>(Shape { positions: vec![Vec3::X], normals: Vec::new() });
        assert!(matches!(shapes(vec![0.0, 1.0], false, 1e-4, still), Ok(Shapes::Constant)));
        let bad = |time_s: f64, _: Side| Ok::<_, ()>(Shape { positions: vec![Vec3::X / (1.0 - time_s as f32)], normals: Vec::new() });
        let Ok(Shapes::Refused(told)) = shapes(vec![0.0, 1.0], false, 1e9, bad) else { panic!() };
        assert!(told.contains("at 1 s are not finite"), "{told}");
    }
}
