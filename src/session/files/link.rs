use crate::io::{Link, LinkError, LinkScene};
use crate::session::action::Action;
use crate::session::files::action::FileAction;
use crate::session::playback::PlaybackAction;
use crate::session::shell::ShellAction;
use crate::session::tour::TourAction;

/// The actions that open what a link carries, or say why it cannot be opened.
pub fn link_actions(link: Result<Link, LinkError>) -> Vec<Action> {
    let Link { scene, time, tour } = match link {
        Ok(link) => link,
        Err(error) => return vec![ShellAction::Fail(error.to_string()).into()],
    };
    let opened = scene.map(|scene| match scene {
        LinkScene::Example(example) => FileAction::OpenExample(example).into(),
        LinkScene::Document(document) => {
            FileAction::Opened { document, file: None, contents: None }.into()
        }
    });
    let at = time.map(|time| PlaybackAction::SetTime(time).into());
    let step = tour.map(|step| TourAction::Enter(usize::from(step) - 1).into());
    opened.into_iter().chain(at).chain(step).collect()
}
