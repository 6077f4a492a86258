//! The hard cases in their menu.

use ik_arm::io::{Example, ExampleGroup};

use crate::bench::Bench;

#[test]
fn every_hard_case_opens_from_its_menu_and_says_what_it_shows() {
    let mut bench = Bench::new();
    for example in Example::of(ExampleGroup::HardCases) {
        bench.choose(&["Examples", "Hard cases", example.title]);
        let opened = example.open().expect("it opens").document;
        assert_eq!(bench.session().document(), &opened, "{}", example.title);
        assert!(bench.says(example.sentence), "{}", example.sentence);
        assert!(bench.session().document().is_moving(), "Space plays {}", example.title);
    }
}
