//! Balance: the centre of mass is brought over the feet, or over a point on the ground.
//!
//! The solver of whole-body targets moves the centre. The limbs take part in it with the pose that the
//! last limb step has left: see [`HeldLimb`]. Because the limb step then poses them anew, which moves
//! the centre a little, both steps are repeated until it is where it should be.

use glam::{Vec2, Vec3};

use super::balance_target::{BalanceOver, BalanceReport, BalanceTarget, Footing};
use super::carried::BodyTarget;
use super::skeleton_rig::SkeletonRig;
use super::target::{Target, TargetSpace};
use crate::chain_ik::{ChainTarget, HeldLimb, SolveError};
use crate::skeleton::{Balance, JointId, Skeleton};

impl SkeletonRig {
    /// The balance if it poses the figure: it has influence, and the solver's method [can
    /// balance](crate::chain_ik::Method::can_balance).
    pub fn active_balance(&self) -> Option<&BalanceTarget> {
        let can_balance = self.solver.method.can_balance();
        self.balance.as_ref().filter(|balance| can_balance && balance.is_posing())
    }

    /// What the balance needs to know of a pose.
    pub(super) fn footing(&self, posed: &Skeleton) -> Footing {
        let (limbs, over) = (self.held_limbs(posed), self.place_of_balance(posed));
        let influence = self.balance.map_or(0.0, |balance| balance.influence);
        let is_full = over.is_some_and(|(_, firmness)| influence * firmness >= 1.0);
        Footing { limbs, over, is_full }
    }

    /// The whole-body target that balances the figure.
    pub(super) fn body_target_of_balance(&self, footing: &Footing) -> Option<BodyTarget> {
        let balance = self.active_balance()?;
        let (over, firmness) = footing.over?;
        let root = self.skeleton.ids().next()?;
        let tip = ChainTarget::balanced(root, Vec3::new(over.x, 0.0, over.y));
        let influence = balance.influence * firmness;
        (influence > 0.0).then(|| BodyTarget { tip: tip.with_weight(balance.weight), influence })
    }

    /// x and z of the point over which the centre of mass should be, and how firmly the figure
    /// stands, from 0 to 1.
    fn place_of_balance(&self, posed: &Skeleton) -> Option<(Vec2, f32)> {
        match self.balance?.over {
            BalanceOver::Feet => Balance::middle_of_feet(posed),
            BalanceOver::Point(point) => Some((point, 1.0)),
        }
    }

    /// The limbs of targets in a pose, without those whose joints whole-body targets turn. The tips
    /// of targets in the world stay while the body moves; other limbs move with it.
    fn held_limbs(&self, posed: &Skeleton) -> Vec<HeldLimb> {
        let solved = |target: &&Target| self.is_solved_for(target);
        let bodies = self.targets.iter().filter(solved).filter(|it| it.limb().is_none());
        let turned: Vec<JointId> = bodies.flat_map(|target| self.moved_by(target).turned).collect();
        let held = self.targets.iter().filter(solved).filter_map(|target| {
            let limb = target.limb_in(&self.skeleton)?;
            let stays = target.present_space() == TargetSpace::World;
            let is_free = limb.joints().all(|joint| !turned.contains(&joint));
            is_free.then(|| HeldLimb::new(posed, limb.upper, stays.then_some(limb.lower)))
        });
        held.collect()
    }

    /// The result of the balance in a pose; `None` without a balance that has influence, and for a
    /// figure without mass.
    pub(super) fn balance_report(&self, posed: &Skeleton) -> Option<BalanceReport> {
        self.balance.filter(BalanceTarget::is_posing)?;
        let centre = Balance::of(posed)?.centre_on_ground();
        let method = self.solver.method;
        let refused = (!method.can_balance()).then_some(SolveError::CannotBalance { method });
        let over = self.place_of_balance(posed).map(|(over, _)| over);
        Some(BalanceReport { over, centre, refused })
    }
}
