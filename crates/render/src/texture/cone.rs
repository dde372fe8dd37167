//! Ray cones: how wide a path is where it meets a surface, and how much of a texture that covers (Akenine-Möller et al. 2019, 2021).

/// The width of a ray: `width` metres at its origin, `spread` more per metre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    width: f32,
    spread: f32,
    /// True while what it meets is seen sharply, from the camera or by way of mirrors.
    sharp: bool,
}

/// Width of a ray per metre and per square root of the solid angle that its direction represents. A diffuse bounce spreads by about
/// 0.06, which averages no more than a hand's breadth across a room and still reads from coarse levels.
const SPREAD: f32 = 1.0 / 32.0;

/// Directions of at least this density are as good as mirrored.
const SHARP_DENSITY: f32 = 100.0;

impl Cone {
    /// A ray without width: textures are read at points.
    pub const POINT: Self = Self { width: 0.0, spread: 0.0, sharp: true };

    /// A ray from the camera; `spread` is the angle that it covers.
    #[inline]
    pub fn camera(spread: f32) -> Self {
        Self { width: 0.0, spread, sharp: true }
    }

    /// The ray `distance` metres on, where it meets a surface. Mirrors, panes and smooth borders change nothing more.
    #[inline]
    #[must_use]
    pub fn advanced(&self, distance: f32) -> Self {
        Self { width: self.width + self.spread * distance, ..*self }
    }

    /// The ray after scattering into a direction of the density `pdf`.
    #[inline]
    #[must_use]
    pub fn scattered(&self, pdf: f32) -> Self {
        let spread = SPREAD / pdf.max(1e-6).sqrt();
        Self { width: self.width, spread: self.spread.max(spread), sharp: self.sharp && pdf > SHARP_DENSITY }
    }

    /// The footprint on a surface whose texture coordinates cover `uv_density` of their plane per square metre.
    ///
    /// Slanted surfaces count as if seen straight on: what a pixel covers beyond that its samples average.
    #[inline]
    pub fn footprint(&self, uv_density: f32) -> Footprint {
        Footprint { area: uv_density * self.width * self.width, sharp: self.sharp }
    }
}

/// The part of a texture that one lookup covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    /// In squares of the texture coordinate.
    pub area: f32,
    /// True for the fine blend between levels, false for the nearest finer one.
    pub sharp: bool,
}

impl Footprint {
    /// A point.
    pub const POINT: Self = Self { area: 0.0, sharp: true };
}
