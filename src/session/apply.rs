use super::action::Action;
use super::effect::Effect;
use super::panel_tab::PanelTab;
use super::session::Session;

impl Session {
    /// Applies an action and returns the effect that the program must carry out, if any. An invalid
    /// action changes nothing and is reported by [`Session::message`]; an action that would lose
    /// unsaved changes opens a dialog first.
    pub fn apply(&mut self, action: impl Into<Action>) -> Option<Effect> {
        let compared = self.compares_skinning();
        let effect = self.apply_to_part(action.into());
        if self.compares_skinning() && !compared {
            self.show_tab(PanelTab::Skin);
        }
        self.watch_tour();
        effect
    }

    fn apply_to_part(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Edit(action) => self.apply_edit(action),
            Action::Transaction(action) => self.apply_transaction(action),
            Action::Select(action) => return self.apply_selection(action),
            Action::View(action) => self.apply_view(action),
            Action::Playback(action) => self.apply_playback(action),
            Action::Solver(action) => self.apply_solver(action),
            Action::Bake(action) => return self.apply_bake(action),
            Action::File(action) => return self.apply_file(action),
            Action::Shell(action) => return self.apply_shell(action),
            Action::Tour(action) => self.apply_tour(action),
        }
        None
    }
}
