//! A session and what is expected of it, checked after every action.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind};

use ik_arm::document::Document;
use ik_arm::session::{
    Action, Dialog, FileAction, Session, SolverEdit, TourAction, TransactionAction,
};

use crate::soak::kinds::{KINDS, Sort, kind};
use crate::soak::past::is_same;
use crate::soak::{Broken, hold, past, pictured, posed, sound};

/// Checks to make after an action.
#[derive(Clone, Copy, Debug)]
pub struct Care {
    /// True if this action is undone and redone.
    pub step: bool,
    pub saving: bool,
    pub scene: bool,
    /// True if everything is undone and redone.
    pub walk: bool,
}

impl Care {
    pub const FULL: Self = Self { step: true, saving: true, scene: true, walk: true };
}

pub struct Watch {
    pub session: Session,
    pub expected: Expected,
    /// During the tour, what is expected of the user's own document.
    own: Option<Expected>,
}

/// The expected state of a document and its history.
pub struct Expected {
    /// First document of the history.
    pub began: Document,
    /// Number of actions since.
    pub age: usize,
    /// The document as last saved; `None` if it never was.
    saved: Option<Document>,
    /// The document before the open transaction.
    before_edit: Option<Document>,
    /// A revision and its document as JSON.
    revisions: HashMap<u64, u64>,
    /// Number of undo steps, if just counted.
    steps: Option<usize>,
}

impl Expected {
    /// Of a document that was just opened.
    fn of(document: Document) -> Self {
        Self {
            began: document.clone(),
            age: 0,
            saved: Some(document),
            before_edit: None,
            revisions: HashMap::new(),
            steps: None,
        }
    }
}

impl Watch {
    /// Number of actions whose steps the history always keeps.
    const WHOLE: usize = 450;

    pub fn new(document: Document) -> Self {
        let session = Session::with_document(Default::default(), document.clone());
        Self { session, expected: Expected::of(document), own: None }
    }

    /// True if the action was applied instead of asked about.
    pub fn apply(&mut self, action: &Action, care: Care) -> Result<bool, Broken> {
        catch_unwind(AssertUnwindSafe(|| self.watched(action, care))).unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or(panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            Err(Broken(format!("nothing panics: {}", text.unwrap_or_default())))
        })
    }

    fn watched(&mut self, action: &Action, care: Care) -> Result<bool, Broken> {
        let mut before = Before::new(&self.session, care.step);
        let own = Before::new(self.session.own(), care.step);
        self.session.apply(action.clone());
        if self.follow_tour(action, &own)? {
            sound::document(self.session.document())?;
            return Ok(true);
        }
        if self.own.is_none() {
            // An action that leaves the tour acts on the user's own document.
            before = own;
        }
        self.expected.age += 1;
        let waits = match action {
            Action::File(action) => Some(Dialog::Unsaved { then: Box::new(action.clone()) }),
            _ => None,
        };
        let waits = waits.as_ref();
        let is_done = waits.is_none()
            || self.session.shell().dialog() != waits
            || before.dialog.as_ref() == waits;
        let is_replaced = self.follow(action, &before);
        sound::document(self.session.document())?;
        sound::shown(&self.session)?;
        posed::all(&self.session)?;
        self.check_documents(action, &before, is_replaced)?;
        self.check_saved(action, is_replaced)?;
        if care.step && !is_replaced {
            self.check_step(action, &before)?;
        }
        if care.saving {
            past::saving(self.session.document())?;
            self.check_revision()?;
        }
        if care.scene {
            pictured::all(&self.session)?;
        }
        self.check_past(action, &before, is_replaced, care.walk)?;
        Ok(is_done)
    }

    /// Follows the beginning, the steps and the end of the tour; `own` is the user's own document
    /// before the action. Returns whether the action has begun a step.
    fn follow_tour(&mut self, action: &Action, own: &Before) -> Result<bool, Broken> {
        let is_begun = matches!(action, Action::Tour(TourAction::Enter(_)));
        if self.session.tour().is_some() {
            hold!(
                is_same(self.session.own().document(), &own.document),
                "the tour leaves the own document alone"
            );
        }
        if is_begun {
            let of_step = Expected::of(self.session.document().clone());
            let before = std::mem::replace(&mut self.expected, of_step);
            self.own.get_or_insert(before);
        } else if self.session.tour().is_none()
            && let Some(own) = self.own.take()
        {
            self.expected = Expected { before_edit: None, steps: None, ..own };
        }
        Ok(is_begun)
    }

    /// Follows saving and opening. Returns whether another document was opened.
    fn follow(&mut self, action: &Action, before: &Before) -> bool {
        let session = &self.session;
        let can_replace = matches!(
            action,
            Action::File(FileAction::Opened { .. })
                | Action::File(FileAction::OpenExample(_))
                | Action::File(FileAction::New)
                | Action::File(FileAction::NewFigure)
                | Action::File(FileAction::NewEmpty)
                | Action::File(FileAction::Recover { .. })
                | Action::File(FileAction::Discard(_))
                | Action::File(FileAction::Saved(_))
        );
        let is_fresh =
            session.history().undo_label().is_none() && session.history().redo_label().is_none();
        let is_replaced = can_replace
            && is_fresh
            && session.history().revision() != before.revision
            && !session.history().is_editing();
        if let Action::File(FileAction::Saved(_)) = action {
            self.expected.saved = Some(before.document.clone());
        }
        if is_replaced {
            self.expected.began = session.document().clone();
            self.expected.saved =
                (!session.history().is_unsaved()).then(|| self.expected.began.clone());
            self.expected.age = 0;
            self.expected.revisions.clear();
        }
        is_replaced
    }

    /// Checks that actions outside the document leave it unchanged, and that a cancelled drag
    /// restores it.
    fn check_documents(
        &mut self,
        action: &Action,
        before: &Before,
        is_replaced: bool,
    ) -> Result<(), Broken> {
        let document = self.session.document();
        let is_left = is_same(document, &before.document);
        let is_view = matches!(action, Action::Solver(_))
            || matches!(KINDS[kind(action)].sort, Sort::Look | Sort::Time);
        hold!(!is_view || is_left || before.follows_mouse, "it leaves the document alone");
        if *action == Action::Edit(SolverEdit::ApplyPose.into()) {
            posed::locked(&before.document.rig, document.skeleton())?;
        }
        let takes_back = matches!(
            action,
            Action::Transaction(TransactionAction::Cancel)
                | Action::Transaction(TransactionAction::Undo)
        );
        if let Some(before) =
            self.expected.before_edit.as_ref().filter(|_| takes_back && !is_replaced)
        {
            hold!(is_same(document, before), "a cancelled transaction leaves no trace");
            let same = past::saved(document)? == past::saved(before)?;
            hold!(same, "a cancelled transaction leaves no trace in a file");
        }
        let pressed = self.expected.before_edit.take();
        self.expected.before_edit = self
            .session
            .history()
            .is_editing()
            .then(|| pressed.unwrap_or_else(|| before.document.clone()));
        Ok(())
    }

    fn check_saved(&self, action: &Action, is_replaced: bool) -> Result<(), Broken> {
        let session = &self.session;
        if !session.history().is_unsaved() {
            let is_saved = self
                .expected
                .saved
                .as_ref()
                .is_some_and(|it| past::has_same_content(it, session.document()));
            hold!(is_saved, "a document that counts as saved equals the saved one");
        }
        let is_written = matches!(action, Action::File(FileAction::Saved(_))) && !is_replaced;
        hold!(!is_written || !session.history().is_unsaved(), "what has just been saved is saved");
        Ok(())
    }

    /// Checks that equal revisions have equal documents.
    fn check_revision(&mut self) -> Result<(), Broken> {
        if self.session.history().is_editing() {
            return Ok(());
        }
        let mut hasher = DefaultHasher::new();
        past::saved(self.session.document())?.hash(&mut hasher);
        let (revision, hash) = (self.session.history().revision(), hasher.finish());
        let known = *self.expected.revisions.entry(revision).or_insert(hash);
        hold!(known == hash, "revision {revision} is one document");
        Ok(())
    }

    /// Checks that an edit of one action is undone by one Undo and redone by one Redo.
    fn check_step(&self, action: &Action, before: &Before) -> Result<(), Broken> {
        let Some(was) = before.session.as_deref() else { return Ok(()) };
        let session = &self.session;
        let is_whole = !was.history().is_editing() && !session.history().is_editing();
        if !is_whole || is_same(session.document(), was.document()) {
            return Ok(());
        }
        let mut copy = session.clone();
        let is_undo = *action == Action::Transaction(TransactionAction::Undo);
        let back = if is_undo { TransactionAction::Redo } else { TransactionAction::Undo };
        copy.apply(back.clone());
        hold!(is_same(copy.document(), was.document()), "one {back:?} leads to before the action");
        let same = past::saved(copy.document())? == past::saved(was.document())?;
        hold!(same, "one {back:?} leads to what was saved before the action");
        let is_same_time = session.playback().time() == was.playback().time();
        let same = is_same(copy.shown(), was.shown());
        hold!(!is_same_time || same, "one {back:?} shows what was shown before the action");
        if matches!(
            action,
            Action::Transaction(TransactionAction::Undo)
                | Action::Transaction(TransactionAction::Redo)
        ) {
            return Ok(());
        }
        copy.apply(TransactionAction::Redo);
        hold!(is_same(copy.document(), session.document()), "one Redo leads to after the action");
        hold!(is_same(copy.shown(), session.shown()), "one Redo shows what the action did");
        Ok(())
    }

    fn check_past(
        &mut self,
        action: &Action,
        before: &Before,
        is_replaced: bool,
        is_due: bool,
    ) -> Result<(), Broken> {
        let last = self.expected.steps.take();
        if !is_due {
            return Ok(());
        }
        let began = (self.expected.age < Self::WHOLE).then_some(&self.expected.began);
        let steps = past::walk(&self.session, began)?;
        self.expected.steps = Some(steps);
        let Some(last) = last.filter(|_| !is_replaced) else { return Ok(()) };
        // Unkeyed edits of keyed channels are no steps at another time.
        let is_elsewhen = before.time != self.session.playback().time();
        let moves = matches!(
            action,
            Action::Transaction(TransactionAction::Undo)
                | Action::Transaction(TransactionAction::Redo)
        ) || is_elsewhen;
        hold!(moves || steps <= last + 1, "an action is one step: {steps} after {last}");
        Ok(())
    }
}

/// State before an action, for comparison.
struct Before {
    document: Document,
    session: Option<Box<Session>>,
    dialog: Option<Dialog>,
    revision: u64,
    time: f64,
    follows_mouse: bool,
}

impl Before {
    fn new(session: &Session, whole: bool) -> Self {
        Self {
            document: session.document().clone(),
            session: whole.then(|| Box::new(session.clone())),
            dialog: session.shell().dialog().cloned(),
            revision: session.history().revision(),
            time: session.playback().time(),
            follows_mouse: session.history().follows_mouse(),
        }
    }
}
