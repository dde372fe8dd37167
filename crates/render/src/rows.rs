//! What the rows of a picture show of a scene that moves: with a rolling shutter, bands of rows see it at moments of their own.

use crate::prepared::RenderScene;
use crate::triangle_point::TrianglePoint;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{BodyId, CameraView, PartId, band_of_row};

/// The scene that each row of a picture shows.
#[derive(Clone)]
pub struct Rows<'a, 's>(Vec<(u32, &'a RenderScene<'s>)>);

impl<'a, 's> From<&'a RenderScene<'s>> for Rows<'a, 's> {
    /// One scene in all rows.
    fn from(scene: &'a RenderScene<'s>) -> Self {
        Self(vec![(0, scene)])
    }
}

impl<'a, 's> Rows<'a, 's> {
    /// Bands of rows from the upper border on, each with its first row and its scene.
    ///
    /// # Panics
    /// When there is none.
    pub fn bands(bands: impl IntoIterator<Item = (u32, &'a RenderScene<'s>)>) -> Self {
        let bands: Vec<_> = bands.into_iter().collect();
        assert!(!bands.is_empty(), "a picture has rows");
        Self(bands)
    }

    /// The band of the row at an image coordinate.
    pub(crate) fn band(&self, y: f64) -> usize {
        band_of_row(self.0.len(), |band| self.0[band].0, y)
    }

    /// The scene that the row at an image coordinate shows.
    pub(crate) fn at(&self, y: f64) -> &'a RenderScene<'s> {
        self.0[self.band(y)].1
    }
}

/// Where the bodies of a scene are when the rows of two pictures are exposed.
#[derive(Clone, Debug, Default)]
pub struct Ways {
    /// The body of each part.
    pub body_of_parts: Vec<Option<BodyId>>,
    /// By band of rows of the first picture and body: the map of the world that takes it from rest to its place.
    pub here: Vec<Vec<DAffine3>>,
    /// By band of rows of the second picture and body.
    pub there: Vec<Vec<DAffine3>>,
}

impl Ways {
    /// The place of a point of a part in a band of the second picture; it is here at `p_world` in a band of the first.
    fn carry(&self, part: PartId, p_world: DVec3, [from, to]: [usize; 2]) -> DVec3 {
        let Some(body) = self.body_of_parts.get(part as usize).copied().flatten() else { return p_world };
        let (here, there) = (self.here[from][body as usize], self.there[to][body as usize]);
        if here == there { p_world } else { (there * here.inverse()).transform_point3(p_world) }
    }
}

/// A scene at another moment: [`Lookout::moved`](crate::Lookout::moved).
pub struct Moved<'s> {
    /// The first row of each band, and the scene when it is exposed, without its light.
    pub(crate) bands: Vec<(u32, RenderScene<'s>)>,
    pub(crate) ways: Ways,
    /// By part: whether its mesh has another shape at each moment, with the same triangles.
    pub(crate) deforming: Vec<bool>,
}

impl<'s> Moved<'s> {
    /// Where a point of a triangle is when the picture `next` shows it, and the scene then; it is at `p_world` in a band of the first picture,
    /// which shows `here`.
    pub(crate) fn place(
        &self,
        next: &CameraView<'_>,
        (here, triangle): (&RenderScene<'_>, u32),
        p_world: DVec3,
        from: usize,
    ) -> (DVec3, &RenderScene<'s>) {
        let part = here.triangles.part_of(triangle);
        let on = self.deforming.get(part as usize).filter(|deforms| **deforms).map(|_| TrianglePoint::of(here, triangle, p_world));
        let place = |to: usize| match &on {
            Some(on) => on.place(&self.bands[to].1),
            None => self.ways.carry(part, p_world, [from, to]),
        };
        let band = next.band_that_shows(self.bands.len(), |band| self.bands[band].0, place);
        (place(band), &self.bands[band].1)
    }
}
