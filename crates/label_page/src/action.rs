//! The actions of a page, and how each is turned into an edit, in which every decision is made.

use super::camera::CameraRequest;
use super::pieces::Pieces;
use super::selection::{Expand, Filters, select};
use super::split;
use super::stroke::{Picked, StrokeShape, VisibleScene};
use enfilade_dataset::Classes;
use enfilade_geometry::Bvh;
use enfilade_label::annotation::{Edit, runs};
use enfilade_scene::PartLabel;
use serde::Deserialize;
use std::collections::{BTreeSet, HashMap, HashSet};

/// An action of a page.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// Labels what a stroke touches.
    Stroke {
        #[serde(flatten)]
        look: Look,
        apply: Apply,
    },
    /// Labels pieces alike.
    Assign { pieces: Vec<u32>, apply: Apply },
    /// Gives each piece a class of its own.
    AssignEach { pieces: Vec<u32>, semantic: Vec<i64> },
    /// Splits a piece.
    Split { piece: u32, by: SplitBy },
    /// Labels the copies of pieces, moved or mirrored, as these are labelled, each copy with instances of its own.
    SameAgain { pieces: Vec<u32> },
    /// Undoes the last edit of the person who asks, or of everyone.
    Undo {
        #[serde(default)]
        everyone: bool,
    },
    /// Does again what was undone last: by the person who asks, or by everyone.
    Redo {
        #[serde(default)]
        everyone: bool,
    },
}

/// A stroke over a view, and how it selects pieces. Requests flatten it into theirs and refuse fields that neither has.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Look {
    camera: CameraRequest,
    shape: StrokeShape,
    #[serde(default)]
    hidden: Vec<u32>,
    #[serde(default)]
    expand: Expand,
    #[serde(default)]
    filters: Filters,
}

/// The label to assign: a class, an instance, or a class with a new instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Apply {
    layer: LayerName,
    #[serde(default)]
    value: Option<i64>,
    #[serde(default)]
    unique: bool,
    #[serde(default)]
    new: bool,
}

/// The two layers of labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum LayerName {
    Semantic,
    Instance,
}

/// How to split.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SplitBy {
    /// Into connected components.
    Component,
    /// By material.
    Material,
    /// Into these faces and the rest.
    Faces(Vec<u32>),
}

/// Why an action is refused. Nothing was changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// True when the request is valid, but cannot be done in the current state.
    pub conflict: bool,
    /// The problem found, and what was expected.
    pub error: String,
    /// What to do.
    pub help: String,
}

impl Refusal {
    /// The request is wrong.
    pub fn request(error: impl Into<String>) -> Self {
        Self { conflict: false, error: error.into(), help: "correct the request; nothing was changed".into() }
    }

    /// The request cannot be done in the current state.
    pub fn conflict(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { conflict: true, error: error.into(), help: help.into() }
    }
}

/// The forms of [`Apply`].
const APPLIES: &str = "apply is none of {layer: \"semantic\", value}, the same with new: true or unique: true, {layer: \"instance\", value}, \
                       {layer: \"instance\", unique: true} and {layer: \"instance\", new: true}";

/// Instance numbers that were never given out.
struct NewInstances {
    /// The value of the first piece.
    first: i16,
    /// Increment from one piece to the next: 0 where all get the same.
    step: i16,
    /// Description of the action.
    what: String,
    /// The first number that is free after them.
    next: i32,
}

/// The state in which an action is decided.
pub struct Context<'a> {
    pub pieces: &'a Pieces,
    pub next_instance: i32,
    pub classes: &'a Classes,
    pub bvh: &'a Bvh,
}

impl Look {
    /// The visible faces that pass the filters, and the selected pieces.
    ///
    /// # Errors
    /// When the camera, the shape, the filters or a piece number is wrong.
    pub fn select(&self, at: &Context<'_>) -> Result<(Vec<u32>, Vec<u32>), Refusal> {
        let camera = self.camera.check().map_err(Refusal::request)?;
        let covered = self.shape.covered(&camera).map_err(Refusal::request)?;
        self.filters.check().map_err(Refusal::request)?;
        at.check_pieces("hidden", &self.hidden)?;
        let hidden: HashSet<u32> = self.hidden.iter().copied().collect();
        let visible = VisibleScene { bvh: at.bvh, piece_of_face: at.pieces.of_face(), hidden: &hidden };
        let faces = visible.visible_faces(&camera, &covered);
        Ok(select(at.pieces, &faces, &self.filters, self.expand))
    }
}

impl Context<'_> {
    /// The edit that an action asks for; `None` when it would change nothing, and for undo and redo.
    ///
    /// # Errors
    /// When the action is wrong, or cannot be done in the current state.
    pub fn decide(&self, action: &Action) -> Result<Option<Edit>, Refusal> {
        match action {
            Action::Stroke { look, apply } => self.label(&look.select(self)?.1, apply),
            Action::Assign { pieces, apply } => {
                self.check_pieces("pieces", pieces)?;
                self.label(&distinct(pieces), apply)
            }
            Action::AssignEach { pieces, semantic } => self.label_each(pieces, semantic),
            Action::Split { piece, by } => self.split(*piece, by).map(Some),
            Action::SameAgain { pieces } => {
                self.check_pieces("pieces", pieces)?;
                self.same_again(&distinct(pieces)).map(Some)
            }
            Action::Undo { .. } | Action::Redo { .. } => Ok(None),
        }
    }

    /// The surface under an image point, and its piece.
    ///
    /// # Errors
    /// When the camera or a piece number is wrong, or the point is not in the image.
    pub fn pick(&self, camera: &CameraRequest, [x, y]: [f64; 2], hidden: &[u32]) -> Result<Option<(u32, Picked)>, Refusal> {
        let camera = camera.check().map_err(Refusal::request)?;
        self.check_pieces("hidden", hidden)?;
        if !(0.0..=f64::from(camera.width)).contains(&x) || !(0.0..=f64::from(camera.height)).contains(&y) {
            return Err(Refusal::request(format!("pixel {x}, {y} is outside of the image of {}x{}", camera.width, camera.height)));
        }
        let hidden: HashSet<u32> = hidden.iter().copied().collect();
        let visible = VisibleScene { bvh: self.bvh, piece_of_face: self.pieces.of_face(), hidden: &hidden };
        Ok(visible.meet(&camera, x, y).map(|picked| (visible.piece_of_face[picked.face as usize], picked)))
    }

    /// Refuses numbers that are no pieces.
    ///
    /// # Errors
    /// Which field names which number.
    pub fn check_pieces(&self, field: &str, pieces: &[u32]) -> Result<(), Refusal> {
        let count = self.pieces.list().len();
        match pieces.iter().find(|&&piece| piece as usize >= count) {
            Some(piece) => Err(Refusal::request(format!("{field} names piece {piece}, but there are {count} (0 to {})", count.max(1) - 1))),
            None => Ok(()),
        }
    }

    fn label(&self, pieces: &[u32], apply: &Apply) -> Result<Option<Edit>, Refusal> {
        let before = |piece: u32| self.pieces.list()[piece as usize].label;
        let set = |of: &dyn Fn(usize, PartLabel) -> PartLabel| {
            pieces.iter().enumerate().map(|(i, &piece)| of(i, before(piece))).collect::<Vec<PartLabel>>()
        };
        let Apply { layer, value, unique, new } = *apply;
        let (labels, what, next) = match (layer, value) {
            (LayerName::Semantic, Some(id)) if !unique && !new => {
                let (semantic, what) = self.class(id)?;
                let (labels, left) = self.out_of_shared(pieces, set(&|_, label| PartLabel { semantic, ..label }));
                (labels, if left { format!("{what}, out of an instance of another class,") } else { what }, self.next_instance)
            }
            (LayerName::Semantic, Some(id)) if unique != new => {
                let (semantic, class) = self.class(id)?;
                let NewInstances { first, step, what, next } = self.new_instances(pieces.len(), unique)?;
                let label = |i: usize, _: PartLabel| PartLabel { semantic, instance: first + step * i as i16 };
                (set(&label), format!("{class}, {}", what.to_lowercase()), next)
            }
            (LayerName::Instance, Some(id)) if !unique && !new => {
                let (instance, what, next) = self.known_instance(id)?;
                (set(&|_, label| PartLabel { instance, ..label }), what, next)
            }
            (LayerName::Instance, None) if unique != new => {
                let NewInstances { first, step, what, next } = self.new_instances(pieces.len(), unique)?;
                (set(&|i, label| PartLabel { instance: first + step * i as i16, ..label }), what, next)
            }
            _ => return Err(Refusal::request(APPLIES)),
        };
        Ok(self.edit(what, pieces, &labels, next))
    }

    /// A class, and what giving it is called.
    fn class(&self, id: i64) -> Result<(i16, String), Refusal> {
        let semantic = self.classes.check(id).map_err(Refusal::request)?;
        Ok((semantic, if semantic == -1 { "No class".into() } else { format!("Class {}", self.classes.name(semantic)) }))
    }

    /// An instance number that was given out, the next one, or −1; what giving it is called; and the number that is free after it.
    fn known_instance(&self, id: i64) -> Result<(i16, String, i32), Refusal> {
        let next = self.next_instance;
        let known = i16::try_from(id).ok().filter(|&id| id == -1 || id >= 1 && i32::from(id) <= next);
        let instance = known.ok_or_else(|| Refusal::request(format!("there is no instance {id}; expected 1 to {next}, or -1 for none")))?;
        let what = if instance == -1 { "No instance".into() } else { format!("Instance {instance}") };
        Ok((instance, what, next.max(i32::from(instance) + 1)))
    }

    /// One unused instance for this number of pieces, or one for each of them.
    fn new_instances(&self, pieces: usize, unique: bool) -> Result<NewInstances, Refusal> {
        let wanted = if unique { pieces } else { pieces.min(1) };
        let first = self.instances(wanted)?;
        let what = if unique { "Instances of their own".into() } else { format!("New instance {first}") };
        Ok(NewInstances { first, step: i16::from(unique), what, next: self.next_instance + wanted as i32 })
    }

    /// The first of `wanted` instance numbers that were never given out.
    pub(super) fn instances(&self, wanted: usize) -> Result<i16, Refusal> {
        let last = self.next_instance as usize + wanted;
        if last > i16::MAX as usize + 1 {
            let error = format!("{wanted} more instances would go beyond {}, which is what int16 images hold", i16::MAX);
            return Err(Refusal::conflict(error, "give several pieces one instance"));
        }
        Ok(self.next_instance.min(i32::from(i16::MAX)) as i16)
    }

    fn label_each(&self, pieces: &[u32], semantic: &[i64]) -> Result<Option<Edit>, Refusal> {
        self.check_pieces("pieces", pieces)?;
        if semantic.len() != pieces.len() {
            return Err(Refusal::request(format!("{} classes for {} pieces; expected one each", semantic.len(), pieces.len())));
        }
        if distinct(pieces).len() != pieces.len() {
            return Err(Refusal::request("a piece is named twice"));
        }
        let classes: Vec<i16> = semantic.iter().map(|&id| self.classes.check(id)).collect::<Result<_, _>>().map_err(Refusal::request)?;
        let label = |(&piece, semantic): (&u32, i16)| PartLabel { semantic, ..self.pieces.list()[piece as usize].label };
        let (labels, _) = self.out_of_shared(pieces, pieces.iter().zip(classes).map(label).collect());
        Ok(self.edit("Classes".into(), pieces, &labels, self.next_instance))
    }

    /// Labels with new classes, of which those have no instance whose instance would have another class too, such as that of the piece that
    /// they were split from. Besides, whether there are any.
    fn out_of_shared(&self, pieces: &[u32], mut labels: Vec<PartLabel>) -> (Vec<PartLabel>, bool) {
        let after: HashMap<u32, PartLabel> = pieces.iter().copied().zip(labels.iter().copied()).collect();
        let mut classes: HashMap<i16, BTreeSet<i16>> = HashMap::new();
        for (number, piece) in self.pieces.list().iter().enumerate() {
            let label = after.get(&(number as u32)).unwrap_or(&piece.label);
            if label.instance >= 1 && label.semantic >= 1 {
                classes.entry(label.instance).or_default().insert(label.semantic);
            }
        }
        let mut left = false;
        for (piece, label) in pieces.iter().zip(&mut labels) {
            let changed = label.semantic >= 1 && label.semantic != self.pieces.list()[*piece as usize].label.semantic;
            if changed && classes.get(&label.instance).is_some_and(|classes| classes.len() > 1) {
                (label.instance, left) = (PartLabel::NONE.instance, true);
            }
        }
        (labels, left)
    }

    /// The edit that gives these labels to the pieces whose labels differ.
    fn edit(&self, what: String, pieces: &[u32], labels: &[PartLabel], next_instance: i32) -> Option<Edit> {
        let differs = |(piece, label): &(&u32, &PartLabel)| self.pieces.list()[**piece as usize].label != **label;
        let (pieces, labels): (Vec<u32>, Vec<PartLabel>) = pieces.iter().zip(labels).filter(differs).unzip();
        if pieces.is_empty() {
            return None;
        }
        let description = match pieces.as_slice() {
            [one] => format!("{what} on {}", self.pieces.list()[*one as usize].name),
            many => format!("{what} on {} parts", many.len()),
        };
        let (semantic, instance) = labels.iter().map(|label| (label.semantic, label.instance)).unzip();
        Some(Edit::Label { description, pieces, semantic, instance, next_instance })
    }

    fn split(&self, number: u32, by: &SplitBy) -> Result<Edit, Refusal> {
        self.check_pieces("piece", &[number])?;
        let (piece, scene) = (&self.pieces.list()[number as usize], self.pieces.scene());
        let (groups, whole) = match by {
            SplitBy::Component => (split::by_component(scene, &piece.faces), "all its faces are connected"),
            SplitBy::Material => (split::by_material(scene, &piece.faces), "all its faces are of one material"),
            SplitBy::Faces(painted) => {
                let groups = split::by_faces(piece, self.pieces.of_face(), number, painted).map_err(Refusal::request)?;
                (groups.into_iter().filter(|group| !group.is_empty()).collect(), "the painted faces are all of it or none")
            }
        };
        let [_, new @ ..] = groups.as_slice() else { return Err(Refusal::conflict("the piece has no faces", "choose another")) };
        if new.is_empty() {
            let error = format!("{:?} cannot be split in this way: {whole}", piece.name);
            return Err(Refusal::conflict(error, "paint the faces that are to be a piece of their own"));
        }
        Ok(Edit::Split {
            description: format!("Split {} into {}", piece.name, groups.len()),
            piece: number,
            names: self.pieces.new_names(piece.part, new.len()),
            faces: new.iter().map(|faces| runs(faces)).collect(),
        })
    }
}

/// The pieces in ascending order, each once.
fn distinct(pieces: &[u32]) -> Vec<u32> {
    let mut pieces = pieces.to_vec();
    pieces.sort_unstable();
    pieces.dedup();
    pieces
}
