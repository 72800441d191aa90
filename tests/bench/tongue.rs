//! scratch
use kickdrift::number::rational::ratio;
use kickdrift::tongue::Tongues;
use num_integer::Integer;
fn main() {
    let max: u64 = std::env::args().nth(1).and_then(|x| x.parse().ok()).unwrap_or(100);
    let t = std::time::Instant::now();
    let (mut n, mut bad, mut ulps) = (0u64, 0u64, [0u64; 6]);
    for sum in 2..=max { for p in 1..sum { let q = sum - p; if p.gcd(&q) != 1 { continue; }
        let mut t = Tongues::new(p, q, &ratio(1, 25)).unwrap();
        for entry in kickdrift::tongue::Entry::ALL { let k = t.zeros(entry); if k > 0 { for x in t.edges(entry, 1, k).unwrap() {
          n += 1; let w = x.hi.to_bits() - x.lo.to_bits(); ulps[(w as usize).min(5)] += 1; } } }
        bad += t.effort().precise;
    } }
    println!("{n} edges, {bad} uncertified, ulps {ulps:?}, {:?}", t.elapsed());
    for (p, q) in [(7,2),(7,3),(5,3)] { for g in Tongues::new(p,q,&ratio(1,25)).unwrap().all().unwrap() { println!("{p}/{q} {g:?}"); } }
}
