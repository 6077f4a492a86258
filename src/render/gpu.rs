use std::sync::Arc;

use thiserror::Error;

/// A graphics device and the way to it.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub instance: wgpu::Instance,
    pub adapter: wgpu::Adapter,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

/// Why there is nothing to draw with.
#[derive(Debug, Error)]
pub enum GpuError {
    #[error(
        "no graphics adapter was found ({0})\n\
         Install a Vulkan driver; without a graphics card, a software one will do:\n  \
         Debian, Ubuntu:  apt install mesa-vulkan-drivers libvulkan1\n  \
         Fedora:          dnf install mesa-vulkan-drivers vulkan-loader\n  \
         Arch:            pacman -S vulkan-swrast vulkan-icd-loader"
    )]
    NoAdapter(#[from] wgpu::RequestAdapterError),
    #[error(
        "no graphics adapter is called {wanted:?}, as WGPU_ADAPTER_NAME asks for; here are {found:?}"
    )]
    NoSuchAdapter { wanted: String, found: Vec<String> },
    #[error("the graphics adapter {adapter} gives no device: {source}")]
    NoDevice { adapter: String, source: wgpu::RequestDeviceError },
}

/// The device could not do what it was told.
#[derive(Debug, Error)]
#[error("the device could not draw the picture: {0}")]
pub struct DeviceError(String);

impl Gpu {
    /// A device that draws pictures without a window.
    ///
    /// `WGPU_BACKEND` and `WGPU_ADAPTER_NAME` choose among several.
    ///
    /// # Errors
    ///
    /// If there is no adapter, or it gives no device.
    pub fn headless() -> Result<Self, GpuError> {
        Self::with_gl_as_fallback(|backends| {
            let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
            let descriptor = wgpu::InstanceDescriptor { backends, ..descriptor };
            Self::new(wgpu::Instance::new(descriptor), None)
        })
    }

    /// Makes something of all backends but OpenGL, and if that fails, of all: OpenGL's drivers write
    /// to standard error even where it is not chosen. `WGPU_BACKEND` limits the backends.
    ///
    /// # Errors
    ///
    /// The last of `make`'s.
    pub(crate) fn with_gl_as_fallback<T, E>(
        mut make: impl FnMut(wgpu::Backends) -> Result<T, E>,
    ) -> Result<T, E> {
        let all = wgpu::Backends::from_env().unwrap_or_default();
        let without_gl = all - wgpu::Backends::GL;
        if without_gl.is_empty() || without_gl == all {
            return make(all);
        }
        make(without_gl).or_else(|_| make(all))
    }

    /// A device that can show what it draws on `surface`, if there is one.
    ///
    /// # Errors
    ///
    /// If there is no such adapter, or it gives no device.
    pub fn new(
        instance: wgpu::Instance,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<Self, GpuError> {
        let adapter = adapter(&instance, surface)?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("ik-arm"),
            // To time frames, where the adapter has a clock.
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|source| GpuError::NoDevice { adapter: adapter.get_info().name, source })?;
        let gpu = Self { instance, adapter, device, queue };
        gpu.on_fault(|why| log::error!("the graphics device failed: {why}"));
        Ok(gpu)
    }

    /// Has it told, from whatever thread notices it, why the device is good for nothing more: it is
    /// lost, or has no memory left. Where it only finds fault with what it is told, that is logged.
    /// Takes the place of what was to be told before.
    pub fn on_fault(&self, tell: impl Fn(String) + Send + Sync + 'static) {
        let tell = Arc::new(tell);
        let lost = Arc::clone(&tell);
        self.device.set_device_lost_callback(move |reason, message| {
            lost(format!("it was lost ({reason:?}) {message}").trim_end().to_owned());
        });
        self.device.on_uncaptured_error(Arc::new(move |error| match error {
            wgpu::Error::Validation { .. } => log::error!("graphics: {error}"),
            wgpu::Error::OutOfMemory { .. } | wgpu::Error::Internal { .. } => {
                tell(error.to_string());
            }
        }));
    }

    /// The adapter's name and the interface it is reached by: "llvmpipe (Vulkan)".
    pub fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{} ({})", info.name, info.backend)
    }

    /// The longest side that a picture can have here.
    pub fn longest_side(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Does what tells the device something, and says if it could not do it.
    ///
    /// # Errors
    ///
    /// If the device finds fault with it.
    pub fn watched<T>(&self, telling: impl FnOnce() -> T) -> Result<T, DeviceError> {
        let faults = [
            wgpu::ErrorFilter::Internal,
            wgpu::ErrorFilter::Validation,
            wgpu::ErrorFilter::OutOfMemory,
        ]
        .map(|kind| self.device.push_error_scope(kind));
        let told = telling();
        // Every scope is closed, whatever the others have found.
        let found = faults.into_iter().rev().filter_map(|fault| pollster::block_on(fault.pop()));
        match found.collect::<Vec<_>>().first() {
            Some(error) => Err(DeviceError(error.to_string())),
            None => Ok(told),
        }
    }
}

/// The one that `WGPU_ADAPTER_NAME` names, or else the best. So does `wgpu::util`, which panics where
/// there is none of that name.
fn adapter(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    let Ok(wanted) = std::env::var("WGPU_ADAPTER_NAME") else {
        let best = wgpu::util::initialize_adapter_from_env_or_default(instance, surface);
        return Ok(pollster::block_on(best)?);
    };
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    adapters.retain(|adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface)));
    let name = |adapter: &wgpu::Adapter| adapter.get_info().name;
    let is_wanted = |name: String| name.to_lowercase().contains(&wanted.to_lowercase());
    match adapters.iter().position(|adapter| is_wanted(name(adapter))) {
        Some(index) => Ok(adapters.swap_remove(index)),
        None => {
            let found = adapters.iter().map(name).collect();
            Err(GpuError::NoSuchAdapter { wanted, found })
        }
    }
}
