//! Measurements of a small test image of a view: the input of every score and of the gates.

/// Measurements of a test image of a view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewStats {
    /// Pixels of the test image.
    pub pixels: u32,
    /// Pixels that show a surface.
    pub hits: u32,
    /// Distinct triangles seen.
    pub triangles: u32,
    /// Distinct parts seen, each in at least one pixel of 2000.
    pub parts: u32,
    /// Perplexity of the parts' projected areas: exp(−Σ p ln p) with p a part's share of the pixels that show a surface; 0 for none.
    pub perplexity: f64,
    /// Mean over the pixels that show a surface of the contrast of what they show ([`WorldMesh::contrasts`](enfilade_scene::WorldMesh::contrasts)).
    pub contrast: f64,
}

impl ViewStats {
    /// Share of the pixels that show no surface.
    pub fn void_share(&self) -> f64 {
        1.0 - f64::from(self.hits) / f64::from(self.pixels)
    }
}
