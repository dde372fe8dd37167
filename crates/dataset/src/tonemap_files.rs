//! `metadata_tonemap.csv`: how radiance became the 8-bit pictures of a camera's frames, and the way back.
//!
//! `tonemap.jpg` is min(1, (`scale` · max(0, radiance))^`gamma`): below white, radiance is displayed^(1 / `gamma`) / `scale`. For
//! `display.jpg`, whose curve is in docs/previews.md, the exposure and white balance are stored; all frames of the trajectory share them.

use crate::tables::Table;
use crate::{Dataset, DatasetError};

const HEADER: [&str; 6] = ["frame_id", "percentile", "brightness", "scale", "gamma", "display_scale"];
/// Columns that older datasets lack.
const WHITE: [&str; 3] = ["display_white_r", "display_white_g", "display_white_b"];

/// The exposures of a frame's pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMapRow {
    /// Frame number.
    pub frame: u32,
    /// Percentile of brightness that determines the exposures, 0 to 100.
    pub percentile: f64,
    /// Brightness (0.3 R + 0.59 G + 0.11 B) at that percentile of the frame's valid pixels; `None` when it has none.
    pub brightness: Option<f64>,
    /// Factor of radiance in `tonemap.jpg`.
    pub scale: f64,
    /// The power that the product is raised to.
    pub gamma: f64,
    /// Factor of radiance in `display.jpg`.
    pub display_scale: f64,
    /// Additional factors of red, green and blue in `display.jpg`; 1 in datasets of earlier versions.
    pub display_white: [f64; 3],
}

impl Dataset {
    /// Writes the exposures of a camera's frames.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_tone_maps(&self, scene: &str, camera: &str, rows: &[ToneMapRow]) -> Result<(), DatasetError> {
        let mut table = Table::new(&self.layout().tone_maps(scene, camera), &[&HEADER[..], &WHITE].concat());
        let number = |v: f64| format!("{v:?}");
        let cells = |row: &ToneMapRow| {
            let brightness = row.brightness.map(number).unwrap_or_default();
            let frame = [row.frame.to_string(), number(row.percentile), brightness];
            let numbers = [row.scale, row.gamma, row.display_scale].into_iter().chain(row.display_white).map(number);
            frame.into_iter().chain(numbers).collect()
        };
        table.rows = rows.iter().map(cells).collect();
        table.write()
    }

    /// The exposures of a camera's frames; none when there is no table.
    ///
    /// # Errors
    /// When the table cannot be read.
    pub fn read_tone_maps(&self, scene: &str, camera: &str) -> Result<Vec<ToneMapRow>, DatasetError> {
        let table = match Table::read(&self.layout().tone_maps(scene, camera)) {
            Err(error) if error.is_not_found() => return Ok(Vec::new()),
            table => table?,
        };
        let columns = HEADER.map(|name| table.column(name));
        let [frame, percentile, brightness, scale, gamma, display_scale] = columns.into_iter().collect::<Result<Vec<_>, _>>()?[..] else {
            unreachable!("as many columns as names")
        };
        let white = WHITE.map(|name| table.column(name).ok());
        let row = |at: usize| {
            let mut display_white = [1.0; 3];
            for (factor, column) in display_white.iter_mut().zip(white) {
                *factor = column.map_or(Ok(1.0), |column| table.parse(at, column))?;
            }
            Ok(ToneMapRow {
                frame: table.parse(at, frame)?,
                percentile: table.parse(at, percentile)?,
                brightness: if table.rows[at][brightness].is_empty() { None } else { Some(table.parse(at, brightness)?) },
                scale: table.parse(at, scale)?,
                gamma: table.parse(at, gamma)?,
                display_scale: table.parse(at, display_scale)?,
                display_white,
            })
        };
        (0..table.rows.len()).map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_come_back_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert_eq!(dataset.read_tone_maps("room", "cam_00").unwrap(), []);
        let row = |frame, brightness| ToneMapRow {
            frame,
            percentile: 90.0,
            brightness,
            scale: 0.1 + 0.2,
            gamma: 1.0 / 2.2,
            display_scale: 1.0 / 3.0,
            display_white: [0.9, 1.0, 1.1],
        };
        let rows = [row(0, Some(0.7)), row(7, None)];
        dataset.write_tone_maps("room", "cam_00", &rows).unwrap();
        assert_eq!(dataset.read_tone_maps("room", "cam_00").unwrap(), rows);
    }
}
