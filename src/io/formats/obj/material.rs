//! Materials, in `.mtl` files.

use std::collections::HashMap;

use super::mesh::{lines, numbers};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMaterial {
    /// `Kd`, as sRGB.
    pub colour: [f32; 3],
    /// `Ke`, as sRGB.
    pub emission: [f32; 3],
    /// `d`, from 0 to 1; without it 1 − `Tr`, or 1.
    pub opacity: f32,
    has_opacity: bool,
    /// File with the image of `map_Kd`.
    pub texture: Option<String>,
}

impl Default for ObjMaterial {
    fn default() -> Self {
        Self {
            colour: [1.0; 3],
            emission: [0.0; 3],
            opacity: 1.0,
            has_opacity: false,
            texture: None,
        }
    }
}

/// Reads the materials of a text, by their names, into `materials`. Returns what is wrong with lines
/// that are left out.
pub fn read(text: &str, materials: &mut HashMap<String, ObjMaterial>) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut name = None;
    for (number, (_, line)) in (1..).zip(lines(text)) {
        let line = line.trim();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if word == "newmtl" {
            name = Some(rest.trim().to_owned());
            materials.insert(rest.trim().to_owned(), ObjMaterial::default());
            continue;
        }
        let Some(material) = name.as_ref().and_then(|name| materials.get_mut(name)) else {
            continue;
        };
        if let Err(reason) = material.set(word, rest.trim()) {
            wrong.push(format!("line {number}: {reason}"));
        }
    }
    wrong
}

impl ObjMaterial {
    fn set(&mut self, word: &str, rest: &str) -> Result<(), String> {
        let colour = || {
            let [red, green, blue] = numbers(rest, word, "r g b")?;
            Ok::<_, String>([red, green, blue].map(|channel: f32| channel.clamp(0.0, 1.0)))
        };
        let number = || {
            let rest = rest.strip_prefix("-halo").unwrap_or(rest);
            let [number] = numbers(rest, word, "from 0 to 1")?;
            Ok::<_, String>(f32::clamp(number, 0.0, 1.0))
        };
        match word {
            "Kd" => self.colour = colour()?,
            "Ke" => self.emission = colour()?,
            "d" => (self.opacity, self.has_opacity) = (number()?, true),
            "Tr" if !self.has_opacity => self.opacity = 1.0 - number()?,
            "map_Kd" => {
                // Options such as `-s 1 1 1` stand before the name.
                let name = match rest.starts_with('-') {
                    true => rest.split_whitespace().last().unwrap_or_default(),
                    false => rest,
                };
                self.texture = (!name.is_empty()).then(|| name.replace('\\', "/"));
            }
            _ => {}
        }
        Ok(())
    }
}
