use web_sys::console;

use super::page::show_failure;

/// Writes warnings, errors and panics to the console of the browser; the page shows panics, too.
pub fn connect() {
    report_panics();
    log::set_logger(&ConsoleLog).unwrap_or_else(|_| log::debug!("a log is set already"));
    log::set_max_level(log::LevelFilter::Warn);
}

/// Writes what is logged to the console of the browser.
struct ConsoleLog;

impl log::Log for ConsoleLog {
    fn enabled(&self, _: &log::Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &log::Record<'_>) {
        let line = format!("{}: {}", record.target(), record.args()).into();
        match record.level() {
            log::Level::Error => console::error_1(&line),
            log::Level::Warn => console::warn_1(&line),
            _ => console::log_1(&line),
        }
    }

    fn flush(&self) {}
}

/// Writes panics to the console of the browser, and shows the page's own words for them.
fn report_panics() {
    std::panic::set_hook(Box::new(|panic| {
        console::error_1(&panic.to_string().into());
        show_failure(&format!("The program failed (this is a bug): {panic}"));
    }));
}
