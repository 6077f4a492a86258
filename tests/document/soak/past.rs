//! Checks of undo, redo and saving.

use ik_arm::document::Document;
use ik_arm::io;
use ik_arm::session::{Action, Session, TransactionAction};

use crate::soak::{Broken, hold};

/// Equal except for the camera, which is not undone.
pub fn is_same(a: &Document, b: &Document) -> bool {
    a.display == b.display && has_same_content(a, b)
}

/// Equal except for the cameras.
pub fn has_same_content(a: &Document, b: &Document) -> bool {
    let Document {
        rig,
        keys,
        timeline,
        track_start,
        camera: _,
        display: _,
        metres_per_unit,
        animation_name,
    } = a;
    *rig == b.rig
        && *keys == b.keys
        && *timeline == b.timeline
        && *track_start == b.track_start
        && *metres_per_unit == b.metres_per_unit
        && *animation_name == b.animation_name
}

/// Names of the fields in which two documents differ.
fn differing_fields(a: &Document, b: &Document) -> Vec<&'static str> {
    let (one, other) = (&a.rig, &b.rig);
    let fields = [
        ("skeleton", one.skeleton == other.skeleton),
        ("targets", one.targets == other.targets),
        ("posture", one.posture == other.posture),
        ("skin", one.skin == other.skin),
        ("rig", one == other),
        ("keys", a.keys == b.keys),
        ("timeline", a.timeline == b.timeline),
        ("track start", a.track_start == b.track_start),
        ("camera", a.camera == b.camera),
        ("document", a == b),
    ];
    fields.iter().filter(|(_, is_same)| !is_same).map(|(name, _)| *name).collect()
}

/// The document as JSON, with a default camera.
pub fn saved(document: &Document) -> Result<String, Broken> {
    let camera = Document::default().camera;
    let document = Document { camera, ..document.clone() };
    io::to_json(&document).map_err(|error| Broken(format!("a document can be saved: {error}")))
}

/// Checks that a saved document opens bit-identically.
pub fn saving(document: &Document) -> Result<(), Broken> {
    let text =
        io::to_json(document).map_err(|error| Broken(format!("it can be saved: {error}")))?;
    let opened = io::parse("soak.json", &text, &io::OpenOptions::default())
        .map_err(|error| Broken(format!("what is saved can be opened: {error}")))?;
    // A skin's file may be missing, which is told at every opening.
    let odd = opened.warnings.iter().find(|remark| remark.field != "skin.mesh.file");
    hold!(odd.is_none(), "nothing is odd in what is saved: {odd:?}");
    let differing = differing_fields(&opened.document, document);
    hold!(differing.is_empty(), "a saved document opens unchanged, not with other {differing:?}");
    let again = io::to_json(&opened.document).ok();
    hold!(again.as_ref() == Some(&text), "an opened document is saved with the same bytes");
    Ok(())
}

/// Number of undo steps. Checks that undoing all leads to the first document and redoing all back.
pub fn walk(session: &Session, began: Option<&Document>) -> Result<usize, Broken> {
    let mut session = session.clone();
    session.apply(TransactionAction::Commit);
    let present = (session.shown().clone(), saved(session.document())?);
    walk_there_and_back(
        &mut session,
        &TransactionAction::Redo.into(),
        &TransactionAction::Undo.into(),
    )?;
    let mut first = session.clone();
    let steps = walk_there_and_back(
        &mut session,
        &TransactionAction::Undo.into(),
        &TransactionAction::Redo.into(),
    )?;
    while first.history().undo_label().is_some() {
        first.apply(TransactionAction::Undo);
    }
    if let Some(began) = began {
        hold!(is_same(first.document(), began), "all undone, it is the document of the beginning");
        let same = saved(first.document())? == saved(began)?;
        hold!(same, "all undone, it is saved as the document of the beginning");
    }
    hold!(is_same(session.shown(), &present.0), "undo and redo restore what is shown");
    let same = saved(session.document())? == present.1;
    hold!(same, "undo and redo restore what is saved");
    Ok(steps)
}

/// Applies one action to the end and the other back, and checks that both see the same documents.
fn walk_there_and_back(
    session: &mut Session,
    there: &Action,
    back: &Action,
) -> Result<usize, Broken> {
    const ENDLESS: usize = 3000;
    let mut passed: Vec<(Document, Document)> = Vec::new();
    loop {
        let state = (session.document().clone(), session.shown().clone());
        session.apply(there.clone());
        if session.shell().message().is_none_or(|message| message.starts_with("There is nothing")) {
            hold!(is_same(session.document(), &state.0), "nothing to {there:?} changes nothing");
            break;
        }
        passed.push(state);
        hold!(passed.len() < ENDLESS, "{there:?} comes to an end");
    }
    let steps = passed.len();
    for (step, (document, shown)) in passed.into_iter().enumerate().rev() {
        session.apply(back.clone());
        let name = session.shell().message().unwrap_or_default().to_owned();
        let same = is_same(session.document(), &document);
        hold!(
            same,
            "{there:?} and {back:?} are the same document, at step {step} of {steps}, {name}"
        );
        let same = is_same(session.shown(), &shown);
        hold!(same, "{there:?} and {back:?} are shown the same, at step {step} of {steps}, {name}");
    }
    Ok(steps)
}
