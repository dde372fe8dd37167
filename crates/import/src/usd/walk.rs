//! The walk through the stage: each prim with what it inherits becomes parts, lights and cameras.

use super::animation::Animations;
use super::bind::{self, Bindings};
use super::camera;
use super::constants::Constants;
use super::deform::{Rig, Skeletons};
use super::joints::Joints;
use super::label::{self, Unknown};
use super::light::Lamp;
use super::material::Materials;
use super::shapes;
use super::stage::{Prim, Stage};
use super::state::{Shape, State};
use super::stretch::Stretch;
use super::things::{Thing, Things};
use super::xform::Xform;
use crate::ImportError;
use crate::assembly::{Assembly, FileLabel};
use enfilade_math::DAffine3;
use std::collections::HashMap;
use std::rc::Rc;

/// More visits than this are taken for instances that multiply without end.
const MAX_VISITS: usize = 1 << 21;

/// A walk through a stage: what it has met, and what was made of it.
pub(super) struct Walk<'s> {
    pub stage: &'s mut Stage,
    pub z_up: bool,
    pub(super) materials: Materials,
    pub(super) pieces: HashMap<String, Shape>,
    pub(super) things: Things,
    pub(super) animations: Animations,
    pub(super) skeletons: Skeletons,
    visited: usize,
    pub(super) unknown_labels: Unknown,
    /// Number of notes beyond the first of each kind.
    hidden: usize,
    pub(super) cages: usize,
    /// Emitting variants of materials, for meshes that are lights.
    pub(super) glowing: HashMap<(u32, [u32; 3]), u32>,
    /// Variants of materials with the display colours of prims, by material and colour.
    pub(super) colored: HashMap<(u32, [u32; 3]), u32>,
    /// Rectangles and disks that emit, whose backs are dark.
    panels: usize,
    /// Suns and surroundings.
    skies: usize,
    joints: Joints,
}

impl<'s> Walk<'s> {
    pub(super) fn new(stage: &'s mut Stage, z_up: bool) -> Self {
        Self {
            animations: Animations::new(stage.layer()),
            stage,
            z_up,
            materials: Materials::default(),
            pieces: HashMap::new(),
            things: Things::default(),
            skeletons: Skeletons::default(),
            visited: 0,
            unknown_labels: Unknown::default(),
            hidden: 0,
            cages: 0,
            glowing: HashMap::new(),
            colored: HashMap::new(),
            panels: 0,
            skies: 0,
            joints: Joints::default(),
        }
    }

    /// Adds all of the stage.
    pub(super) fn all(&mut self, a: &mut Assembly) -> Result<(), ImportError> {
        let root = self.stage.root();
        let state = State {
            file_from_parent: DAffine3::IDENTITY,
            body: None,
            label: FileLabel::NONE,
            bindings: Bindings::default(),
            constants: Constants::default(),
            hidden: false,
            prefix: String::new(),
            object: None,
            thing: None,
            rig: Rig::default(),
            stretch: None,
        };
        let names = root.children();
        for (i, name) in names.iter().enumerate() {
            a.progress(i, names.len());
            let prim = self.stage.child(&root, name, a)?;
            self.visit(&prim, &state, a)?;
        }
        std::mem::take(&mut self.things).settle(a);
        self.animations.finish(a);
        std::mem::take(&mut self.joints).add(self.stage, a)?;
        self.report(a);
        Ok(())
    }

    fn report(&self, a: &mut Assembly) {
        for attribute in &*self.stage.sampled.borrow() {
            a.warn(attribute, "its value changes with time; that of the first moment was taken");
        }
        if self.hidden > 0 {
            a.warn("visibility", format!("{} prims that are invisible, or have the purpose guide or proxy, were left out", self.hidden));
        }
        if self.panels > 0 && self.skies > 0 {
            a.warn(
                "lights",
                format!(
                    "{} lights are rectangles or disks, whose dark backs keep out the sun and sky; \
                     take away those that stand in for daylight before windows and above rooms",
                    self.panels
                ),
            );
        }
        if self.cages > 0 {
            a.warn(
                "subdivisionScheme",
                format!("{} meshes are subdivision surfaces; their cages were taken, with smooth normals where there are none", self.cages),
            );
        }
        if let Some((name, path)) = &self.unknown_labels.first {
            let message = format!("{} labels name no class of NYU40 and were left out; the first is {name:?}", self.unknown_labels.count);
            a.warn(path, message);
        }
    }

    /// Adds a prim and what is below it.
    pub(super) fn visit(&mut self, prim: &Rc<Prim>, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        self.visited += 1;
        if self.visited > MAX_VISITS {
            return Err(a.malformed(&prim.path, format!("the scene has more than {MAX_VISITS} prims and instances; make it smaller")));
        }
        if !prim.is_defined() || !prim.is_active() {
            return Ok(());
        }
        let hidden = is_aside(prim, state.hidden);
        let is_invisible = prim.text("visibility") == Some("invisible");
        self.hidden += usize::from(is_invisible || hidden && !state.hidden);
        if is_invisible {
            return Ok(());
        }
        let before = a.contents();
        let object = a.push_object(prim.name(), state.object);
        let xform = Rc::new(Xform::of(prim, a));
        let (file_from_parent, bearer) = if xform.resets { (DAffine3::IDENTITY, None) } else { (state.file_from_parent, state.body) };
        let moved = self.animations.body(prim, &state.prefix, &xform, (file_from_parent, bearer), a);
        let begun = moved.problem.is_some().then(|| Stretch::new(file_from_parent, bearer));
        let stretch = state.stretch.as_ref().filter(|_| !xform.resets).cloned().or(begun);
        let state = State {
            file_from_parent: file_from_parent * xform.rest(),
            body: moved.body,
            label: label::at(prim, Some(object), state.label, &mut self.unknown_labels),
            bindings: bind::at(prim, &state.bindings, self.stage, a)?,
            constants: state.constants.below(prim),
            hidden,
            prefix: state.prefix.clone(),
            object: Some(object),
            thing: Thing::at(prim, object, state.thing),
            rig: state.rig.at(prim),
            stretch: stretch.map(|stretch| stretch.below(&xform)),
        };
        match prim.kind() {
            // Their shaders are read where they are bound.
            "Material" | "Shader" | "NodeGraph" | "GeomSubset" => return Ok(()),
            "PointInstancer" if hidden => return Ok(()),
            _ if hidden => (),
            "Mesh" => self.mesh(prim, &state, a)?,
            "Camera" => camera::add(prim, state.file_from_parent, a),
            "PointInstancer" => return self.instances(prim, &state, a),
            "" | "Xform" | "Scope" | "SkelRoot" => (),
            kind if kind.ends_with("Light") || kind == "DomeLight_1" => {
                self.panels += usize::from(matches!(kind, "RectLight" | "DiskLight"));
                self.skies += usize::from(matches!(kind, "DistantLight" | "DomeLight" | "DomeLight_1"));
                if state.body.is_some() && kind.starts_with("DomeLight") {
                    a.warn(&prim.path, "it moves with time; surroundings stay as they are at first");
                }
                let baked = &mut self.materials.baked;
                Lamp { prim, file_from_prim: state.file_from_parent, object, label: state.label, baked, z_up: self.z_up }
                    .add(self.stage, a)?;
            }
            kind => match shapes::mesh(prim) {
                Some(mesh) => self.shape(prim, mesh, &state, a)?,
                None if ignored(kind) => (),
                None => a.warn(&prim.path, format!("prims of type {kind} are not supported; it was left out")),
            },
        }
        if let Some(body) = state.body {
            a.carry(body, before);
        }
        for name in prim.children() {
            let child = self.stage.child(prim, &name, a)?;
            self.visit(&child, &state, a)?;
        }
        if let Some(problem) = moved.problem.filter(|_| a.has_more_than_parts(before)) {
            a.warn(&prim.path, format!("its meshes follow it, but no light or camera in it does: {problem}"));
        }
        self.joints.met(prim, state.file_from_parent, before, a);
        Ok(())
    }
}

/// True where a prim, or else what is above it, has the purpose `guide` or `proxy`. Prims without a type have none of their own.
pub(super) fn is_aside(prim: &Prim, inherited: bool) -> bool {
    let own = if prim.kind().is_empty() { None } else { prim.text("purpose") };
    own.map_or(inherited, |purpose| matches!(purpose, "guide" | "proxy"))
}

/// Types that have no place in a picture of a room and need no mention.
fn ignored(kind: &str) -> bool {
    kind.starts_with("Physics") || kind.starts_with("Render") || matches!(kind, "SkelAnimation" | "Skeleton" | "BlendShape")
}
