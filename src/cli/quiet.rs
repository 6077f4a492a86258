//! Keeps graphics drivers from printing error messages when nothing is wrong.

/// Replaces this process by one without Mesa's Vulkan layer "device select", if the layer would
/// print an error.
///
/// The layer asks the Wayland compositor for its GPU. Without `XDG_RUNTIME_DIR` there is no
/// compositor, and libwayland prints an error each time. The layer is switched off by an
/// environment variable, which must be set before a process starts: changing it later is unsafe.
pub(super) fn restart_without_device_select() {
    #[cfg(target_os = "linux")]
    linux::restart();
}

#[cfg(target_os = "linux")]
mod linux {
    use std::env;
    use std::os::unix::process::CommandExt as _;
    use std::path::Path;
    use std::process::Command;

    const SWITCH: &str = "NODEVICE_SELECT";

    pub(super) fn restart() {
        let runtime_folder = env::var_os("XDG_RUNTIME_DIR").unwrap_or_default();
        if Path::new(&runtime_folder).is_absolute() || env::var_os(SWITCH).is_some() {
            return;
        }
        let (Ok(program), mut arguments) = (env::current_exe(), env::args_os()) else { return };
        let name = arguments.next().unwrap_or_default();
        // `exec` returns only if it fails. This process then continues, and the layer prints its
        // errors.
        let error = Command::new(program).arg0(name).args(arguments).env(SWITCH, "1").exec();
        log::debug!("cannot restart: {error}");
    }
}
