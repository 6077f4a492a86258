//! Small glTF files, written by hand.

use serde_json::{Value, json};

/// A file in the making: its JSON, and the bytes of its buffer.
pub struct Text {
    pub json: Value,
    bytes: Vec<u8>,
}

impl Text {
    /// A file with nodes, of which those are the joints.
    pub fn new(nodes: Value, joints: &[usize]) -> Self {
        let json = json!({
            "scene": 0, "scenes": [{ "nodes": [0] }],
            "nodes": nodes, "skins": [{ "name": "skin", "joints": joints }],
            "accessors": [], "bufferViews": [], "buffers": [{ "byteLength": 0 }],
            "asset": { "version": "2.0" },
        });
        Self { json, bytes: Vec::new() }
    }

    /// Three joints in a row, each 1 above the one before, and a separate fourth node.
    pub fn chain() -> Self {
        let up = json!([0, 1, 0]);
        let nodes = json!([
            { "name": "a", "children": [1, 3] },
            { "name": "b", "children": [2], "translation": up },
            { "name": "c", "translation": up },
            { "name": "lamp", "translation": [5, 0, 0] },
        ]);
        Self::new(nodes, &[0, 1, 2])
    }

    /// An accessor of floats, in rows of so many.
    pub fn floats(&mut self, width: usize, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let shape = if width == 1 { "SCALAR".to_owned() } else { format!("VEC{width}") };
        self.accessor(&bytes, 5126, numbers.len() / width, &shape)
    }

    /// A buffer view with these bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let view = push(
            &mut self.json["bufferViews"],
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }),
        );
        self.bytes.extend(bytes);
        view
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, count: usize, shape: &str) -> usize {
        let view = self.view(bytes);
        let is_normalized = component < 5125;
        push(
            &mut self.json["accessors"],
            json!({ "bufferView": view, "componentType": component, "count": count, "type": shape,
                    "normalized": is_normalized }),
        )
    }

    /// Moves a node by a path of the first animation.
    pub fn animate(&mut self, node: usize, path: &str, kind: &str, input: usize, output: usize) {
        if self.json.get("animations").is_none() {
            self.json["animations"] = json!([{ "samplers": [], "channels": [] }]);
        }
        let animation = &mut self.json["animations"][0];
        let sampler = json!({ "input": input, "output": output, "interpolation": kind });
        let sampler = push(&mut animation["samplers"], sampler);
        let target = json!({ "node": node, "path": path });
        push(&mut animation["channels"], json!({ "sampler": sampler, "target": target }));
    }

    /// The file with its bytes in itself.
    pub fn embedded(&self) -> String {
        let data = base64(&self.bytes);
        self.with_uri(&format!("data:application/octet-stream;base64,{data}"))
    }

    pub fn with_uri(&self, uri: &str) -> String {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({ "byteLength": self.bytes.len(), "uri": uri });
        json.to_string()
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Bytes of the `.glb` file.
    pub fn binary(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({ "byteLength": self.bytes.len() });
        glb(json.to_string().as_bytes(), &self.bytes)
    }
}

pub fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let chunk = |bytes: &[u8], kind: &[u8; 4], padding: u8| {
        let length = bytes.len().next_multiple_of(4);
        let mut chunk = (length as u32).to_le_bytes().to_vec();
        chunk.extend(kind);
        chunk.extend(bytes);
        chunk.resize(8 + length, padding);
        chunk
    };
    let chunks = [chunk(json, b"JSON", b' '), chunk(binary, b"BIN\0", 0)].concat();
    let length = (12 + chunks.len()) as u32;
    [b"glTF".to_vec(), 2_u32.to_le_bytes().to_vec(), length.to_le_bytes().to_vec(), chunks].concat()
}

pub fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().expect("a list");
    list.push(value);
    list.len() - 1
}

pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, n| bits << 8 | u32::from(*three.get(n).unwrap_or(&0)));
        for digit in 0..4 {
            let value = bits >> (18 - 6 * digit) & 63;
            text.push(if digit <= three.len() { DIGITS[value as usize] as char } else { '=' });
        }
    }
    text
}
