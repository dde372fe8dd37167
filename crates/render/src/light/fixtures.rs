//! Fixtures: the things that light a scene. The sky is one, the sun is one, and so is each window and each lamp with all its bulbs.
//!
//! Only distance decides what belongs to one lamp, so that no labels or names are needed: emissive parts and lights at a point are joined
//! where their boxes are close, and large ones, such as a glowing ceiling, are fixtures by themselves. The panes of a window are joined in
//! the same way.

use super::bounds::{Emitters, LightBounds};
use super::sample::{LightKind, LightSample};
use enfilade_frame::MAX_FIXTURES;
use enfilade_math::{Bounds3, Vec3};
use enfilade_scene::{Light, PartId, Scene};
use std::collections::BTreeMap;

/// Bulbs of one lamp, and panes of one window, are at most this far apart along each axis, metres.
const GAP_M: f32 = 0.25;
/// Length above which an emitter is a separate fixture, metres.
const LARGE_M: f32 = 2.0;
/// Largest number of windows that are separate fixtures, so that there is room for lamps.
const MAX_WINDOWS: usize = 12;
/// Means no fixture in tables.
const NONE: u16 = u16::MAX;

/// Something that lights a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixture {
    /// Kind of fixture.
    pub kind: FixtureKind,
    /// Name of its strongest emissive part or light, or of its largest pane; `sky`, `sun` and `rest` for these.
    pub name: String,
    /// Middle of the box around it, world, metres; `None` for what is far away, and for the rest.
    pub position: Option<Vec3>,
    /// Luminance of its radiant intensity, W/sr: radiance × area of surfaces, the largest intensity of lights at a point. 0 for the sky,
    /// the sun and windows.
    pub intensity: f32,
    /// Emissive parts of the fixture, or its panes.
    pub parts: Vec<PartId>,
    /// Names of its lights.
    pub lights: Vec<String>,
}

/// Kinds of fixtures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixtureKind {
    /// The sky, or an environment map, as far as its light comes through no window.
    Sky,
    /// All directional lights.
    Sun,
    /// The sky's light through the panes of a window.
    Window,
    /// Emissive surfaces and lights at a point, close to each other.
    Lamp,
    /// The weakest lamps of a scene that has too many.
    Rest,
}

impl FixtureKind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Sky, Self::Sun, Self::Window, Self::Lamp, Self::Rest];

    /// Name of the kind in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sky => "sky",
            Self::Sun => "sun",
            Self::Window => "window",
            Self::Lamp => "lamp",
            Self::Rest => "rest",
        }
    }
}

/// The fixtures of a scene, and which of them light comes from.
#[derive(Debug, Default)]
pub(crate) struct Fixtures {
    /// The sky, the sun, the windows from the largest on, the lamps from the strongest on, the rest; those that there are.
    pub list: Vec<Fixture>,
    /// By part, of those that emit.
    of_part: Vec<u16>,
    /// By number of the emitter in the light hierarchy.
    of_emitter: Vec<u16>,
    /// By part, of panes; empty without any.
    of_pane: Vec<u16>,
}

/// A part that the sky shines through.
pub(super) struct Pane {
    pub part: PartId,
    pub bounds: Bounds3,
    pub area_m2: f32,
}

/// An emissive part, a light at a point, or a pane.
struct Source {
    bounds: Bounds3,
    /// Luminance of its radiant intensity, W/sr; of panes the area, square metres.
    strength: f32,
    part: Option<PartId>,
    /// Index in `Scene::lights`.
    light: Option<usize>,
}

impl Fixtures {
    /// Finds the fixtures of a scene. `parts` are the parts of the first emitters of the hierarchy, whose bounds are `bounds`; the others
    /// are the lights of the scene with the numbers `lights`.
    pub(super) fn new(
        scene: &Scene,
        bounds: &[LightBounds],
        panes: &[Pane],
        parts: &[PartId],
        lights: &[usize],
        [has_sky, has_sun]: [bool; 2],
    ) -> Self {
        // Collect what each part emits in all its patches, and what each light does.
        let mut sources: Vec<Source> = Vec::new();
        let mut source_of_emitter = Vec::with_capacity(bounds.len());
        for (emitter, found) in bounds.iter().enumerate() {
            let (part, light) = (parts.get(emitter).copied(), emitter.checked_sub(parts.len()).map(|light| lights[light]));
            match sources.last_mut() {
                Some(last) if part.is_some() && last.part == part => {
                    last.bounds = last.bounds.union(found.bounds);
                    last.strength += found.power();
                }
                _ => sources.push(Source { bounds: found.bounds, strength: found.power(), part, light }),
            }
            source_of_emitter.push(sources.len() - 1);
        }

        // Far-away fixtures come first.
        let mut list = Vec::new();
        if has_sky {
            list.push(Fixture::of_kind(FixtureKind::Sky));
        }
        if has_sun {
            let suns = scene.lights.iter().filter(|light| matches!(light, Light::Directional { .. }));
            list.push(Fixture { lights: suns.map(|light| light.name().to_string()).collect(), ..Fixture::of_kind(FixtureKind::Sun) });
        }

        // Then windows, of panes that are close, the largest first; what comes through those beyond the limit remains the sky's.
        let panes: Vec<Source> =
            panes.iter().map(|pane| Source { bounds: pane.bounds, strength: pane.area_m2, part: Some(pane.part), light: None }).collect();
        let mut of_pane = vec![NONE; if panes.is_empty() { 0 } else { scene.parts.len() }];
        for window in joined(&panes).iter().take(MAX_WINDOWS) {
            let found = Fixture::of_sources(FixtureKind::Window, scene, &panes, window);
            found.parts.iter().for_each(|&part| of_pane[part as usize] = list.len() as u16);
            list.push(Fixture { intensity: 0.0, ..found });
        }

        // Then lamps, of bulbs that are close, the strongest first; the weakest beyond the limit count as one.
        let room = MAX_FIXTURES - list.len();
        let mut lamps = joined(&sources);
        let rest = if lamps.len() > room { lamps.split_off(room - 1) } else { Vec::new() };
        let mut of_source = vec![NONE; sources.len()];
        for lamp in &lamps {
            lamp.iter().for_each(|&source| of_source[source] = list.len() as u16);
            list.push(Fixture::of_sources(FixtureKind::Lamp, scene, &sources, lamp));
        }
        if !rest.is_empty() {
            let rest = rest.concat();
            rest.iter().for_each(|&source| of_source[source] = list.len() as u16);
            let kind = FixtureKind::Rest;
            list.push(Fixture { name: kind.name().into(), position: None, ..Fixture::of_sources(kind, scene, &sources, &rest) });
        }

        // Say where each emitter belongs.
        let mut of_part = vec![NONE; scene.parts.len()];
        for (source, fixture) in sources.iter().zip(&of_source) {
            source.part.into_iter().for_each(|part| of_part[part as usize] = *fixture);
        }
        Self { list, of_part, of_emitter: source_of_emitter.into_iter().map(|source| of_source[source]).collect(), of_pane }
    }

    /// The fixture of light from the sun or the sky; `window` is the one that it comes through.
    #[inline]
    pub fn of_far(&self, kind: LightKind, window: Option<u16>) -> Option<u16> {
        let wanted = if kind == LightKind::Environment { FixtureKind::Sky } else { FixtureKind::Sun };
        if wanted == FixtureKind::Sky && window.is_some() {
            return window;
        }
        self.list.iter().take(2).position(|fixture| fixture.kind == wanted).map(|index| index as u16)
    }

    /// The fixture that a light sample comes from; `window` is the one that it comes through.
    #[inline]
    pub fn of_sample(&self, sample: &LightSample, window: Option<u16>) -> Option<u16> {
        match (sample.kind(), sample.emitter) {
            (LightKind::Surfaces | LightKind::Points, Some(emitter)) => self.of_emitter(emitter),
            (kind, _) => self.of_far(kind, window),
        }
    }

    /// The fixture of an emitter of the light hierarchy.
    #[inline]
    fn of_emitter(&self, emitter: u32) -> Option<u16> {
        self.of_emitter.get(emitter as usize).copied().filter(|&fixture| fixture != NONE)
    }

    /// The fixture that an emissive part belongs to.
    #[inline]
    pub fn of_part(&self, part: PartId) -> Option<u16> {
        self.of_part.get(part as usize).copied().filter(|&fixture| fixture != NONE)
    }

    /// The window that a part is a pane of.
    #[inline]
    pub fn of_pane(&self, part: PartId) -> Option<u16> {
        self.of_pane.get(part as usize).copied().filter(|&fixture| fixture != NONE)
    }
}

impl Fixture {
    fn of_kind(kind: FixtureKind) -> Self {
        Self { kind, name: kind.name().into(), position: None, intensity: 0.0, parts: Vec::new(), lights: Vec::new() }
    }

    fn of_sources(kind: FixtureKind, scene: &Scene, sources: &[Source], chosen: &[usize]) -> Self {
        let members = || chosen.iter().map(|&source| &sources[source]);
        let bounds = members().fold(Bounds3::EMPTY, |bounds, source| bounds.union(source.bounds));
        // Of equally strong ones the first.
        let strongest = members().reduce(|best, source| if source.strength > best.strength { source } else { best });
        Self {
            name: strongest.map_or_else(String::new, |source| source.name(scene).into()),
            position: Some(bounds.center()),
            intensity: members().map(|source| source.strength).sum(),
            parts: members().filter_map(|source| source.part).collect(),
            lights: members().filter_map(|source| source.light).map(|light| scene.lights[light].name().into()).collect(),
            ..Self::of_kind(kind)
        }
    }
}

impl Source {
    fn name<'a>(&self, scene: &'a Scene) -> &'a str {
        match (self.part, self.light) {
            (Some(part), _) => &scene.parts[part as usize].name,
            (None, Some(light)) => scene.lights[light].name(),
            (None, None) => "",
        }
    }

    /// Distance along the axis on which the boxes are the farthest apart, metres; below zero where they overlap.
    fn gap_m(&self, other: &Self) -> f32 {
        let (a, b) = (self.bounds, other.bounds);
        (a.min - b.max).max(b.min - a.max).max_element()
    }
}

/// The sources of each lamp, the strongest lamp first; of windows likewise.
fn joined(sources: &[Source]) -> Vec<Vec<usize>> {
    // Join those that are close: along x from left to right, so that each is compared only with those that begin before it ends.
    let mut group_of: Vec<usize> = (0..sources.len()).collect();
    let mut small: Vec<usize> = (0..sources.len()).filter(|&i| sources[i].bounds.extent().max_element() <= LARGE_M).collect();
    small.sort_by(|&a, &b| sources[a].bounds.min.x.total_cmp(&sources[b].bounds.min.x));
    for (place, &a) in small.iter().enumerate() {
        let reach = sources[a].bounds.max.x + GAP_M;
        for &b in small[place + 1..].iter().take_while(|&&b| sources[b].bounds.min.x <= reach) {
            if sources[a].gap_m(&sources[b]) <= GAP_M {
                let (a, b) = (first_of(&mut group_of, a), first_of(&mut group_of, b));
                group_of[a.max(b)] = a.min(b);
            }
        }
    }

    // Gather the members of each, and order them.
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for source in 0..sources.len() {
        groups.entry(first_of(&mut group_of, source)).or_default().push(source);
    }
    let mut groups: Vec<Vec<usize>> = groups.into_values().collect();
    let strength = |group: &Vec<usize>| group.iter().map(|&source| sources[source].strength).sum::<f32>();
    groups.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
    groups
}

/// The first source of the group that a source belongs to; shortens the chain on the way.
fn first_of(group_of: &mut [usize], mut source: usize) -> usize {
    while group_of[source] != source {
        group_of[source] = group_of[group_of[source]];
        source = group_of[source];
    }
    source
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rgb;

    /// Lights at these points, from the weakest on.
    fn fixtures(points: &[Vec3]) -> Fixtures {
        let light =
            |(i, &position): (usize, &Vec3)| Light::Point { name: format!("bulb {i}"), position, intensity: Rgb::splat(i as f32 + 1.0) };
        let scene = Scene { lights: points.iter().enumerate().map(light).collect(), ..Scene::default() };
        let bounds: Vec<LightBounds> = (0..points.len()).map(|i| LightBounds::point(points[i], i as f32 + 1.0)).collect();
        Fixtures::new(&scene, &bounds, &[], &[], &(0..points.len()).collect::<Vec<_>>(), [true, false])
    }

    #[test]
    fn bulbs_that_are_close_are_one_lamp_and_those_of_a_chain_too() {
        let found = fixtures(&[0.0, 5.0, 0.2, 0.4].map(|x| Vec3::X * x));
        let listed: Vec<(&str, f32, &[String])> = found.list.iter().map(|f| (f.name.as_str(), f.intensity, &f.lights[..])).collect();
        let names = |numbers: &[u32]| numbers.iter().map(|i| format!("bulb {i}")).collect::<Vec<_>>();
        assert_eq!(listed, [("sky", 0.0, &[][..]), ("bulb 3", 8.0, &names(&[0, 2, 3])), ("bulb 1", 2.0, &names(&[1]))]);
        assert_eq!(found.list[1].position, Some(Vec3::X * 0.2));
        assert_eq!([0, 1, 2, 3].map(|i| found.of_emitter(i)), [Some(1), Some(2), Some(1), Some(1)]);
        assert_eq!((found.of_far(LightKind::Environment, None), found.of_far(LightKind::Distant, None)), (Some(0), None));
    }

    #[test]
    fn the_weakest_of_too_many_lamps_are_one() {
        let found = fixtures(&(0..50).map(|i| Vec3::Y * i as f32).collect::<Vec<_>>());
        assert_eq!(found.list.len(), MAX_FIXTURES);
        let rest = found.list.last().unwrap();
        assert_eq!((rest.kind, rest.lights.len(), rest.position), (FixtureKind::Rest, 12, None));
        assert_eq!((found.of_emitter(0), found.of_emitter(49)), (Some(39), Some(1)));
    }
}
