//! The memory that a large scene takes: a million triangles under eight textures of 4096×4096, from the OBJ file to a finished dataset.
//!
//! `memory [--triangles N] [--textures N] [--side N]` writes a rolling floor and a lamp above it to a scratch folder, runs every stage
//! on it with one frame of 640×480 at 4 samples, and prints the peak memory of the process after each step.
//!
//! `memory --copies N [--triangles N] [--apart]` renders such a frame of N copies of a ball under the sky. With `--apart` each copy has its
//! own mesh.

use anyhow::{Context, Result, bail};
use enfilade_geometry::Mesh;
use enfilade_import::{ImportOptions, load};
use enfilade_math::{DAffine3, DMat3, DVec3, Vec3};
use enfilade_pipeline::{Config, Overrides, Silent, Stopwatch};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Environment, Intrinsics, Material, Part, Pose, Quiet, Scene};
use image::{ImageBuffer, Rgb};
use std::fmt::Write;
use std::path::Path;

/// Width of the floor, metres.
const WIDTH: f32 = 8.0;

/// Runs the instrument.
pub fn run() -> Result<()> {
    let (mut triangles, mut textures, mut side, mut copies, mut apart) = (1_000_000u32, 8u32, 4096u32, 0u32, false);
    let mut words = crate::arguments::arguments();
    while let Some(word) = words.next() {
        if word == "--apart" {
            apart = true;
            continue;
        }
        let number = words.next().with_context(|| format!("{word} needs a number"))?.parse()?;
        match word.as_str() {
            "--triangles" => triangles = number,
            "--textures" => textures = number.max(1),
            "--side" => side = number,
            "--copies" => copies = number,
            _ => bail!("unknown option {word}; expected --triangles, --textures, --side, --copies or --apart"),
        }
    }
    if copies > 0 {
        return render_copies(triangles, copies, apart);
    }
    let folder = tempfile::tempdir()?;
    for k in 0..textures {
        let noise =
            |x: u32, y: u32| Rgb([0, 1, 2].map(|c| (enfilade_math::hash_u32((y * side + x) ^ (k << 28) ^ (c << 24)) >> 25) as u8 + 64));
        ImageBuffer::from_fn(side, side, noise).save(folder.path().join(format!("{k}.png")))?;
    }
    let rows = f64::from(triangles / 2).sqrt().ceil() as u32;
    write_scene(folder.path(), rows, textures)?;
    println!("{} triangles, {textures} textures of {side}x{side}", 2 * rows * rows + 2);

    let file = folder.path().join("scene.obj");
    let scene = load(&file, &ImportOptions::default(), &Quiet)?.scene;
    println!("imported: {} MB at the most", most_memory_mb()?);
    let prepared = RenderScene::new(&scene, &Quiet)?;
    println!("ready for rays: {} MB", most_memory_mb()?);
    drop(prepared);
    drop(scene);

    let dataset = folder.path().join("dataset.toml");
    std::fs::write(
        &dataset,
        "frames = 1\n[gate]\naction = \"report\"\n[render]\nsize = [640, 480]\nsamples = 4\n[[scene]]\nname = \"large\"\nfile = \"scene.obj\"\n\
         cameras = [{ position = [4.0, -4.0, 1.6], look_at = [6.5, -6.5, 0.2] }]\n",
    )?;
    let config = Config::read(&dataset, &Overrides::default())?;
    let summary = enfilade_pipeline::run(&config, &folder.path().join("out"), None, &Silent)?;
    println!("every stage: {} MB", most_memory_mb()?);
    if let Some(failure) = summary.scenes.iter().find_map(|scene| scene.failure.as_ref()) {
        bail!("{}: {}", failure.stage.name(), failure.message);
    }
    println!("all laws hold");
    Ok(())
}

/// Renders one frame of `copies` copies of a ball of about `triangles` triangles.
fn render_copies(triangles: u32, copies: u32, apart: bool) -> Result<()> {
    let rows = f64::from(triangles / 4).sqrt().ceil() as u32;
    let ball = ball(rows);
    println!("{copies} copies of {} triangles{}", ball.triangles.len(), if apart { ", each a mesh of its own" } else { "" });
    let mut scene = Scene { environment: Some(Environment::Constant { radiance: enfilade_math::Rgb::WHITE }), ..Scene::default() };
    scene.materials.push(Material::diffuse("grey", enfilade_math::Rgb::splat(0.5)));
    let columns = f64::from(copies).sqrt().ceil();
    for i in 0..copies {
        let at = DVec3::new((f64::from(i) % columns).floor(), (f64::from(i) / columns).floor(), 0.0) * 2.5;
        let world_from_mesh = DAffine3 { matrix3: DMat3::from_rotation_z(f64::from(i)), translation: at };
        scene.parts.push(Part { name: format!("ball {i}"), object: None, mesh: if apart { i } else { 0 }, material: 0, world_from_mesh });
    }
    scene.meshes = (0..if apart { copies } else { 1 }).map(|_| ball.clone().into()).collect();
    let (before, time) = (most_memory_mb()?, Stopwatch::start());
    let prepared = RenderScene::new(&scene, &Quiet)?;
    println!("ready for rays: {} MB more than the scene's {before} MB, in {:.1} core-s", most_memory_mb()? - before, time.cpu_s());
    let camera = Camera::from(Intrinsics { width: 640, height: 480, fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, skew: 0.0 });
    let pose = Pose::look_at(0, DVec3::new(-4.0, -4.0, 3.0), DVec3::new(columns, columns, 0.0), DVec3::Z).context("a view")?;
    let (view, config) = (CameraView::still(&camera, &pose), RenderConfig { samples: 4, ..RenderConfig::default() });
    let time = Stopwatch::start();
    let guide = Guide::learn(&prepared, &[view], &config);
    render_frame(&prepared, &guide, &view, &config, &Quiet)?;
    println!("rendered: {} MB in all, in {:.1} core-s", most_memory_mb()?, time.cpu_s());
    Ok(())
}

/// A dented ball of 4 `rows`² triangles.
fn ball(rows: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=2 * rows {
            let [latitude, longitude] = [row, column].map(|i| std::f32::consts::PI * i as f32 / rows as f32);
            let radius = 1.0 + 0.1 * (9.0 * longitude).sin() * (7.0 * latitude).sin();
            let around = Vec3::new(longitude.cos(), longitude.sin(), 0.0);
            mesh.positions.push((around * latitude.sin() + Vec3::Z * latitude.cos()) * radius);
        }
    }
    for row in 0..rows {
        for column in 0..2 * rows {
            let a = row * (2 * rows + 1) + column;
            let below = a + 2 * rows + 1;
            mesh.triangles.extend([[a, below, a + 1], [a + 1, below, below + 1]]);
        }
    }
    mesh
}

/// A floor of `rows` × `rows` squares in stripes of one texture each, and a lamp; y is up.
fn write_scene(folder: &Path, rows: u32, textures: u32) -> Result<()> {
    let mut materials = String::from("newmtl lamp\nKe 10 10 10\n");
    (0..textures).for_each(|k| materials += &format!("newmtl m{k}\nKd 1 1 1\nmap_Kd {k}.png\n"));
    std::fs::write(folder.join("scene.mtl"), materials)?;

    let mut obj = String::from("mtllib scene.mtl\n");
    for z in 0..=rows {
        for x in 0..=rows {
            let [x, z] = [x, z].map(|i| WIDTH * i as f32 / rows as f32);
            writeln!(obj, "v {x:.4} {:.4} {z:.4}\nvt {:.4} {:.4}", 0.15 * (3.0 * x).sin() * (2.0 * z).cos(), x / 4.0, z / 4.0)?;
        }
    }
    for k in 0..textures {
        writeln!(obj, "o stripe{k}\nusemtl m{k}")?;
        for z in k * rows / textures..(k + 1) * rows / textures {
            for x in 0..rows {
                let a = z * (rows + 1) + x + 1;
                let (b, c, d) = (a + 1, a + rows + 1, a + rows + 2);
                writeln!(obj, "f {a}/{a} {c}/{c} {b}/{b}\nf {b}/{b} {c}/{c} {d}/{d}")?;
            }
        }
    }
    obj += "v 3 3 3\nv 5 3 3\nv 5 3 5\nv 3 3 5\no lamp\nusemtl lamp\nf -4 -3 -2 -1\n";
    Ok(std::fs::write(folder.join("scene.obj"), obj)?)
}

/// The peak memory of this process so far, in megabytes (10⁶ bytes).
fn most_memory_mb() -> Result<u64> {
    let status = std::fs::read_to_string("/proc/self/status").context("only Linux tells a process's memory here")?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).context("no VmHWM in /proc/self/status")?;
    let kib: u64 = line.split_whitespace().nth(1).context("an empty VmHWM")?.parse()?;
    Ok(kib * 1024 / 1_000_000)
}
