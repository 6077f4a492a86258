//! The table of mouse and keyboard shortcuts.

use egui::{Grid, ScrollArea, Ui, vec2};

use crate::session::Session;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session) {
    let navigation = session.preferences().navigation;
    let [orbit, pan, zoom] = navigation.help();
    let view = format!("View ({})", navigation.name());
    let groups: [(&str, &[(&str, &str)]); 7] = [
        (
            &view,
            &[
                ("Orbit", orbit),
                ("Pan", pan),
                ("Zoom", zoom),
                ("Orbit over handles", "Alt+left drag"),
            ],
        ),
        (
            "Camera",
            &[
                ("Front, right, top", "1, 3, 7"),
                ("Back, left, bottom", "Ctrl+1, 3, 7"),
                ("Toggle perspective, orthographic", "5"),
                ("Frame selection, all", "F, Home"),
                ("Orbit, pan, zoom", "arrows, Shift+arrows, + -"),
                ("Reset view", "double-click the background"),
            ],
        ),
        (
            "Skeleton",
            &[
                ("Select, add to the selection", "click, Shift+click"),
                ("Add a child joint, at the mouse", "A, Ctrl+click"),
                ("Add or remove a target, rename, delete", "T, F2, Delete"),
                ("Run or pause the solver, one iteration", "R, S"),
                ("Previous, next iteration", ", ."),
                ("End the solver run or the race", "Esc"),
                ("Select all, none", "Ctrl+A, Esc"),
            ],
        ),
        (
            "During a drag",
            &[
                ("Precise, snap", "Shift, Ctrl"),
                ("Lock to an axis, a plane", "X Y Z, Shift+X Y Z"),
                ("Type the offset", "digits , - ."),
                ("Accept, cancel", "Enter, Esc or right button"),
            ],
        ),
        (
            "Sliders",
            &[
                ("Step 1, 0.1, 10", "arrows, Shift+arrows, Page keys"),
                ("Minimum and maximum, reset", "Home End, double-click"),
                ("Cancel a drag", "Esc"),
            ],
        ),
        (
            "Document",
            &[
                ("Undo, redo", "Ctrl+Z, Ctrl+Shift+Z"),
                ("New, new skeleton", "Ctrl+N, Ctrl+Shift+N"),
                ("Open, save, save as", "Ctrl+O, Ctrl+S, Ctrl+Shift+S"),
                ("Export, save a picture", "Ctrl+E, Ctrl+P"),
            ],
        ),
        (
            "Timeline",
            &[
                ("Play or pause", "Space"),
                ("Key selected, all", "K, Shift+K"),
                ("Previous and next frame, key", "arrows in the timeline"),
                ("Start, end", "Home, End in the timeline"),
                ("Select keys, add, all", "click or box, Shift, Ctrl+A"),
                ("Delete, copy, paste keys", "Delete, Ctrl+C, Ctrl+V"),
                ("Drag off the frame grid", "Ctrl"),
                ("Zoom, pan the timeline", "wheel, middle drag"),
            ],
        ),
    ];
    // Two columns show all shortcuts at once; a window too small for them scrolls.
    let room = ui.ctx().content_rect().size() - vec2(64.0, 96.0);
    let size = vec2(900.0, 460.0).min(room);
    ui.set_min_size(size);
    ScrollArea::both().max_width(size.x).max_height(size.y).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 24.0;
            for column in [&[0, 2, 4, 5][..], &[1, 3, 6]] {
                ui.vertical(|ui| {
                    ui.spacing_mut().item_spacing.x = 8.0;
                    column.iter().for_each(|group| group_of_keys(ui, groups[*group]));
                });
            }
        });
    });
}

fn group_of_keys(ui: &mut Ui, (title, rows): (&str, &[(&str, &str)])) {
    ui.strong(title);
    let grid = Grid::new(title).num_columns(2).min_col_width(190.0);
    grid.min_row_height(18.0).spacing(vec2(8.0, 2.0)).show(ui, |ui| {
        for (what, keys) in rows {
            ui.label(*what);
            ui.weak(*keys);
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}
