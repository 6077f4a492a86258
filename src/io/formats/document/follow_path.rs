//! Fields of followed paths in a file, and conversions between these fields and [`FollowPath`]s.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::skeleton::joint;
use crate::document::{FollowPath, PathKind, SkeletonRig, WavyRing};
use crate::io::json::{Above0, AtField, FieldError, JsonNumber, JsonObject, Whole};

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
    pub fn add_to(self, rig: &mut SkeletonRig) -> Result<(), FieldError> {
        match self {
            Self::One(JsonObject(fields)) => fields.add_to(rig),
            Self::Many(paths) => {
                let mut paths = paths.into_iter().enumerate();
                paths.try_for_each(|(index, JsonObject(fields))| fields.add_to(rig).at(index))
            }
        }
    }
}

impl FollowPathFields {
    fn new(path: &FollowPath) -> Self {
        let root = Some(path.root.into());
        match path.kind {
            PathKind::Ring(ring) => Self {
                root,
                path: None,
                radius: Some(ring.radius.into()),
                amplitude: Some(ring.amplitude.into()),
                waves: Some(ring.waves.into()),
                period: Some(ring.period.into()),
            },
            PathKind::Head => Self { root, path: Some(PathName::Head), ..Self::default() },
            PathKind::Target => Self { root, path: Some(PathName::Target), ..Self::default() },
        }
    }

    /// Adds the path to a rig that has a joint.
    fn add_to(self, rig: &mut SkeletonRig) -> Result<(), FieldError> {
        let kind = match self.path.unwrap_or_default() {
            PathName::Ring => PathKind::Ring(self.ring()?),
            PathName::Head => PathKind::Head,
            PathName::Target => PathKind::Target,
        };
        let root = match self.root {
            Some(root) => joint(root, rig.skeleton.joints().len()).at("root")?,
            None => match rig.skeleton.ids().next() {
                Some(first) => first,
                None => return Ok(()),
            },
        };
        if rig.skeleton[root].parent.is_some() {
            let reason = format!("must be a joint without a parent, got joint {root}");
            return Err(reason).at("root");
        }
        if rig.path_kind(root).is_some() {
            return Err(format!("must have one path, got a second for root {root}")).at("root");
        }
        rig.follow_paths = rig.with_path(root, Some(kind));
        Ok(())
    }

    fn ring(&self) -> Result<WavyRing, FieldError> {
        let missing = |name: &str| FieldError::from(format!("must have `{name}` for a ring"));
        let number = |name: &str, field: Option<JsonNumber>| field.ok_or_else(|| missing(name));
        let ring = WavyRing {
            radius: number("radius", self.radius)?.0,
            amplitude: number("amplitude", self.amplitude)?.0,
            waves: self.waves.ok_or_else(|| missing("waves"))?.0,
            period: number("period", self.period)?.0,
        };
        Above0::try_from(JsonNumber(ring.period)).at("period")?;
        Ok(ring)
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
