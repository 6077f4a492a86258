use std::sync::{Arc, OnceLock};

use bytemuck::Pod;
use thiserror::Error;
use wgpu::util::DeviceExt as _;

/// A graphics device with its queue, adapter and instance.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The instance that the adapter belongs to.
    pub instance: wgpu::Instance,
    /// The physical device and its driver.
    pub adapter: wgpu::Adapter,
    /// The logical device.
    pub device: wgpu::Device,
    /// The command queue of the device.
    pub queue: wgpu::Queue,
    /// Reason of the failure, set once the device is lost or out of memory.
    failure: Arc<OnceLock<DeviceError>>,
}

/// Reasons why there is no graphics device.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter has the features that the program requires.
    #[error(
        "no graphics adapter was found ({0})\n\
         Install a Vulkan driver; without a graphics card, install a software one:\n  \
         Debian, Ubuntu:  apt install mesa-vulkan-drivers libvulkan1\n  \
         Fedora:          dnf install mesa-vulkan-drivers vulkan-loader\n  \
         Arch:            pacman -S vulkan-swrast vulkan-icd-loader"
    )]
    NoAdapter(#[from] wgpu::RequestAdapterError),
    /// No adapter has the name in `WGPU_ADAPTER_NAME`.
    #[error("WGPU_ADAPTER_NAME must name one of the adapters {found:?}, got {wanted:?}")]
    NoSuchAdapter {
        /// Name in the environment variable.
        wanted: String,
        /// Names of all adapters.
        found: Vec<String>,
    },
    /// The adapter's driver refused to create a device.
    #[error("the graphics adapter {adapter} provides no device: {source}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// The driver's error.
        source: wgpu::RequestDeviceError,
    },
}

/// Failure of a graphics device.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the graphics device failed: {0}")]
pub struct DeviceError(String);

impl Gpu {
    /// Creates a device that draws without a window.
    ///
    /// The environment variables `WGPU_BACKEND` and `WGPU_ADAPTER_NAME` choose among several
    /// adapters.
    ///
    /// # Errors
    ///
    /// If there is no adapter, or it provides no device.
    pub async fn headless() -> Result<Self, GpuError> {
        Self::with_gl_as_fallback(async |backends| {
            let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
            let descriptor = wgpu::InstanceDescriptor { backends, ..descriptor };
            Self::new(wgpu::Instance::new(descriptor), None).await
        })
        .await
    }

    /// Calls `make` with all backends except OpenGL and, if that fails, with all backends: OpenGL
    /// drivers write to standard error even if they are not chosen. `WGPU_BACKEND` limits the
    /// backends.
    ///
    /// # Errors
    ///
    /// The error of the last call of `make`.
    pub(crate) async fn with_gl_as_fallback<T, E>(
        mut make: impl AsyncFnMut(wgpu::Backends) -> Result<T, E>,
    ) -> Result<T, E> {
        let all = wgpu::Backends::from_env().unwrap_or_default();
        let without_gl = all - wgpu::Backends::GL;
        if without_gl.is_empty() || without_gl == all {
            return make(all).await;
        }
        match make(without_gl).await {
            Err(_) => make(all).await,
            made => made,
        }
    }

    /// Creates a device that can present to `surface`, if one is given.
    ///
    /// # Errors
    ///
    /// If no adapter can present to the surface, or the adapter provides no device.
    pub async fn new(
        instance: wgpu::Instance,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<Self, GpuError> {
        let adapter = adapter(&instance, surface).await?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("ik-arm"),
            // `GpuTimer` requires timestamp queries.
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|source| GpuError::NoDevice { adapter: adapter.get_info().name, source })?;
        let gpu = Self { instance, adapter, device, queue, failure: Arc::default() };
        gpu.on_failure(|| {});
        Ok(gpu)
    }

    /// Sets a callback that runs once, on any thread, when the device is lost or out of memory, and
    /// that replaces the previous callback. [`Gpu::check`] then returns the reason. Validation
    /// errors, which are mistakes in this program, are only logged.
    pub fn on_failure(&self, callback: impl Fn() + Send + Sync + 'static) {
        let failure = Arc::clone(&self.failure);
        let fail = Arc::new(move |reason: String| {
            if failure.set(DeviceError(reason)).is_ok() {
                callback();
            }
        });
        let lose = Arc::clone(&fail);
        self.device.set_device_lost_callback(move |reason, message| {
            lose(format!("lost ({reason:?}) {message}").trim_end().to_owned());
        });
        self.device.on_uncaptured_error(Arc::new(move |error| match error {
            wgpu::Error::Validation { .. } => log::error!("graphics: {error}"),
            wgpu::Error::OutOfMemory { .. } | wgpu::Error::Internal { .. } => {
                fail(error.to_string());
            }
        }));
    }

    /// Checks that the device still works.
    ///
    /// # Errors
    ///
    /// If the device has reported that it is lost or out of memory.
    pub fn check(&self) -> Result<(), DeviceError> {
        self.failure.get().map_or(Ok(()), |failure| Err(failure.clone()))
    }

    /// Names of the adapter and its backend, like "llvmpipe (Vulkan)".
    pub fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{} ({})", info.name, info.backend)
    }

    /// True if the adapter is a program on the CPU that draws while this program waits. That of a
    /// browser draws in another process.
    pub fn is_software(&self) -> bool {
        let info = self.adapter.get_info();
        info.device_type == wgpu::DeviceType::Cpu && info.backend != wgpu::Backend::BrowserWebGpu
    }

    /// Maximum width and height of a texture in pixels.
    pub fn longest_side(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Creates a buffer of `size` bytes that commands of the queue can write.
    pub(super) fn buffer(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Creates a buffer with these contents; one item of zeros if there are none.
    pub(super) fn filled_buffer<T: Pod>(
        &self,
        label: &str,
        contents: &[T],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let none = [T::zeroed()];
        let contents = if contents.is_empty() { &none } else { contents };
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: bytemuck::cast_slice(contents),
            usage,
        })
    }

    /// Creates a texture of a width and height in pixels, with one level and one sample per pixel.
    pub fn texture(
        &self,
        label: &str,
        format: wgpu::TextureFormat,
        [width, height]: [u32; 2],
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Runs `work`, which sends commands to the device, and returns the device's errors.
    ///
    /// # Errors
    ///
    /// If the device rejects a command, is lost or out of memory.
    pub async fn watched<T>(&self, work: impl AsyncFnOnce() -> T) -> Result<T, DeviceError> {
        let scopes = [
            wgpu::ErrorFilter::Internal,
            wgpu::ErrorFilter::Validation,
            wgpu::ErrorFilter::OutOfMemory,
        ]
        .map(|filter| self.device.push_error_scope(filter));
        let result = work().await;
        let mut caught = None;
        // Pops every scope, even after one that has caught an error.
        for scope in scopes.into_iter().rev() {
            let error = scope.pop().await;
            caught = caught.or(error);
        }
        match caught {
            Some(error) => Err(DeviceError(error.to_string())),
            None => self.check().map(|()| result),
        }
    }
}

/// The adapter whose name contains `WGPU_ADAPTER_NAME`, or the best adapter if that variable is not
/// set. The function of `wgpu::util` for this purpose panics if no adapter has the name.
async fn adapter(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    let Ok(wanted) = std::env::var("WGPU_ADAPTER_NAME") else {
        let best = wgpu::util::initialize_adapter_from_env_or_default(instance, surface);
        return Ok(best.await?);
    };
    let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
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
