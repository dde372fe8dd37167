//! Materials as glTF's metallic-roughness with extensions.
//!
//! | ours | glTF |
//! |---|---|
//! | diffuse, rough diffuse | no specular reflection (`KHR_materials_specular` 0); roughness of the body is lost |
//! | plastic | dielectric of the coat's index of refraction; roughness √α |
//! | Beckmann's facets | GGX of the same α |
//! | conductor | metal whose colour is the reflectance at normal incidence, ((η−1)² + k²) / ((η+1)² + k²) |
//! | solid glass | transmission with volume: index of refraction and Beer's law as they are |
//! | pane | transmission without volume |
//! | Disney's model | metallic-roughness of the same parameters, with the nearest sheen and coat |
//! | blend | the heavier of the two |
//! | height map | normal map, by the mean size of texture coordinates on the parts that have the material |

use super::document::{Document, TextureUse};
use super::picture::{computed, reference};
use enfilade_math::Rgb;
use enfilade_scene::{
    Alpha, Bsdf, ColorParam, Distribution, Material, NormalMap, Principled, Roughness, ScalarParam, Scene, TextureRef, Wrap,
};
use serde_json::{Map, Value, json};

/// Distance at which glTF states the colour that absorption leaves.
const ATTENUATION_M: f32 = 0.1;

/// Adds every material of the scene, under the same index.
pub(super) fn add_all(document: &mut Document, scene: &Scene) {
    for (index, material) in scene.materials.iter().enumerate() {
        let user = format!("material {:?}", material.name);
        let json = Writer { document, scene, user }.material(index as u32, material);
        document.materials.push(json);
    }
}

struct Writer<'d, 'f, 's> {
    document: &'d mut Document<'f>,
    scene: &'s Scene,
    user: String,
}

/// The values under `pbrMetallicRoughness` and `extensions`.
#[derive(Default)]
struct Body {
    pbr: Map<String, Value>,
    extensions: Map<String, Value>,
}

impl Writer<'_, '_, '_> {
    fn material(&mut self, index: u32, material: &Material) -> Value {
        let (principled, roughness_is_alpha) = self.nearest(&material.bsdf);
        let emits = !material.emission.factor.is_black();
        // A solid body is entered and left through fronts and backs alike; the specification wants it single-sided.
        let double_sided = if emits { material.emits_both_sides } else { material.two_sided && !principled.solid };
        let mut json = json!({ "name": material.name, "doubleSided": double_sided });
        let mut body = self.body(&principled, roughness_is_alpha);
        self.alpha(&mut json, &mut body, material, &principled);
        if emits {
            self.emission(&mut json, &mut body, &material.emission);
        }
        if let Some(map) = &material.normal_map {
            json["normalTexture"] = self.normal_map(index, map);
        }
        json["pbrMetallicRoughness"] = body.pbr.into();
        if !body.extensions.is_empty() {
            json["extensions"] = body.extensions.into();
        }
        json
    }

    /// The nearest thing that glTF has, and whether its roughness is α still instead of α's root.
    fn nearest(&mut self, bsdf: &Bsdf) -> (Principled, bool) {
        match bsdf {
            Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } => {
                (Principled { base_color: *reflectance, specular: 0.0.into(), ..Principled::default() }, false)
            }
            Bsdf::Conductor { eta, k, reflectance, alpha } => {
                self.facets(alpha);
                let at_normal = |n: f32, k: f32| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
                let normal = Rgb::new(at_normal(eta.r, k.r), at_normal(eta.g, k.g), at_normal(eta.b, k.b));
                let base_color = ColorParam { factor: reflectance.factor * normal, texture: reflectance.texture };
                (Principled { base_color, metallic: 1.0.into(), roughness: alpha.param, ..Principled::default() }, true)
            }
            Bsdf::Dielectric { eta, alpha, transmittance, absorption } => {
                self.facets(alpha);
                let (base_color, transmission, absorption) = (*transmittance, 1.0.into(), *absorption);
                let glass = Principled {
                    base_color,
                    roughness: alpha.param,
                    ior: *eta,
                    transmission,
                    solid: true,
                    absorption,
                    ..Principled::default()
                };
                (glass, true)
            }
            Bsdf::ThinDielectric { eta, transmittance } => {
                let transmission = 1.0.into();
                (Principled { base_color: *transmittance, roughness: 0.0.into(), ior: *eta, transmission, ..Principled::default() }, true)
            }
            Bsdf::Plastic { diffuse, eta, alpha, specular, .. } => {
                self.facets(alpha);
                let (base_color, roughness, specular_color) = (*diffuse, alpha.param, *specular);
                (Principled { base_color, roughness, ior: *eta, specular_color, ..Principled::default() }, true)
            }
            Bsdf::Principled(principled) => ((**principled).clone(), false),
            Bsdf::Disney(p) => {
                self.note("glTF has no model of Disney's; metallic-roughness of the same parameters was written");
                let sheen_color = (Rgb::WHITE * p.sheen.factor.max(0.0)).into();
                let nearest = Principled {
                    base_color: p.base_color,
                    metallic: if p.thin { 0.0.into() } else { p.metallic },
                    roughness: p.roughness,
                    ior: p.eta.max(1.0),
                    transmission: p.spec_trans,
                    solid: !p.thin,
                    // The coat has a quarter of a dielectric's strength.
                    clearcoat: ScalarParam { factor: 0.25 * p.clearcoat.factor, ..p.clearcoat },
                    clearcoat_roughness: (0.1 + (0.001 - 0.1) * p.clearcoat_gloss.factor).max(0.0).sqrt().into(),
                    sheen_color,
                    sheen_roughness: 0.5.into(),
                    ..Principled::default()
                };
                (nearest, false)
            }
            Bsdf::Blend { first, second, weight } => {
                self.note("glTF cannot blend two surfaces; the heavier one was written");
                self.nearest(if weight.factor < 0.5 { first } else { second })
            }
        }
    }

    /// glTF has GGX alone.
    fn facets(&mut self, alpha: &Roughness) {
        if alpha.distribution == Distribution::Beckmann {
            self.note("glTF has no facets of Beckmann's; GGX of the same alpha was written");
        }
    }

    fn body(&mut self, p: &Principled, roughness_is_alpha: bool) -> Body {
        let mut body = Body::default();
        let [r, g, b] = p.base_color.factor.to_array().map(|v| v.clamp(0.0, 1.0));
        body.pbr.insert("baseColorFactor".into(), json!([r, g, b, 1.0]));
        if let Some(texture) = &p.base_color.texture {
            body.pbr.insert("baseColorTexture".into(), self.texture(texture, TextureUse::Color));
        }
        self.roughness(&mut body, p, roughness_is_alpha);
        self.dielectric(&mut body, p);
        self.layers(&mut body, p);
        body
    }

    /// Roughness is read from green, metalness from blue, of one texture.
    fn roughness(&mut self, body: &mut Body, p: &Principled, is_alpha: bool) {
        let mut roughness = p.roughness.factor.clamp(0.0, 1.0);
        if is_alpha {
            // A map already contains the roots, with the factor in them.
            roughness = if p.roughness.texture.is_some() { 1.0 } else { roughness.sqrt() };
        }
        body.pbr.insert("metallicFactor".into(), json!(p.metallic.factor.clamp(0.0, 1.0)));
        body.pbr.insert("roughnessFactor".into(), json!(roughness));
        if let Some((texture, _)) = p.roughness.texture.or(p.metallic.texture) {
            let in_place = |param: &ScalarParam, channel: u8| param.texture == Some((texture, channel));
            let map = if !is_alpha && in_place(&p.roughness, 1) && in_place(&p.metallic, 2) {
                self.texture(&texture, TextureUse::Data)
            } else {
                self.roughness_map(&texture, p, is_alpha)
            };
            body.pbr.insert("metallicRoughnessTexture".into(), map);
        }
    }

    /// Puts the values read from the picture of `texture` into the channels that glTF reads; one in channels without a value.
    fn roughness_map(&mut self, texture: &TextureRef, p: &Principled, is_alpha: bool) -> Value {
        let channel = |param: &ScalarParam| param.texture.filter(|(t, _)| t.image == texture.image).map(|(_, channel)| channel);
        let (roughness, metallic) = (channel(&p.roughness), channel(&p.metallic));
        if p.metallic.texture.is_some() && metallic.is_none() {
            self.note("roughness and metalness come from two pictures; glTF has one, so the metalness is its factor");
        }
        let image = &self.scene.images[texture.image as usize];
        let name = format!("{} (roughness of {})", image.name, self.user);
        computed(self.document, self.scene, texture, &name, |x, y| {
            let (rgb, alpha) = image.texel(x, y);
            let value = |channel: Option<u8>| channel.map_or(1.0, |c| [rgb.r, rgb.g, rgb.b, alpha][usize::from(c)]);
            let read = value(roughness);
            let green = if is_alpha && roughness.is_some() { (read * p.roughness.factor).clamp(0.0, 1.0).sqrt() } else { read };
            [0.0, green, value(metallic)].map(byte)
        })
    }

    /// Index of refraction, specular strength, transmission, volume.
    fn dielectric(&mut self, body: &mut Body, p: &Principled) {
        if p.ior != 1.5 {
            self.extend(body, "KHR_materials_ior", json!({ "ior": p.ior }));
        }
        let plain = |param: &ColorParam, factor: Rgb| param.factor == factor && param.texture.is_none();
        if p.specular.factor != 1.0 || p.specular.texture.is_some() || !plain(&p.specular_color, Rgb::WHITE) {
            let mut specular = json!({ "specularFactor": p.specular.factor, "specularColorFactor": p.specular_color.factor.to_array() });
            self.scalar_texture(&mut specular, "specularTexture", &p.specular, 3);
            if let Some(texture) = &p.specular_color.texture {
                specular["specularColorTexture"] = self.texture(texture, TextureUse::Color);
            }
            self.extend(body, "KHR_materials_specular", specular);
        }
        if p.transmission.factor > 0.0 {
            let mut transmission = json!({ "transmissionFactor": p.transmission.factor });
            self.scalar_texture(&mut transmission, "transmissionTexture", &p.transmission, 0);
            self.extend(body, "KHR_materials_transmission", transmission);
            if p.solid {
                let left = p.absorption.map(|a| (-a * ATTENUATION_M).exp());
                let mut volume = json!({ "thicknessFactor": 1.0 });
                if !p.absorption.is_black() {
                    volume["attenuationDistance"] = json!(ATTENUATION_M);
                    volume["attenuationColor"] = json!(left.to_array());
                }
                self.extend(body, "KHR_materials_volume", volume);
            }
        }
    }

    /// Clear coat and sheen.
    fn layers(&mut self, body: &mut Body, p: &Principled) {
        if p.clearcoat.factor > 0.0 {
            let mut coat = json!({ "clearcoatFactor": p.clearcoat.factor, "clearcoatRoughnessFactor": p.clearcoat_roughness.factor });
            self.scalar_texture(&mut coat, "clearcoatTexture", &p.clearcoat, 0);
            self.scalar_texture(&mut coat, "clearcoatRoughnessTexture", &p.clearcoat_roughness, 1);
            self.extend(body, "KHR_materials_clearcoat", coat);
        }
        if !p.sheen_color.factor.is_black() {
            let mut sheen =
                json!({ "sheenColorFactor": p.sheen_color.factor.to_array(), "sheenRoughnessFactor": p.sheen_roughness.factor });
            if let Some(texture) = &p.sheen_color.texture {
                sheen["sheenColorTexture"] = self.texture(texture, TextureUse::Color);
            }
            self.scalar_texture(&mut sheen, "sheenRoughnessTexture", &p.sheen_roughness, 3);
            self.extend(body, "KHR_materials_sheen", sheen);
        }
    }

    fn alpha(&mut self, json: &mut Value, body: &mut Body, material: &Material, p: &Principled) {
        let (mode, opacity) = match &material.alpha {
            Alpha::Opaque => return,
            Alpha::Mask { opacity, cutoff } => {
                json["alphaCutoff"] = json!(cutoff);
                ("MASK", opacity)
            }
            Alpha::Blend { opacity } => ("BLEND", opacity),
        };
        json["alphaMode"] = json!(mode);
        body.pbr["baseColorFactor"][3] = json!(opacity.factor.clamp(0.0, 1.0));
        let in_base_color = opacity.texture.is_none_or(|(texture, channel)| channel == 3 && p.base_color.texture == Some(texture));
        if !in_base_color {
            self.note("its opacity comes from a picture of its own, which glTF cannot say; only the factor was written");
        }
    }

    fn emission(&mut self, json: &mut Value, body: &mut Body, emission: &ColorParam) {
        let strength = emission.factor.max_component();
        json["emissiveFactor"] = json!((emission.factor / strength).to_array());
        if let Some(texture) = &emission.texture {
            json["emissiveTexture"] = self.texture(texture, TextureUse::Color);
        }
        self.extend(body, "KHR_materials_emissive_strength", json!({ "emissiveStrength": strength }));
    }

    fn normal_map(&mut self, material: u32, map: &NormalMap) -> Value {
        match map {
            NormalMap::Normal { texture, scale } => {
                let mut json = self.texture(texture, TextureUse::Data);
                json["scale"] = json!(scale);
                json
            }
            NormalMap::Bump { texture, scale } => {
                let image = &self.scene.images[texture.image as usize];
                let meters = meters_per_texture_unit(self.scene, material);
                let [[a, b, _], [d, e, _]] = texture.uv_transform;
                // Texels per metre along u and v.
                let density = [a.hypot(d) * image.width as f32 / meters, b.hypot(e) * image.height as f32 / meters];
                let at = |x: i64, y: i64| {
                    let index = |wrap: Wrap, i: i64, n: u32| match wrap {
                        Wrap::Clamp => i.clamp(0, i64::from(n) - 1),
                        Wrap::Repeat | Wrap::Mirror => i.rem_euclid(i64::from(n)),
                    } as usize;
                    scale * image.texel(index(texture.wrap[0], x, image.width), index(texture.wrap[1], y, image.height)).0.luminance()
                };
                let name = format!("{} (normals of {})", image.name, self.user);
                computed(self.document, self.scene, texture, &name, |x, y| {
                    let (x, y) = (x as i64, y as i64);
                    // Rows count downward, v upward.
                    let du = 0.5 * (at(x + 1, y) - at(x - 1, y)) * density[0];
                    let dv = 0.5 * (at(x, y - 1) - at(x, y + 1)) * density[1];
                    let length = (du * du + dv * dv + 1.0).sqrt();
                    [-du / length, -dv / length, 1.0 / length].map(|n| byte(0.5 + 0.5 * n))
                })
            }
        }
    }

    fn texture(&mut self, texture: &TextureRef, usage: TextureUse) -> Value {
        reference(self.document, self.scene, texture, usage, &self.user)
    }

    /// The texture of a number, which glTF reads from one certain channel.
    fn scalar_texture(&mut self, json: &mut Value, key: &str, param: &ScalarParam, channel: u8) {
        match &param.texture {
            Some((texture, c)) if *c == channel => json[key] = self.texture(texture, TextureUse::Data),
            Some((_, c)) => self.note(&format!("{key} is read from channel {channel} in glTF and comes from channel {c}; it was left out")),
            None => {}
        }
    }

    fn extend(&mut self, body: &mut Body, name: &'static str, value: Value) {
        body.extensions.insert(name.into(), value);
        self.document.extensions.insert(name);
    }

    fn note(&mut self, what: &str) {
        self.document.notes.push(format!("{}: {what}", self.user));
    }
}

fn byte(v: f32) -> u8 {
    (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// Metres that one unit of texture coordinates covers on the parts of a material: the root of their area in metres over their area in
/// texture coordinates. One where there is nothing to measure.
fn meters_per_texture_unit(scene: &Scene, material: u32) -> f32 {
    let (mut world, mut plane) = (0.0, 0.0);
    for part in scene.parts.iter().filter(|part| part.material == material) {
        let mesh = &scene.meshes[part.mesh as usize];
        if mesh.uvs.is_empty() {
            continue;
        }
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let [p, q, r] = scene.world_corners(part, t);
            let [a, b, c] = triangle.map(|i| mesh.uvs[i as usize]);
            world += f64::from(0.5 * (q - p).cross(r - p).length());
            plane += f64::from(0.5 * (b - a).perp_dot(c - a).abs());
        }
    }
    if plane > 0.0 { (world / plane).sqrt() as f32 } else { 1.0 }
}
