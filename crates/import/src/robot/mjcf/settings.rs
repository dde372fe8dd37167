//! What a model states once for all its elements: `<compiler>`, and the classes of `<default>`.

use super::tree::Element;
use crate::ImportError;
use crate::joints::joint::quaternion;
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};
use std::collections::BTreeMap;
use std::path::Path;

/// Attributes of which an element may give the first numbers alone; the others are those of its class.
const PARTIAL: [&str; 1] = ["size"];
/// Ways to state a rotation: an element that has one of them inherits none.
const ROTATIONS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];

/// The settings of a model.
pub(super) struct Settings {
    degrees: bool,
    euler: [char; 3],
    meshes: String,
    textures: String,
    strip: bool,
    /// Whether a joint with a range is limited though it does not say so.
    pub auto_limits: bool,
    classes: BTreeMap<String, Class>,
}

/// Attributes by element, of a class with those that it inherits.
type Class = BTreeMap<String, Vec<(String, String)>>;

impl Settings {
    /// The assets of a kind, with what their classes give them, and their names: those of their files where they state none.
    ///
    /// # Errors
    /// When one is of a class that is not there.
    pub(super) fn assets(&self, root: &Element, tag: &str) -> Result<Vec<(Option<String>, Element)>, ImportError> {
        let stem = |path: &str| {
            Path::new(&path.replace('\\', "/")).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
        };
        let asset = |asset: &Element| {
            let asset = self.complete(asset, None)?;
            let name = asset.text("name").map(str::to_string).or_else(|| asset.text("file").map(stem));
            Ok((name, asset))
        };
        root.all("asset").flat_map(|assets| assets.all(tag)).map(asset).collect()
    }

    /// The settings of a model.
    ///
    /// # Errors
    /// When one is not known.
    pub(super) fn of(root: &Element) -> Result<Self, ImportError> {
        let mut settings = Self {
            degrees: true,
            euler: ['x', 'y', 'z'],
            meshes: String::new(),
            textures: String::new(),
            strip: false,
            auto_limits: true,
            classes: BTreeMap::from([("main".to_string(), Class::new())]),
        };
        for compiler in root.all("compiler") {
            settings.compiler(compiler)?;
        }
        for default in root.all("default") {
            settings.class(default, "main", true)?;
        }
        Ok(settings)
    }

    fn compiler(&mut self, compiler: &Element) -> Result<(), ImportError> {
        match compiler.text("angle") {
            Some("radian") => self.degrees = false,
            Some("degree") => self.degrees = true,
            None => (),
            Some(other) => return Err(compiler.wrong(format!("found {other:?} as angle, expected degree or radian"))),
        }
        if compiler.text("coordinate") == Some("global") {
            let problem = "coordinates are global, which MuJoCo itself no longer reads; save the model with local ones (MuJoCo 2.3.3)";
            return Err(compiler.wrong(problem.into()));
        }
        if let Some(order) = compiler.text("eulerseq") {
            let axes: Vec<char> = order.chars().collect();
            let known = axes.iter().all(|axis| "xyzXYZ".contains(*axis));
            let axes = <[char; 3]>::try_from(axes).ok().filter(|_| known);
            self.euler = axes.ok_or_else(|| compiler.wrong(format!("found {order:?} as eulerseq, expected three of xyzXYZ")))?;
        }
        let all = compiler.text("assetdir").map(str::to_string);
        let own = |name: &str| compiler.text(name).map(str::to_string).or_else(|| all.clone());
        self.meshes = own("meshdir").unwrap_or_else(|| std::mem::take(&mut self.meshes));
        self.textures = own("texturedir").unwrap_or_else(|| std::mem::take(&mut self.textures));
        self.strip = compiler.flag("strippath").unwrap_or(self.strip);
        self.auto_limits = compiler.flag("autolimits").unwrap_or(self.auto_limits);
        Ok(())
    }

    fn class(&mut self, default: &Element, parent: &str, outermost: bool) -> Result<(), ImportError> {
        let name = match default.text("class") {
            Some(name) => name.to_string(),
            None if outermost => "main".to_string(),
            None => return Err(default.wrong("a class within another needs a name (class)".into())),
        };
        let inherited = self.classes.get(&name).or_else(|| self.classes.get(parent)).cloned().unwrap_or_default();
        let mut class = inherited;
        for element in default.children.iter().filter(|element| element.tag != "default") {
            let known = class.remove(&element.tag).unwrap_or_default();
            class.insert(element.tag.clone(), merged(&element.attributes, &known));
        }
        self.classes.insert(name.clone(), class);
        default.all("default").try_for_each(|below| self.class(below, &name, false))
    }

    /// An element with the attributes of its class, which is its own, else `inherited` of the bodies around it, else `main`.
    ///
    /// # Errors
    /// When there is no such class.
    pub(super) fn complete(&self, element: &Element, inherited: Option<&str>) -> Result<Element, ImportError> {
        let name = element.text("class").or(inherited).unwrap_or("main");
        let class = self.classes.get(name).ok_or_else(|| element.wrong(format!("there is no default class {name:?}")))?;
        let Some(defaults) = class.get(&element.tag) else { return Ok(element.clone()) };
        let mut complete = element.clone();
        complete.attributes = merged(&element.attributes, defaults);
        Ok(complete)
    }

    /// An angle of the file, radians.
    pub(super) fn radians(&self, angle: f64) -> f64 {
        if self.degrees { angle.to_radians() } else { angle }
    }

    /// The path of a mesh's file.
    pub(super) fn mesh_file(&self, path: &str) -> String {
        self.within(&self.meshes, path)
    }

    /// The path of a picture.
    pub(super) fn texture_file(&self, path: &str) -> String {
        self.within(&self.textures, path)
    }

    fn within(&self, folder: &str, path: &str) -> String {
        let path = path.replace('\\', "/");
        let path = if self.strip { path.rsplit('/').next().unwrap_or_default().to_string() } else { path };
        let folder = folder.replace('\\', "/");
        match folder.trim_end_matches('/') {
            _ if crate::assembly::is_absolute(&path) => path,
            "" if folder.is_empty() => path,
            folder => format!("{folder}/{path}"),
        }
    }

    /// The placement of an element within what it lies in.
    ///
    /// # Errors
    /// When it is not given by finite numbers, or turns by nothing.
    pub(super) fn placement(&self, element: &Element) -> Result<DAffine3, ImportError> {
        let position = element.vector("pos")?.map_or(DVec3::ZERO, DVec3::from_array);
        Ok(DAffine3::from_rotation_translation(self.rotation(element)?, position))
    }

    fn rotation(&self, element: &Element) -> Result<DQuat, ImportError> {
        let none = |attribute: &str| element.wrong(format!("{attribute} has no direction"));
        if let Some([x, y, z, angle]) = element.vector("axisangle")? {
            let axis = DVec3::new(x, y, z).try_normalize().ok_or_else(|| none("axisangle"))?;
            return Ok(DQuat::from_axis_angle(axis, self.radians(angle)));
        }
        if let Some(angles) = element.vector::<3>("euler")? {
            return Ok(self.euler(angles));
        }
        if let Some(axes) = element.vector::<6>("xyaxes")? {
            let x = DVec3::from_slice(&axes).try_normalize().ok_or_else(|| none("xyaxes"))?;
            let y = DVec3::from_slice(&axes[3..]);
            let y = (y - x * x.dot(y)).try_normalize().ok_or_else(|| none("xyaxes"))?;
            return Ok(DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize());
        }
        if let Some(z) = element.vector("zaxis")? {
            return along(DVec3::from_array(z)).ok_or_else(|| none("zaxis"));
        }
        match element.vector::<4>("quat")? {
            Some(q) => quaternion(&q).ok_or_else(|| none("quat")),
            None => Ok(DQuat::IDENTITY),
        }
    }

    /// The rotation of angles in the file's unit about the axes of `eulerseq`: small letters turn along, capitals stay.
    pub(super) fn euler(&self, angles: [f64; 3]) -> DQuat {
        self.euler.iter().zip(angles).fold(DQuat::IDENTITY, |turned, (axis, angle)| {
            let direction = match axis.to_ascii_lowercase() {
                'x' => DVec3::X,
                'y' => DVec3::Y,
                _ => DVec3::Z,
            };
            let next = DQuat::from_axis_angle(direction, self.radians(angle));
            if axis.is_lowercase() { turned * next } else { next * turned }
        })
    }
}

/// The shortest rotation that turns z into a direction; `None` if it has none.
pub(super) fn along(direction: DVec3) -> Option<DQuat> {
    let direction = direction.try_normalize()?;
    let axis = DVec3::Z.cross(direction);
    let sine = axis.length();
    let axis = if sine < 1e-10 { DVec3::X } else { axis / sine };
    Some(DQuat::from_axis_angle(axis, sine.atan2(direction.z)))
}

fn merged(own: &[(String, String)], inherited: &[(String, String)]) -> Vec<(String, String)> {
    let mut all = own.to_vec();
    let turned = own.iter().any(|(name, _)| ROTATIONS.contains(&name.as_str()));
    let left = |name: &str| matches!(name, "class" | "name") || turned && ROTATIONS.contains(&name);
    for (name, value) in inherited.iter().filter(|(name, _)| !left(name)) {
        match all.iter_mut().find(|(known, _)| known == name) {
            None => all.push((name.clone(), value.clone())),
            Some((_, given)) if PARTIAL.contains(&name.as_str()) => {
                let rest = value.split_whitespace().skip(given.split_whitespace().count());
                *given = std::iter::once(given.as_str()).chain(rest).collect::<Vec<_>>().join(" ");
            }
            Some(_) => (),
        }
    }
    all
}
