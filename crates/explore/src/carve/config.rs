//! What a user may say about carving: the size of voxels and of the domain, how many rays are cast, and from how many positions.

use crate::error::require;
use crate::{ExploreError, Preset};
use enfilade_options::options;
use serde::{Deserialize, Serialize};

options! {
    /// How free space is carved. The defaults are Hypersim's.
    ///
    /// ```
    /// use enfilade_explore::CarveConfig;
    ///
    /// let fine = CarveConfig { voxel_m: 0.05, ..CarveConfig::default() };
    /// assert_eq!(fine.validate(), Ok(()));
    /// let error = CarveConfig { rays: 10, ..fine }.validate().unwrap_err();
    /// assert_eq!(error.to_string(), "rays = 10: expected 64 or more");
    /// ```
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct CarveConfig keys pub CarveKeys {
        /// Whose rules are followed.
        pub preset: Preset = Preset::Default => fixed,
        /// Edge of a voxel, metres.
        pub voxel_m: f64 = 0.1,
        /// Side of the cube to be carved, metres. It is centred on the box around the start cameras.
        pub extent_m: f64 = 30.0,
        /// Rays cast from each position, spread evenly over the sphere.
        pub rays: u32 = 512 * 512,
        /// Positions to carve from for each start camera: its own, then random free ones.
        pub iterations: u32 = 5,
        /// Free voxels outside the building stay free. (The other presets keep them in any case.)
        pub keep_outside: bool = false,
        /// Seed of the random positions. The published programs use 0.
        pub seed: u64 = 0 => fixed,
    }
}

impl CarveConfig {
    /// Checks that the values make sense.
    ///
    /// # Errors
    /// The first value out of its range.
    pub fn validate(&self) -> Result<(), ExploreError> {
        let positive = |v: f64| v > 0.0 && v.is_finite();
        require(positive(self.voxel_m), "voxel_m", self.voxel_m, "a positive length in metres")?;
        require(positive(self.extent_m) && self.extent_m >= self.voxel_m, "extent_m", self.extent_m, "a length of at least one voxel")?;
        require(self.rays >= 64, "rays", self.rays, "64 or more")?;
        require(self.iterations >= 1, "iterations", self.iterations, "1 or more")
    }
}
