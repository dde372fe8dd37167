//! Writes a scene of any format as a Mitsuba 3 scene, so that another renderer can load exactly what this one loads:
//! `cargo run -p enfilade-pipeline --example to_mitsuba -- room.gltf FOLDER` makes `FOLDER/exported.xml` with meshes and textures.
//!
//! Both renderers then read that file, so what the conversion loses is lost for both. Placements are applied to the vertices.
//! Materials become ones that both renderers define alike:
//!
//! | here | there |
//! |---|---|
//! | diffuse, conductor, plastic, dielectric, thin dielectric | the same, GGX |
//! | principled, metal (metallic ≥ ½) | `roughconductor`, a mirror (`material` = none) tinted by the base colour |
//! | principled, transmitting (≥ ½) | `dielectric` or `thindielectric` of its index of refraction, untinted |
//! | principled, else | `roughplastic` of its base colour and index of refraction |
//! | masked | thresholded into `mask`; blended: `mask` |
//! | normal map, bump map | the same |
//!
//! Textured roughness, metalness and transmission become their means; clear-coat, sheen, absorption and the sun's disk are dropped;
//! emitters shine on their front. Spots fall off along a line in the angle, and the rows of environment maps move by up to half a row,
//! because Mitsuba's first and last rows are on the poles.

use enfilade_import::{ImportOptions, load};
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, place, srgb_from_linear};
use enfilade_scene::{
    Alpha, Bsdf, ColorParam, Distribution, Environment, Image, Light, Material, NormalMap, Part, Pixels, Principled, Quiet, ScalarParam,
    Scene, TextureRef, Wrap,
};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// GGX roughness below which a surface is written as smooth.
const SMOOTH: f32 = 1e-3;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Runs the instrument.
pub fn run() -> Outcome<()> {
    let arguments: Vec<PathBuf> = crate::arguments::arguments().map(PathBuf::from).collect();
    let [file, folder] = arguments.as_slice() else { return Err("usage: to-mitsuba SCENE FOLDER".into()) };
    let scene = load(file, &ImportOptions::default(), &Quiet)?.scene;
    for name in ["meshes", "textures"] {
        std::fs::create_dir_all(folder.join(name))?;
    }
    let mut writer = Writer { scene: &scene, folder, xml: String::from("<scene version=\"3.0.0\">\n"), textures: 0 };
    writer.camera()?;
    for (index, material) in scene.materials.iter().enumerate() {
        writer.material(index, material)?;
    }
    for (index, part) in scene.parts.iter().enumerate() {
        writer.part(index, part)?;
    }
    scene.lights.iter().try_for_each(|light| writer.light(light))?;
    writer.environment()?;
    writer.xml.push_str("</scene>\n");
    std::fs::write(folder.join("exported.xml"), writer.xml)?;
    Ok(())
}

struct Writer<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    xml: String,
    textures: usize,
}

/// The file has y up, the world z: (x, y, z) → (x, z, −y).
fn file_from_world() -> DMat3 {
    DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y)
}

impl Writer<'_> {
    fn camera(&mut self) -> Outcome<()> {
        let camera = self.scene.cameras.first().ok_or("the scene has no camera")?;
        // Mitsuba looks along +z with x to the left.
        let axes = file_from_world() * camera.world_from_camera * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, -1.0));
        let placement = DAffine3::from_mat3_translation(axes, file_from_world() * camera.position);
        let fov = camera.fov_x_rad.to_degrees();
        writeln!(
            self.xml,
            "<integrator type=\"path\"></integrator>\n<sensor type=\"perspective\">\n\t<float name=\"fov\" value=\"{fov}\"/>"
        )?;
        writeln!(self.xml, "\t<transform name=\"to_world\">{}</transform>", matrix(placement))?;
        writeln!(self.xml, "\t<film type=\"hdrfilm\"></film>\n\t<sampler type=\"independent\"></sampler>\n</sensor>")?;
        Ok(())
    }

    fn light(&mut self, light: &Light) -> Outcome<()> {
        let file = |v: enfilade_math::Vec3| file_from_world() * v.as_dvec3();
        let toward = |from: DVec3, direction: DVec3| {
            let up = direction.any_orthonormal_vector();
            format!("<lookat origin=\"{}\" target=\"{}\" up=\"{}\"/>", triple(from), triple(from + direction), triple(up))
        };
        match light {
            Light::Point { position, intensity, .. } => writeln!(
                self.xml,
                "<emitter type=\"point\"><point name=\"position\" value=\"{}\"/>{}</emitter>",
                triple(file(*position)),
                rgb("intensity", *intensity)
            )?,
            Light::Spot { position, direction, intensity, inner_rad, outer_rad, .. } => writeln!(
                self.xml,
                "<emitter type=\"spot\"><transform name=\"to_world\">{}</transform>{}<float name=\"beam_width\" value=\"{}\"/><float name=\"cutoff_angle\" value=\"{}\"/></emitter>",
                toward(file(*position), file(*direction)),
                rgb("intensity", *intensity),
                inner_rad.to_degrees(),
                outer_rad.to_degrees()
            )?,
            Light::Profile { name, .. } => return Err(format!("light {name}: Mitsuba has no lights with IES profiles").into()),
            Light::Directional { direction, irradiance, .. } => writeln!(
                self.xml,
                "<emitter type=\"directional\"><vector name=\"direction\" value=\"{}\"/>{}</emitter>",
                triple(file(*direction)),
                rgb("irradiance", *irradiance)
            )?,
        }
        Ok(())
    }

    fn environment(&mut self) -> Outcome<()> {
        match &self.scene.environment {
            None => {}
            Some(Environment::Constant { radiance }) => {
                writeln!(self.xml, "<emitter type=\"constant\">{}</emitter>", rgb("radiance", *radiance))?;
            }
            Some(Environment::Map { image, scale, map_from_world, .. }) => {
                let image = &self.scene.images[*image as usize];
                write_exr(&self.folder.join("textures/environment.exr"), image, *scale)?;
                let world_from_map =
                    DMat3::from_cols(map_from_world.row(0).as_dvec3(), map_from_world.row(1).as_dvec3(), map_from_world.row(2).as_dvec3());
                let placement = DAffine3::from_mat3(file_from_world() * world_from_map);
                writeln!(
                    self.xml,
                    "<emitter type=\"envmap\"><string name=\"filename\" value=\"textures/environment.exr\"/><transform name=\"to_world\">{}</transform></emitter>",
                    matrix(placement)
                )?;
            }
        }
        Ok(())
    }

    fn part(&mut self, index: usize, part: &Part) -> Outcome<()> {
        let mesh = &self.scene.meshes[part.mesh as usize];
        let to_file = DAffine3::from_mat3(file_from_world()) * part.world_from_mesh;
        let normal_matrix = to_file.matrix3.inverse().transpose();
        let mut ply = String::from("ply\nformat binary_little_endian 1.0\n");
        writeln!(ply, "element vertex {}", mesh.positions.len())?;
        let mut properties = vec!["x", "y", "z"];
        properties.extend(if mesh.normals.is_empty() { &[][..] } else { &["nx", "ny", "nz"] });
        properties.extend(if mesh.uvs.is_empty() { &[][..] } else { &["u", "v"] });
        properties.iter().try_for_each(|name| writeln!(ply, "property float {name}"))?;
        writeln!(ply, "element face {}\nproperty list uchar int vertex_indices\nend_header", mesh.triangles.len())?;
        let mut bytes = ply.into_bytes();
        let mut put = |v: f32| bytes.extend(v.to_le_bytes());
        for (i, p) in mesh.positions.iter().enumerate() {
            place(&to_file, *p).to_array().into_iter().for_each(&mut put);
            if let Some(n) = mesh.normals.get(i) {
                (normal_matrix * n.as_dvec3()).normalize_or_zero().as_vec3().to_array().into_iter().for_each(&mut put);
            }
            if let Some(uv) = mesh.uvs.get(i) {
                [uv.x, 1.0 - uv.y].into_iter().for_each(&mut put);
            }
        }
        for triangle in &mesh.triangles {
            bytes.push(3);
            triangle.iter().for_each(|i| bytes.extend(i.to_le_bytes()));
        }
        let name = format!("meshes/{index}.ply");
        std::fs::write(self.folder.join(&name), bytes)?;
        writeln!(self.xml, "<shape type=\"ply\"><string name=\"filename\" value=\"{name}\"/>")?;
        if mesh.normals.is_empty() {
            writeln!(self.xml, "\t<boolean name=\"face_normals\" value=\"true\"/>")?;
        }
        let material = &self.scene.materials[part.material as usize];
        if !material.emission.factor.is_black() {
            let radiance = self.color("radiance", &material.emission, true)?;
            writeln!(self.xml, "\t<emitter type=\"area\">{radiance}</emitter>")?;
        }
        writeln!(self.xml, "\t<ref id=\"material{}\"/>\n</shape>", part.material)?;
        Ok(())
    }

    fn material(&mut self, index: usize, material: &Material) -> Outcome<()> {
        let mut bsdf = self.bsdf(&material.bsdf)?;
        if let Some(map) = material.normal_map {
            bsdf = match map {
                NormalMap::Normal { texture, .. } => {
                    let texture = self.texture("normalmap", &texture, Rgb::WHITE, Store::Data)?;
                    format!("<bsdf type=\"normalmap\">{texture}{bsdf}</bsdf>")
                }
                NormalMap::Bump { texture, scale } => {
                    let texture = self.texture("height", &texture, Rgb::WHITE, Store::Data)?;
                    format!("<bsdf type=\"bumpmap\">{texture}<float name=\"scale\" value=\"{scale}\"/>{bsdf}</bsdf>")
                }
            };
        }
        let transmits = bsdf.contains("dielectric\"");
        if material.two_sided && !transmits {
            bsdf = format!("<bsdf type=\"twosided\">{bsdf}</bsdf>");
        }
        let opacity = match &material.alpha {
            Alpha::Opaque => None,
            Alpha::Mask { opacity, cutoff } => Some((opacity, Some(*cutoff))),
            Alpha::Blend { opacity } => Some((opacity, None)),
        };
        if let Some((opacity, cutoff)) = opacity {
            let opacity = match opacity.texture {
                None => {
                    format!("<float name=\"opacity\" value=\"{}\"/>", cutoff.map_or(opacity.factor, |c| f32::from(opacity.factor >= c)))
                }
                Some((texture, channel)) => {
                    self.texture("opacity", &texture, Rgb::WHITE, Store::Opacity(channel, opacity.factor, cutoff))?
                }
            };
            bsdf = format!("<bsdf type=\"mask\">{opacity}{bsdf}</bsdf>");
        }
        let id = format!(" id=\"material{index}\"");
        writeln!(self.xml, "{}", bsdf.replacen("<bsdf", &format!("<bsdf{id}"), 1))?;
        Ok(())
    }

    fn bsdf(&mut self, bsdf: &Bsdf) -> Outcome<String> {
        let rough = |alpha: f32| if alpha > SMOOTH { "rough" } else { "" };
        let facets = |alpha: f32, distribution| match (rough(alpha), distribution) {
            ("", _) => String::new(),
            (_, Distribution::Ggx) => format!("<string name=\"distribution\" value=\"ggx\"/><float name=\"alpha\" value=\"{alpha}\"/>"),
            (_, Distribution::Beckmann) => {
                format!("<string name=\"distribution\" value=\"beckmann\"/><float name=\"alpha\" value=\"{alpha}\"/>")
            }
        };
        let ior = |eta: f32| format!("<float name=\"int_ior\" value=\"{eta}\"/><float name=\"ext_ior\" value=\"1\"/>");
        Ok(match bsdf {
            Bsdf::Diffuse { reflectance } => format!("<bsdf type=\"diffuse\">{}</bsdf>", self.color("reflectance", reflectance, false)?),
            Bsdf::Conductor { eta, k, reflectance, alpha } => {
                let (alpha, distribution) = (self.mean(alpha), alpha.distribution);
                let tint = self.color("specular_reflectance", reflectance, false)?;
                let metal = match *eta == Rgb::BLACK && *k == Rgb::BLACK {
                    true => "<string name=\"material\" value=\"none\"/>".to_string(),
                    false => rgb("eta", *eta) + &rgb("k", *k),
                };
                format!("<bsdf type=\"{}conductor\">{metal}{}{tint}</bsdf>", rough(alpha), facets(alpha, distribution))
            }
            Bsdf::Dielectric { eta, alpha, transmittance, .. } => {
                let (alpha, distribution) = (self.mean(alpha), alpha.distribution);
                let tint = self.color("specular_transmittance", transmittance, false)?;
                format!("<bsdf type=\"{}dielectric\">{}{}{tint}</bsdf>", rough(alpha), ior(*eta), facets(alpha, distribution))
            }
            Bsdf::ThinDielectric { eta, transmittance } => {
                let tint = self.color("specular_transmittance", transmittance, false)?;
                format!("<bsdf type=\"thindielectric\">{}{tint}</bsdf>", ior(*eta))
            }
            Bsdf::Plastic { diffuse, eta, alpha, specular, nonlinear } => {
                let (alpha, distribution) = (self.mean(alpha), alpha.distribution);
                let colors = self.color("diffuse_reflectance", diffuse, false)? + &self.color("specular_reflectance", specular, false)?;
                let nonlinear = format!("<boolean name=\"nonlinear\" value=\"{nonlinear}\"/>");
                format!("<bsdf type=\"{}plastic\">{}{}{colors}{nonlinear}</bsdf>", rough(alpha), ior(*eta), facets(alpha, distribution))
            }
            Bsdf::Principled(p) => self.principled(p)?,
            // Models that Mitsuba shares no definition of.
            other => return Err(format!("no counterpart in Mitsuba for {other:?}").into()),
        })
    }

    fn principled(&mut self, p: &Principled) -> Outcome<String> {
        let alpha = self.mean(&p.roughness).powi(2);
        if self.mean(&p.metallic) >= 0.5 {
            let (eta, k) = (Rgb::BLACK, Rgb::BLACK);
            return self.bsdf(&Bsdf::Conductor { eta, k, reflectance: p.base_color, alpha: alpha.into() });
        }
        if self.mean(&p.transmission) >= 0.5 {
            let transmittance = Rgb::WHITE.into();
            return self.bsdf(&match p.solid {
                true => Bsdf::Dielectric { eta: p.ior, alpha: 0.0.into(), transmittance, absorption: Rgb::BLACK },
                false => Bsdf::ThinDielectric { eta: p.ior, transmittance },
            });
        }
        let (diffuse, specular) = (p.base_color, Rgb::WHITE.into());
        self.bsdf(&Bsdf::Plastic { diffuse, eta: p.ior.max(1.01), alpha: alpha.into(), specular, nonlinear: false })
    }

    /// A number's mean over its texture.
    fn mean(&self, p: &ScalarParam) -> f32 {
        let Some((texture, channel)) = p.texture else { return p.factor };
        let image = &self.scene.images[texture.image as usize];
        let all = (0..image.height as usize).flat_map(|y| (0..image.width as usize).map(move |x| (x, y)));
        let sum: f64 = all.map(|(x, y)| f64::from(channel_of(image.texel(x, y), channel))).sum();
        p.factor * (sum / (f64::from(image.width) * f64::from(image.height))) as f32
    }

    fn color(&mut self, name: &str, p: &ColorParam, emitted: bool) -> Outcome<String> {
        match p.texture {
            None => Ok(rgb(name, p.factor)),
            Some(texture) => self.texture(name, &texture, p.factor, if emitted { Store::Radiance } else { Store::Reflectance }),
        }
    }

    /// A bitmap element; the picture, multiplied by `factor`, goes into a file of its own.
    fn texture(&mut self, name: &str, texture: &TextureRef, factor: Rgb, store: Store) -> Outcome<String> {
        let image = &self.scene.images[texture.image as usize];
        self.textures += 1;
        let float = matches!(store, Store::Radiance) || matches!(image.pixels, Pixels::RgbF32(_));
        let file = format!("textures/{}.{}", self.textures, if float { "exr" } else { "png" });
        let path = self.folder.join(&file);
        match store {
            _ if float => write_exr(&path, image, factor)?,
            Store::Reflectance => write_png(&path, image, |(c, _)| (c * factor).map(|v| srgb_from_linear(v.clamp(0.0, 1.0))))?,
            Store::Opacity(channel, factor, cutoff) => write_png(&path, image, |texel| {
                let opacity = channel_of(texel, channel) * factor;
                Rgb::splat(cutoff.map_or(opacity, |c| f32::from(opacity >= c)))
            })?,
            Store::Data | Store::Radiance => write_png(&path, image, |(c, _)| c)?,
        }
        // Mitsuba's v points down: v' = 1 − v on both sides of the transform.
        let [[a, b, tu], [c, d, tv]] = texture.uv_transform;
        let rows = [a, -b, b + tu, -c, d, 1.0 - d - tv, 0.0, 0.0, 1.0].map(|v| v.to_string()).join(" ");
        let raw = float || !matches!(store, Store::Reflectance);
        let wrap = match texture.wrap[0] {
            Wrap::Repeat => "repeat",
            Wrap::Clamp => "clamp",
            Wrap::Mirror => "mirror",
        };
        Ok(format!(
            "<texture type=\"bitmap\" name=\"{name}\"><string name=\"filename\" value=\"{file}\"/><boolean name=\"raw\" value=\"{raw}\"/><string name=\"wrap_mode\" value=\"{wrap}\"/><transform name=\"to_uv\"><matrix value=\"{rows}\"/></transform></texture>"
        ))
    }
}

/// The use of a picture, which determines how it is stored.
enum Store {
    Reflectance,
    Radiance,
    Data,
    /// Channel, factor and threshold.
    Opacity(u8, f32, Option<f32>),
}

fn channel_of((color, alpha): (Rgb, f32), channel: u8) -> f32 {
    if channel == 3 { alpha } else { color[usize::from(channel)] }
}

fn write_png(path: &Path, image: &Image, code: impl Fn((Rgb, f32)) -> Rgb) -> Outcome<()> {
    let picture = image::RgbImage::from_fn(image.width, image.height, |x, y| {
        let c = code(image.texel(x as usize, y as usize));
        image::Rgb([c.r, c.g, c.b].map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8))
    });
    Ok(picture.save(path)?)
}

fn write_exr(path: &Path, image: &Image, factor: Rgb) -> Outcome<()> {
    let texel = |x: usize, y: usize| {
        let c = image.texel(x, y).0 * factor;
        (c.r, c.g, c.b)
    };
    Ok(exr::prelude::write_rgb_file(path, image.width as usize, image.height as usize, texel)?)
}

fn rgb(name: &str, c: Rgb) -> String {
    format!("<rgb name=\"{name}\" value=\"{} {} {}\"/>", c.r, c.g, c.b)
}

fn triple(v: DVec3) -> String {
    format!("{}, {}, {}", v.x, v.y, v.z)
}

fn matrix(m: DAffine3) -> String {
    let (c, t) = (m.matrix3, m.translation);
    let row = |i: usize| format!("{} {} {} {}", c.x_axis[i], c.y_axis[i], c.z_axis[i], t[i]);
    format!("<matrix value=\"{} {} {} 0 0 0 1\"/>", row(0), row(1), row(2))
}
