//! Who is refused, what cannot break the server, and that work ends with who asked for it.

use std::io::{BufReader, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

use crate::support::{Answer, Page};

/// A tile in a few milliseconds of an optimized program.
const SMALL: &str = "tile?unit=1/4&level=0&x=0&y=0&size=32";

/// Some 10 s of one core, optimized: nearly all that a picture may cost.
const LARGE: &str = "picture?h1=1/2..3/5&h2=1/2..3/5&step=1/19000";

#[test]
fn the_page_is_whole_and_may_load_nothing_else() {
    let page = Page::start("");
    let index = page.get("");
    assert_eq!(index.status, 200);
    assert!(index.head.contains("content-type: text/html"));
    for rule in ["default-src 'none'", "script-src 'self'", "connect-src 'self'", "frame-ancestors 'none'"] {
        assert!(index.head.contains(rule), "{}", index.head);
    }
    for header in
        ["x-content-type-options: nosniff", "referrer-policy: no-referrer", "cache-control: no-store"]
    {
        assert!(index.head.contains(header), "{}", index.head);
    }
    // Whatever the page refers to is here.
    let mut seen = 0;
    let (html, css) =
        (String::from_utf8(index.body).unwrap(), String::from_utf8(page.get("page.css").body).unwrap());
    let after = |text: &str, before: &str| -> Vec<String> {
        text.split(before).skip(1).map(|rest| rest.split('"').next().unwrap().to_string()).collect()
    };
    for path in [after(&html, "href=\""), after(&html, "src=\""), after(&css, "url(\"")].concat() {
        let answer = page.get(&path);
        assert!(answer.status == 200 && !answer.body.is_empty(), "{path}");
        seen += 1;
    }
    assert!(seen > 8, "{seen}");
    // What it would ask for first is in it.
    let begun = html.split_once("id=\"begun\">").unwrap().1.split_once("</script>").unwrap().0;
    assert_eq!(begun.as_bytes(), page.get("start").body);
}

/// Every user of a machine sees the arguments of all its processes.
#[cfg(target_os = "linux")]
#[test]
fn the_browser_is_started_on_a_file_for_this_user_and_not_on_the_token() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (browser, told) = (folder.path().join("xdg-open"), folder.path().join("told"));
    std::fs::write(&browser, format!("#!/bin/sh\necho \"$@\" > {0}.new\nmv {0}.new {0}\n", told.display()))
        .unwrap();
    std::fs::set_permissions(&browser, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap());
    let mut page =
        Page::start_with("explore", &[("PATH", path.as_ref()), ("TMPDIR", folder.path().as_os_str())]);
    let start = Instant::now();
    while !told.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let told = std::fs::read_to_string(told).unwrap();
    assert!(!told.contains(&page.token) && !told.contains("http"), "{told}");
    let file = std::path::Path::new(told.trim());
    assert_eq!(std::fs::metadata(file).unwrap().permissions().mode() & 0o777, 0o600);
    let address = format!("http://127.0.0.1:{}/{}/", page.port, page.token);
    assert!(std::fs::read_to_string(file).unwrap().contains(&format!("content=\"0; url={address}\"")));
    let kill = std::process::Command::new("kill").arg(page.id().to_string()).status();
    assert!(kill.unwrap().success() && page.ends_within(Duration::from_secs(20)) && !file.exists());
}

#[test]
fn only_this_machine_with_the_token_of_this_start_is_answered() {
    let (page, other) = (Page::start(""), Page::start(""));
    assert!(page.token.len() == 32 && page.token != other.token);
    let status = |request: String| page.send(request.as_bytes()).status;
    let (port, token) = (page.port, &page.token);
    let with_host = |host: &str| status(format!("GET /{token}/start HTTP/1.1\r\nHost: {host}\r\n\r\n"));
    for host in ["127.0.0.1", "localhost", "[::1]", "LocalHost"] {
        assert_eq!(with_host(&format!("{host}:{port}")), 200, "{host}");
    }
    for host in ["evil.example", "127.0.0.1", "localhost", "127.0.0.1:1", "", "127.0.0.1.evil.example"] {
        assert_eq!(with_host(host), 403, "{host}");
    }
    assert_eq!(with_host(&format!("127.0.0.1:{port}\r\nHost: evil.example")), 403);
    assert_eq!(
        status(format!("GET http://evil.example/{token}/start HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n")),
        403
    );
    let path = |path: &str| status(format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n"));
    for wrong in [
        "/",
        "/start",
        "//start",
        "/index.html",
        "/favicon.ico",
        &format!("/{}/start", other.token),
        &format!("/{token}"),
    ] {
        assert_eq!(path(wrong), 403, "{wrong}");
    }
    for wrong in [
        "../Cargo.toml",
        "..%2fCargo.toml",
        "%2e%2e/etc/passwd",
        "./start",
        "/etc/passwd",
        "fonts/",
        "fonts/..",
        "start/",
        "START",
    ] {
        assert_eq!(path(&format!("/{token}/{wrong}")), 404, "{wrong}");
    }
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "BREW"] {
        let answer = page
            .send(format!("{method} /{token}/start HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n").as_bytes());
        assert_eq!((answer.status, answer.head.contains("allow: get, head")), (405, true), "{method}");
    }
    assert_eq!(path(&format!("/{token}/start?{}", "x".repeat(9000))), 414);
    // A head that never ends is not read for ever.
    let endless = format!("GET /{token}/start HTTP/1.1\r\nx: {}", "x".repeat(1 << 20));
    let mut stream = page.connect();
    let written = stream.write_all(endless.as_bytes());
    let answer = Answer::read(&mut BufReader::new(stream));
    assert!(written.is_err() || answer.is_none_or(|answer| answer.status == 431));
}

#[test]
fn bad_parameters_are_named() {
    let page = Page::start("");
    for (path, field) in [
        ("point?h1=1/0&h2=1", "h1"),
        ("point?h1=1", "h2"),
        ("point?h1=1&h2=pi", "h2/h1"),
        ("point?h1=1&h1=2&h2=1", "h1"),
        ("point?h1=-1&h2=1", "h1"),
        ("point?h1=%zz&h2=1", "query"),
        ("tile?unit=0&level=0&x=0&y=0", "unit"),
        ("tile?unit=1&level=-1&x=0&y=0", "level"),
        ("tile?unit=1&level=0&x=0.5&y=0", "x"),
        ("tile?unit=1&level=0&x=0&y=0&what=colour", "what"),
        ("tile?unit=1&level=0&x=0&y=0&size=100000", "size"),
        ("tile?unit=1&level=0&x=0&y=0&lambda1=-1", "lambda1"),
        ("tongues?h1=1..0&h2=0..1", "h1"),
        ("tongues?lambda2=-pi^2&h1=0..1&h2=0..1", "rho"),
        ("cut?kind=h3&value=1&lo=0&hi=1", "kind"),
        ("strip?ratio=7/2&rho=0..1", "rho"),
        ("picture?format=exe", "format"),
        ("system", "system"),
    ] {
        let answer = page.get(path);
        let error = &answer.json()["error"];
        assert_eq!((answer.status, error["field"].as_str()), (400, Some(field)), "{path}: {error}");
        assert!(!error["remedy"].as_str().unwrap().is_empty(), "{path}");
    }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) % n as u64) as usize
    }
}

/// A question with some of its bytes removed, doubled or replaced.
fn spoiled(random: &mut Random, sound: &[u8], most: usize) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for _ in 0..=random.below(most) {
        let at = random.below(bytes.len());
        match random.below(4) {
            0 => drop(bytes.remove(at)),
            1 => bytes.insert(at, bytes[random.below(bytes.len())]),
            2 => bytes[at] = random.below(256) as u8,
            _ => bytes[at] = b"/%&=.-+*^()0123456789pie\r\n :"[random.below(28)],
        }
    }
    bytes
}

const QUESTIONS: [&str; 6] = [
    "start?lambda1=pi^2&rho=1/25",
    "point?h1=1/10&h2=9/10&lambda1=pi^2&lambda2=pi^2/25",
    "tile?unit=8&level=9&x=1&y=2&size=16&what=growth",
    "scene?h1=1/100..1/2&h2=1/100..1&step=1/100",
    "strip?ratio=5/3&rho=1/10..1&samples=2",
    "certificate?lambda1=1&lambda2=1/4&h1=1&h2=3/2",
];

/// Threads of each kind.
const THREADS: u64 = 4;

#[test]
fn thousands_of_malformed_requests_do_no_harm() {
    malformed_requests_do_no_harm(20);
}

#[test]
#[ignore = "some minutes"]
fn a_hundred_thousand_malformed_requests_do_no_harm() {
    malformed_requests_do_no_harm(1);
}

/// A hundred thousand over `share` of them.
fn malformed_requests_do_no_harm(share: u32) {
    let (of_addresses, of_bytes) = (22_000 / share, 3000 / share);
    let page = Page::start("--threads 2");
    let before = page.most_memory();
    // Of addresses, one after the other on connections that live as long as the server lets them; of bytes,
    // each on its own.
    let (mut answered, mut ended) = (0, 0);
    std::thread::scope(|scope| {
        let addresses = |seed: u64| {
            let mut random = Random(seed);
            let mut stream = BufReader::new(page.connect());
            let mut answered = 0;
            for _ in 0..of_addresses {
                let sound = QUESTIONS[random.below(QUESTIONS.len())];
                let printable = |byte: &u8| (0x21..0x7f).contains(byte) && *byte != b'#';
                let path: Vec<u8> =
                    spoiled(&mut random, sound.as_bytes(), 3).into_iter().filter(printable).collect();
                let request = page.request(std::str::from_utf8(&path).unwrap());
                stream.get_mut().write_all(request.as_bytes()).unwrap();
                let answer = Answer::read(&mut stream).unwrap_or_else(|| panic!("no answer to {request}"));
                assert!([200, 400, 404, 422].contains(&answer.status), "{request}: {answer:?}");
                answered += 1;
                if answer.head.contains("connection: close") {
                    stream = BufReader::new(page.connect());
                }
            }
            answered
        };
        let bytes = |seed: u64| {
            let (mut random, mut ended) = (Random(seed), 0);
            for _ in 0..of_bytes {
                let sound = page.request(QUESTIONS[random.below(2)]);
                let mut stream = page.connect();
                // The server may close before all is written.
                let _ = stream.write_all(&spoiled(&mut random, sound.as_bytes(), 12));
                let _ = stream.shutdown(Shutdown::Write);
                let _ = stream.read_to_end(&mut Vec::new());
                ended += 1;
            }
            ended
        };
        let first: Vec<_> = (0..THREADS).map(|seed| scope.spawn(move || addresses(seed))).collect();
        let second: Vec<_> = (9..9 + THREADS).map(|seed| scope.spawn(move || bytes(seed))).collect();
        answered += first.into_iter().map(|thread| thread.join().unwrap()).sum::<u32>();
        ended += second.into_iter().map(|thread| thread.join().unwrap()).sum::<u32>();
    });
    assert_eq!(answered + ended, THREADS as u32 * (of_addresses + of_bytes));
    let grown = page.most_memory() - before;
    assert!(grown < 128 << 20, "{} MiB more", grown >> 20);
    assert_eq!(page.get(SMALL).status, 200);
    assert_eq!(page.end(), "", "nothing on standard error, a panic least of all");
}

#[test]
fn a_thousand_at_once_are_served_or_told_to_come_again() {
    let page = Page::start("--threads 2");
    let before = page.most_memory();
    let statuses: Vec<u16> = std::thread::scope(|scope| {
        let one = || page.send(page.request(SMALL).as_bytes());
        let start = |_| std::thread::Builder::new().stack_size(256 << 10).spawn_scoped(scope, one).unwrap();
        let all: Vec<_> = (0..1000).map(start).collect();
        all.into_iter().map(|thread| thread.join().unwrap().status).collect()
    });
    let of = |status: u16| statuses.iter().filter(|&&own| own == status).count();
    assert_eq!(of(200) + of(503), 1000);
    assert!(of(200) >= 64, "{} served", of(200));
    let grown = page.most_memory() - before;
    assert!(grown < 256 << 20, "{} MiB more", grown >> 20);
    assert_eq!(page.get(SMALL).status, 200);
    assert_eq!(page.end(), "");
}

/// Whether a connection is still open, on which nothing is sent.
fn is_open(stream: &mut TcpStream) -> bool {
    stream.set_nonblocking(true).unwrap();
    stream.read(&mut [0]).is_err_and(|cause| cause.kind() == std::io::ErrorKind::WouldBlock)
}

#[test]
fn strangers_that_drip_or_idle_leave_for_those_who_come_later() {
    let page = Page::start("");
    let mut strangers: Vec<_> = (0..300).map(|_| page.connect()).collect();
    strangers.iter_mut().step_by(2).for_each(|stream| stream.write_all(b"GET /").unwrap());
    assert_eq!(page.get("start").status, 200);
    // It was answered while they were there, not when all had been silent for too long.
    assert!(is_open(&mut strangers[290]) && !is_open(&mut strangers[0]));
    // Nor does the head of a request take for ever, however it drips: who has not shown the token is sent
    // away.
    let mut one = page.connect();
    let request = page.request("start");
    let sent = request.bytes().cycle().take(100).take_while(|byte| {
        std::thread::sleep(Duration::from_millis(500));
        one.write_all(&[*byte]).is_ok()
    });
    assert!(sent.filter(|byte| *byte != b'\n').count() < 100);
}

/// Whether no answer comes for a while: nobody has refused the question.
fn is_worked_on(stream: &mut TcpStream) -> bool {
    stream.set_read_timeout(Some(Duration::from_millis(400))).unwrap();
    stream.read(&mut [0]).is_err()
}

#[test]
fn work_ends_with_the_client() {
    let page = Page::start("--threads 1");
    let timed = || {
        let start = Instant::now();
        assert_eq!(page.get(SMALL).status, 200);
        start.elapsed()
    };
    timed();
    let alone = timed();
    // One lane for long questions: this one holds it, and whoever asked for it goes away.
    let mut stream = page.connect();
    stream.write_all(page.request(LARGE).as_bytes()).unwrap();
    assert!(is_worked_on(&mut stream));
    drop(stream);
    let after = timed();
    assert!(after < Duration::from_secs(2) + 4 * alone, "{after:?} after, {alone:?} alone");
    // So do those that wait.
    let mut waiting: Vec<_> = (0..8).map(|_| page.connect()).collect();
    waiting.iter().for_each(|mut stream| stream.write_all(page.request(LARGE).as_bytes()).unwrap());
    assert!(waiting.iter_mut().all(is_worked_on));
    drop(waiting);
    let after = timed();
    assert!(after < Duration::from_secs(2) + 4 * alone, "{after:?} after, {alone:?} alone");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_it_before_the_answer() {
    let mut page = Page::start("--threads 1");
    let mut stream = page.connect();
    stream.write_all(page.request(LARGE).as_bytes()).unwrap();
    assert!(is_worked_on(&mut stream));
    let sent = std::process::Command::new("kill").args(["-INT", &page.id().to_string()]).status().unwrap();
    // Far longer than even a busy machine takes for the picture.
    assert!(sent.success() && page.ends_within(Duration::from_secs(120)));
    let mut answer = Vec::new();
    // The connection may be reset.
    let _ = stream.read_to_end(&mut answer);
    assert_eq!(String::from_utf8_lossy(&answer), "");
}
