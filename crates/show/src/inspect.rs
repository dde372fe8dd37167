//! Inspection of a pixel: every layer's value at one place, with units and names.

use enfilade_frame::vector;
use enfilade_frame::{Frame, LAYERS, Layer};
use enfilade_label::class_name;
use enfilade_scene::CameraView;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Names that turn numbers into words.
#[derive(Clone, Copy, Debug, Default)]
pub struct Names<'a> {
    /// `parts[i]` is the name of render entity i + 1.
    pub parts: &'a [String],
    /// `materials[i]` is the name of its material; may be empty.
    pub materials: &'a [String],
}

/// Everything known about one pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PixelReport {
    /// Column, from 0 at the left.
    pub x: u32,
    /// Row, from 0 at the top.
    pub y: u32,
    /// Number of the part that the pixel's centre sees, -1 where nothing was hit; `None` if the frame has no such layer.
    pub entity: Option<i16>,
    /// Name of the part, where it is known.
    pub part: Option<String>,
    /// The material of that part, where it is known.
    pub material: Option<String>,
    /// NYU40 class of the part by name, where the frame has labels.
    pub class: Option<String>,
    /// Number of the instance.
    pub instance: Option<i16>,
    /// Origin and direction (unit length) of the ray through the pixel's centre, in the world; `None` where the picture shows nothing.
    pub ray: Option<([f64; 3], [f64; 3])>,
    /// Projection of the stored position, in pixels from the upper left corner; a pixel's centre is at + 0.5.
    pub projects_to: Option<(f64, f64)>,
    /// The stored values, in the order of the layers.
    pub layers: Vec<LayerValue>,
}

/// The stored value of one layer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LayerValue {
    /// Name of the layer.
    pub name: String,
    /// One number per channel, as text: exact, and `NaN` where there is none.
    pub values: Vec<String>,
    /// Unit; empty for pure numbers.
    pub unit: String,
}

/// A pixel outside of the image.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pixel ({x}, {y}) is outside of the image, which has columns 0 to {last_x} and rows 0 to {last_y}", last_x = width - 1, last_y = height - 1)]
pub struct OutsideError {
    /// Requested column.
    pub x: u32,
    /// Requested row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Reports on pixel (x, y) of a frame taken from `view`.
///
/// # Errors
/// When there is no such pixel.
pub fn inspect(frame: &Frame, view: &CameraView<'_>, names: Names<'_>, x: u32, y: u32) -> Result<PixelReport, OutsideError> {
    if x >= frame.width || y >= frame.height {
        return Err(OutsideError { x, y, width: frame.width, height: frame.height });
    }
    let pixel = y as usize * frame.width as usize + x as usize;
    let number = |layer| frame.get(layer).map(|values| values.get(pixel) as i16);
    let entity = number(Layer::RenderEntityId);
    let part = entity.and_then(|id| usize::try_from(id).ok()?.checked_sub(1));
    let name = |list: &[String]| part.and_then(|part| list.get(part).cloned());
    let centre = (f64::from(x) + 0.5, f64::from(y) + 0.5);
    let position = frame.get(Layer::Position).map(|values| vector(values, pixel));
    let projects_to = position.filter(|p| p.is_finite()).and_then(|p| view.project_in_row(p, centre.1));
    let layer_value = |(layer, values): (Layer, &enfilade_frame::Values)| {
        let spec = layer.spec();
        let channels = pixel * spec.channels..(pixel + 1) * spec.channels;
        LayerValue { name: spec.name.into(), values: channels.map(|i| values.get(i).to_string()).collect(), unit: spec.unit.into() }
    };
    Ok(PixelReport {
        x,
        y,
        entity,
        part: name(names.parts),
        material: name(names.materials),
        class: part.and(number(Layer::Semantic)).map(|class| class_name(class).to_string()),
        instance: number(Layer::SemanticInstance).filter(|&i| i >= 1),
        ray: view.centre_ray(centre.0, centre.1).map(|ray| (ray.origin.to_array(), ray.direction.to_array())),
        projects_to,
        layers: frame.iter().map(layer_value).collect(),
    })
}

impl fmt::Display for PixelReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "pixel ({}, {})", self.x, self.y)?;
        let part = match (&self.part, self.entity) {
            (Some(name), _) => name.clone(),
            (None, Some(id)) if id >= 1 => format!("{id}, of no known name"),
            (None, Some(_)) => "nothing: the ray meets no part".into(),
            (None, None) => "not known: the frame has no render_entity_id".into(),
        };
        writeln!(f, "  part       {part}")?;
        if let Some(material) = &self.material {
            writeln!(f, "  material   {material}")?;
        }
        if let Some(class) = &self.class {
            let instance = self.instance.map_or("no instance".into(), |i| format!("instance {i}"));
            writeln!(f, "  class      {class}, {instance}")?;
        }
        let point = |[x, y, z]: [f64; 3]| format!("({x:.4}, {y:.4}, {z:.4})");
        match self.ray {
            Some((origin, direction)) => writeln!(f, "  ray        from {} m along {}", point(origin), point(direction))?,
            None => writeln!(f, "  ray        none: the picture shows nothing here")?,
        }
        if let Some((x, y)) = self.projects_to {
            let off = (x - f64::from(self.x) - 0.5).hypot(y - f64::from(self.y) - 0.5);
            writeln!(f, "  position projects to ({x:.3}, {y:.3}), {off:.4} px from the pixel's centre")?;
        }
        let width = LAYERS.iter().map(|spec| spec.name.len()).max().unwrap_or(0);
        for layer in &self.layers {
            let line = format!("  {:<width$}  {}  {}", layer.name, layer.values.join("  "), layer.unit);
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;
    use enfilade_testroom as testroom;

    fn report(part: i16) -> PixelReport {
        report_with(part, Names { parts: &testroom::PARTS.map(String::from), materials: &[] })
    }

    fn report_with(part: i16, names: Names<'_>) -> PixelReport {
        let pose = testroom::pose();
        let frame = testroom::frame(&pose);
        let pixel = testroom::pixel_of(&frame, part) as u32;
        inspect(&frame, &CameraView::still(&testroom::intrinsics().into(), &pose), names, pixel % 64, pixel / 64).unwrap()
    }

    #[test]
    fn a_pixel_of_the_mirror_is_known_by_name_class_and_place() {
        let report = report(3);
        assert_eq!(report.part.as_deref(), Some("wall/mirror"));
        assert_eq!((report.class.as_deref(), report.instance), (Some("mirror"), Some(1)));
        let (x, y) = report.projects_to.unwrap();
        assert!((x - f64::from(report.x) - 0.5).abs() < 1e-3 && (y - f64::from(report.y) - 0.5).abs() < 1e-3);
        let depth = report.layers.iter().find(|l| l.name == "depth_meters").unwrap();
        let distance: f64 = depth.values[0].parse().unwrap();
        let (origin, direction) = report.ray.map(|(o, d)| (DVec3::from(o), DVec3::from(d))).unwrap();
        assert!(((origin + direction * distance).y - 2.0).abs() < 1e-5, "the mirror hangs at y = 2");
        let text = report.to_string();
        assert!(text.contains("  class      mirror, instance 1\n") && text.contains("depth_meters") && text.contains("  m\n"), "{text}");
        assert_eq!(report.layers.len(), LAYERS.len());
    }

    #[test]
    fn the_void_is_called_nothing_and_json_keeps_it() {
        let report = report(-1);
        assert_eq!((report.part.as_ref(), report.class.as_ref(), report.projects_to), (None, None, None));
        assert!(report.to_string().contains("nothing: the ray meets no part") && report.to_string().contains("NaN"));
        let json = serde_json::to_string(&report).unwrap();
        assert_eq!(serde_json::from_str::<PixelReport>(&json).unwrap().layers, report.layers);
    }

    #[test]
    fn a_part_without_a_name_has_its_number() {
        assert!(report_with(2, Names::default()).to_string().contains("  part       2, of no known name\n"));
        assert!(report_with(-1, Names::default()).to_string().contains("  part       nothing: the ray meets no part\n"));
        let (pose, frame) = (testroom::pose(), Frame::new(2, 2));
        let report = inspect(&frame, &CameraView::still(&testroom::intrinsics().into(), &pose), Names::default(), 0, 0).unwrap();
        assert!(report.to_string().contains("  part       not known: the frame has no render_entity_id\n"));
    }

    #[test]
    fn pixels_outside_are_refused() {
        let pose = testroom::pose();
        let camera = testroom::intrinsics().into();
        let error = inspect(&testroom::frame(&pose), &CameraView::still(&camera, &pose), Names::default(), 64, 0).unwrap_err();
        assert_eq!(error.to_string(), "pixel (64, 0) is outside of the image, which has columns 0 to 63 and rows 0 to 47");
    }
}
