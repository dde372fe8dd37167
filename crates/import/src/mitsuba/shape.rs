//! Shapes to meshes and parts: files, primitives, groups and their instances.

use super::reader::{MAX_PARTS, Reader};
use super::xml::Node;
use super::{bsdf, serialized, transform};
use crate::ImportError;
use crate::mesh;
use crate::obj::ObjFile;
use crate::ply::{self, Means};
use crate::primitives;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Vec2, Vec3};
use enfilade_scene::{ObjectId, PartLabel};
use std::path::{Path, PathBuf};

impl<'n> Reader<'n, '_> {
    /// Adds the part or parts of a shape.
    pub(super) fn shape(&mut self, node: &'n Node) -> Result<(), ImportError> {
        self.placed_shape(node, DAffine3::IDENTITY, "", 0)
    }

    /// Adds a shape under the placement of its instance, whose name comes first.
    fn placed_shape(&mut self, node: &'n Node, outer: DAffine3, prefix: &str, depth: usize) -> Result<(), ImportError> {
        self.visit(node, depth, "instances")?;
        match node.plugin.as_str() {
            // Only its instances are visible.
            "shapegroup" if depth == 0 => return Ok(()),
            "instance" => return self.instance(node, outer, prefix, depth),
            _ => (),
        }
        let bsdf = self.objects(node, "bsdf")?.first().copied();
        let emitters = self.objects(node, "emitter")?;
        let emitter = emitters.iter().find(|e| e.plugin == "area").copied();
        if let Some(other) = emitters.iter().find(|e| e.plugin != "area") {
            self.warn(other, "only area emitters can be part of a shape; ignored");
        }
        if let Some(emitter) = emitter {
            self.report_unknown(emitter, &["radiance", "sampling_weight"], &[]);
        }
        if node.plugin == "obj" && self.version < 2 {
            self.attributes.turn_to(None);
            return self.obj_shape(node, emitter, outer, prefix);
        }
        let Some((mesh, in_shape, stem)) = self.mesh(node)? else { return Ok(()) };
        self.attributes.turn_to(Some(mesh));
        let medium = self.medium_inside(node)?;
        let Some(material) = self.material(bsdf, emitter, medium)? else {
            self.warn(node, "the shape scatters nothing (null bsdf) and was left out");
            return Ok(());
        };
        let file_from_mesh = self.placement(node, outer)? * in_shape;
        let name = node.id.clone().unwrap_or_else(|| format!("{}_{stem}", bsdf::name(bsdf)));
        self.place(node, None, &format!("{prefix}{name}"), mesh, material, file_from_mesh)
    }

    /// The placement of a shape within its instance's, at the first moment.
    pub(super) fn placement(&mut self, node: &'n Node, outer: DAffine3) -> Result<DAffine3, ImportError> {
        if transform::is_animated(node, "to_world") {
            self.warn(node, "the shape is animated; its first moment was used");
        }
        Ok(outer * transform::of(node, "to_world")?)
    }

    /// Adds a part of a shape. It belongs to the instance, where it is of one, else to `object`, else it is an object by itself.
    pub(super) fn place(
        &mut self,
        node: &'n Node,
        object: Option<ObjectId>,
        name: &str,
        mesh: u32,
        material: u32,
        file_from_mesh: DAffine3,
    ) -> Result<(), ImportError> {
        self.parts += 1;
        if self.parts > MAX_PARTS {
            return Err(node.error(format!("the scene has more than {MAX_PARTS} parts; check the instances")));
        }
        let object = self.instance.or(object).unwrap_or_else(|| self.a.push_object(name, None));
        self.a.push_part_of(object, name, mesh, material, file_from_mesh, PartLabel::NONE);
        Ok(())
    }

    fn instance(&mut self, node: &'n Node, outer: DAffine3, prefix: &str, depth: usize) -> Result<(), ImportError> {
        self.report_unknown(node, &["to_world"], &["shape"]);
        let group = self.objects(node, "shape")?.first().copied().filter(|g| g.plugin == "shapegroup");
        let group = group.ok_or_else(|| node.error("the instance refers to no shapegroup"))?;
        let placement = outer * transform::of(node, "to_world")?;
        let name = node.id.as_deref().or(group.id.as_deref()).unwrap_or("instance");
        let prefix = format!("{prefix}{name}_");
        let outermost = self.instance;
        self.instance = Some(outermost.unwrap_or_else(|| self.a.push_object(name, None)));
        for shape in self.objects(group, "shape")? {
            self.placed_shape(shape, placement, &prefix, depth + 1)?;
        }
        self.instance = outermost;
        Ok(())
    }

    /// The path of a shape's file, which is empty for shapes without one, and its flags. Reports what of it is not read.
    pub(super) fn stated(&mut self, node: &'n Node) -> Result<(&'n str, [bool; 3]), ImportError> {
        const TAGS: [&str; 7] = ["bsdf", "emitter", "medium", "texture", "sensor", "subsurface", "shape"];
        const FILES: [&str; 7] =
            ["filename", "to_world", "face_normals", "flip_normals", "flip_tex_coords", "shape_index", "load_materials"];
        const PRIMITIVES: [&str; 7] = ["to_world", "flip_normals", "center", "radius", "p0", "p1", "face_normals"];
        let from_file = is_file(node);
        self.report_unknown(node, if from_file { &FILES } else { &PRIMITIVES }, &TAGS);
        let path = node.raw_text("filename").unwrap_or_default();
        if from_file && path.is_empty() {
            return Err(node.error("the shape has no filename"));
        }
        let flags =
            [node.flag("face_normals", false), node.flag("flip_normals", false), node.flag("flip_tex_coords", node.plugin == "obj")];
        Ok((path, flags))
    }

    /// The mesh of a shape, the placement that its own parameters add, and the stem of its name. `None` when there is none.
    fn mesh(&mut self, node: &'n Node) -> Result<Option<(u32, DAffine3, String)>, ImportError> {
        let (path, flags) = self.stated(node)?;
        let from_file = is_file(node);
        let index = node.float_or("shape_index", 0.0)? as i64;
        let Some(in_shape) = self.shape_parameters(node)? else { return Ok(None) };
        let stem = if from_file { stem(path) } else { node.plugin.clone() };
        let key = (node.plugin.clone(), path.to_string(), index, flags);
        let mesh = match self.meshes.get(&key) {
            Some(&known) => known,
            None => {
                let read = self.made(node, path, index, flags);
                let read = if from_file { self.a.mesh_or_none(read, path, &node.place())?.flatten() } else { read? };
                let built = read.map(|(mesh, means)| {
                    self.attributes.insert(mesh, means);
                    mesh
                });
                self.meshes.insert(key, built);
                built
            }
        };
        Ok(mesh.map(|mesh| (mesh, in_shape, stem)))
    }

    /// The mesh of the scene that a shape is, with the means of its attributes. `None` for one without faces.
    fn made(&mut self, node: &'n Node, path: &str, index: i64, flags: [bool; 3]) -> Result<Option<(u32, Means)>, ImportError> {
        let from_file = is_file(node);
        let Built { mesh, origin, means, file } = self.build(node, path, index)?;
        let mesh = finish(mesh, from_file, flags);
        let place = if from_file { "mesh".to_string() } else { node.place() };
        Ok(self.a.push_mesh_from(origin, mesh, &file, &place)?.map(|mesh| (mesh, means)))
    }

    /// The mesh as the file or the formula has it, with v downward as Mitsuba has it.
    fn build(&mut self, node: &'n Node, path: &str, index: i64) -> Result<Built, ImportError> {
        let mut means = Means::default();
        let scene = self.a.file().to_path_buf();
        let own = |mesh| Ok(Built { mesh, origin: DVec3::ZERO, means: Means::default(), file: scene });
        match node.plugin.as_str() {
            "rectangle" => own(primitives::rectangle()),
            "disk" => own(primitives::disk()),
            "sphere" => own(primitives::sphere()),
            "cube" => own(primitives::cube()),
            "cylinder" => own(primitives::cylinder()),
            plugin => {
                let (file, bytes) = self.a.read(path)?;
                let unit = self.a.meters_per_unit();
                let (mesh, origin) = match plugin {
                    "obj" => {
                        let mut obj = ObjFile::parse(&bytes, &file)?;
                        obj.settle(unit);
                        obj.notes.iter().for_each(|note| self.a.warn(node.place(), format!("{}: {note}", file.display())));
                        (obj.mesh(obj.groups.iter()), obj.origin)
                    }
                    "ply" => {
                        let ply = ply::read(&bytes, &file, self.attributes.wanted, unit)?;
                        if ply.mean_color.is_some() && !self.attributes.wanted {
                            self.warn(node, format!("{}: the colours of vertices were dropped", file.display()));
                        }
                        if let Some(trailing) = ply.trailing {
                            self.warn(node, format!("{}: {trailing}", file.display()));
                        }
                        means = ply.means;
                        (ply.mesh, ply.origin)
                    }
                    _ => serialized::read(&bytes, index, &file, unit)?,
                };
                Ok(Built { mesh, origin, means, file })
            }
        }
    }
}

/// A mesh, the point from which its positions count, its attributes, and the file to name in messages.
struct Built {
    mesh: Mesh,
    origin: DVec3,
    means: Means,
    file: PathBuf,
}

/// True for shapes whose mesh is in a file.
fn is_file(node: &Node) -> bool {
    matches!(node.plugin.as_str(), "obj" | "ply" | "serialized")
}

/// Applies a shape's flags ([faceNormals, flipNormals, flipTexCoords]) and turns v upward.
pub(super) fn finish(mut mesh: Mesh, from_file: bool, [face_normals, flip_normals, flip_uvs]: [bool; 3]) -> Mesh {
    // OBJ files have v upward, which `flipTexCoords` (on for them) makes Mitsuba's downward; here it is turned upward again.
    if !flip_uvs {
        mesh.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(uv.x, 1.0 - uv.y));
    }
    if face_normals {
        // The front is where the corners run counter-clockwise, wherever the file's normals point.
        mesh.normals.clear();
    } else if from_file && mesh.normals.is_empty() {
        mesh::add_smooth_normals(&mut mesh);
    } else if from_file {
        mesh::turn_faces_to_normals(&mut mesh);
    }
    if flip_normals {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        mesh.normals.iter_mut().for_each(|n: &mut Vec3| *n = -*n);
    }
    mesh
}

/// The name of a file without folder and extension.
pub(super) fn stem(path: &str) -> String {
    let path = path.replace('\\', "/");
    Path::new(&path).file_stem().map_or_else(|| "mesh".to_string(), |s| s.to_string_lossy().into_owned())
}
