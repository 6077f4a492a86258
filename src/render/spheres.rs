use super::Gpu;
use super::globe::Globes;
use super::shell::Shells;
use super::sphere_order::{SphereOrder, SphereSide, SphereSurface};
use crate::scene::{Colour, Globe, Scene, SphereShell};

/// Draws the see-through spheres, which are the shells and the globe, from back to front over
/// everything opaque.
#[derive(Debug)]
pub(super) struct Spheres {
    shells: Shells,
    globe: Globes,
    order: SphereOrder,
    /// Shells that can be drawn, then the globe if there is one.
    spheres: Vec<SphereShell>,
    /// Numbers of shell sides that are drawn before the globe's far side and before its near side.
    behind_globe: [u32; 2],
}

impl Spheres {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        Self {
            shells: Shells::new(gpu, view),
            globe: Globes::new(gpu, view),
            order: SphereOrder::default(),
            spheres: Vec::new(),
            behind_globe: [0; 2],
        }
    }

    /// Sends the changes to the device and returns the number of bytes sent. `size` is the
    /// picture's in pixels.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32)) -> u64 {
        let projection = scene.camera.projection(size.0 as f32 / size.1 as f32);
        self.spheres.clear();
        self.spheres.extend(scene.shells.iter().filter(|shell| has_size(shell)));
        let shells = self.spheres.len();
        self.spheres.extend(scene.globe.filter(Globe::has_size).map(of_globe));
        let surfaces = self.order.sort(&projection, &self.spheres);
        let is_shell = |surface: &&SphereSurface| surface.sphere < shells;
        self.behind_globe = [SphereSide::Far, SphereSide::Near].map(|side| {
            let behind = surfaces.iter().take_while(|it| is_shell(it) || it.side != side);
            behind.filter(is_shell).count() as u32
        });
        let sides = surfaces.iter().filter(is_shell);
        let sides = sides.map(|surface| (&self.spheres[surface.sphere], surface.side));
        self.shells.upload(gpu, sides) + self.globe.upload(gpu, scene)
    }

    pub fn triangles(&self) -> u32 {
        self.shells.triangles() + self.globe.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let [far, near] = self.behind_globe;
        self.shells.draw(pass, 0..far);
        self.globe.draw(pass, SphereSide::Far);
        self.shells.draw(pass, far..near);
        self.globe.draw(pass, SphereSide::Near);
        self.shells.draw(pass, near..u32::MAX);
    }
}

/// True if a shell can be drawn: its centre and squared radius are finite, and the radius is above
/// 0.
fn has_size(shell: &SphereShell) -> bool {
    let radius = shell.radius;
    shell.centre.is_finite() && radius > 0.0 && (radius * radius).is_finite()
}

fn of_globe(globe: Globe) -> SphereShell {
    SphereShell { centre: globe.centre, radius: globe.radius, colour: Colour([0; 4]) }
}
