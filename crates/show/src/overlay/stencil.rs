//! Strokes gathered into one coverage before they are blended, so that lines which meet do not add up.

use crate::sheet::canvas::{Canvas, Color, distance_to_segment};

/// Strokes that are gathered before they are blended, so that strokes of one line do not add up where they meet.
pub(super) struct Stencil {
    width: u32,
    height: u32,
    coverage: Vec<f32>,
    touched: Vec<usize>,
}

impl Stencil {
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, coverage: vec![0.0; width as usize * height as usize], touched: Vec::new() }
    }

    /// Adds a straight stroke of a round pen, antialiased.
    pub fn stroke(&mut self, from: [f32; 2], to: [f32; 2], radius: f32) {
        let range = |axis: usize, limit: u32| {
            let (low, high) = (from[axis].min(to[axis]) - radius - 1.0, from[axis].max(to[axis]) + radius + 1.0);
            (low.max(0.0) as u32)..(high.max(0.0).ceil() as u32).min(limit)
        };
        for y in range(1, self.height) {
            for x in range(0, self.width) {
                let place = y as usize * self.width as usize + x as usize;
                let distance = distance_to_segment([x as f32 + 0.5, y as f32 + 0.5], from, to);
                let coverage = (radius - distance + 0.5).clamp(0.0, 1.0);
                if coverage > self.coverage[place] {
                    if self.coverage[place] == 0.0 {
                        self.touched.push(place);
                    }
                    self.coverage[place] = coverage;
                }
            }
        }
    }

    /// Blends all strokes into a canvas of the same size, and forgets them.
    pub fn blend(&mut self, canvas: &mut Canvas, color: Color, opacity: f32) {
        for place in self.touched.drain(..) {
            let (x, y) = (place % self.width as usize, place / self.width as usize);
            canvas.blend(x as u32, y as u32, color, opacity * self.coverage[place]);
            self.coverage[place] = 0.0;
        }
    }
}
