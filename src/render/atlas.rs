use core::ops::Range;

/// Packs small coverage images into a large one, row by row, until the large one is full.
#[derive(Debug)]
pub(super) struct Atlas {
    width: u32,
    height: u32,
    /// Maximum height in pixels. The atlas grows towards it in powers of two.
    max_height: u32,
    /// Coverage from 0 to 255, row by row.
    pixels: Vec<u8>,
    /// Upper left corner of the next image.
    pen: (u32, u32),
    row_height: u32,
    changed: Range<u32>,
}

impl Atlas {
    /// Gap between images in pixels, so that none bleeds into its neighbour.
    const GAP: u32 = 1;
    const FIRST_HEIGHT: u32 = 64;

    pub fn new(width: u32, max_height: u32) -> Self {
        let mut atlas = Self {
            width,
            height: 0,
            max_height,
            pixels: Vec::new(),
            pen: (Self::GAP, Self::GAP),
            row_height: 0,
            changed: 0..0,
        };
        atlas.grow(Self::FIRST_HEIGHT.min(max_height));
        atlas
    }

    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Reserves a rectangle and returns its upper left corner; `None` if the atlas is full.
    pub fn place(&mut self, (width, height): (u32, u32)) -> Option<(u32, u32)> {
        let end = |from: u32, length: u32| from.checked_add(length)?.checked_add(Self::GAP);
        if end(Self::GAP, width)? > self.width {
            return None;
        }
        let (mut pen, mut row_height) = (self.pen, self.row_height);
        if end(pen.0, width)? > self.width {
            pen = (Self::GAP, pen.1 + row_height + Self::GAP);
            row_height = 0;
        }
        let bottom = end(pen.1, height)?;
        if bottom > self.max_height {
            return None;
        }
        if bottom > self.height {
            self.grow(bottom.next_power_of_two().min(self.max_height));
        }
        self.pen = (pen.0 + width + Self::GAP, pen.1);
        self.row_height = row_height.max(height);
        self.change(pen.1..bottom);
        Some(pen)
    }

    /// Sets the coverage of a pixel, from 0 to 1.
    pub fn set(&mut self, (x, y): (u32, u32), cover: f32) {
        let index = y as usize * self.width as usize + x as usize;
        if let Some(pixel) = self.pixels.get_mut(index) {
            *pixel = (cover.clamp(0.0, 1.0) * 255.0).round() as u8;
        }
    }

    /// Removes all images.
    pub fn clear(&mut self) {
        self.pixels.fill(0);
        self.pen = (Self::GAP, Self::GAP);
        self.row_height = 0;
        self.change(0..self.height);
    }

    /// Returns the range of rows that have changed since the previous call.
    pub fn take_changed(&mut self) -> Range<u32> {
        core::mem::take(&mut self.changed)
    }

    pub fn rows(&self, rows: Range<u32>) -> &[u8] {
        let index = |row: u32| row as usize * self.width as usize;
        self.pixels.get(index(rows.start)..index(rows.end)).unwrap_or_default()
    }

    fn grow(&mut self, height: u32) {
        self.height = height;
        self.pixels.resize(self.width as usize * height as usize, 0);
        self.change(0..height);
    }

    fn change(&mut self, rows: Range<u32>) {
        let has_none = self.changed.is_empty();
        let start = if has_none { rows.start } else { self.changed.start.min(rows.start) };
        self.changed = start..self.changed.end.max(rows.end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_never_overlap_and_never_leave_the_atlas() {
        let mut atlas = Atlas::new(100, 300);
        let mut taken = vec![false; 100 * 300];
        let mut placed = 0;
        for step in 0..1000 {
            let (width, height) = (1 + step * 7 % 23, 1 + step * 5 % 17);
            let Some((left, top)) = atlas.place((width, height)) else {
                break;
            };
            placed += 1;
            assert!(atlas.size().1 <= 300 && top + height < atlas.size().1);
            for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
                let pixel = &mut taken[((top + y) * 100 + left + x) as usize];
                assert!(!core::mem::replace(pixel, true), "{step}");
            }
        }
        assert!((50..1000).contains(&placed), "{placed}");
        assert_eq!(atlas.size(), (100, 300));
    }

    #[test]
    fn an_image_that_is_too_large_does_not_fit() {
        let mut atlas = Atlas::new(64, 64);
        for size in [(63, 1), (1, 63), (u32::MAX, 1), (1, u32::MAX)] {
            assert_eq!(atlas.place(size), None, "{size:?}");
        }
        assert_eq!(atlas.place((62, 62)), Some((1, 1)));
    }

    #[test]
    fn changed_rows_are_returned_once() {
        let mut atlas = Atlas::new(64, 256);
        assert_eq!(atlas.take_changed(), 0..64);
        assert_eq!(atlas.take_changed(), 0..0);
        atlas.place((10, 10));
        atlas.place((10, 20));
        assert_eq!(atlas.take_changed(), 1..22);
        atlas.place((10, 100));
        assert_eq!((atlas.size(), atlas.take_changed()), ((64, 128), 0..128));
        atlas.set((3, 5), 1.0);
        assert_eq!(atlas.rows(5..6)[3], 255);
        atlas.clear();
        assert_eq!(atlas.take_changed(), 0..128);
        assert_eq!(atlas.rows(5..6)[3], 0);
    }
}
