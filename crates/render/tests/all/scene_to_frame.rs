//! The example program renders a scene file to the files of a frame.

#[path = "../../examples/scene_to_frame.rs"]
#[allow(dead_code, reason = "the program's own main and its default scene are not called here")]
mod example;

use enfilade_dataset::hdf5::{Elements, read_array};
use enfilade_frame::Layer;
use std::path::Path;

#[test]
fn the_example_writes_color_and_depth_of_a_cornell_box() {
    let frame = example::frame_of(Path::new(example::CORNELL), [16, 12], 4).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let written = |layer: Layer| {
        let file = folder.path().join(layer.spec().name);
        example::write_layer(&frame, layer, &file).unwrap();
        read_array(&file).unwrap()
    };
    let (color, depth) = (written(Layer::Color), written(Layer::DepthMeters));
    assert_eq!((color.shape, depth.shape), (vec![12, 16, 3], vec![12, 16]));
    let Elements::F16(color) = color.values else { panic!("colour is stored as float16") };
    assert!(color.iter().all(|v| v.is_finite()) && color.iter().any(|v| v.to_f32() > 0.1));
    // The camera is 3.2 m in front of the box's middle, whose back is 1 m behind that.
    let Elements::F32(depth) = depth.values else { panic!("depth is stored as float32") };
    assert!(depth.iter().all(|v| (2.0..6.0).contains(v)), "{depth:?}");
}
