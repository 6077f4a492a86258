//! Fields of followed paths in a file, and conversions between these fields and [`FollowPath`]s.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::check::{above_0, joint};
use crate::document::{FollowPath, PathKind, SkeletonRig, WavyRing};
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonNumber, JsonObject, Whole};
use crate::kinematics::skeleton::JointId;

/// The followed paths, or a single one.
#[derive(Serialize)]
#[serde(untagged)]
pub enum FollowPathList {
    One(JsonObject<FollowPathFields>),
    Many(Vec<JsonObject<FollowPathFields>>),
}

#[derive(Default, Serialize, Deserialize)]
pub struct FollowPathFields {
    /// The head; without it, the first root.
    root: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<PathName>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    amplitude: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    waves: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<JsonNumber>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum PathName {
    #[default]
    Ring,
    Head,
    Target,
}

impl FollowPathList {
    pub fn new(paths: &[FollowPath]) -> Self {
        Self::Many(paths.iter().map(FollowPathFields::new).map(JsonObject).collect())
    }

    /// Adds the paths to a rig, which must have its skeleton already.
    pub fn add_to(self, rig: &mut SkeletonRig, at: &JsonPath) -> Result<(), FieldError> {
        let at_index = |(index, fields)| (at.clone().index(index), fields);
        let all: Vec<_> = match self {
            Self::One(fields) => vec![(at.clone(), fields)],
            Self::Many(fields) => fields.into_iter().enumerate().map(at_index).collect(),
        };
        for (at, JsonObject(fields)) in all {
            let Some(path) = fields.follow_path(rig, &at)? else { continue };
            if rig.path_kind(path.root).is_some() {
                let reason = format!("must have one path, got a second for root {}", path.root);
                return Err(FieldError::new(at.key("root"), reason));
            }
            rig.follow_paths = rig.with_path(path.root, Some(path.kind));
        }
        Ok(())
    }
}

impl FollowPathFields {
    fn new(path: &FollowPath) -> Self {
        let root = Some(Whole(u32::try_from(path.root.index()).unwrap_or(u32::MAX)));
        match path.kind {
            PathKind::Ring(ring) => Self {
                root,
                path: None,
                radius: Some(JsonNumber(ring.radius)),
                amplitude: Some(JsonNumber(ring.amplitude)),
                waves: Some(Whole(ring.waves)),
                period: Some(JsonNumber(ring.period)),
            },
            PathKind::Head => Self { root, path: Some(PathName::Head), ..Self::default() },
            PathKind::Target => Self { root, path: Some(PathName::Target), ..Self::default() },
        }
    }

    /// The path; `None` for a skeleton without joints.
    fn follow_path(
        &self,
        rig: &SkeletonRig,
        at: &JsonPath,
    ) -> Result<Option<FollowPath>, FieldError> {
        let kind = match self.path.unwrap_or_default() {
            PathName::Ring => PathKind::Ring(self.ring(at)?),
            PathName::Head => PathKind::Head,
            PathName::Target => PathKind::Target,
        };
        let root = match self.root {
            Some(root) => {
                let at = at.clone().key("root");
                let root = JointId::new(joint(at.clone(), root, rig.skeleton.joints().len())?);
                if rig.skeleton[root].parent.is_some() {
                    let reason = format!("must be a joint without a parent, got joint {root}");
                    return Err(FieldError::new(at, reason));
                }
                Some(root)
            }
            None => rig.skeleton.ids().next(),
        };
        Ok(root.map(|root| FollowPath { root, kind }))
    }

    fn ring(&self, at: &JsonPath) -> Result<WavyRing, FieldError> {
        let missing = |name| FieldError::new(at.clone(), format!("must have `{name}` for a ring"));
        let number = |name, field: Option<JsonNumber>| Ok(field.ok_or_else(|| missing(name))?.0);
        Ok(WavyRing {
            radius: number("radius", self.radius)?,
            amplitude: number("amplitude", self.amplitude)?,
            waves: self.waves.ok_or_else(|| missing("waves"))?.0,
            period: above_0(at.clone().key("period"), number("period", self.period)?)?,
        })
    }
}

impl<'de> Deserialize<'de> for FollowPathList {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;

        impl<'de> Visitor<'de> for OneOrMany {
            type Value = FollowPathList;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of objects: [{…}], or one object")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let path = FollowPathFields::deserialize(MapAccessDeserializer::new(map))?;
                Ok(FollowPathList::One(JsonObject(path)))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut paths = Vec::new();
                while let Some(path) = list.next_element()? {
                    paths.push(path);
                }
                Ok(FollowPathList::Many(paths))
            }
        }

        deserializer.deserialize_any(OneOrMany)
    }
}
