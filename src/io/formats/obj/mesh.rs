//! The triangles of a file, by materials.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

use crate::kinematics::skin::TriangleMesh;

/// An error in a line, whose first byte is at `at` in the text.
pub struct LineError {
    pub at: usize,
    pub reason: String,
}

/// Corner of a face: indices of its position, texture coordinates and normal.
type Corner = (usize, Option<usize>, Option<usize>);

/// A file as far as it is read.
#[derive(Default)]
pub struct ObjMesh {
    positions: Vec<Vec3>,
    /// sRGB; one for each position, or none.
    colours: Vec<[u8; 4]>,
    coordinates: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// The vertex of each corner.
    vertices: HashMap<Corner, u32>,
    corners: Vec<Corner>,
    /// Materials by name in the order in which faces use them, with the triangles of these faces.
    pub parts: Vec<(String, Vec<[u32; 3]>)>,
    part_of: HashMap<String, usize>,
    material: String,
    /// Files with materials, each with the place of its line in the text.
    pub libraries: Vec<(String, usize)>,
}

impl ObjMesh {
    /// Reads a text.
    pub fn new(text: &str) -> Result<Self, LineError> {
        let mut mesh = Self::default();
        for (at, line) in lines(text) {
            mesh.add(at, &line).map_err(|reason| LineError { at, reason })?;
        }
        Ok(mesh)
    }

    fn add(&mut self, at: usize, line: &str) -> Result<(), String> {
        let line = line.trim();
        let (word, name) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        // Names can have a #, such as `Material #25`.
        let rest = name.split('#').next().unwrap_or_default();
        match word {
            "v" => self.add_position(rest)?,
            "vt" => self.add_coordinates(rest)?,
            "vn" => self.add_normal(rest)?,
            "f" => self.add_face(rest)?,
            "usemtl" => name.trim().clone_into(&mut self.material),
            "mtllib" => self.add_libraries(at, name),
            // Names of objects and groups, smoothing, points, lines and curves.
            _ => {}
        }
        Ok(())
    }

    fn add_position(&mut self, rest: &str) -> Result<(), String> {
        let position: [f32; 3] = numbers(rest, "v", "x y z")?;
        let others: Vec<&str> = rest.split_whitespace().skip(3).collect();
        // Three numbers more are a colour; with a fourth before them, which is a weight.
        if let [.., red, green, blue] = others[..] {
            let channel = |text: &str| text.parse::<f32>().unwrap_or(1.0).clamp(0.0, 1.0);
            let [red, green, blue] =
                [red, green, blue].map(|it| (channel(it) * 255.0).round() as u8);
            self.colours.resize(self.positions.len(), [255; 4]);
            self.colours.push([red, green, blue, 255]);
        }
        self.positions.push(position.into());
        Ok(())
    }

    fn add_coordinates(&mut self, rest: &str) -> Result<(), String> {
        let v_is_missing = rest.split_whitespace().nth(1).is_none();
        let [u, v] = match v_is_missing {
            true => [numbers::<1>(rest, "vt", "u")?[0], 0.0],
            false => numbers(rest, "vt", "u v")?,
        };
        self.coordinates.push(Vec2::new(u, 1.0 - v));
        Ok(())
    }

    fn add_normal(&mut self, rest: &str) -> Result<(), String> {
        // Some programs write NaN for corners of triangles without an area; these become smooth.
        let normal = match rest.to_ascii_lowercase().contains("nan") {
            true => [0.0; 3],
            false => numbers(rest, "vn", "x y z")?,
        };
        self.normals.push(Vec3::from(normal).normalize_or_zero());
        Ok(())
    }

    /// Adds the files with materials of a line: one, whose name can have spaces, or several.
    fn add_libraries(&mut self, at: usize, names: &str) {
        let names = names.split_inclusive(".mtl").map(str::trim).filter(|name| !name.is_empty());
        self.libraries.extend(names.map(|name| (name.to_owned(), at)));
    }

    /// Adds the triangles of a face around its first corner.
    fn add_face(&mut self, rest: &str) -> Result<(), String> {
        let mut corners = Vec::new();
        for text in rest.split_whitespace() {
            corners.push(self.vertex(text)?);
        }
        let [first, others @ ..] = &corners[..] else {
            return Err("f must have at least three corners, got none".to_owned());
        };
        if others.len() < 2 {
            return Err(format!("f must have at least three corners, got {}", corners.len()));
        }
        let part = match self.part_of.get(&self.material) {
            Some(part) => *part,
            None => {
                self.parts.push((self.material.clone(), Vec::new()));
                self.part_of.insert(self.material.clone(), self.parts.len() - 1);
                self.parts.len() - 1
            }
        };
        let triangles = others.windows(2).map(|pair| [*first, pair[0], pair[1]]);
        self.parts[part].1.extend(triangles);
        Ok(())
    }

    /// The vertex of a corner such as `1/2/3`, `1//3` or `-1`.
    fn vertex(&mut self, text: &str) -> Result<u32, String> {
        let mut indices = text.split('/');
        let mut index = |what: &str, count: usize| {
            let text = indices.next().filter(|text| !text.is_empty());
            text.map(|text| index_of(text, what, count)).transpose()
        };
        let position = index("v", self.positions.len())?;
        let corner = (
            position
                .ok_or_else(|| format!("a corner must begin with the index of a v, got {text}"))?,
            index("vt", self.coordinates.len())?,
            index("vn", self.normals.len())?,
        );
        let next = self.corners.len() as u32;
        let vertex = *self.vertices.entry(corner).or_insert(next);
        if vertex == next {
            self.corners.push(corner);
        }
        Ok(vertex)
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|(_, triangles)| triangles.len()).sum()
    }

    /// The mesh with the triangles of all parts, one part after the other.
    pub fn mesh(&self) -> TriangleMesh {
        let smooth = self.smooth_normals();
        let has_coordinates = !self.coordinates.is_empty();
        let corners = || self.corners.iter().copied();
        let normal = |(position, _, normal): Corner| {
            let given = normal.map(|normal| self.normals[normal]);
            given.filter(|it| *it != Vec3::ZERO).unwrap_or(smooth[position])
        };
        let place = |(_, at, _): Corner| at.map(|at| self.coordinates[at]).unwrap_or_default();
        let colour =
            |(position, ..): Corner| self.colours.get(position).copied().unwrap_or([255; 4]);
        TriangleMesh {
            positions: corners().map(|(position, ..)| self.positions[position]).collect(),
            normals: corners().map(normal).collect(),
            texture_coordinates: corners().filter(|_| has_coordinates).map(place).collect(),
            colours: corners().filter(|_| !self.colours.is_empty()).map(colour).collect(),
            triangles: self.parts.iter().flat_map(|(_, triangles)| triangles).copied().collect(),
            ..TriangleMesh::default()
        }
    }

    /// For each position the mean of the normals of the triangles around it, by their areas.
    fn smooth_normals(&self) -> Vec<Vec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for corners in self.parts.iter().flat_map(|(_, triangles)| triangles) {
            let positions = corners.map(|corner| self.corners[corner as usize].0);
            let [a, b, c] = positions.map(|position| self.positions[position].as_dvec3());
            let area = (b - a).cross(c - a);
            positions.into_iter().for_each(|position| sums[position] += area);
        }
        sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()).collect()
    }
}

/// The lines of a text, each with the place of its first byte. A line that ends with a backslash, and
/// is no comment, goes on in the next one.
pub fn lines(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut rest = text.split_inclusive('\n');
    let mut next = 0;
    std::iter::from_fn(move || {
        let at = next;
        let mut joined = String::new();
        loop {
            let Some(line) = rest.next() else {
                return (!joined.is_empty()).then_some((at, joined));
            };
            next += line.len();
            let line = line.trim_end();
            let is_comment = joined.is_empty() && line.trim_start().starts_with('#');
            let begun = line.strip_suffix('\\').filter(|_| !is_comment);
            let Some(begun) = begun else {
                joined.push_str(line);
                return Some((at, joined));
            };
            joined.push_str(begun);
            joined.push(' ');
        }
    })
}

/// The first numbers of a line; numbers beyond them are ignored.
pub fn numbers<const N: usize>(text: &str, word: &str, names: &str) -> Result<[f32; N], String> {
    let mut numbers = [0.0; N];
    let mut words = text.split_whitespace();
    for number in &mut numbers {
        let word_read = words.next();
        let parsed = word_read.and_then(|text| text.parse::<f32>().ok());
        *number = parsed.filter(|number| number.is_finite()).ok_or_else(|| {
            let got = word_read.map_or_else(|| "too few".to_owned(), |it| format!("{it:?}"));
            match N {
                1 => format!("{word} must have a finite number, {names}, got {got}"),
                _ => format!("{word} must have {N} finite numbers, {names}, got {got}"),
            }
        })?;
    }
    Ok(numbers)
}

/// The index from 0 for one from 1, or from −1 backwards.
fn index_of(text: &str, what: &str, count: usize) -> Result<usize, String> {
    let index = text.parse::<i64>().ok().and_then(|index| match index {
        1.. => usize::try_from(index - 1).ok(),
        0 => None,
        _ => usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)),
    });
    index.filter(|index| *index < count).ok_or_else(|| match count {
        0 => {
            format!("a corner must not have a {what}, because there is none before it, got {text}")
        }
        _ => format!(
            "the {what} of a corner must be from 1 to {count}, or from -{count} to -1, got {text}"
        ),
    })
}
