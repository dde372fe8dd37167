//! The choice between our rules, the paper's and those of Hypersim's published programs, with the list of all differences.

use serde::{Deserialize, Serialize};

/// Whose rules are followed. `docs/trajectories.md` has the table of all of them, with the reasons.
///
/// What the two others do differently in carving ([`crate::carve`]):
///
/// | | default | paper | hypersim |
/// |---|---|---|---|
/// | occupied voxels | every voxel that a triangle touches | the same | point samples a quarter voxel apart and the centroid; triangles without a vertex in the cube are left out |
/// | domain | the cube, cut down to the scene | the same | the whole cube |
/// | rays end | before the first occupied voxel | the same | also at the mesh |
/// | starts in a wall | skipped | skipped | accepted, unless no way leads out of occupied voxels |
/// | starts at the same position | carved from one after the other | the same | carved from once |
/// | start in an occupied voxel | moved along the widest of 2048 pooled views, at most 8 voxels | the same | along the widest of all rays, each pooled with its 50 nearest |
/// | random positions | uniform in the free voxels; enclosed ones first where rays leave the scene | uniform in the free voxels | by rejection from the box around the centres of the free voxels, by `std::mt19937_64` |
/// | outside the building | left unknown | kept | kept |
/// | box of the free space | voxel borders | voxel borders | voxel centres |
/// | edge of a voxel | as configured | as configured | rounded to single precision |
///
/// And in planning ([`crate::plan`], mode walk):
///
/// | | default | paper | hypersim |
/// |---|---|---|---|
/// | a position | keeps its clearance | is free | is free |
/// | a pose | sees its target, which is at least `min_look_distance_m` away | need not | need not |
/// | roll | uniform within `roll_limit_deg`, drawn for every candidate | the same | the up vector's components deviate by 0.1 each, the same in every trajectory |
/// | queries | in the box around the last point, cut to the heights allowed | the same | in the whole box; those at other heights are dropped |
/// | score | by [`crate::Saliency`] | the same | distinct triangles, with emptiness as one of them, times the square of the share of surface |
/// | views of little | sorted out | taken | taken |
/// | no candidate | more samples, then smaller steps, then the least bad one | more samples, then an error | an error, where the program aborts |
/// | random numbers | a stream for each trajectory | the same | Armadillo's, from the seed, for each trajectory again |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The paper's rules and ours: nothing leaks, and no view is one that nobody would use.
    #[default]
    Default,
    /// The rules that the paper's supplement states, and no others; start cameras in walls are left out all the same.
    Paper,
    /// What the published programs do, to the letter.
    Hypersim,
}

impl Preset {
    /// Name of the preset in configurations.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Paper => "paper",
            Self::Hypersim => "hypersim",
        }
    }
}
