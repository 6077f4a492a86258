//! The signed distance of a body, near a box.

use std::collections::HashMap;

use glam::DVec3;

use super::body::{Body, Group, Member, Part};
use super::round_cone::Sighting;
use super::sweep::Sweep;

/// The parts of a body that shape its surface near a point, so that the distance costs as much as
/// there are parts nearby. Equal to the field of all parts in its range, but for rounding.
#[derive(Clone, Debug)]
pub struct Field {
    /// Indices of the parts in the body.
    parts: Vec<usize>,
    /// The parts.
    sweeps: Vec<Sweep>,
    /// The distance within which each part blends with others, and its inverse.
    widths: Vec<[f64; 2]>,
    /// Groups of parts, by their indices in `parts`.
    groups: Vec<Group>,
}

/// Memory for intermediate results of a [`Field`].
#[derive(Debug, Default)]
pub struct FieldScratch {
    sightings: Vec<Sighting>,
    distances: Vec<f64>,
    members: Vec<NearMember>,
}

/// A member of a group from a point: its distance, and that within which it blends with others.
#[derive(Clone, Copy, Debug)]
struct NearMember {
    distance: f64,
    width: f64,
    /// 1/width.
    per_width: f64,
}

impl Field {
    /// The field of all parts.
    pub fn new(body: &Body) -> Self {
        let widths = |part: &Part| {
            let width = 0.5 * part.sweep.least_radius();
            [width, 1.0 / width]
        };
        Self {
            parts: (0..body.parts.len()).collect(),
            sweeps: body.parts.iter().map(|part| part.sweep.clone()).collect(),
            widths: body.parts.iter().map(widths).collect(),
            groups: body.groups.clone(),
        }
    }

    /// The field for points at most `radius` away from a point, which must be in the range of this
    /// field.
    pub fn near(&self, point: DVec3, radius: f64) -> Self {
        // Each distance changes by at most `radius` on the way, that of a group by a little more
        // where its members have different widths.
        let reach = 2.2 * radius;
        let distances: Vec<f64> = self.sweeps.iter().map(|part| part.distance(point)).collect();
        let mut members = Vec::new();
        let mut kept: Vec<(f64, Group)> = Vec::new();
        for group in &self.groups {
            self.measure(group, &distances, &mut members);
            let distance = blended_distance(&members);
            let is_near = |near: &NearMember| near.distance <= distance + reach + near.width;
            let near = group.members.iter().zip(&members).filter(|(_, near)| is_near(near));
            let members = near.map(|(member, _)| self.reduced(member, &distances, reach)).collect();
            kept.push((distance, Group { members }));
        }
        let least = kept.iter().map(|(distance, _)| *distance).fold(f64::INFINITY, f64::min);
        kept.retain(|(distance, _)| *distance <= least + reach);
        let mut near = self.with_groups(&without_subsets(kept));
        near.sweeps.iter_mut().for_each(|part| *part = part.near(point, radius));
        near
    }

    /// The field of some groups, and of the parts in them.
    fn with_groups(&self, groups: &[Group]) -> Self {
        let members = groups.iter().flat_map(|group| &group.members);
        let mut used: Vec<usize> = members.flat_map(Member::parts).collect();
        used.sort_unstable();
        used.dedup();
        let mut index = vec![usize::MAX; self.parts.len()];
        for (new, old) in used.iter().enumerate() {
            index[*old] = new;
        }
        let reindexed = |group: &Group| Group {
            members: group.members.iter().map(|member| member.reindexed(&index)).collect(),
        };
        Self {
            parts: used.iter().map(|old| self.parts[*old]).collect(),
            sweeps: used.iter().map(|old| self.sweeps[*old].clone()).collect(),
            widths: used.iter().map(|old| self.widths[*old]).collect(),
            groups: groups.iter().map(reindexed).collect(),
        }
    }

    /// Indices of the parts, in the order of the body.
    pub fn parts(&self) -> &[usize] {
        &self.parts
    }

    /// Signed distance: the least over all groups. It changes by no more than the way, but for a
    /// tenth.
    pub fn distance(&self, point: DVec3, scratch: &mut FieldScratch) -> f64 {
        let FieldScratch { distances, members, .. } = scratch;
        distances.clear();
        distances.extend(self.sweeps.iter().map(|part| part.distance(point)));
        let mut least = f64::INFINITY;
        for group in &self.groups {
            self.measure(group, distances, members);
            least = least.min(blended_distance(members));
        }
        least
    }

    /// Distance, gradient (at most 1 long) and local radius.
    pub fn sighting(&self, point: DVec3, scratch: &mut FieldScratch) -> Sighting {
        let FieldScratch { sightings, distances, members } = scratch;
        sightings.clear();
        sightings.extend(self.sweeps.iter().map(|part| part.sighting(point)));
        distances.clear();
        distances.extend(sightings.iter().map(|seen| seen.distance));
        let mut nearest = Sighting::NONE;
        for group in &self.groups {
            self.measure(group, distances, members);
            let distance = blended_distance(members);
            if distance < nearest.distance {
                nearest = blend(group, sightings, members, distance);
            }
        }
        nearest
    }

    /// Writes the members of a group as they are at a point with these distances from the parts.
    fn measure(&self, group: &Group, distances: &[f64], members: &mut Vec<NearMember>) {
        let near = |part: usize| {
            let ([width, per_width], distance) = (self.widths[part], distances[part]);
            NearMember { distance, width, per_width }
        };
        members.clear();
        members.extend(group.members.iter().map(|member| match *member {
            Member::Part(part) => near(part),
            Member::Bend(first, second, width) => {
                let (first, second) = (near(first), near(second));
                let (distance, _) = smooth_minimum(first.distance, second.distance, width);
                let width = width_at_bend(first, second);
                NearMember { distance, width, per_width: 1.0 / width }
            }
        }));
    }

    /// A bend is one of its bones where the other one is too far away to count.
    fn reduced(&self, member: &Member, distances: &[f64], reach: f64) -> Member {
        let Member::Bend(first, second, bend) = *member else { return *member };
        let width = bend.max(self.widths[first][0].min(self.widths[second][0]));
        let farther = distances[first] - distances[second];
        if farther.abs() <= width + reach {
            return *member;
        }
        Member::Part(if farther < 0.0 { first } else { second })
    }
}

/// The groups that are no part of another one, whose distance is never greater.
fn without_subsets(groups: Vec<(f64, Group)>) -> Vec<Group> {
    let is_part = |one: &Group, other: &Group| {
        one.members.iter().all(|member| other.members.contains(member))
    };
    let mut kept: Vec<Option<Group>> = Vec::new();
    // Only groups with a member in common are compared: comparing each with each takes most of the
    // time for a long chain.
    let mut with_part: HashMap<usize, Vec<usize>> = HashMap::new();
    for (_, group) in groups {
        let parts = || group.members.iter().filter_map(|member| member.parts().last());
        let others = parts().filter_map(|part| with_part.get(&part)).flatten();
        let others: Vec<usize> = others.copied().filter(|other| kept[*other].is_some()).collect();
        let of_kept = |other: &usize| kept[*other].as_ref();
        if others.iter().filter_map(of_kept).any(|other| is_part(&group, other)) {
            continue;
        }
        for other in others {
            kept[other].take_if(|other| is_part(other, &group));
        }
        parts().for_each(|part| with_part.entry(part).or_default().push(kept.len()));
        kept.push(Some(group));
    }
    kept.into_iter().flatten().collect()
}

/// The quadratic smooth minimum: min(a, b) where they differ by more than `width`, and at most
/// `width`/4 below it; with the share of b in its gradient.
fn smooth_minimum(a: f64, b: f64, width: f64) -> (f64, f64) {
    let overlap = width - (a - b).abs();
    if overlap <= 0.0 {
        return if a <= b { (a, 0.0) } else { (b, 1.0) };
    }
    let overlap = overlap / width;
    let share_of_b = if a <= b { 0.5 * overlap } else { 1.0 - 0.5 * overlap };
    (a.min(b) - 0.25 * width * overlap * overlap, share_of_b)
}

/// Width of two bones that meet: that of the nearer one, changing evenly from one to the other
/// where both are near.
fn width_at_bend(first: NearMember, second: NearMember) -> f64 {
    let farther = (first.distance - second.distance) / first.width.min(second.width);
    let share = (0.5 + 0.5 * farther).clamp(0.0, 1.0);
    first.width + (second.width - first.width) * share
}

/// Distance of the members of a group: the f with Σ x_i² = 1, where x_i = max(0, f + k_i − d_i)/k_i
/// for a member with the distance d_i and the width k_i. It is d_i where no other member is near,
/// at most the smallest width below the least d_i however many members meet, and smooth.
fn blended_distance(members: &[NearMember]) -> f64 {
    let mut f = members.iter().map(|near| near.distance).fold(f64::INFINITY, f64::min);
    // Newton's method from above; the sum is convex in f, so that it converges from one side. The
    // first step finds nothing to do where one member alone is near.
    for _ in 0..12 {
        let (mut sum, mut slope) = (-1.0, 0.0);
        for near in members.iter().filter(|near| f + near.width > near.distance) {
            let part = near.part(f);
            sum += part * part;
            slope += part * near.per_width;
        }
        if sum <= 1e-10 {
            break;
        }
        f -= 0.5 * sum / slope;
    }
    f
}

/// The members of a group as one surface: each has its share x_i/k_i of the gradient.
fn blend(group: &Group, sightings: &[Sighting], members: &[NearMember], f: f64) -> Sighting {
    let mut blended = Sighting { distance: f, gradient: DVec3::ZERO, radius: f64::INFINITY };
    let mut total = 0.0;
    for (member, near) in group.members.iter().zip(members) {
        let share = near.part(f) * near.per_width;
        if share == 0.0 {
            continue;
        }
        let (gradient, radius) = match *member {
            Member::Part(part) => (sightings[part].gradient, sightings[part].radius),
            Member::Bend(first, second, width) => {
                let (first, second) = (&sightings[first], &sightings[second]);
                let (_, of_second) = smooth_minimum(first.distance, second.distance, width);
                let radius = match of_second {
                    0.0 => first.radius,
                    1.0 => second.radius,
                    _ => first.radius.min(second.radius),
                };
                (first.gradient.lerp(second.gradient, of_second), radius)
            }
        };
        total += share;
        blended.gradient += share * gradient;
        blended.radius = blended.radius.min(radius);
    }
    blended.gradient /= total;
    blended
}

impl NearMember {
    /// The member's x in [`blended_distance`] for a distance f.
    fn part(&self, f: f64) -> f64 {
        ((f + self.width - self.distance) * self.per_width).max(0.0)
    }
}

impl Member {
    fn parts(&self) -> impl Iterator<Item = usize> + use<> {
        let (first, second) = match *self {
            Self::Part(part) => (part, None),
            Self::Bend(first, second, _) => (first, Some(second)),
        };
        core::iter::once(first).chain(second)
    }

    fn reindexed(&self, index: &[usize]) -> Self {
        match *self {
            Self::Part(part) => Self::Part(index[part]),
            Self::Bend(first, second, width) => Self::Bend(index[first], index[second], width),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Group, Member, without_subsets};

    /// The groups that are no part of another one, each compared with each.
    fn by_all_pairs(groups: &[Group]) -> Vec<Vec<Member>> {
        let is_part = |one: &Group, other: &Group| {
            one.members.iter().all(|member| other.members.contains(member))
        };
        let mut kept: Vec<&Group> = Vec::new();
        for group in groups {
            if !kept.iter().any(|other| is_part(group, other)) {
                kept.retain(|other| !is_part(other, group));
                kept.push(group);
            }
        }
        kept.into_iter().map(|group| group.members.clone()).collect()
    }

    #[test]
    fn the_same_groups_are_kept_as_by_comparing_each_with_each() {
        let mut state = 7_u64;
        let mut below = |most: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % most
        };
        for case in 0..2_000 {
            let mut member = |parts: u64| match below(3) {
                0 => Member::Bend(below(parts) as usize, below(parts) as usize, 0.5),
                _ => Member::Part(below(parts) as usize),
            };
            let groups: Vec<Group> = (0..12)
                .map(|index| Group {
                    members: (0..1 + (index + case) % 3).map(|_| member(4)).collect(),
                })
                .collect();
            let kept = without_subsets(groups.iter().map(|group| (0.0, group.clone())).collect());
            let kept: Vec<_> = kept.into_iter().map(|group| group.members).collect();
            assert_eq!(kept, by_all_pairs(&groups));
        }
    }
}
