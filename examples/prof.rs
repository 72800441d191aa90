use kickdrift::map::{Grid, Products, Shard, for_each_band};
use kickdrift::number::parse::parse;
use kickdrift::verdict::Limits;
fn main(){
    let d = std::env::args().nth(1).unwrap(); let d=d.as_str();
    let all = std::env::args().nth(2).is_some();
    let x = |text: &str| parse("x", text).unwrap();
    let grid=Grid::new(x("pi^2"), x("pi^2/25"), [x(d), x(d)], (x(d), x("2/pi")), (x(d), x("7/2"))).unwrap();
    let mut count=0;
    let c = for_each_band(&grid, Products{label:all,growth:all}, Shard::WHOLE, 1, &Limits::default(), |_, band| { count += band.verdicts.iter().filter(|&&v| v != 0).count(); Ok(()) });
    println!("{count} {c:?}");
}
