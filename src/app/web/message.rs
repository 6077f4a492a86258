//! Messages between the page and a page in which it is embedded.

use js_sys::{JSON, Reflect};
use serde_json::json;
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::{MessageEvent, Window};
use winit::event_loop::EventLoopProxy;

use super::event::PlatformEvent;
use super::page::on_each;
use crate::app::event::{UserEvent, send};
use crate::io::Link;
use crate::session::{Session, link_actions};

/// Answers messages: `{open: "#example=walk"}` opens what a link carries, `{read: true}` is answered
/// with [`answer`].
pub fn take_sent(proxy: &EventLoopProxy<UserEvent>) {
    let proxy = proxy.clone();
    on_each(web_sys::window(), "message", move |event: MessageEvent| {
        let field = |name: &str| Reflect::get(&event.data(), &name.into()).ok();
        if let Some(link) = field("open").and_then(|link| link.as_string()) {
            let actions = link_actions(Link::parse(&link));
            send(&proxy, UserEvent::Platform(PlatformEvent::Linked(actions)));
        }
        if field("read").is_some_and(|read| read.is_truthy())
            && let Some(asker) = event.source()
        {
            // Not checked: the window of another page is none of this page's class.
            let asker = asker.unchecked_into::<Window>();
            send(&proxy, UserEvent::Platform(PlatformEvent::Asked(asker)));
        }
    });
}

/// Posts the shown limb: `{ik_arm: {hand, elbow, yaw_deg, pitch_deg, twist_deg, shoulder_angle_deg,
/// elbow_angle_deg}}`, points relative to the Root; `{ik_arm: null}` without a limb.
pub fn answer(asker: &Window, session: &Session) {
    let limb = session.limb().map(|limb| {
        let pose = limb.frames.pose();
        json!({
            "hand": pose.hand.to_array(),
            "elbow": pose.elbow.to_array(),
            "yaw_deg": pose.yaw().to_degrees(),
            "pitch_deg": pose.pitch().to_degrees(),
            "twist_deg": pose.twist.to_degrees(),
            "shoulder_angle_deg": pose.shoulder_angle().to_degrees(),
            "elbow_angle_deg": pose.elbow_angle().to_degrees(),
        })
    });
    let answer = JSON::parse(&json!({ "ik_arm": limb }).to_string()).unwrap_or(JsValue::NULL);
    if let Err(refused) = asker.post_message(&answer, "*") {
        log::warn!("the other page takes no answer: {refused:?}");
    }
}
