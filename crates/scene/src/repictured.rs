//! Renumbers the pictures that a material refers to, for a list in which they have other places.

use crate::{Alpha, Bsdf, ColorParam, Material, NormalMap, ScalarParam, TextureRef};

impl Material {
    /// The material with picture number k of a list at `place(k)` of another.
    #[must_use]
    pub fn repictured(mut self, place: impl Fn(u32) -> u32) -> Self {
        let mut shift = |t: &mut TextureRef| t.image = place(t.image);
        of_bsdf(&mut self.bsdf, &mut shift);
        of_color(&mut self.emission, &mut shift);
        if let Alpha::Mask { opacity, .. } | Alpha::Blend { opacity } = &mut self.alpha {
            of_scalar(opacity, &mut shift);
        }
        if let Some(NormalMap::Normal { texture, .. } | NormalMap::Bump { texture, .. }) = &mut self.normal_map {
            shift(texture);
        }
        self
    }
}

fn of_color(p: &mut ColorParam, found: &mut dyn FnMut(&mut TextureRef)) {
    p.texture.iter_mut().for_each(found);
}

fn of_scalar(p: &mut ScalarParam, found: &mut dyn FnMut(&mut TextureRef)) {
    p.texture.iter_mut().for_each(|(t, _)| found(t));
}

fn of_bsdf(bsdf: &mut Bsdf, found: &mut dyn FnMut(&mut TextureRef)) {
    match bsdf {
        Bsdf::Diffuse { reflectance } => of_color(reflectance, found),
        Bsdf::RoughDiffuse { reflectance, roughness } => {
            of_color(reflectance, found);
            of_scalar(roughness, found);
        }
        Bsdf::Conductor { reflectance, alpha, .. } => {
            of_color(reflectance, found);
            of_scalar(alpha, found);
        }
        Bsdf::Dielectric { transmittance, alpha, .. } => {
            of_color(transmittance, found);
            of_scalar(alpha, found);
        }
        Bsdf::ThinDielectric { transmittance, .. } => of_color(transmittance, found),
        Bsdf::Plastic { diffuse, specular, alpha, .. } => {
            of_color(diffuse, found);
            of_color(specular, found);
            of_scalar(alpha, found);
        }
        Bsdf::Blend { first, second, weight } => {
            of_scalar(weight, found);
            of_bsdf(first, found);
            of_bsdf(second, found);
        }
        Bsdf::Disney(p) => {
            of_color(&mut p.base_color, found);
            p.scalars_mut().into_iter().for_each(|scalar| of_scalar(scalar, found));
        }
        Bsdf::Principled(p) => {
            for color in [&mut p.base_color, &mut p.specular_color, &mut p.sheen_color] {
                of_color(color, found);
            }
            let scalars = [&mut p.metallic, &mut p.roughness, &mut p.specular, &mut p.transmission, &mut p.clearcoat];
            for scalar in scalars.into_iter().chain([&mut p.clearcoat_roughness, &mut p.sheen_roughness]) {
                of_scalar(scalar, found);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Principled;
    use enfilade_math::Rgb;

    #[test]
    fn every_picture_of_a_material_moves() {
        let color = |image| ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(image)) };
        let scalar = |image| ScalarParam { factor: 1.0, texture: Some((TextureRef::new(image), 1)) };
        let principled = Principled {
            base_color: color(0),
            specular_color: color(1),
            sheen_color: color(2),
            metallic: scalar(3),
            roughness: scalar(4),
            specular: scalar(5),
            transmission: scalar(6),
            clearcoat: scalar(7),
            clearcoat_roughness: scalar(8),
            sheen_roughness: scalar(9),
            ..Principled::default()
        };
        let plastic = Bsdf::Plastic { diffuse: color(10), eta: 1.5, alpha: scalar(11).into(), specular: color(12), nonlinear: false };
        let both = Bsdf::Blend { first: Box::new(Bsdf::Principled(Box::new(principled))), second: Box::new(plastic), weight: scalar(13) };
        let material = Material {
            emission: color(14),
            alpha: Alpha::Blend { opacity: scalar(15) },
            normal_map: Some(NormalMap::Bump { texture: TextureRef::new(16), scale: 0.01 }),
            ..Material::new("m", both)
        };
        let mut seen = Vec::new();
        material.repictured(|k| k + 100).textures(|t| seen.push(t.image));
        seen.sort_unstable();
        assert_eq!(seen, (100..117).collect::<Vec<u32>>());
    }
}
