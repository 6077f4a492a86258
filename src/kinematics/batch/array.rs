/// Points, one for each arm.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// x of each arm.
    pub x: &'a [f32],
    /// y of each arm.
    pub y: &'a [f32],
    /// z of each arm.
    pub z: &'a [f32],
}

/// Points to write, one for each arm.
#[derive(Debug)]
pub struct PointsMut<'a> {
    /// x of each arm.
    pub x: &'a mut [f32],
    /// y of each arm.
    pub y: &'a mut [f32],
    /// z of each arm.
    pub z: &'a mut [f32],
}

/// Unit quaternions to write, one for each arm.
#[derive(Debug)]
pub struct QuaternionsMut<'a> {
    /// x of each arm.
    pub x: &'a mut [f32],
    /// y of each arm.
    pub y: &'a mut [f32],
    /// z of each arm.
    pub z: &'a mut [f32],
    /// w of each arm.
    pub w: &'a mut [f32],
}

impl<'a> PointsMut<'a> {
    /// Three arrays, of x, y and z.
    pub fn of([x, y, z]: &'a mut [impl AsMut<[f32]>; 3]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut() }
    }
}

impl<'a> QuaternionsMut<'a> {
    /// Four arrays, of x, y, z and w.
    pub fn of([x, y, z, w]: &'a mut [impl AsMut<[f32]>; 4]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut(), w: w.as_mut() }
    }
}
