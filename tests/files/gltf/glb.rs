//! A `.glb` file taken apart, by other code than the program's own.

use glam::{Mat4, Quat, Vec3};
use serde_json::Value;

pub struct Glb {
    pub json: Value,
    binary: Vec<u8>,
}

impl Glb {
    pub fn new(bytes: &[u8]) -> Self {
        let number = |at: usize| {
            u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize
        };
        assert_eq!((&bytes[..4], number(4), number(8)), (&b"glTF"[..], 2, bytes.len()));
        let json = number(12);
        assert_eq!((&bytes[16..20], json % 4), (&b"JSON"[..], 0));
        let binary = 20 + json;
        assert_eq!((&bytes[binary + 4..binary + 8], number(binary) % 4), (&b"BIN\0"[..], 0));
        assert_eq!(binary + 8 + number(binary), bytes.len());
        Self {
            json: serde_json::from_slice(&bytes[20..binary]).expect("JSON"),
            binary: bytes[binary + 8..].to_vec(),
        }
    }

    pub fn nodes(&self) -> &Vec<Value> {
        self.json["nodes"].as_array().expect("nodes")
    }

    /// The joints of the skin.
    pub fn joints(&self) -> Vec<usize> {
        indices(&self.json["skins"][0]["joints"])
    }

    pub fn name(&self, node: usize) -> &str {
        self.nodes()[node]["name"].as_str().expect("a name")
    }

    pub fn node(&self, name: &str) -> usize {
        let has_name = |node: &Value| node["name"] == name;
        self.nodes().iter().position(has_name).unwrap_or_else(|| panic!("no node {name}"))
    }

    pub fn children(&self, node: usize) -> Vec<usize> {
        indices(&self.nodes()[node]["children"])
    }

    pub fn local(&self, node: usize) -> Mat4 {
        let node = &self.nodes()[node];
        let [translation, rotation] = ["translation", "rotation"].map(|key| floats(&node[key]));
        let rotation = match rotation[..] {
            [x, y, z, w] => Quat::from_xyzw(x, y, z, w),
            _ => Quat::IDENTITY,
        };
        let translation = match translation[..] {
            [x, y, z] => Vec3::new(x, y, z),
            _ => Vec3::ZERO,
        };
        Mat4::from_rotation_translation(rotation, translation)
    }

    /// In the world, for every node.
    pub fn worlds(&self) -> Vec<Mat4> {
        let mut worlds = vec![Mat4::NAN; self.nodes().len()];
        let mut next = indices(&self.json["scenes"][0]["nodes"]);
        next.iter().for_each(|node| worlds[*node] = self.local(*node));
        while let Some(node) = next.pop() {
            for child in self.children(node) {
                worlds[child] = worlds[node] * self.local(child);
                next.push(child);
            }
        }
        worlds
    }

    /// Rows of floats.
    pub fn rows(&self, accessor: &Value) -> Vec<Vec<f32>> {
        let accessor = &self.json["accessors"][index(accessor)];
        assert_eq!(accessor["componentType"], 5126);
        let view = &self.json["bufferViews"][index(&accessor["bufferView"])];
        let offset = |of: &Value| of["byteOffset"].as_u64().unwrap_or(0) as usize;
        let start = offset(view) + offset(accessor);
        let width = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            Some("MAT4") => 16,
            other => panic!("{other:?}"),
        };
        let bytes = &self.binary[start..start + 4 * width * index(&accessor["count"])];
        let numbers = bytes.chunks(4).map(|four| f32::from_le_bytes(four.try_into().expect("4")));
        numbers.collect::<Vec<_>>().chunks(width).map(<[f32]>::to_vec).collect()
    }
}

pub fn index(value: &Value) -> usize {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no index")) as usize
}

fn indices(value: &Value) -> Vec<usize> {
    value.as_array().map(|values| values.iter().map(index).collect()).unwrap_or_default()
}

pub fn floats(value: &Value) -> Vec<f32> {
    let number = |value: &Value| value.as_f64().expect("a number") as f32;
    value.as_array().map(|values| values.iter().map(number).collect()).unwrap_or_default()
}
