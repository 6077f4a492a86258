use crate::bench::Bench;
#[test]
fn dump() {
    let mut bench = Bench::new();
    bench.choose(&["Help"]);
    println!("{:?}", bench.harness);
}
