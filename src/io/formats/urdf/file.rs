use std::collections::HashMap;

use glam::{DAffine3, DMat3, DVec3};

use super::xml::{UrdfError, XmlElement, XmlTree};

/// A robot as its file has it.
pub struct Robot {
    pub name: String,
    pub links: Vec<Link>,
    pub joints: Vec<RobotJoint>,
    /// What is not read: files of meshes and textures, and names of unknown bodies.
    pub unread: Vec<String>,
}

pub struct Link {
    pub name: String,
    pub visuals: Vec<Visual>,
}

/// A body of a link.
pub struct Visual {
    /// From the body's space to the link's.
    pub origin: DAffine3,
    pub shape: Shape,
    /// Red, green, blue and opacity from 0 to 1, as sRGB.
    pub colour: [f32; 4],
}

/// A body around its origin.
#[derive(Clone, Copy)]
pub enum Shape {
    /// With these lengths of its sides along x, y and z.
    Box(DVec3),
    /// Around z.
    Cylinder {
        radius: f64,
        length: f64,
    },
    Sphere {
        radius: f64,
    },
}

pub struct RobotJoint {
    pub name: String,
    pub kind: JointKind,
    /// Index of the parent link.
    pub parent: usize,
    /// Index of the child link.
    pub child: usize,
    /// From the child's space, at the angle 0, to the parent's.
    pub origin: DAffine3,
    /// Byte of the file at which the joint begins.
    pub at: usize,
}

pub enum JointKind {
    /// Turns about a unit axis in the child's space, from a lower to an upper limit in radians.
    Turning { axis: DVec3, limits: Option<[f64; 2]> },
    /// Does not turn.
    Fixed,
    /// Locked, because a skeleton's joint cannot move so, or because another joint moves it by
    /// `mimic`: its type.
    Unsupported(String),
}

/// Returns whether a text is URDF, judged by its first element.
pub fn is_urdf(text: &str) -> bool {
    let mut rest = text.trim_start();
    loop {
        let (start, end) = match rest {
            _ if rest.starts_with("<?") => ("<?", "?>"),
            _ if rest.starts_with("<!--") => ("<!--", "-->"),
            _ if rest.starts_with("<!") => ("<!", ">"),
            _ => break,
        };
        let Some(length) = rest[start.len()..].find(end) else { return false };
        rest = rest[start.len() + length + end.len()..].trim_start();
    }
    let name = rest.strip_prefix("<robot");
    name.is_some_and(|rest| rest.starts_with(|c: char| c.is_whitespace() || "/>".contains(c)))
}

/// Parses a file.
pub fn parse(text: &str) -> Result<Robot, UrdfError> {
    let tree = XmlTree::parse(text)?;
    // xacro is a macro language from which URDF is often generated.
    if let Some(macro_) = tree.all().find(|element| element.name().starts_with("xacro:")) {
        let reason = "must be URDF, got xacro: `xacro x.xacro > x.urdf` expands it";
        return Err(UrdfError::new(macro_.at(), "", reason));
    }
    let root = tree.root();
    let palette = palette(root)?;
    let mut unread = Vec::new();
    let links = links(root, &palette, &mut unread)?;
    let mut index = HashMap::new();
    for (number, link) in links.iter().enumerate() {
        if index.insert(link.name.clone(), number).is_some() {
            let reason = "names of links must be unique, got two of this name";
            return Err(UrdfError::new(root.at(), &link.name, reason));
        }
    }
    let joints = root.children("joint").map(|node| joint(node, &index));
    let joints = joints.collect::<Result<_, _>>()?;
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    Ok(Robot { name, links, joints, unread })
}

/// The named colours of the robot.
fn palette(root: XmlElement<'_>) -> Result<HashMap<String, [f32; 4]>, UrdfError> {
    let mut palette = HashMap::new();
    let in_links = root.children("link").flat_map(|link| link.children("visual"));
    let materials = in_links.flat_map(|visual| visual.children("material"));
    for material in root.children("material").chain(materials) {
        let (Some(name), Some(colour)) = (material.attribute("name"), colour(material)?) else {
            continue;
        };
        palette.entry(name.to_owned()).or_insert(colour);
    }
    Ok(palette)
}

fn colour(material: XmlElement<'_>) -> Result<Option<[f32; 4]>, UrdfError> {
    let Some(colour) = material.child("color") else { return Ok(None) };
    let [red, green, blue, opacity] = numbers(colour, "rgba", "", [1.0; 4])?;
    Ok(Some([red, green, blue, opacity].map(|channel| channel.clamp(0.0, 1.0) as f32)))
}

fn links(
    root: XmlElement<'_>,
    palette: &HashMap<String, [f32; 4]>,
    unread: &mut Vec<String>,
) -> Result<Vec<Link>, UrdfError> {
    let mut links = Vec::new();
    for node in root.children("link") {
        let name = name_of(node)?;
        let mut visuals = Vec::new();
        for node in node.children("visual") {
            visuals.extend(visual(node, name, palette, unread)?);
        }
        links.push(Link { name: name.to_owned(), visuals });
    }
    Ok(links)
}

fn name_of(node: XmlElement<'_>) -> Result<&str, UrdfError> {
    let name = node.attribute("name").filter(|name| !name.trim().is_empty());
    let kind = node.name();
    name.ok_or_else(|| UrdfError::new(node.at(), "", format!("a {kind} must have a name")))
}

/// A body of a link; `None` for a mesh or an unknown body, which goes to `unread`.
fn visual(
    node: XmlElement<'_>,
    link: &str,
    palette: &HashMap<String, [f32; 4]>,
    unread: &mut Vec<String>,
) -> Result<Option<Visual>, UrdfError> {
    /// The grey of bodies without a material.
    const GREY: [f32; 4] = [0.75, 0.75, 0.75, 1.0];
    let Some(geometry) = node.child("geometry").and_then(|it| it.elements().next()) else {
        return Ok(None);
    };
    let length = |name: &str| length(geometry, name, link);
    let shape = match geometry.name() {
        "box" => Shape::Box(DVec3::from(sizes(geometry, link)?)),
        "cylinder" => Shape::Cylinder { radius: length("radius")?, length: length("length")? },
        "sphere" => Shape::Sphere { radius: length("radius")? },
        "mesh" => {
            unread.push(geometry.attribute("filename").unwrap_or_default().to_owned());
            return Ok(None);
        }
        other => {
            unread.push(other.to_owned());
            return Ok(None);
        }
    };
    let material = node.child("material");
    let named = material.and_then(|it| palette.get(it.attribute("name")?)).copied();
    let own = material.map(colour).transpose()?.flatten();
    let texture = material.and_then(|it| it.child("texture")?.attribute("filename"));
    unread.extend(texture.map(str::to_owned));
    Ok(Some(Visual { origin: origin(node, link)?, shape, colour: own.or(named).unwrap_or(GREY) }))
}

fn sizes(geometry: XmlElement<'_>, link: &str) -> Result<[f64; 3], UrdfError> {
    let at = geometry.at();
    if geometry.attribute("size").is_none() {
        return Err(UrdfError::new(at, link, "a box must have a size"));
    }
    let size = numbers(geometry, "size", link, [0.0; 3])?;
    let is_valid = size.iter().all(|side| *side >= 0.0);
    let [x, y, z] = size;
    let reason = format!("the size of a box must be 0 or more, got {x} {y} {z}");
    if is_valid { Ok(size) } else { Err(UrdfError::new(at, link, reason)) }
}

fn length(geometry: XmlElement<'_>, name: &str, link: &str) -> Result<f64, UrdfError> {
    let kind = geometry.name();
    if geometry.attribute(name).is_none() {
        let reason = format!("a {kind} must have a {name}");
        return Err(UrdfError::new(geometry.at(), link, reason));
    }
    let [value] = numbers(geometry, name, link, [0.0])?;
    let reason = format!("the {name} of a {kind} must be 0 or more, got {value}");
    if value >= 0.0 { Ok(value) } else { Err(UrdfError::new(geometry.at(), link, reason)) }
}

fn joint(node: XmlElement<'_>, links: &HashMap<String, usize>) -> Result<RobotJoint, UrdfError> {
    let (name, at) = (name_of(node)?, node.at());
    let link = |end: &'static str| {
        let link = node.child(end).and_then(|it| it.attribute("link"));
        let link = link.ok_or_else(|| {
            UrdfError::new(at, name, format!("must have a {end} with the name of a link"))
        })?;
        links.get(link).copied().ok_or_else(|| {
            UrdfError::new(at, name, format!("its {end} must be a link, got {link:?}"))
        })
    };
    let kind = node.attribute("type").unwrap_or_default();
    let kind = match kind {
        "revolute" | "continuous" if node.child("mimic").is_some() => {
            JointKind::Unsupported(format!("{kind}, mimic"))
        }
        "revolute" | "continuous" => {
            let is_limited = kind == "revolute";
            JointKind::Turning { axis: axis(node, name)?, limits: limits(node, name, is_limited)? }
        }
        "fixed" => JointKind::Fixed,
        "prismatic" | "planar" | "floating" => JointKind::Unsupported(kind.to_owned()),
        _ => {
            let kinds = "revolute, continuous, fixed, prismatic, planar or floating";
            let reason = format!("its type must be {kinds}, got {kind:?}");
            return Err(UrdfError::new(at, name, reason));
        }
    };
    let (parent, child) = (link("parent")?, link("child")?);
    Ok(RobotJoint { name: name.to_owned(), kind, parent, child, origin: origin(node, name)?, at })
}

fn axis(joint: XmlElement<'_>, name: &str) -> Result<DVec3, UrdfError> {
    let Some(node) = joint.child("axis") else { return Ok(DVec3::X) };
    let axis = DVec3::from(numbers(node, "xyz", name, [1.0, 0.0, 0.0])?);
    let reason = || UrdfError::new(node.at(), name, "its axis must not be zero");
    axis.try_normalize().ok_or_else(reason)
}

/// Lower and upper limit; `None` without limits.
fn limits(
    joint: XmlElement<'_>,
    name: &str,
    is_limited: bool,
) -> Result<Option<[f64; 2]>, UrdfError> {
    let Some(node) = joint.child("limit").filter(|_| is_limited) else { return Ok(None) };
    let [lower] = numbers(node, "lower", name, [0.0])?;
    let [upper] = numbers(node, "upper", name, [0.0])?;
    Ok(Some([lower, upper]))
}

/// The transform of the `origin` of an element.
fn origin(node: XmlElement<'_>, name: &str) -> Result<DAffine3, UrdfError> {
    let Some(node) = node.child("origin") else { return Ok(DAffine3::IDENTITY) };
    let [roll, pitch, yaw] = numbers(node, "rpy", name, [0.0; 3])?;
    let turn = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch);
    let place = DVec3::from(numbers(node, "xyz", name, [0.0; 3])?);
    Ok(DAffine3::from_mat3_translation(turn * DMat3::from_rotation_x(roll), place))
}

/// The numbers of an attribute, or `default` without it. `name` is that of the joint or link.
fn numbers<const N: usize>(
    node: XmlElement<'_>,
    attribute: &str,
    name: &str,
    default: [f64; N],
) -> Result<[f64; N], UrdfError> {
    /// Greatest size of a number: what a skeleton of metres can hold with room for products.
    const MOST: f64 = 1e12;
    let Some(text) = node.attribute(attribute) else { return Ok(default) };
    let number = |word: &str| word.parse().ok().filter(|it: &f64| it.abs() <= MOST);
    let values: Option<Vec<f64>> = text.split_whitespace().map(number).collect();
    values.and_then(|values| values.try_into().ok()).ok_or_else(|| {
        let element = node.name();
        let numbers = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
        let reason =
            format!("{attribute} of {element} must be {numbers} within ±1e12, got {text:?}");
        UrdfError::new(node.at(), name, reason)
    })
}
