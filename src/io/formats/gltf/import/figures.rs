//! The figures of a file: skins that belong together, and the nodes that are joints without a skin.

use std::collections::{BTreeSet, HashMap};

use super::nodes::NodeTree;
use crate::io::formats::gltf::UniqueNames;
use crate::io::formats::gltf::file::{GltfFile, GltfNode, GltfSkin};

/// The skins that make one figure, or the parts of a file without skins.
pub struct Figure {
    /// A unique name: that of the first skin, otherwise of the first node with it, otherwise `skin_`
    /// and its number. Without skins, the name of the root of the first part.
    pub name: String,
    /// The names that the other skins would have.
    aliases: Vec<String>,
    /// The skins in the order of the file.
    pub skins: Vec<usize>,
}

impl Figure {
    /// The number of the first skin; 0 without one.
    pub fn first(&self) -> usize {
        self.skins.first().copied().unwrap_or_default()
    }

    /// Returns whether the figure or one of its skins is called `name`.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.aliases.iter().any(|alias| alias == name)
    }
}

/// The figures of a file. Skins are of one figure if they share joints, if joints of one are below
/// joints of the other, or if joints of both are children of the same node: exporters write a skin
/// for each mesh.
pub fn figures(file: &GltfFile<'_>, nodes: &NodeTree, parts: &BTreeSet<usize>) -> Vec<Figure> {
    if file.skins.0.is_empty() {
        let roots = nodes.roots();
        let root = parts.first().and_then(|node| file.nodes.0.get(roots[*node]));
        let name = |root: &GltfNode| root.name.clone().filter(|name| !name.trim().is_empty());
        let name = root.map(|root| name(root).unwrap_or_else(|| "skeleton".to_owned()));
        let figure = |name| Figure { name, aliases: Vec::new(), skins: Vec::new() };
        return name.map(figure).into_iter().collect();
    }
    let names = skin_names(file);
    let mut figures: Vec<Figure> = Vec::new();
    let mut of_first = HashMap::new();
    for (skin, (first, name)) in first_skins(file, nodes).into_iter().zip(names).enumerate() {
        if first == skin {
            of_first.insert(first, figures.len());
            figures.push(Figure { name, aliases: Vec::new(), skins: vec![skin] });
        } else {
            let figure = &mut figures[of_first[&first]];
            figure.skins.push(skin);
            figure.aliases.push(name);
        }
    }
    figures
}

/// The nodes that are joints even if no skin lists them: those that move, and the bones of a humanoid.
/// In a file with neither and without skins, the nodes with meshes; without these, if several nodes
/// have names, all but cameras.
pub fn parts(file: &GltfFile<'_>, nodes: &NodeTree, moving: &BTreeSet<usize>) -> BTreeSet<usize> {
    let humanoid = file.extensions.humanoid().into_iter().map(|(node, _)| node);
    let humanoid = humanoid.filter(|node| *node < nodes.parents.len());
    let parts: BTreeSet<usize> = moving.iter().copied().chain(humanoid).collect();
    if !(parts.is_empty() && file.skins.0.is_empty()) {
        return parts;
    }
    let chosen = |is_part: fn(&GltfNode) -> bool| -> BTreeSet<usize> {
        let all = file.nodes.0.iter().enumerate();
        all.filter(|(_, node)| is_part(node)).map(|(index, _)| index).collect()
    };
    let with_meshes = chosen(|node| node.mesh.is_some());
    let named = file.nodes.0.iter().filter(|node| node.name.is_some()).count();
    match with_meshes.is_empty() && named > 1 {
        true => chosen(|node| node.camera.is_none()),
        false => with_meshes,
    }
}

/// A unique name for each skin.
fn skin_names(file: &GltfFile<'_>) -> Vec<String> {
    let mut users = vec![None; file.skins.0.len()];
    for node in &file.nodes.0 {
        let user = node.skin.and_then(|skin| users.get_mut(skin.0 as usize));
        if let Some(user) = user {
            *user = user.or(node.name.as_deref());
        }
    }
    let mut names = UniqueNames::default();
    let name = |(index, (skin, user)): (usize, (&GltfSkin, Option<&str>))| {
        let name = skin.name.as_deref().or(user).filter(|name| !name.trim().is_empty());
        names.free(name.unwrap_or(&format!("skin_{index}")))
    };
    file.skins.0.iter().zip(users).enumerate().map(name).collect()
}

/// For each skin the first one of its figure.
fn first_skins(file: &GltfFile<'_>, nodes: &NodeTree) -> Vec<usize> {
    let joints_of = |skin: &GltfSkin| -> Vec<usize> {
        let joints = skin.joints.iter().map(|joint| joint.0 as usize);
        joints.filter(|joint| *joint < nodes.parents.len()).collect()
    };
    let mut owners: Vec<Option<usize>> = vec![None; nodes.parents.len()];
    let mut above: HashMap<usize, usize> = HashMap::new();
    let mut firsts: Vec<usize> = (0..file.skins.0.len()).collect();
    let mut unite = |one: usize, other: usize| {
        // Each skin that is passed comes nearer to its first one, so that ways stay short.
        let mut root = |mut skin: usize| {
            while firsts[skin] != skin {
                firsts[skin] = firsts[firsts[skin]];
                skin = firsts[skin];
            }
            skin
        };
        let (one, other) = (root(one), root(other));
        firsts[one.max(other)] = one.min(other);
    };
    let all: Vec<Vec<usize>> = file.skins.0.iter().map(joints_of).collect();
    for (skin, joints) in all.iter().enumerate() {
        for &joint in joints {
            match owners[joint] {
                Some(owner) => unite(owner, skin),
                None => owners[joint] = Some(skin),
            }
            if let Some(parent) = nodes.parents[joint] {
                unite(*above.entry(parent).or_insert(skin), skin);
            }
        }
    }
    // The nearest joint above each node, parents first.
    let mut nearest: Vec<Option<usize>> = vec![None; nodes.parents.len()];
    for &node in &nodes.order {
        let of_parent = nodes.parents[node].and_then(|parent| nearest[parent]);
        if let (Some(own), Some(of_parent)) = (owners[node], of_parent) {
            unite(own, of_parent);
        }
        nearest[node] = owners[node].or(of_parent);
    }
    // A first skin has a lower number than its figure's others.
    for skin in 0..firsts.len() {
        firsts[skin] = firsts[firsts[skin]];
    }
    firsts
}
