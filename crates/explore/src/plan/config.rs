//! What a user may say about trajectories: the modes and their settings, the rules of a pose, and the gates of a view, all checked here.

use crate::error::require;
use crate::{ExploreError, Preset, Saliency};
use enfilade_options::{Form, Given, Value, options};
use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

options! {
    /// How a trajectory is found. The defaults are Hypersim's, as its paper states them, with a clearance and limits added.
    ///
    /// ```
    /// use enfilade_explore::{Mode, PlanConfig, VideoConfig};
    ///
    /// let mode = Mode::Video(VideoConfig { fps: 30.0, ..VideoConfig::default() });
    /// let video = PlanConfig { mode, frames: 300, camera_height_m: Some([1.4, 1.7]), ..PlanConfig::default() };
    /// assert_eq!(video.validate(), Ok(()));
    ///
    /// // A share is a number from 0 to 1, not a percentage.
    /// let error = PlanConfig { max_void_share: 20.0, ..video }.validate().unwrap_err();
    /// assert_eq!(error.to_string(), "max_void_share = 20: expected a share from 0 to 1");
    /// ```
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct PlanConfig keys pub PlanKeys {
        /// Whose rules: this crate's, or those of Hypersim's paper or program, which know walks alone.
        pub preset: Preset = Preset::Default => fixed,
        /// What kind of trajectory.
        #[serde(skip_serializing_if = "is_default")]
        pub mode: Mode = Mode::default(),
        /// Poses in the trajectory, the start camera's among them.
        pub frames: u32 = 100 => fixed,
        /// Poses compared at each step.
        pub candidates: u32 = 20,
        /// Random points drawn at each step of a walk for the camera, and as many for its target, before the rules sort them out.
        pub queries: u32 = 1000,
        /// How far the camera and its target may each move in one step of a walk along x, y and z, metres.
        pub step_m: [f64; 3] = [1.5, 1.5, 0.25],
        /// How far above or below those of frame 0 the camera and its target may each be in a walk or a video, metres. Where
        /// `camera_height_m` is given, it is about the target of a walk alone, which goes up and down with the camera.
        pub height_range_m: f64 = 0.25,
        /// The minimum and maximum height of the camera above the floor, metres; free unless given. The floor is the lowest of the
        /// first surfaces below the camera and below eight places half a metre around it.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub camera_height_m: Option<[f64; 2]> = None,
        /// Views are level: neither pitch nor roll.
        #[serde(skip_serializing_if = "is_default")]
        pub level: bool = false,
        /// The lowest and the highest angle of the viewing axis above the horizon, degrees.
        #[serde(skip_serializing_if = "is_any_pitch")]
        pub pitch_limits_deg: [f64; 2] = ANY_PITCH,
        /// The camera keeps at least this far from every surface, metres. Measured by occupied voxels, so up to a voxel's diagonal more.
        pub clearance_m: f64 = 0.2,
        /// The target is at least this far from the camera, metres.
        pub min_look_distance_m: f64 = 0.5,
        /// Roll is uniform within plus and minus this, degrees (less than 90).
        pub roll_limit_deg: f64 = 5.0,
        /// Minimum and maximum share of the surface points in view that the view before saw too, each from 0 to 1; for walks.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub overlap: Option<[f64; 2]> = None,
        /// Views that show no surface in more than this share of the pixels are taken only when nothing better is found.
        pub max_void_share: f64 = 0.2,
        /// Views that show the back of things in more than this share of the pixels are taken only when nothing better is found. Parts that are
        /// seen from behind around the start camera too (thin ones with two sides, ones modelled inside out) do not count.
        pub max_back_face_share: f64 = 0.25,
        /// Something nearer than this is too near, metres.
        pub min_depth_m: f64 = 0.3,
        /// Views that show something too near in more than this share of the pixels are taken only when nothing better is found.
        pub max_near_share: f64 = 0.5,
        /// Views from positions around which more than this share of the level or of the upward directions meets no surface, or only the
        /// back of one, are taken only when nothing better is found. Outside of a building at least half of the level ones do, and in one
        /// with a ceiling few of the upward ones.
        /// Where the start camera itself stands more open, that counts instead.
        pub max_open_share: f64 = 0.5,
        /// Horizontal field of view of the test images, radians.
        pub fov_x_rad: f64 = std::f64::consts::FRAC_PI_3 => fixed,
        /// Width of the test images, pixels. Planning time is in proportion to width times height.
        pub test_width: u32 = 256,
        /// Height of the test images, pixels.
        pub test_height: u32 = 192 => fixed,
        /// A second camera stands this far to the right of the first, metres, and keeps the same rules; 0 for none.
        #[serde(skip_serializing_if = "is_zero")]
        pub stereo_baseline_m: f64 = 0.0 => fixed,
        /// What makes a view worth taking.
        pub saliency: Saliency = Saliency::default(),
        /// Seed; each trajectory has its own stream of random numbers.
        pub seed: u64 = 0 => fixed,
    }
}

/// Kinds of trajectories.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Mode {
    /// Hypersim's: a random walk drawn to what is worth seeing. Neighbouring frames are a step apart, not a video.
    Walk(WalkConfig),
    /// A smooth path at bounded speed.
    Video(VideoConfig),
    /// Pictures that keep a distance from each other, over all the space within reach.
    Stills(StillsConfig),
    /// Views as people take them of a room.
    Photos(PhotosConfig),
    /// Every surface seen a number of times from different angles.
    Coverage(CoverageConfig),
    /// Views of objects from above and around them.
    Objects(ObjectsConfig),
    /// Poses made by hand.
    Keyframes(KeyframesConfig),
    /// The cameras of the scene as they are, frame by frame.
    Cameras(CamerasConfig),
}

impl Value for Mode {
    const FORM: Form = Form::Table;

    fn read(_: &Given) -> Option<Self> {
        None
    }
}

impl Default for Mode {
    fn default() -> Self {
        Self::Walk(WalkConfig {})
    }
}

/// A random walk: its keys are those of [`PlanConfig`], and it has no others.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WalkConfig {}

impl<'de> Deserialize<'de> for WalkConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let keys = BTreeMap::<String, IgnoredAny>::deserialize(deserializer)?;
        match keys.into_keys().next() {
            Some(key) => Err(D::Error::custom(format!("mode walk has no key `{key}`: the keys of walks belong beside `mode`"))),
            None => Ok(Self {}),
        }
    }
}

/// A smooth path at bounded speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VideoConfig {
    /// Frames per second.
    pub fps: f64,
    /// The camera never moves faster, metres per second.
    pub max_speed_m_s: f64,
    /// The camera never turns faster, about whatever axis, degrees per second.
    pub max_turn_deg_s: f64,
    /// The camera never gathers or loses speed faster along its path, metres per second squared. It begins at rest.
    pub max_acceleration_m_s2: f64,
    /// Places that the path leads through are at least this far apart, metres.
    pub waypoint_distance_m: f64,
}

impl Default for VideoConfig {
    fn default() -> Self {
        Self { fps: 24.0, max_speed_m_s: 0.8, max_turn_deg_s: 40.0, max_acceleration_m_s2: 1.0, waypoint_distance_m: 2.0 }
    }
}

/// Pictures that keep a distance from each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StillsConfig {
    /// Two stills are at least this far apart, metres, or look in directions that differ by `min_angle_deg`.
    pub min_distance_m: f64,
    /// Stills that are nearer look in directions that differ by at least this, degrees; 0 asks for the distance alone.
    pub min_angle_deg: f64,
}

impl Default for StillsConfig {
    fn default() -> Self {
        Self { min_distance_m: 0.75, min_angle_deg: 0.0 }
    }
}

/// Views as people take them. The defaults are those of NYUv2's 795 training photographs (Silberman et al. 2012): heights and pitches above
/// the floor that a plane fits, of the 624 in which enough floor is in view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PhotosConfig {
    /// Mean and standard deviation of the camera's height above the floor, metres.
    pub height_m: [f64; 2],
    /// Mean and standard deviation of the angle of the view above the horizon, degrees.
    pub pitch_deg: [f64; 2],
    /// Two photos are at least this far apart, metres, or their cameras are turned by `min_angle_deg` from each other.
    pub min_distance_m: f64,
    /// Photos that are nearer are turned by at least this from each other, degrees.
    pub min_angle_deg: f64,
}

impl Default for PhotosConfig {
    fn default() -> Self {
        Self { height_m: [1.34, 0.1], pitch_deg: [-13.3, 6.9], min_distance_m: 0.3, min_angle_deg: 25.0 }
    }
}

/// Every surface seen a number of times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CoverageConfig {
    /// Views wanted of every surface.
    pub views: u32,
    /// Views of a surface count apart when their directions differ by at least this, degrees.
    pub min_angle_deg: f64,
    /// A surface farther away than this does not count as seen, metres.
    pub max_distance_m: f64,
    /// A surface that is seen at a greater angle from its normal than this does not count as seen, degrees (less than 90).
    pub max_incidence_deg: f64,
    /// Poses considered; half as many more go to what those leave unseen.
    pub poses: u32,
    /// Points by which area is measured, spread evenly over all surfaces.
    pub samples: u32,
}

impl Default for CoverageConfig {
    fn default() -> Self {
        Self { views: 3, min_angle_deg: 15.0, max_distance_m: 5.0, max_incidence_deg: 75.0, poses: 2000, samples: 20_000 }
    }
}

/// Views of objects from above and around them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectsConfig {
    /// The least and the greatest distance of the camera from the point that it looks at, metres.
    pub radius_m: [f64; 2],
    /// The least and the greatest angle of the camera above that point, degrees from the horizon.
    pub elevation_deg: [f64; 2],
    /// Names of objects or parts of the scene that cameras look at, beside those that `[[object]]` placed.
    pub look_at: Vec<String>,
    /// Share of the frames in which each of `look_at` is to be visible; objects of `[[object]]` have their own.
    pub visible_share: f64,
}

impl Default for ObjectsConfig {
    fn default() -> Self {
        Self { radius_m: [0.5, 1.5], elevation_deg: [10.0, 80.0], look_at: Vec::new(), visible_share: 0.5 }
    }
}

/// Poses made by hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyframesConfig {
    /// Files of poses, CSV or JSON; each is one trajectory. Whoever plans reads them, by [`crate::parse_keyframes`].
    pub files: Vec<String>,
}

/// The cameras of the scene as they are: those that ride on bodies go with them, others stay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CamerasConfig {
    /// Frames per second.
    pub fps: f64,
}

impl Default for CamerasConfig {
    fn default() -> Self {
        Self { fps: 24.0 }
    }
}

impl Mode {
    /// Frames per second, if the mode says when its frames are taken.
    pub fn fps(&self) -> Option<f64> {
        match self {
            Self::Video(video) => Some(video.fps),
            Self::Cameras(cameras) => Some(cameras.fps),
            Self::Walk(_) | Self::Stills(_) | Self::Photos(_) | Self::Coverage(_) | Self::Objects(_) | Self::Keyframes(_) => None,
        }
    }

    /// True if the mode takes poses that are given, which it does not change.
    pub fn is_given(&self) -> bool {
        matches!(self, Self::Keyframes(_) | Self::Cameras(_))
    }

    /// Name of the mode in configurations and reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Walk(_) => "walk",
            Self::Video(_) => "video",
            Self::Stills(_) => "stills",
            Self::Photos(_) => "photos",
            Self::Coverage(_) => "coverage",
            Self::Objects(_) => "objects",
            Self::Keyframes(_) => "keyframes",
            Self::Cameras(_) => "cameras",
        }
    }

    fn validate(&self) -> Result<(), ExploreError> {
        let positive = |v: f64| v > 0.0 && v.is_finite();
        let above_0 = |field, v: f64| require(positive(v), field, v, "a number above 0");
        match self {
            Self::Walk(_) => Ok(()),
            Self::Video(v) => {
                above_0("fps", v.fps)?;
                above_0("max_speed_m_s", v.max_speed_m_s)?;
                above_0("max_turn_deg_s", v.max_turn_deg_s)?;
                above_0("max_acceleration_m_s2", v.max_acceleration_m_s2)?;
                above_0("waypoint_distance_m", v.waypoint_distance_m)
            }
            Self::Stills(s) => {
                above_0("min_distance_m", s.min_distance_m)?;
                require((0.0..=180.0).contains(&s.min_angle_deg), "min_angle_deg", s.min_angle_deg, "an angle from 0 to 180 degrees")
            }
            Self::Photos(photos) => photos.validate(),
            Self::Coverage(c) => {
                for (field, n) in [("views", c.views), ("poses", c.poses), ("samples", c.samples)] {
                    require(n >= 1, field, n, "1 or more")?;
                }
                above_0("max_distance_m", c.max_distance_m)?;
                require((0.0..=180.0).contains(&c.min_angle_deg), "min_angle_deg", c.min_angle_deg, "an angle from 0 to 180 degrees")?;
                let incidence = c.max_incidence_deg;
                require(incidence > 0.0 && incidence < 90.0, "max_incidence_deg", incidence, "an angle between 0 and 90 degrees")
            }
            Self::Objects(o) => o.validate(),
            Self::Cameras(c) => above_0("fps", c.fps),
            Self::Keyframes(k) => {
                require(!k.files.is_empty(), "files", "[]", "at least one file of poses, as in files = [\"kitchen.csv\"]")
            }
        }
    }
}

impl PhotosConfig {
    fn validate(&self) -> Result<(), ExploreError> {
        let shown = |[mean, deviation]: [f64; 2]| format!("[{mean}, {deviation}]");
        let [height, deviation] = self.height_m;
        let ok = height > 0.0 && height.is_finite() && deviation >= 0.0 && deviation.is_finite();
        require(ok, "height_m", shown(self.height_m), "a mean above 0 and a standard deviation in metres")?;
        let [pitch, deviation] = self.pitch_deg;
        let ok = pitch.abs() <= STEEPEST_ELEVATION_DEG && (0.0..=STEEPEST_ELEVATION_DEG).contains(&deviation);
        require(ok, "pitch_deg", shown(self.pitch_deg), "a mean from -84 to 84 and a standard deviation in degrees")?;
        require(self.min_distance_m >= 0.0, "min_distance_m", self.min_distance_m, "a length of 0 or more")?;
        require((0.0..=180.0).contains(&self.min_angle_deg), "min_angle_deg", self.min_angle_deg, "an angle from 0 to 180 degrees")
    }
}

impl ObjectsConfig {
    fn validate(&self) -> Result<(), ExploreError> {
        let [near, far] = self.radius_m;
        let shown = |[low, high]: [f64; 2]| format!("[{low}, {high}]");
        let ok = near > 0.0 && far >= near && far.is_finite();
        require(ok, "radius_m", shown(self.radius_m), "two distances above 0 in metres, the lower one first")?;
        let [low, high] = self.elevation_deg;
        let ok = low >= 0.0 && high >= low && high <= STEEPEST_ELEVATION_DEG;
        require(
            ok,
            "elevation_deg",
            shown(self.elevation_deg),
            "two angles from 0 to 84 degrees, the lower one first: steeper views have no roll",
        )?;
        require((0.0..=1.0).contains(&self.visible_share), "visible_share", self.visible_share, "a share from 0 to 1")
    }
}

/// Steeper views have no meaningful roll and are not taken.
const STEEPEST_ELEVATION_DEG: f64 = 84.0;

fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

fn is_default<T: Default + PartialEq>(v: &T) -> bool {
    *v == T::default()
}

const ANY_PITCH: [f64; 2] = [-90.0, 90.0];

fn is_any_pitch(v: &[f64; 2]) -> bool {
    *v == ANY_PITCH
}

impl PlanConfig {
    /// # Errors
    /// When a value is out of its domain, or two of them do not go together.
    pub fn validate(&self) -> Result<(), ExploreError> {
        let length = |v: f64| v >= 0.0 && v.is_finite();
        let counts = [("frames", self.frames), ("candidates", self.candidates), ("queries", self.queries)];
        for (field, n) in counts.into_iter().chain([("test_width", self.test_width), ("test_height", self.test_height)]) {
            require(n >= 1, field, n, "1 or more")?;
        }
        let step_ok = self.step_m.iter().all(|s| length(*s)) && self.step_m[0] + self.step_m[1] > 0.0;
        require(step_ok, "step_m", format!("{:?}", self.step_m), "three lengths in metres, the first two not both 0")?;
        require(length(self.height_range_m), "height_range_m", self.height_range_m, "a length of 0 or more")?;
        require(length(self.clearance_m), "clearance_m", self.clearance_m, "a length of 0 or more")?;
        require(length(self.stereo_baseline_m), "stereo_baseline_m", self.stereo_baseline_m, "a length of 0 or more")?;
        let distance = self.min_look_distance_m;
        require(distance > 0.0 && length(distance), "min_look_distance_m", distance, "a length above 0")?;
        require((0.0..90.0).contains(&self.roll_limit_deg), "roll_limit_deg", self.roll_limit_deg, "0 up to but not 90 degrees")?;
        let fov_ok = self.fov_x_rad > 0.0 && self.fov_x_rad < std::f64::consts::PI;
        require(fov_ok, "fov_x_rad", self.fov_x_rad, "an angle between 0 and pi")?;
        self.validate_height_and_pitch()?;
        self.validate_gates()?;
        let [alpha, beta, weight] = self.saliency.numbers();
        let saliency_ok = [alpha, beta].iter().all(|v| (0.0..=16.0).contains(v)) && (0.0..=1000.0).contains(&weight);
        let found = format!("alpha {alpha}, beta {beta}, weight {weight}");
        require(saliency_ok, "saliency", found, "exponents from 0 to 16 and a weight from 0 to 1000")?;
        let walks = self.preset == Preset::Default || matches!(self.mode, Mode::Walk(_));
        require(
            walks,
            "mode",
            format!("{} with preset {}", self.mode.name(), self.preset.name()),
            "walk, the only one that the preset has",
        )?;
        self.mode.validate()
    }

    fn validate_height_and_pitch(&self) -> Result<(), ExploreError> {
        if let Some([min, max]) = self.camera_height_m {
            let ok = min >= 0.0 && max > min && max.is_finite();
            require(
                ok,
                "camera_height_m",
                format!("[{min}, {max}]"),
                "the least and the greatest height in metres, the second above the first",
            )?;
        }
        let [low, high] = self.pitch_limits_deg;
        let ok = (-90.0..=90.0).contains(&low) && (low..=90.0).contains(&high);
        require(ok, "pitch_limits_deg", format!("[{low}, {high}]"), "two angles from -90 to 90 degrees, the lower one first")
    }

    fn validate_gates(&self) -> Result<(), ExploreError> {
        let length = self.min_depth_m >= 0.0 && self.min_depth_m.is_finite();
        require(length, "min_depth_m", self.min_depth_m, "a length of 0 or more")?;
        let shares = [
            ("max_void_share", self.max_void_share),
            ("max_back_face_share", self.max_back_face_share),
            ("max_near_share", self.max_near_share),
            ("max_open_share", self.max_open_share),
        ];
        for (field, share) in shares {
            require((0.0..=1.0).contains(&share), field, share, "a share from 0 to 1")?;
        }
        let Some([min, max]) = self.overlap else { return Ok(()) };
        let ok = (0.0..=1.0).contains(&min) && (min..=1.0).contains(&max);
        require(ok, "overlap", format!("[{min}, {max}]"), "two shares from 0 to 1, the lower one first")?;
        let follows = matches!(self.mode, Mode::Walk(_));
        require(
            follows,
            "overlap",
            format!("[{min}, {max}] with mode {}", self.mode.name()),
            "mode walk, the one that chooses each view by the last",
        )
    }
}
