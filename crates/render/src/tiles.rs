//! An image cut into square tiles, which threads take one at a time.

/// Side of a tile in pixels: large enough for coherent rays, small enough to spread over threads.
const SIDE: u32 = 16;

/// The tiles of an image, row by row from the upper left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiles {
    width: u32,
    height: u32,
}

impl Tiles {
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    fn columns(self) -> u32 {
        self.width.div_ceil(SIDE)
    }

    /// Number of tiles.
    pub fn count(self) -> u32 {
        self.columns() * self.height.div_ceil(SIDE)
    }

    /// The pixels (x, y) of a tile, row by row.
    pub fn pixels(self, tile: u32) -> impl Iterator<Item = (u32, u32)> + Clone {
        let (x0, y0) = ((tile % self.columns()) * SIDE, (tile / self.columns()) * SIDE);
        let (x1, y1) = (self.width.min(x0 + SIDE), self.height.min(y0 + SIDE));
        (y0..y1).flat_map(move |y| (x0..x1).map(move |x| (x, y)))
    }

    /// The values of all tiles' pixels as rows of the image.
    pub fn rows<T: Copy + Default>(self, tiles: &[Vec<T>]) -> Vec<T> {
        let mut image = vec![T::default(); self.width as usize * self.height as usize];
        for (tile, values) in (0..self.count()).zip(tiles) {
            for ((x, y), value) in self.pixels(tile).zip(values) {
                image[y as usize * self.width as usize + x as usize] = *value;
            }
        }
        image
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (width, height) in [(1, 1), (16, 16), (17, 33), (50, 7)] {
            let tiles = Tiles::new(width, height);
            let numbered: Vec<Vec<u32>> = (0..tiles.count()).map(|t| tiles.pixels(t).map(|(x, y)| y * width + x + 1).collect()).collect();
            assert_eq!(tiles.rows(&numbered), (1..=width * height).collect::<Vec<_>>());
        }
    }
}
