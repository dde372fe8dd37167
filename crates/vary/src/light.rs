//! The light of a variation: which lamps are lit, how bright and of what colour, and the sun and sky of another moment.
//!
//! Light is reckoned in kilo-candela per square metre. For homes the first scene's exposure says what a radiance of one is. A file's units
//! have no such meaning: the daylight that falls into its room is taken for that of a usual day ([`DAY_KLX`]), and where none does, its
//! lamps for those of a home. A new sky brings a new exposure, as a camera chooses one, so that walls keep their brightness.

use crate::config::{LampVary, SkyVary};
use crate::draw::{chance, log_uniform, reciprocal_uniform, uniform};
use crate::first::{First, Seeds};
use crate::repaint::{Paint, repaint};
use crate::sources::{Glowing, Lamp, flux, glow_of_parts, lamps, tinted};
use crate::survey::Survey;
use enfilade_dataset::{Variation, VariedLamp, VariedSky};
use enfilade_furniture::{Exposure, Glow};
use enfilade_home::light::{LightConfig, Moment};
use enfilade_math::{Rgb, Rng, Vec2};
use enfilade_scene::{Cx, Environment, LabelledScene, Light, PartId, Scene, Warning};
use std::collections::BTreeMap;

/// Illuminance in a room by the daylight of a usual day, kilo-lux: 2.5 % of a clear sky's, and some sun.
const DAY_KLX: f32 = 0.6;
/// Illuminance by all lamps of a home, kilo-lux.
const LAMPS_KLX: f32 = 0.09;
/// Share of the lamps that have a colour of their own.
const ODD_LAMPS: f64 = 0.2;
/// With a smaller share of the rays that leave a room it is closed but for cracks.
const OPEN_SHARE: f32 = 1e-3;
/// Directions whose sky gives daylight its colour.
const SKY_DIRECTIONS: u32 = 64;

/// How much one unit of the first scene's light is, and what its lamps give.
struct Measure {
    /// Balance and level of the first scene.
    exposure: Exposure,
    /// Illuminance by daylight in the first scene, kilo-lux, where surfaces stand for it.
    day_klx: f32,
    /// Share of [`LAMPS_KLX`] that a kilo-lumen of its lamps gives.
    lamps_per_klm: f32,
}

/// Lights `scene` anew.
pub fn light(
    scene: &mut LabelledScene,
    first: &First,
    kinds: (Option<&LampVary>, Option<&SkyVary>),
    seeds: &Seeds,
    record: &mut Variation,
    cx: &dyn Cx,
) {
    let glow = glow_of_parts(scene, kinds.1.and_then(|sky| sky.daylight.as_deref()));
    let found = lamps(scene, &glow);
    let warn = |message: String| cx.warn(Warning { place: first.name.into(), message });
    let survey = (first.home.is_none() && kinds.1.is_some()).then(|| Survey::of(&scene.scene, &glow));
    let sky = kinds.1.filter(|_| match &survey {
        Some(survey) if survey.open_share < OPEN_SHARE && survey.daylight == 0.0 => {
            warn("no daylight comes into it, so `sky` of [vary] changes nothing".into());
            false
        }
        _ => true,
    });
    let lamp = kinds.0.filter(|_| {
        if found.is_empty() {
            warn("it has no lamps, so `lamps` of [vary] changes nothing; lamps = \"ceiling\" of the scene hangs some".into());
        }
        !found.is_empty()
    });
    if let Some(sky) = sky {
        tell_guess(scene, sky, &glow, &warn);
    }
    let measure = Measure::of(scene, first, survey.as_ref(), &found);
    let moment = sky.map(|sky| drawn_sky(sky, first, survey.as_ref(), !found.is_empty(), seeds, &warn));
    record.sky = moment.as_ref().map(described);
    let is_dark = moment.is_some_and(|light| light.to_sun().z < 0.0);
    let fluxes: Vec<f32> = found.iter().map(|lamp| flux(&scene.scene, lamp, &|light| measure.exposure.measure(light))).collect();
    record.lamps = lamp.map_or_else(Vec::new, |lamp| drawn_lamps(lamp, &found, &fluxes, is_dark, &mut Rng::new(seeds.light).fork(2)));
    // The exposure that shows walls as bright as before.
    let exposure = moment.map_or(measure.exposure, |light| {
        let klm: f32 = if record.lamps.is_empty() {
            fluxes.iter().zip(&found).filter(|(_, lamp)| is_lit(&scene.scene, lamp)).map(|(flux, _)| flux).sum()
        } else {
            fluxes.iter().zip(&record.lamps).filter(|(_, lamp)| lamp.lit).map(|(flux, lamp)| flux * lamp.power as f32).sum()
        };
        let weather = light.weather();
        Exposure::of(weather.sky_klx(), weather.sun_klx(), klm * measure.lamps_per_klm)
    });
    shine(scene, &glow, &found, &record.lamps, &Change { measure: &measure, exposure, light: moment });
    // Around a closed room a sky would only cost samples.
    let is_closed = survey.is_some_and(|survey| survey.open_share < OPEN_SHARE);
    if let Some(light) = moment.filter(|_| !is_closed) {
        let outward = first.home.as_ref().map_or(&[][..], |home| &home.outward);
        replace_sky(&mut scene.scene, &light, outward, exposure);
    }
}

/// Says which surfaces were taken for windows without a class that says so.
fn tell_guess(scene: &LabelledScene, sky: &SkyVary, glow: &[Glowing], warn: &dyn Fn(String)) {
    let is_guessed = |part: &usize| glow[*part] == Glowing::Daylight && scene.labels.parts[*part].semantic < 1;
    let guessed: Vec<&str> = (0..glow.len()).filter(is_guessed).map(|part| scene.scene.parts[part].name.as_str()).collect();
    if sky.daylight.is_none() && !guessed.is_empty() {
        warn(format!(
            "{} glow upright and have no class, and were taken for daylight: sky = {{ daylight = [\"NAME*\"] }} of [vary] says what is",
            guessed.join(", ")
        ));
    }
}

impl Measure {
    fn of(scene: &LabelledScene, first: &First, survey: Option<&Survey>, lamps: &[Lamp]) -> Self {
        if let Some(home) = &first.home {
            let all: f32 = lamps.iter().map(|lamp| flux(&scene.scene, lamp, &|light| light)).sum();
            return Self { exposure: home.light.exposure(), day_klx: DAY_KLX, lamps_per_klm: 1.0 / all.max(1e-6) };
        }
        let survey = survey.copied().unwrap_or_default();
        let per_kcd = match survey {
            Survey { daylight, .. } if daylight > 0.0 => daylight / DAY_KLX,
            Survey { lamps, .. } if lamps > 0.0 => lamps / LAMPS_KLX,
            _ => 1.0,
        };
        let exposure = Exposure::new(per_kcd);
        let lit: f32 = lamps.iter().map(|lamp| flux(&scene.scene, lamp, &|light| exposure.measure(light))).sum();
        let lamps_klx = survey.lamps / per_kcd;
        Self { exposure, day_klx: DAY_KLX, lamps_per_klm: if lit > 0.0 { lamps_klx / LAMPS_KLX / lit } else { 0.0 } }
    }
}

/// The moment of a variation. Place, bearing and surroundings are the room's, whatever the variation.
fn drawn_sky(sky: &SkyVary, first: &First, survey: Option<&Survey>, has_lamps: bool, seeds: &Seeds, warn: &dyn Fn(String)) -> LightConfig {
    let place = first.home.as_ref().map_or_else(
        || {
            let rng = Rng::new(seeds.place);
            let outward = survey.and_then(|survey| survey.outward).unwrap_or(Vec2::NEG_Y);
            let noon = LightConfig { day_of_year: 80, hour: 13.0, ..LightConfig::random(Moment::Day, &mut rng.fork(1)) };
            noon.facing_sun(outward, rng.fork(2).next_f32())
        },
        |home| home.light,
    );
    let place = LightConfig { outside: sky.outside.unwrap_or(place.outside), ..place };
    let mut moments = sky.moments.clone();
    if !has_lamps {
        moments.retain(|moment| *moment == Moment::Day);
        if moments.len() < sky.moments.len() {
            warn("it has no lamps, so `sky` of [vary] leaves out evenings and nights".into());
        }
        if moments.is_empty() {
            moments.push(Moment::Day);
        }
    }
    let mut rng = Rng::new(seeds.light).fork(1);
    let moment = moments[rng.below(moments.len())];
    let drawn = place.at(moment, &mut rng.fork(1));
    let between = |[low, high]: [f64; 2], share: f32| low as f32 + (high - low) as f32 * share;
    LightConfig { cloud: between(sky.cloud, drawn.cloud), turbidity: uniform(&mut rng.fork(2), sky.turbidity) as f32, ..drawn }
}

fn described(light: &LightConfig) -> VariedSky {
    let elevation = light.to_sun().z.clamp(-1.0, 1.0).asin().to_degrees();
    let moment = match elevation {
        e if e > 0.0 => Moment::Day,
        e if e > -9.0 => Moment::Evening,
        _ => Moment::Night,
    };
    VariedSky {
        moment: moment.name().into(),
        latitude_deg: light.latitude_deg,
        day_of_year: light.day_of_year,
        hour: light.hour,
        sun_elevation_deg: elevation,
        cloud: light.cloud,
        turbidity: light.turbidity,
        outside: light.outside.name().into(),
    }
}

/// The state of every lamp. Where it is dark, the strongest is lit in any case.
fn drawn_lamps(config: &LampVary, found: &[Lamp], fluxes: &[f32], is_dark: bool, rng: &mut Rng) -> Vec<VariedLamp> {
    let [low, high] = config.lit;
    let share = uniform(rng, if is_dark { [0.5 * (low + high), high] } else { [low, high] });
    let usual = reciprocal_uniform(rng, config.kelvin);
    let strongest = (0..found.len()).max_by(|a, b| fluxes[*a].total_cmp(&fluxes[*b]).then(b.cmp(a)));
    let lamp = |(index, lamp): (usize, &Lamp)| {
        // Each lamp has digits of its own, whatever the others are.
        let rng = &mut rng.fork(index as u64);
        let own = reciprocal_uniform(rng, config.kelvin);
        let kelvin = if chance(rng, ODD_LAMPS) { own } else { usual };
        let lit = chance(rng, share) || is_dark && Some(index) == strongest;
        VariedLamp { name: lamp.name.clone(), lit, kelvin: kelvin.round(), power: log_uniform(rng, config.power) }
    };
    found.iter().enumerate().map(lamp).collect()
}

/// Whether a lamp of the first scene is lit.
fn is_lit(scene: &Scene, lamp: &Lamp) -> bool {
    let glows = |part: &PartId| !scene.materials[scene.parts[*part as usize].material as usize].emission.factor.is_black();
    lamp.parts.iter().any(glows) || !lamp.lights.is_empty()
}

/// From the light of the first scene to that of the variation.
struct Change<'a> {
    measure: &'a Measure,
    exposure: Exposure,
    /// The moment, where it is another one.
    light: Option<LightConfig>,
}

impl Change<'_> {
    fn measured(&self, before: Rgb) -> Rgb {
        self.measure.exposure.measure(before)
    }

    /// Light of a lamp that had this radiance or intensity.
    fn lamp(&self, before: Rgb, state: Option<&VariedLamp>) -> Rgb {
        let measured = self.measured(before);
        match state {
            None => self.exposure.expose(measured),
            Some(lamp) if !lamp.lit => Rgb::BLACK,
            Some(lamp) => self.exposure.expose(tinted(measured, lamp.kelvin, lamp.power)),
        }
    }

    /// Radiance of a surface that stands for daylight.
    fn daylight(&self, before: Rgb) -> Rgb {
        let Some(light) = &self.light else { return before };
        let weather = light.weather();
        let up = |k| enfilade_math::warp::cosine_hemisphere(enfilade_math::warp::hammersley(k, SKY_DIRECTIONS));
        let sky = (0..SKY_DIRECTIONS).map(|k| weather.radiance(up(k))).sum::<Rgb>();
        let inside_klx = 0.025 * weather.sky_klx() + 0.012 * weather.sun_klx();
        let color = sky.lerp(Rgb::splat(sky.luminance()), 0.5) / sky.luminance().max(f32::MIN_POSITIVE);
        self.exposure.expose(color * (self.measured(before).luminance() * inside_klx / self.measure.day_klx))
    }
}

/// Changes what glows.
fn shine(scene: &mut LabelledScene, glow: &[Glowing], found: &[Lamp], states: &[VariedLamp], change: &Change) {
    let mut paints: BTreeMap<PartId, Paint> = BTreeMap::new();
    for part in 0..scene.scene.parts.len() as PartId {
        let emission = scene.scene.materials[scene.scene.parts[part as usize].material as usize].emission;
        let factor = match glow[part as usize] {
            Glowing::Daylight => change.daylight(emission.factor),
            Glowing::Other => change.exposure.expose(change.measured(emission.factor)),
            Glowing::No | Glowing::Lamp => continue,
        };
        paints.insert(part, Paint { emission: factor, name: None });
    }
    for (index, lamp) in found.iter().enumerate() {
        let state = states.get(index);
        for &part in &lamp.parts {
            paints.insert(part, lamp_paint(&scene.scene, part, state, change));
        }
        for &light in &lamp.lights {
            if let Light::Point { intensity, .. } | Light::Spot { intensity, .. } | Light::Profile { intensity, .. } =
                &mut scene.scene.lights[light]
            {
                *intensity = change.lamp(*intensity, state);
            }
        }
    }
    repaint(&mut scene.scene, &paints);
}

/// The glow of a part of a lamp. Lamps of homes say in the names of their materials what they give.
fn lamp_paint(scene: &Scene, part: PartId, state: Option<&VariedLamp>, change: &Change) -> Paint {
    let part = &scene.parts[part as usize];
    let material = &scene.materials[part.material as usize];
    let Some((glow, state)) = Glow::of_material(&material.name).zip(state) else {
        return Paint { emission: change.lamp(material.emission.factor, state), name: None };
    };
    let glow = Glow { lumens: glow.lumens * state.power as f32, kelvin: state.kelvin as f32 };
    let luminance = glow.luminance_kcd(crate::sources::area_m2(scene, part));
    let emission = if state.lit { change.exposure.expose(tinted(luminance, state.kelvin, 1.0)) } else { Rgb::BLACK };
    Paint { emission, name: Some(glow.material_name(state.lit)) }
}

/// Puts another sun and sky around the scene, in place of its surroundings and its sun. The picture of the new ones takes the place of the
/// old, so that no other picture gets another number.
fn replace_sky(scene: &mut Scene, light: &LightConfig, outward: &[Vec2], exposure: Exposure) {
    scene.lights.retain(|light| !matches!(light, Light::Directional { .. }));
    let old = match &scene.environment {
        Some(Environment::Map { image, .. }) => Some(*image),
        _ => None,
    };
    let mut is_used = false;
    scene.materials.iter().for_each(|material| material.textures(|texture| is_used |= Some(texture.image) == old));
    light.illuminate_exposed(scene, outward, exposure);
    if let (Some(old), Some(Environment::Map { image, .. })) = (old.filter(|_| !is_used), &mut scene.environment)
        && let Some(picture) = scene.images.pop()
    {
        scene.images[old as usize] = picture;
        *image = old;
    }
}
