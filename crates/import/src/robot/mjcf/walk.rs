//! The tree of bodies, with what is in them.

use super::meshes::Meshes;
use super::omitted::Omitted;
use super::pictures::Layout;
use super::settings::Settings;
use super::shade::Shades;
use super::tree::Element;
use crate::ImportError;
use crate::assembly::Assembly;
use crate::joints::joint::{Joint, Kind, Link};
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{BodyId, ObjectId};
use std::collections::BTreeMap;

/// Bodies, frames and copies within each other are no deeper than this.
const MAX_DEPTH: usize = 200;
/// More copies by `<replicate>` are taken for a mistake.
const MAX_COPIES: usize = 100_000;

/// Where an element is.
#[derive(Clone)]
pub(super) struct Place {
    /// The body, or `world`.
    pub name: String,
    pub file_from_here: DAffine3,
    /// Class of elements that state none.
    pub class: Option<String>,
    pub object: ObjectId,
    /// The body of the scene that it moves with.
    pub body: Option<BodyId>,
    /// The body of the model.
    pub link: usize,
    /// What the copies of a `<replicate>` add to names.
    suffix: String,
    depth: usize,
}

/// A model on its way into a scene.
pub(super) struct Walk<'r> {
    pub settings: Settings,
    pub meshes: Meshes,
    pub shades: Shades,
    pub omitted: Omitted,
    pub pushed: BTreeMap<(String, Option<Layout>), Option<u32>>,
    pub root: &'r Element,
    /// In MuJoCo's order; the first is the world.
    pub links: Vec<Link>,
    /// In the order of `qpos`.
    pub joints: Vec<Joint>,
    /// Cameras and lights that look at a body, with it; placed when all bodies are known.
    pub aimed: Vec<(Element, Place)>,
    /// Number of copies by `<replicate>` so far.
    copies: usize,
}

impl<'r> Walk<'r> {
    pub(super) fn of(root: &'r Element) -> Result<Self, ImportError> {
        let settings = Settings::of(root)?;
        Ok(Self {
            meshes: Meshes::of(root, &settings)?,
            shades: Shades::of(root, &settings)?,
            settings,
            omitted: Omitted::default(),
            pushed: BTreeMap::new(),
            root,
            links: vec![Link {
                name: "world".into(),
                file_from_link: DAffine3::IDENTITY,
                jointed: false,
                mocap: false,
                body: None,
                parent: 0,
            }],
            joints: Vec::new(),
            aimed: Vec::new(),
            copies: 0,
        })
    }

    /// Adds all that is in the world.
    ///
    /// # Errors
    /// When an element is wrong, or refers to what is not there.
    pub(super) fn world(&mut self, a: &mut Assembly) -> Result<(), ImportError> {
        let model = self.root.text("model").unwrap_or("world").to_string();
        let object = a.push_object(&model, None);
        for world in self.root.all("worldbody") {
            let place = Place {
                name: "world".into(),
                file_from_here: DAffine3::IDENTITY,
                class: world.text("childclass").map(str::to_string),
                object,
                body: None,
                link: 0,
                suffix: String::new(),
                depth: 0,
            };
            self.content(world, &place, a)?;
        }
        for (element, place) in std::mem::take(&mut self.aimed) {
            self.view(&element, &place, a)?;
        }
        Ok(())
    }

    fn content(&mut self, scope: &Element, at: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        if at.depth > MAX_DEPTH {
            return Err(scope.wrong(format!("bodies are nested more than {MAX_DEPTH} deep")));
        }
        for element in &scope.children {
            match element.tag.as_str() {
                "geom" => self.geom(element, at, a)?,
                "body" => self.link(element, at, a)?,
                "frame" => {
                    let class = element.text("childclass").map_or_else(|| at.class.clone(), |class| Some(class.into()));
                    let file_from_here = at.file_from_here * self.settings.placement(element)?;
                    self.content(element, &Place { file_from_here, class, depth: at.depth + 1, ..at.clone() }, a)?;
                }
                "replicate" => self.copies(element, at, a)?,
                "light" | "camera" => self.aimed.push((element.clone(), at.clone())),
                "attach" => {
                    let remedy = "save the whole model in one file (mujoco.mj_saveLastXML) and import that";
                    return Err(element.wrong(format!("models within models (attach) are not read; {remedy}")));
                }
                "composite" | "flexcomp" | "plugin" => {
                    let place = element.place(a);
                    a.warn(place, format!("<{}> is not read; it was left out", element.tag));
                }
                // Joints are read with their body; sites, inertias and what belongs to them are not seen.
                _ => (),
            }
        }
        Ok(())
    }

    fn copies(&mut self, replicate: &Element, at: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        let count = replicate.number("count")?.unwrap_or(0.0).max(0.0) as usize;
        self.copies = self.copies.saturating_add(count);
        if self.copies > MAX_COPIES {
            return Err(replicate.wrong(format!("{} copies in the whole model, expected at most {MAX_COPIES}", self.copies)));
        }
        let offset = replicate.vector("offset")?.map_or(DVec3::ZERO, DVec3::from_array);
        let angles = replicate.vector::<3>("euler")?.unwrap_or_default();
        let digits = count.saturating_sub(1).to_string().len();
        let mut position = DVec3::ZERO;
        for copy in 0..count {
            let turn = self.settings.euler(angles.map(|angle| angle * copy as f64));
            let file_from_here = at.file_from_here * DAffine3::from_rotation_translation(turn, position);
            position += turn * offset;
            let suffix = format!("{}{}{copy:0digits$}", at.suffix, replicate.text("sep").unwrap_or_default());
            self.content(replicate, &Place { file_from_here, suffix, depth: at.depth + 1, ..at.clone() }, a)?;
        }
        Ok(())
    }

    fn link(&mut self, body: &Element, at: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        let link = self.links.len();
        let name = if body.name().is_empty() { format!("body_{link}") } else { format!("{}{}", body.name(), at.suffix) };
        let class = body.text("childclass").map_or_else(|| at.class.clone(), |class| Some(class.into()));
        let file_from_here = at.file_from_here * self.settings.placement(body)?;
        let object = a.push_object(&name, Some(at.object));
        let mut here = Place { name, file_from_here, class, object, link, depth: at.depth + 1, ..at.clone() };
        let mocap = body.flag("mocap") == Some(true);
        let mut joints = Vec::new();
        self.joints_of(body, &here, &mut joints)?;
        let last = joints.len();
        for (number, joint) in joints.iter_mut().enumerate() {
            let name = if number + 1 == last { here.name.clone() } else { format!("{}.{}", here.name, joint.name) };
            joint.push(&name, here.body, a);
            here.body = joint.body.or(here.body);
        }
        if mocap {
            // A joint without states in qpos.
            let mut stand = Joint::free(&here.name, file_from_here);
            stand.push(&here.name, here.body, a);
            here.body = stand.body.or(here.body);
        }
        let (name, body_id) = (here.name.clone(), here.body);
        self.links.push(Link { name, file_from_link: file_from_here, jointed: last > 0, mocap, body: body_id, parent: at.link });
        self.joints.append(&mut joints);
        self.content(body, &here, a)
    }

    /// The joints of a body, within its frames too.
    fn joints_of(&self, scope: &Element, at: &Place, found: &mut Vec<Joint>) -> Result<(), ImportError> {
        for element in &scope.children {
            match element.tag.as_str() {
                "joint" => found.push(self.joint(&self.settings.complete(element, at.class.as_deref())?, at, found.len())?),
                "freejoint" => found.push(Joint::free(&free_name(element, at), at.file_from_here)),
                "frame" => {
                    let class = element.text("childclass").map_or_else(|| at.class.clone(), |class| Some(class.into()));
                    let file_from_here = at.file_from_here * self.settings.placement(element)?;
                    self.joints_of(element, &Place { file_from_here, class, depth: at.depth + 1, ..at.clone() }, found)?;
                }
                _ => (),
            }
        }
        Ok(())
    }

    fn joint(&self, joint: &Element, at: &Place, number: usize) -> Result<Joint, ImportError> {
        let kind = match joint.text("type").unwrap_or("hinge") {
            "hinge" => Kind::Hinge,
            "slide" => Kind::Slide,
            "ball" => Kind::Ball,
            "free" => return Ok(Joint::free(&free_name(joint, at), at.file_from_here)),
            other => return Err(joint.wrong(format!("found {other:?} as type, expected hinge, slide, ball or free"))),
        };
        let angle = |value: f64| if kind == Kind::Hinge { self.settings.radians(value) } else { value };
        let axis = joint.vector("axis")?.map_or(DVec3::Z, DVec3::from_array);
        let axis = axis.try_normalize().ok_or_else(|| joint.wrong("axis has no direction".into()))?;
        let zero = angle(joint.number("ref")?.unwrap_or(0.0));
        let range = joint.vector::<2>("range")?.map(|range| range.map(angle));
        let limited = joint.flag("limited").unwrap_or(self.settings.auto_limits);
        let limits = range.filter(|_| limited && matches!(kind, Kind::Hinge | Kind::Slide)).map(|range| range.map(|v| v - zero));
        if limits.is_some_and(|[low, high]| low > high) {
            return Err(joint.wrong(format!("found {:?} as range, whose ends descend", joint.text("range").unwrap_or_default())));
        }
        let anchor = joint.vector("pos")?.map_or(DVec3::ZERO, DVec3::from_array);
        let name = if joint.name().is_empty() { format!("joint_{number}") } else { format!("{}{}", joint.name(), at.suffix) };
        Ok(Joint {
            name,
            kind,
            file_from_frame: at.file_from_here * DAffine3::from_translation(anchor),
            axis,
            zero,
            per_metre: 1.0,
            limits,
            mimic: None,
            body: None,
        })
    }
}

/// The name of a free joint: its own, else the body's.
fn free_name(joint: &Element, at: &Place) -> String {
    if joint.name().is_empty() { at.name.clone() } else { format!("{}{}", joint.name(), at.suffix) }
}
