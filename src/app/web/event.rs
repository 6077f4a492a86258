use crate::app::error::GraphicsError;
use crate::app::graphics::Graphics;
use crate::session::Action;

/// An event of the page.
pub(in crate::app) enum PlatformEvent {
    /// Graphics were created, or could not be.
    Graphics(Result<Box<Graphics>, GraphicsError>),
    /// Text was pasted.
    Pasted(String),
    /// The link of the page has changed, or another page sent one.
    Linked(Vec<Action>),
    /// Another page asks for the pose.
    Asked(web_sys::Window),
}

impl core::fmt::Debug for PlatformEvent {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Graphics(Ok(_)) => "graphics were created",
            Self::Graphics(Err(_)) => "graphics could not be created",
            Self::Pasted(_) => "text was pasted",
            Self::Linked(_) => "the link has changed",
            Self::Asked(_) => "another page asks for the pose",
        })
    }
}
