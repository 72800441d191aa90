//! scratch
use kickdrift::number::rational::ratio;
use kickdrift::tongue::edges;
use num_integer::Integer;
fn main() {
    let max: u64 = std::env::args().nth(1).and_then(|x| x.parse().ok()).unwrap_or(100);
    let t = std::time::Instant::now();
    let (mut n, mut bad, mut ulps) = (0u64, 0u64, [0u64; 6]);
    for sum in 2..=max { for p in 1..sum { let q = sum - p; if p.gcd(&q) != 1 { continue; }
        let e = edges(p, q, &ratio(1, 25)).unwrap();
        assert_eq!(e.len() as u64, 2*(p+q)-3);
        for x in e { n += 1; match x { None => bad += 1, Some(x) => { let w = x.hi.to_bits() - x.lo.to_bits(); ulps[(w as usize).min(5)] += 1; } } }
    } }
    println!("{n} edges, {bad} uncertified, ulps {ulps:?}, {:?}", t.elapsed());
    if max < 9 { for (p,q) in [(7,2),(7,3),(5,3)] { println!("{p}/{q} {:?}", edges(p,q,&ratio(1,25)).unwrap()); } }
}
