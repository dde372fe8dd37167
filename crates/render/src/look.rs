//! A look at a view without any light: only its geometry layers, in full or through some of its pixels, and the positions of its points in
//! other views.

use crate::error::RenderError;
use crate::extra::surfaces::{RaySurfaces, surfaces};
use crate::extra::{FlowTo, add_flow, flow};
use crate::geometry_pass::{PixelGeometry, geometry_of, sighting};
use crate::glass::Bodies;
use crate::light::Lights;
use crate::prepared::RenderScene;
use crate::rows::{Moved, Rows, Ways};
use crate::texture::Textures;
use crate::triangle_point::TrianglePoint;
use crate::triangles::Triangles;
use enfilade_frame::{Frame, Layer, Values, f16};
use enfilade_math::DVec3;
use enfilade_scene::{Alpha, CameraView, Scene, band_of_row};
use std::sync::OnceLock;

/// A scene ready to be looked at: rays and cut-outs, without its light.
///
/// ```
/// # use enfilade_geometry::Mesh;
/// # use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
/// use enfilade_frame::Layer;
/// use enfilade_render::Lookout;
/// use enfilade_scene::{Camera, CameraView, Intrinsics, Material, Part, Pose, Scene};
///
/// // A triangle in the plane z = 0, seen from 3 m above; no light is needed.
/// let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
/// let part = Part { name: "triangle".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
/// let scene =
///     Scene { meshes: vec![mesh.into()], materials: vec![Material::diffuse("grey", Rgb::splat(0.5))], parts: vec![part], ..Scene::default() };
/// let camera = Camera::from(Intrinsics::from_fov_x(64, 64, 0.6));
/// let pose = Pose::look_at(0, DVec3::new(0.2, 0.2, 3.0), DVec3::new(0.2, 0.2, 0.0), DVec3::Y).expect("y is not along the view");
///
/// // Through every fourth pixel in both directions.
/// let look = Lookout::new(&scene)?.look(&CameraView::still(&camera, &pose), 4);
/// assert_eq!([look.frame.width, look.frame.height, look.seeing as u32], [16, 16, 256]);
/// let depth_z_m = look.frame.get(Layer::DepthZMeters).expect("looked at");
/// assert!((depth_z_m.get(8 * 16 + 8) - 3.0).abs() < 1e-5 && depth_z_m.get(0).is_nan());
/// # Ok::<(), enfilade_render::RenderError>(())
/// ```
pub struct Lookout<'s> {
    /// The first row of each band of rows and what it shows, mostly one for all rows. Has no lights and no tables, since no light is
    /// computed.
    bands: Vec<(u32, RenderScene<'s>)>,
    /// Rays ask about every surface that they meet, not only about those with an opacity.
    asks_always: bool,
}

/// Result of a look.
pub struct Look {
    /// `depth_meters`, `depth_z_meters`, `position`, `normal_world` and `render_entity_id`: of a look in full, the values that the
    /// rendered frame will have.
    pub frame: Frame,
    /// By pixel, row by row: true where it shows the back of a triangle, whose corners run clockwise.
    pub behind: Vec<bool>,
    /// Number of pixels that have a ray: all except those beyond the rim of a fisheye.
    pub seeing: usize,
}

/// One pixel of a look.
struct Pixel {
    seeing: bool,
    behind: bool,
    geometry: Option<PixelGeometry>,
}

impl<'s> Lookout<'s> {
    /// Builds what rays need. About two CPU seconds per million triangles.
    ///
    /// # Errors
    /// When the scene has more parts than ids.
    pub fn new(scene: &'s Scene) -> Result<Self, RenderError> {
        Self::with([(0, scene)], false)
    }

    /// Builds what rays need for pictures whose rows show scenes of several moments: bands of rows from the upper border on, each with its
    /// first row.
    ///
    /// # Errors
    /// As [`Lookout::new`].
    ///
    /// # Panics
    /// When there is none.
    pub fn of_rows(bands: &'s [(u32, Scene)]) -> Result<Self, RenderError> {
        Self::with(bands.iter().map(|(row, scene)| (*row, scene)), false)
    }

    /// Prepares a scene for [`Lookout::surfaces`] too: rays ask about every surface that they meet, which makes the other ones slower.
    ///
    /// # Errors
    /// As there.
    pub fn through_surfaces(scene: &'s Scene) -> Result<Self, RenderError> {
        Self::with([(0, scene)], true)
    }

    /// Prepares the scenes of the rows of pictures for [`Lookout::surfaces`] too.
    ///
    /// # Errors
    /// As [`Lookout::new`].
    ///
    /// # Panics
    /// When there is none.
    pub fn through_surfaces_of_rows(bands: &'s [(u32, Scene)]) -> Result<Self, RenderError> {
        Self::with(bands.iter().map(|(row, scene)| (*row, scene)), true)
    }

    fn with(bands: impl IntoIterator<Item = (u32, &'s Scene)>, asks_always: bool) -> Result<Self, RenderError> {
        let ready = |(row, scene): (u32, &'s Scene)| {
            RenderScene::check_parts(scene)?;
            let triangles = Triangles::new(scene);
            let bvh = triangles.hierarchy(|material| asks_always || material.alpha != Alpha::Opaque);
            // Pictures are read at points only, so they need no pyramids.
            let (textures, lights) = (Textures::new(&scene.images, &[]), Lights::default());
            let (tables, bodies, fixtures) = (Vec::new(), Bodies::default(), OnceLock::new());
            Ok((row, RenderScene { scene, textures, triangles, bvh, lights, tables, bodies, fixtures }))
        };
        let bands: Vec<(u32, RenderScene<'s>)> = bands.into_iter().map(ready).collect::<Result<_, RenderError>>()?;
        assert!(!bands.is_empty(), "a picture has rows");
        Ok(Self { bands, asks_always })
    }

    fn rows(&self) -> Rows<'_, 's> {
        Rows::bands(self.bands.iter().map(|(row, scene)| (*row, scene)))
    }

    /// Looks through the centres of the view's pixels, or of every `step`-th of them in both directions.
    ///
    /// # Panics
    /// When `step` is 0.
    pub fn look(&self, view: &CameraView<'_>, step: u32) -> Look {
        let [width, height] = view.camera().size().map(|side| side.div_ceil(step));
        let last = view.camera().size().map(|side| side - 1);
        // In the middle of each cell of the grid, which the border may cut.
        let at = |cell: u32, axis: usize| (cell * step + step / 2).min(last[axis]);
        let rows = self.rows();
        let pixel = |i: u32| pixel(&rows, view, at(i % width, 0), at(i / width, 1));
        let pixels: Vec<Pixel> = enfilade_parallel::map_up_to((width * height) as usize, |i| pixel(i as u32));
        let single = |f: fn(&PixelGeometry) -> f32| Values::F32(pixels.iter().map(|p| p.geometry.as_ref().map_or(f32::NAN, f)).collect());
        let mut frame = Frame::new(width, height);
        frame.insert(Layer::DepthMeters, single(|g| g.distance_m));
        frame.insert(Layer::DepthZMeters, single(|g| g.depth_z_m));
        let position = pixels.iter().flat_map(|p| p.geometry.as_ref().map_or([f32::NAN; 3], |g| g.position)).collect();
        frame.insert(Layer::Position, Values::F32(position));
        let normal = pixels.iter().flat_map(|p| p.geometry.as_ref().map_or([f16::NAN; 3], |g| g.normal_world)).collect();
        frame.insert(Layer::NormalWorld, Values::F16(normal));
        let entity = pixels.iter().map(|p| p.geometry.as_ref().map_or(-1, |g| g.entity)).collect();
        frame.insert(Layer::RenderEntityId, Values::I16(entity));
        let seeing = pixels.iter().filter(|p| p.seeing).count();
        Look { frame, behind: pixels.iter().map(|p| p.behind).collect(), seeing }
    }

    /// Whether the picture of `view` shows the world point: it is inside the image, and nothing is in front of it up to a thousandth of its
    /// distance. Panes and half-transparent surfaces hide it, as in the geometry layers.
    pub fn shows(&self, view: &CameraView<'_>, p_world: DVec3) -> bool {
        let scene = |y: f64| &self.bands[band_of_row(self.bands.len(), |band| self.bands[band].0, y)].1;
        view.project(p_world).is_some_and(|at| flow::shows(scene(at.1), view, at, p_world))
    }

    /// The point that the ray through the centre of a pixel (column, row) meets first; `None` where it meets nothing.
    pub fn touch(&self, view: &CameraView<'_>, [column, row]: [u32; 2]) -> Option<TrianglePoint> {
        let centre = (f64::from(column) + 0.5, f64::from(row) + 0.5);
        let scene = self.rows().at(centre.1);
        let found = sighting(scene, view, centre)?;
        Some(TrianglePoint::of(scene, found.triangle, found.p_world))
    }

    /// The place, world, metres, of a point that was touched at another moment of the same scene, when the row that shows it in the picture
    /// of `view` is exposed.
    pub fn place(&self, view: &CameraView<'_>, point: &TrianglePoint) -> DVec3 {
        let place = |band: usize| point.place(&self.bands[band].1);
        place(view.band_that_shows(self.bands.len(), |band| self.bands[band].0, place))
    }

    /// `optical_flow`, `scene_flow` and `flow_visibility` from every pixel of the view `from` to the view `to`: of any two views, of
    /// different cameras too, forward and backward in time. To the next frame of a trajectory they are the numbers of its layers.
    pub fn flow(&self, from: &CameraView<'_>, to: FlowTo<'_>) -> Frame {
        let [width, height] = from.camera().size();
        let mut frame = Frame::new(width, height);
        add_flow(&self.rows(), from, to, &mut frame);
        frame
    }

    /// The first `count` surfaces that the ray through each pixel's centre meets, straight on through all of them, and the first that lets no
    /// light through on the way that glass bends. Of surfaces of one part in one place that face the same way one is met.
    ///
    /// # Panics
    /// When this was not made by [`Lookout::through_surfaces`].
    pub fn surfaces(&self, view: &CameraView<'_>, count: usize) -> RaySurfaces {
        assert!(self.asks_always, "made by Lookout::through_surfaces");
        surfaces(&self.rows(), view, count)
    }

    /// The scene as another moment has it, for flow that leads there from a picture; `ways` says where bodies are in both. Points of parts that
    /// deform stay on their triangle, with the weights of its corners.
    ///
    /// # Panics
    /// When `ways` has not as many bands of the second picture as this.
    pub fn moved(self, ways: Ways) -> Moved<'s> {
        assert_eq!(ways.there.len(), self.bands.len(), "each band of rows has its own places of bodies");
        let deforming = self.bands[0].1.scene.deforming_parts();
        Moved { bands: self.bands, ways, deforming }
    }
}

fn pixel(rows: &Rows<'_, '_>, view: &CameraView<'_>, x: u32, y: u32) -> Pixel {
    let centre = (f64::from(x) + 0.5, f64::from(y) + 0.5);
    let scene = rows.at(centre.1);
    let Some(found) = sighting(scene, view, centre) else {
        let seeing = view.camera().projection.ray(centre.0, centre.1).is_some();
        return Pixel { seeing, behind: false, geometry: None };
    };
    let winding = scene.triangles.get(found.triangle).cross().as_dvec3();
    Pixel { seeing: true, behind: winding.dot(found.direction) > 0.0, geometry: Some(geometry_of(scene, view, centre.1, &found)) }
}
