//! The choice between the paper's rules and those of Hypersim's published programs, with the list of all differences.

use serde::{Deserialize, Serialize};

/// Whose rules are followed: the paper's with its defects fixed, or those of Hypersim's published programs to the letter.
///
/// This is the one list of what [`Preset::Hypersim`] does differently in carving ([`crate::carve`]):
///
/// | | default | hypersim |
/// |---|---|---|
/// | occupied voxels | every voxel that a triangle touches | point samples a quarter voxel apart and the centroid; triangles without a vertex in the cube are left out |
/// | domain | the cube, cut down to the scene | the whole cube |
/// | rays end | before the first occupied voxel | also at the mesh |
/// | starts outside or in a wall | skipped | accepted, unless no way leads out of occupied voxels |
/// | starts at the same position | carved from one after the other | carved from once |
/// | start in an occupied voxel | moved along the widest of 2048 pooled views, at most 8 voxels | along the widest of all rays, each pooled with its 50 nearest |
/// | random positions | uniform in the free voxels | by rejection from the box around the centres of the free voxels, by `std::mt19937_64` |
/// | outside the building | left unknown | kept |
/// | box of the free space | voxel borders | voxel centres |
/// | edge of a voxel | as configured | rounded to single precision |
///
/// And in planning ([`crate::plan`], mode walk):
///
/// | | default | hypersim |
/// |---|---|---|
/// | first pose | fixed where it breaks a rule | the start camera's, as it is |
/// | a pose | keeps its clearance, sees its target, is at least `min_look_distance_m` from it | need not |
/// | roll | uniform within `roll_limit_deg` | the up vector's components deviate by 0.1 each, the same in every trajectory |
/// | queries | in the box around the last point, cut to the heights allowed | in the whole box; those at other heights are dropped |
/// | score | by [`crate::Saliency`] | distinct triangles, with emptiness as one of them, times the square of the share of surface |
/// | views of little | sorted out | taken |
/// | no candidate | more samples, then smaller steps | an error, where the program aborts |
/// | random numbers | a stream for each trajectory | Armadillo's, from the seed, for each trajectory anew |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Nothing leaks, nothing is skipped silently.
    #[default]
    Default,
    /// For comparisons with the published programs.
    Hypersim,
}
