//! Frames in the making, from which a run continues.

use crate::{Run, Seed, seeds};
use enfilade_math::{DVec3, hash_u64};
use enfilade_render::{FrameRender, Guide, RenderConfig, RenderScene};
use enfilade_scene::{Camera, CameraView, Intrinsics, Pose, Quiet, Scene};
use std::path::Path;

const KEY: &[u8] = b"key";
/// Bytes of signature and version.
const HEAD: usize = 12;

/// Everything that a frame needs, for as long as the program lives.
struct Stage {
    scene: &'static RenderScene<'static>,
    guide: &'static Guide,
    view: CameraView<'static>,
    config: &'static RenderConfig,
}

impl Stage {
    fn new() -> Self {
        let scene: &'static Scene = Box::leak(Box::new(seeds::scene()));
        let scene = &*Box::leak(Box::new(RenderScene::new(scene, &Quiet).expect("a scene that can be rendered")));
        let camera: &'static Camera = Box::leak(Box::new(Intrinsics::from_fov_x(6, 4, 1.0).into()));
        let pose = Pose::look_at(0, DVec3::new(0.3, 0.3, 2.0), DVec3::new(0.3, 0.4, 0.0), DVec3::Y).expect("a pose");
        let view = CameraView::still(camera, &pose);
        let config = &*Box::leak(Box::new(RenderConfig { samples: 4, light_parts: true, fixtures: true, ..RenderConfig::default() }));
        let guide = &*Box::leak(Box::new(Guide::learn(scene, &[view], config)));
        Self { scene, guide, view, config }
    }

    fn frame(&self) -> FrameRender<'static, 'static> {
        FrameRender::new(self.scene, self.guide, &self.view, self.config).expect("a frame that can be rendered")
    }
}

/// Goes on from bytes, and makes layers of what is there. The signature and the checksum are set right, which searching would never
/// find.
pub fn partial(_: &Path) -> Run {
    let stage = Stage::new();
    let head: Vec<u8> = stage.frame().save(KEY)[..HEAD].to_vec();
    Box::new(move |bytes| {
        let _ = stage.frame().restore(bytes, KEY);
        let content = [&head[..], bytes].concat();
        let whole = [&content[..], &checksum(&content).to_le_bytes()].concat();
        let mut frame = stage.frame();
        if frame.restore(&whole, KEY).is_ok() {
            assert!(frame.save(KEY) == whole, "what was read is kept bit by bit");
            drop((frame.frame(), frame.noise(), frame.samples()));
        }
    })
}

/// Frames after some passes, without signature and checksum.
pub fn seeds() -> Vec<Seed> {
    let mut frame = Stage::new().frame();
    let kept = |frame: &FrameRender<'_, '_>, name: &str| {
        let bytes = frame.save(KEY);
        Seed { name: name.into(), bytes: bytes[HEAD..bytes.len() - 8].to_vec() }
    };
    let begun = kept(&frame, "begun");
    frame.pass(&Quiet);
    vec![begun, kept(&frame, "one_pass")]
}

/// Checksum as in `partial.rs` of the renderer: words of eight bytes, the last one filled up with zeros.
fn checksum(bytes: &[u8]) -> u64 {
    let word = |chunk: &[u8]| {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        u64::from_le_bytes(word)
    };
    let (words, rest) = bytes.as_chunks::<8>();
    let words = words.iter().map(|chunk| word(chunk)).chain([word(rest)]);
    words.fold(bytes.len() as u64, |sum, word| hash_u64(sum ^ word))
}
