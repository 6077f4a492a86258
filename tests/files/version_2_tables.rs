//! Documents of version 2 move as they did: their tables of joint positions against those that the
//! last program of version 2 wrote of the same files.

use std::fs;

use glam::DVec3;
use ik_arm::io::{self, Progress};
use pollster::block_on;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/version-2/motions");

/// Columns of the arm's joints in a table of version 2, and of the same points today.
const ARM: [(&str, &str); 3] = [("shoulder", "upper"), ("elbow", "lower"), ("hand", "hand")];

/// Frames in which the Pointer is exactly in a singular direction of the twist reference. The elbow
/// stood at the fallback direction of the reference; it now goes on from the frame before.
const SINGULAR: [(&str, f64); 2] = [("along-the-pole", 60.0), ("straight-up-and-down", 135.0)];

struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(text: &[u8]) -> Self {
        let mut reader = csv::Reader::from_reader(text);
        let columns = reader.headers().expect("a header").iter().map(str::to_owned).collect();
        let rows = reader.deserialize().map(|row| row.expect("numbers")).collect();
        Self { columns, rows }
    }

    /// Names of the points with coordinates, in order.
    fn points(&self) -> Vec<String> {
        let of_x = self.columns.iter().filter_map(|column| column.strip_suffix(".x"));
        of_x.map(str::to_owned).collect()
    }

    fn point(&self, row: &[f64], name: &str) -> DVec3 {
        let x = format!("{name}.x");
        let at = self.columns.iter().position(|column| *column == x).expect("a column");
        DVec3::from_slice(&row[at..])
    }

    /// Size of the figure in the first row, and its largest coordinate in any.
    fn sizes(&self) -> (f64, f64) {
        let points = self.points();
        let first = self.rows[0].as_slice();
        let place = |name: &String| self.point(first, name);
        let steps = points.windows(2).map(|pair| place(&pair[0]).distance(place(&pair[1])));
        let coordinates = self.rows.iter().flat_map(|row| &row[2..]);
        (steps.sum(), coordinates.fold(0.0, |most, it| it.abs().max(most)))
    }
}

#[test]
fn documents_of_version_2_move_as_in_the_program_that_wrote_them() {
    let mut rows = 0;
    let paths = fs::read_dir(FOLDER).expect("a folder").map(|entry| entry.expect("a file").path());
    for path in paths.filter(|path| path.extension().is_some_and(|it| it == "json")) {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let before = Table::read(&fs::read(path.with_extension("csv")).expect("text"));
        let opened = io::open(&path, &io::OpenOptions::default());
        let document = opened.unwrap_or_else(|error| panic!("{error}")).document;
        let table =
            block_on(io::to_csv(&document, None, &Progress::default())).expect("it is written");
        let after = Table::read(&table.bytes);
        assert_eq!(after.rows.len(), before.rows.len(), "{name}");

        let (size, largest) = before.sizes();
        let allowed = 1e-5 * size + 4.0 * f64::from(f32::EPSILON) * largest;
        let is_arm = before.points() == ARM.map(|(former, _)| former);
        let points: Vec<(String, String)> = if is_arm {
            ARM.map(|(former, now)| (former.to_owned(), now.to_owned())).into()
        } else {
            assert_eq!(after.columns, before.columns, "{name}");
            before.points().into_iter().map(|point| (point.clone(), point)).collect()
        };
        for (was, is) in before.rows.iter().zip(&after.rows) {
            assert_eq!(was[..2], is[..2], "{name}: frame and time");
            for (former, now) in &points {
                let is_singular = SINGULAR.contains(&(name.as_str(), was[0]));
                let off = before.point(was, former).distance(after.point(is, now));
                let may_differ = is_singular && former == "elbow";
                assert!(
                    off <= allowed || may_differ,
                    "{name}, frame {}: {former} is {off} away",
                    was[0]
                );
            }
            rows += 1;
        }
    }
    assert!(rows > 1500, "{rows}");
}
