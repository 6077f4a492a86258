use web_sys::{Event, UrlSearchParams};
use winit::event_loop::EventLoopProxy;

use super::event::PlatformEvent;
use super::page::on_each;
use crate::app::event::{UserEvent, send};
use crate::io::Link;
use crate::session::{Action, link_actions};
use crate::ui::Parts;

/// The address of the page without its link.
pub fn address() -> String {
    let location = web_sys::window().map(|window| window.location());
    let parts = location.and_then(|it| Some((it.origin().ok()?, it.pathname().ok()?)));
    parts.map_or_else(String::new, |(origin, path)| origin + &path)
}

/// The parts that the address of an embedded page names, as in `?embed=view,hand`; `None` for the
/// whole program.
pub fn parts() -> Option<Parts> {
    let search = web_sys::window()?.location().search().ok()?;
    let names = UrlSearchParams::new_with_str(&search).ok()?.get("embed")?;
    Some(Parts::parse(&names))
}

/// The actions that open what the page's link carries.
pub fn actions() -> Vec<Action> {
    let hash = web_sys::window().and_then(|window| window.location().hash().ok());
    hash.map_or_else(Vec::new, |hash| link_actions(Link::parse(&hash)))
}

/// Opens what the link carries whenever it changes.
pub fn take_changed(proxy: &EventLoopProxy<UserEvent>) {
    let proxy = proxy.clone();
    on_each(web_sys::window(), "hashchange", move |_: Event| {
        send(&proxy, UserEvent::Platform(PlatformEvent::Linked(actions())));
    });
}
