//! What a large scene takes: a million triangles under eight textures of 4096×4096, from the OBJ file to a finished dataset.
//!
//! `memory [--triangles N] [--textures N] [--side N]` writes a rolling floor and a lamp above it to a scratch folder, runs every stage
//! on it with one frame of 640×480 at 4 samples, and prints the most memory that the process has held after each step.

use anyhow::{Context, Result, bail};
use enfilade_import::{ImportOptions, load};
use enfilade_pipeline::{Config, Overrides, Silent, run};
use enfilade_render::RenderScene;
use enfilade_scene::Quiet;
use image::{ImageBuffer, Rgb};
use std::fmt::Write;
use std::path::Path;

/// Width of the floor, metres.
const WIDTH: f32 = 8.0;

fn main() -> Result<()> {
    let (mut triangles, mut textures, mut side) = (1_000_000u32, 8u32, 4096u32);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let number = words.next().with_context(|| format!("{word} needs a number"))?.parse()?;
        match word.as_str() {
            "--triangles" => triangles = number,
            "--textures" => textures = number.max(1),
            "--side" => side = number,
            _ => bail!("unknown option {word}; expected --triangles, --textures or --side"),
        }
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
        "frames = 1\n[render]\nsize = [640, 480]\nsamples = 4\n[[scene]]\nname = \"large\"\nfile = \"scene.obj\"\n\
         cameras = [{ position = [4.0, -4.0, 1.6], look_at = [6.5, -6.5, 0.2] }]\n",
    )?;
    let config = Config::read(&dataset, &Overrides::default())?;
    let summary = run(&config, &folder.path().join("out"), None, &Silent)?;
    println!("every stage: {} MB; {}", most_memory_mb()?, if summary.ok() { "all laws hold" } else { "FAILED" });
    Ok(())
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

/// The most memory that this process has held so far, in megabytes (10⁶ bytes).
fn most_memory_mb() -> Result<u64> {
    let status = std::fs::read_to_string("/proc/self/status").context("only Linux tells a process's memory here")?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).context("no VmHWM in /proc/self/status")?;
    let kib: u64 = line.split_whitespace().nth(1).context("an empty VmHWM")?.parse()?;
    Ok(kib * 1024 / 1_000_000)
}
