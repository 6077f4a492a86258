/// Coordinates of points, one point for each arm.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// x of each arm's point.
    pub x: &'a [f32],
    /// y of each arm's point.
    pub y: &'a [f32],
    /// z of each arm's point.
    pub z: &'a [f32],
}

/// Arrays to which points are written, one point for each arm.
#[derive(Debug)]
pub struct PointsMut<'a> {
    /// x of each arm's point.
    pub x: &'a mut [f32],
    /// y of each arm's point.
    pub y: &'a mut [f32],
    /// z of each arm's point.
    pub z: &'a mut [f32],
}

/// Arrays to which unit quaternions are written, one for each arm.
#[derive(Debug)]
pub struct QuaternionsMut<'a> {
    /// x of each arm's quaternion.
    pub x: &'a mut [f32],
    /// y of each arm's quaternion.
    pub y: &'a mut [f32],
    /// z of each arm's quaternion.
    pub z: &'a mut [f32],
    /// w of each arm's quaternion.
    pub w: &'a mut [f32],
}

impl<'a> PointsMut<'a> {
    /// Borrows three arrays: x, y and z.
    pub fn of([x, y, z]: &'a mut [impl AsMut<[f32]>; 3]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut() }
    }
}

impl<'a> QuaternionsMut<'a> {
    /// Borrows four arrays: x, y, z and w.
    pub fn of([x, y, z, w]: &'a mut [impl AsMut<[f32]>; 4]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut(), w: w.as_mut() }
    }
}
