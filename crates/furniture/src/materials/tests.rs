//! Checks of every finish: it is made once, reflects no more than real surfaces do, and its pictures tile, have the true scale and stay
//! small.

use super::*;
use crate::palette::DecorConfig;
use enfilade_math::Rgb;
use enfilade_scene::{Image, NormalMap, Parameter, Pixels};

/// Every finish, with the first of those that have a number.
fn finishes() -> Vec<Finish> {
    Finish::all().collect()
}

fn stock(seed: u64) -> Materials {
    let decor = DecorConfig { seed, realism: 1.0 };
    Materials::new(decor.palette(), LampLight::default(), decor.pictures())
}

#[test]
fn a_finish_is_made_once_per_room_and_whatever_was_made_before() {
    let palettes = Palette::all();
    let stock = || Materials::new(palettes[0], LampLight::default(), Rng::new(3));
    let (mut scene, mut other) = (Scene::default(), Scene::default());
    let (mut a, mut b) = (stock(), stock());
    let wood = a.get(&mut scene, Finish::Wood);
    assert_eq!((a.get(&mut scene, Finish::Wood), scene.images.len()), (wood, 2), "colour and relief");
    assert_ne!(a.get(&mut scene, Finish::SofaCloth), wood);
    b.get(&mut other, Finish::Brick);
    b.get(&mut other, Finish::Wood);
    assert_eq!(other.images[2..4], scene.images[0..2]);
    a.enter_room(palettes[1]);
    let (images, cloth) = (scene.images.len(), a.get(&mut scene, Finish::SofaCloth));
    assert_eq!(scene.images.len(), images, "another colour of the same picture");
    assert_ne!(a.get(&mut scene, Finish::Wood), wood);
    a.enter_room(palettes[0]);
    assert_eq!(a.get(&mut scene, Finish::Wood), wood, "the same wood as in the first room");
    assert_ne!(a.get(&mut scene, Finish::SofaCloth), cloth);
}

/// The largest value of each channel of a colour picture, linear; one if the picture has no colours.
fn largest_texel(image: &Image) -> [f32; 3] {
    let Pixels::Rgba8 { srgb: true, texels } = &image.pixels else { return [1.0; 3] };
    let max = texels.iter().fold([0u8; 4], |m, t| std::array::from_fn(|c| m[c].max(t[c])));
    Rgb::from_srgb8([max[0], max[1], max[2]]).to_array()
}

#[test]
fn nothing_reflects_more_than_nine_tenths_and_whites_reflect_eight() {
    for seed in [0, 3, 8] {
        let (mut stock, mut scene) = (stock(seed), Scene::default());
        for finish in finishes() {
            let material = stock.get(&mut scene, finish);
            scene.materials[material as usize].bsdf.parameters(&mut |parameter| {
                let Parameter::Color(color) = parameter else { return };
                let Some(texture) = &color.texture else { return };
                let texel = largest_texel(&scene.images[texture.image as usize]);
                let max = (0..3).map(|c| texel[c] * color.factor[c]).fold(0.0, f32::max);
                assert!(max <= 0.93, "seed {seed}, {finish:?}: a texel reflects {max}");
                let mean = mean_of(&scene.images[texture.image as usize]) * color.factor;
                assert!(mean.max_component() <= 0.86 && mean.luminance() > 0.008, "seed {seed}, {finish:?}: {mean:?} on average");
            });
        }
        for finish in [Finish::CeilingPaint, Finish::BedLinen(0), Finish::WhitePaint, Finish::Porcelain] {
            let material = stock.get(&mut scene, finish) as usize;
            let mut white = 0.0;
            scene.materials[material].bsdf.parameters(&mut |parameter| {
                if let Parameter::Color(c) = parameter {
                    let mean = c.texture.map_or(Rgb::WHITE, |t| mean_of(&scene.images[t.image as usize])) * c.factor;
                    white = if white == 0.0 { mean.luminance() } else { white };
                }
            });
            assert!((0.70..0.86).contains(&white), "seed {seed}, {finish:?}: {white}");
        }
    }
}

fn mean_of(image: &Image) -> Rgb {
    let Pixels::Rgba8 { texels, .. } = &image.pixels else { return Rgb::WHITE };
    texels.iter().map(|t| Rgb::from_srgb8([t[0], t[1], t[2]])).sum::<Rgb>() / texels.len() as f32
}

#[test]
fn pictures_continue_across_their_borders() {
    let (mut stock, mut scene) = (stock(4), Scene::default());
    for finish in finishes() {
        stock.get(&mut scene, finish);
    }
    // Lone things, which are not repeated, and wood, whose boards end somewhere.
    const ONCE: [&str; 6] = ["rug", "book jackets", "screen picture", "leaf", "pale leaf", "floor planks"];
    for image in scene.images.iter().filter(|i| !ONCE.contains(&i.name.trim_end_matches(" relief"))) {
        let Pixels::Rgba8 { texels, .. } = &image.pixels else { continue };
        let (w, h) = (image.width as usize, image.height as usize);
        let step = |a: usize, b: usize| (0..3).map(|c| (f32::from(texels[a][c]) - f32::from(texels[b][c])).abs()).sum::<f32>();
        // Steps across the border beside the largest mean step across any line within: joints are as steep everywhere.
        let column = |x: usize| (0..h).map(|y| step(y * w + x, y * w + (x + 1) % w)).sum::<f32>() / h as f32;
        let row = |y: usize| (0..w).map(|x| step(y * w + x, (y + 1) % h * w + x)).sum::<f32>() / w as f32;
        let max = |line: &dyn Fn(usize) -> f32, n: usize| (0..n - 1).map(line).fold(0.0, f32::max);
        assert!(column(w - 1) <= 1.3 * max(&column, w) + 2.0, "{}: left and right differ by {}", image.name, column(w - 1));
        assert!(row(h - 1) <= 1.3 * max(&row, h) + 2.0, "{}: top and bottom differ by {}", image.name, row(h - 1));
    }
}

#[test]
fn pictures_show_things_at_their_true_size() {
    let (mut stock, mut scene) = (stock(0), Scene::default());
    let mut period = |finish: Finish| {
        let material = stock.get(&mut scene, finish) as usize;
        let Some(NormalMap::Bump { texture, scale }) = scene.materials[material].normal_map else { return ([0.0; 2], 0.0) };
        ([1.0 / texture.uv_transform[0][0], 1.0 / texture.uv_transform[1][1]], scale)
    };
    let (brick, depth) = period(Finish::Brick);
    assert!((brick[0] / 4.0 - 0.25).abs() < 1e-4 && (brick[1] / 12.0 - 0.081).abs() < 1e-4 && (0.002..0.01).contains(&depth));
    for finish in [Finish::FloorTile, Finish::WallTile] {
        let (covers, depth) = period(finish);
        assert!(covers.iter().all(|side| (0.9..2.5).contains(side)) && depth <= 0.003, "{finish:?}: {covers:?}");
    }
    for finish in [Finish::SofaCloth, Finish::CurtainLinen, Finish::Towel(0), Finish::Leather] {
        let (covers, depth) = period(finish);
        assert!(covers[0] < 0.5 && depth < 0.004, "{finish:?}: {covers:?}");
    }
}

#[test]
fn pictures_are_small_enough_and_rooms_share_them() {
    let (decor, mut scene) = (DecorConfig { seed: 2, realism: 1.0 }, Scene::default());
    let home = decor.palette();
    let mut stock = Materials::new(home, LampLight::default(), decor.pictures());
    for room in 0..6 {
        stock.enter_room(decor.room(&home, room));
        for finish in [Finish::WallPaint, Finish::CeilingPaint, Finish::PlankFloor, Finish::Wood, Finish::Accent(0), Finish::WhitePaint] {
            stock.get(&mut scene, finish);
        }
    }
    assert!(scene.images.iter().all(|i| i.width <= 1024 && i.height <= 1024));
    let texels: usize = scene.images.iter().map(|i| (i.width * i.height) as usize).sum();
    assert!(texels < 5_000_000, "{texels} texels");
}
