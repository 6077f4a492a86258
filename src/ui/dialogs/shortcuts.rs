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
                ("Front", "1"),
                ("Right", "3"),
                ("Top", "7"),
                ("Back", "Ctrl+1"),
                ("Left", "Ctrl+3"),
                ("Bottom", "Ctrl+7"),
                ("Perspective or orthographic", "5"),
                ("Frame the selection", "F"),
                ("Frame all", "Home"),
                ("Orbit", "arrows"),
                ("Pan", "Shift+arrows"),
                ("Zoom", "+ and -"),
                ("Reset the view", "double-click the background"),
            ],
        ),
        (
            "Skeleton",
            &[
                ("Select", "click"),
                ("Add to the selection", "Shift+click"),
                ("Select all", "Ctrl+A"),
                ("Select none", "Esc"),
                ("Add a child joint", "A"),
                ("Add a child joint at the mouse", "Ctrl+click"),
                ("Add or remove a target", "T"),
                ("Rename", "F2, double-click in the list"),
                ("Delete", "Delete"),
                ("Run or pause the solver", "R"),
                ("One iteration", "S"),
                ("Previous iteration", ","),
                ("Next iteration", "."),
                ("Previous part of an iteration", "Shift ,"),
                ("Next part of an iteration", "Shift ."),
                ("End the solver run or the race", "Esc"),
            ],
        ),
        (
            "During a drag",
            &[
                ("Precise", "Shift"),
                ("Snap", "Ctrl"),
                ("Lock to an axis", "X, Y, Z"),
                ("Lock to a plane", "Shift+X, Y, Z"),
                ("Type the offset", "digits"),
                ("Accept", "Enter"),
                ("Cancel", "Esc, right button"),
            ],
        ),
        (
            "Numbers and sliders",
            &[
                ("Step 1", "arrows"),
                ("Step 0.1", "Shift+arrows"),
                ("Step 10", "Page Up, Page Down"),
                ("Minimum", "Home"),
                ("Maximum", "End"),
                ("Reset", "double-click"),
                ("Next number, after typing", "Tab"),
                ("Number before, after typing", "Shift+Tab"),
                ("Cancel a drag", "Esc"),
            ],
        ),
        (
            "Document",
            &[
                ("Undo", "Ctrl+Z"),
                ("Redo", "Ctrl+Shift+Z"),
                ("New", "Ctrl+N"),
                ("New figure", "Ctrl+Alt+N"),
                ("New empty document", "Ctrl+Shift+N"),
                ("Open", "Ctrl+O"),
                ("Save", "Ctrl+S"),
                ("Save as", "Ctrl+Shift+S"),
                ("Export", "Ctrl+E"),
                ("Save a picture", "Ctrl+P"),
                ("Copy the pose", "Ctrl+C"),
                ("Quit", "Ctrl+Q"),
            ],
        ),
        (
            "Timeline",
            &[
                ("Play or pause", "Space"),
                ("Key the selected channels", "K"),
                ("Key all channels", "Shift+K"),
                ("Previous and next frame", "left and right in the timeline"),
                ("Previous and next key", "up and down in the timeline"),
                ("Start", "Home in the timeline"),
                ("End", "End in the timeline"),
                ("Select keys", "click, drag a box"),
                ("Add keys to the selection", "Shift"),
                ("Select all keys", "Ctrl+A"),
                ("Delete keys", "Delete"),
                ("Copy keys", "Ctrl+C"),
                ("Paste keys", "Ctrl+V"),
                ("Drag off the frame grid", "Ctrl"),
                ("Drag a key in one direction", "Shift in the graph editor"),
                ("Turn one side of a tangent", "Alt in the graph editor"),
                ("Zoom", "wheel"),
                ("Pan", "middle drag"),
            ],
        ),
    ];
    let room = ui.ctx().content_rect().size() - vec2(64.0, 96.0);
    // As many columns as fit: three show all shortcuts at once, less scroll.
    let (width, columns): (f32, &[&[usize]]) = match room.x {
        1208.0.. => (1208.0, &[&[0, 1, 3], &[2, 4], &[5, 6]]),
        840.0.. => (840.0, &[&[0, 2, 3, 4], &[1, 5, 6]]),
        _ => (420.0, &[&[0, 1, 2, 3, 4, 5, 6]]),
    };
    let size = vec2(width, 690.0).min(room);
    ui.set_min_size(size);
    ScrollArea::both().max_width(size.x).max_height(size.y).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 20.0;
            for column in columns {
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
    let grid = Grid::new(title).num_columns(2).min_col_width(178.0);
    grid.min_row_height(18.0).spacing(vec2(8.0, 2.0)).show(ui, |ui| {
        for (what, keys) in rows {
            ui.label(*what);
            ui.weak(*keys);
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}
