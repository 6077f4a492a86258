use crate::bench::Bench;
use egui_kittest::kittest::NodeT as _;
#[test]
fn dump() {
    let mut bench = Bench::new();
    for hand in [glam::Vec3::new(250., 120., 60.), glam::Vec3::ZERO] {
        bench.apply([ik_arm::session::Action::SetHand(hand)]);
        for n in bench.harness.root().children_recursive() {
            let a = n.accesskit_node();
            if a.raw_bounds().is_some_and(|b| b.x0 > 1000.0) {
                println!("{:?} {:?} {:?} {:?}", a.role(), a.label(), a.value(), a.raw_bounds());
            }
        }
    }
}
