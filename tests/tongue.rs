use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::tongue::*;
#[test]
fn scratch_closings() {
    for (p, q) in [(5, 3), (3, 5), (5, 4), (7, 4), (8, 3), (2,1),(7,6)] {
        let t = std::time::Instant::now();
        let found = closings(p, q, &Search::default()).unwrap();
        println!("{p}/{q} complete {} {:?}", found.complete, t.elapsed());
        for c in &found.closings { println!("   m={} s={} rho={} exact {:?} below {} w {:e}", c.m, to_f64(&c.s.middle()), to_f64(&c.rho.middle()), c.exact.as_ref().map(|(a,b)| format!("{a} {b}")), c.below_verlet, to_f64(&c.s.width())); }
    }
}
#[test]
fn scratch_rows() {
    for (p, q) in [(7, 3), (7,2), (7,1), (2,7)] {
        let mut t = Tongues::new(p, q, &ratio(1, 25)).unwrap();
        for g in t.all().unwrap() { println!("{:?}", t.row(&g, &Wanted::all()).unwrap()); }
    }
    let mut t = Tongues::new(5, 3, &ratio(0, 1)).unwrap();
    for g in t.all().unwrap() { println!("{:?}", t.row(&g, &Wanted::all()).unwrap()); }
    let mut t = Tongues::new(5, 3, &ratio(114, 55)).unwrap();
    for g in t.all().unwrap() { println!("{:?}", t.row(&g, &Wanted::all()).unwrap()); }
    println!("{:?}", Tongues::new(7, 3, &ratio(1, 25)).unwrap().gap(30));
    println!("{:?}", Tongues::new(7, 3, &ratio(-1, 25)).err());
}
