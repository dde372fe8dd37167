//! The objects that a plan looks at, and how much of each a view shows.

use super::planner::Planner;
use crate::ExploreError;
use enfilade_geometry::{Bvh, NOTHING, VisibilityBuffer};
use enfilade_math::{Bounds3, DVec3};
use enfilade_scene::{PartId, Pose, WorldMesh};

/// An object is visible in a view that shows at least this share of the pixels that it would have if nothing hid it: BOP's limit for what
/// is to be found.
const LEAST_VISIBLE: f64 = 0.1;

/// Points by which the share of an object within the picture is measured.
const POINTS: usize = 200;

/// An object that cameras look at, see [`crate::plan_objects`].
#[derive(Clone, Debug, PartialEq)]
pub struct TargetObject {
    /// Name of the object, for reports and warnings.
    pub name: String,
    /// The parts of the scene that it consists of.
    pub parts: Vec<PartId>,
    /// Share of the frames in which it is to be visible, 0 to 1.
    pub visible_share: f64,
}

/// The objects with their surfaces.
pub(super) struct Targets {
    pub list: Vec<Target>,
    /// Index into `list` by part; more than that for parts of none.
    of_part: Vec<u32>,
}

/// An object with its surface.
pub(super) struct Target {
    pub name: String,
    pub visible_share: f64,
    /// Middle of its bounds.
    pub center: DVec3,
    /// Greatest distance of a vertex from the middle.
    pub radius_m: f64,
    points: Vec<DVec3>,
    bvh: Bvh,
}

impl Targets {
    /// # Errors
    /// When there are none, or one has no triangles.
    pub fn new(world: &WorldMesh, objects: &[TargetObject]) -> Result<Self, ExploreError> {
        if objects.is_empty() {
            return Err(ExploreError::NoObjects);
        }
        let mut of_part = vec![u32::MAX; world.contrasts.len()];
        for (index, part) in objects.iter().enumerate().flat_map(|(index, object)| object.parts.iter().map(move |part| (index, *part))) {
            if let Some(of_part) = of_part.get_mut(part as usize) {
                *of_part = index as u32;
            }
        }
        let mut corners = vec![Vec::new(); objects.len()];
        for (triangle, source) in world.corners.iter().zip(&world.sources) {
            if let Some(own) = corners.get_mut(of_part[source.part as usize] as usize) {
                own.push(*triangle);
            }
        }
        let target = |(object, corners): (&TargetObject, Vec<[enfilade_math::Vec3; 3]>)| {
            if corners.is_empty() {
                return Err(ExploreError::EmptyObject { name: object.name.clone() });
            }
            let bounds = Bounds3::from_points(corners.iter().flatten().copied());
            let center = 0.5 * (bounds.min + bounds.max).as_dvec3();
            let points = || corners.iter().flatten().map(|p| p.as_dvec3());
            Ok(Target {
                name: object.name.clone(),
                visible_share: object.visible_share,
                center,
                radius_m: points().map(|p| p.distance(center)).fold(0.0, f64::max),
                points: points().step_by((3 * corners.len()).div_ceil(POINTS)).collect(),
                bvh: Bvh::new(&corners, &|_| false),
            })
        };
        let list = objects.iter().zip(corners).map(target).collect::<Result<_, _>>()?;
        Ok(Self { list, of_part })
    }

    /// Which targets are visible in a view that is in `buffer`; `alone` is room to draw in.
    pub fn shown(&self, planner: &Planner, pose: &Pose, buffer: &VisibilityBuffer, alone: &mut VisibilityBuffer) -> Vec<bool> {
        let mut visible = vec![0u32; self.list.len()];
        for &triangle in buffer.triangles().iter().filter(|triangle| **triangle != NOTHING) {
            let part = planner.world.sources[triangle as usize].part;
            if let Some(count) = visible.get_mut(self.of_part[part as usize] as usize) {
                *count += 1;
            }
        }
        let rays = planner.image.rays(pose);
        let mut is_shown = |(target, visible): (&Target, u32)| {
            if visible == 0 {
                return false;
            }
            alone.draw(&target.bvh, &rays);
            let unhidden = alone.triangles().iter().filter(|triangle| **triangle != NOTHING).count();
            // What is beyond the borders of the picture counts as hidden.
            let framed = target.points.iter().filter(|p| planner.gates.glancer.frames(pose, **p)).count().max(1);
            let whole = unhidden as f64 * target.points.len() as f64 / framed as f64;
            f64::from(visible) >= LEAST_VISIBLE * whole
        };
        self.list.iter().zip(visible).map(|one| is_shown(one)).collect()
    }
}
