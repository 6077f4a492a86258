/// Request of a screen reader.
pub(in crate::app) type PlatformEvent = egui_winit::accesskit_winit::Event;
