//! A layer in memory, and the forms in which it is sent: whole or thinned out, element by element or byte plane by byte plane.

use super::cache::Weight;
use super::summary::Summary;
use enfilade_dataset::Elements;

/// A layer in memory.
pub struct DecodedLayer {
    /// Height, width and channels.
    pub shape: [usize; 3],
    /// The stored numbers.
    pub values: Elements,
    /// Range, mean and percentiles of the values.
    pub summary: Summary,
}

impl Weight for DecodedLayer {
    fn weight(&self) -> usize {
        self.values.as_bytes().len()
    }
}

impl DecodedLayer {
    /// One stored number, counted over rows, columns and channels.
    pub fn number(&self, at: usize) -> f64 {
        match &self.values {
            Elements::F16(v) => f64::from(v[at].to_f32()),
            Elements::F32(v) => f64::from(v[at]),
            Elements::F64(v) => v[at],
            Elements::I16(v) => f64::from(v[at]),
            Elements::I64(v) => v[at] as f64,
            Elements::U8(v) => f64::from(v[at]),
        }
    }

    /// Height, width and bytes of every `step`-th pixel of every `step`-th row.
    pub fn every(&self, step: usize) -> ([usize; 2], Vec<u8>) {
        let [height, width, channels] = self.shape;
        let bytes = self.values.as_bytes();
        if step == 1 {
            return ([height, width], bytes.to_vec());
        }
        let pixel = channels * self.values.element().size();
        let mut kept = Vec::with_capacity(height.div_ceil(step) * width.div_ceil(step) * pixel);
        for row in bytes.chunks_exact(width * pixel).step_by(step) {
            row.chunks_exact(pixel).step_by(step).for_each(|pixel| kept.extend_from_slice(pixel));
        }
        ([height.div_ceil(step), width.div_ceil(step)], kept)
    }
}

/// All first bytes of the elements, then all second bytes, and so on. Bytes of one significance are alike, so this compresses better.
pub fn planes_of(bytes: &[u8], size: usize) -> Vec<u8> {
    (0..size).flat_map(|byte| bytes[byte..].iter().step_by(size)).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::Layer;

    #[test]
    fn planes_gather_bytes_of_one_significance() {
        assert_eq!(planes_of(&[1, 2, 3, 4, 5, 6], 2), [1, 3, 5, 2, 4, 6]);
        assert_eq!(planes_of(&[1, 2, 3, 4], 4), [1, 2, 3, 4]);
    }

    #[test]
    fn every_second_pixel_of_every_second_row_is_kept() {
        let values = Elements::I16((0..15).collect());
        let layer = DecodedLayer { shape: [3, 5, 1], summary: Summary::new(&Layer::Semantic.into(), &values), values };
        let (size, bytes) = layer.every(2);
        let kept: Vec<i16> = bytes.chunks_exact(2).map(|b| i16::from_le_bytes([b[0], b[1]])).collect();
        assert_eq!((size, kept), ([2, 3], vec![0, 2, 4, 10, 12, 14]));
    }
}
