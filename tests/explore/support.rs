//! A page that is served, and a client that writes its requests by hand.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::Value;

/// A server of its own for each test; it ends with it.
pub struct Page {
    child: Child,
    pub port: u16,
    pub token: String,
}

impl Page {
    pub fn start(flags: &str) -> Page {
        Page::start_with(&format!("explore --no-open {flags}"), &[])
    }

    /// The program with these words and these variables.
    pub fn start_with(line: &str, variables: &[(&str, &std::ffi::OsStr)]) -> Page {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kickdrift"));
        command.args(line.split_whitespace()).envs(variables.iter().copied());
        let mut child =
            command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let rest = line.trim().strip_prefix("http://127.0.0.1:").expect("the address is printed");
        let (port, token) = rest.trim_end_matches('/').split_once('/').unwrap();
        Page { child, port: port.parse().unwrap(), token: token.into() }
    }

    pub fn id(&self) -> u32 {
        self.child.id()
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        stream
    }

    /// A request for what is at `path` below the page's address.
    pub fn request(&self, path: &str) -> String {
        format!("GET /{}/{path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", self.token, self.port)
    }

    /// The answer to bytes on a connection of their own.
    pub fn send(&self, bytes: &[u8]) -> Answer {
        let mut stream = self.connect();
        stream.write_all(bytes).unwrap();
        Answer::read(&mut BufReader::new(stream)).expect("an answer")
    }

    pub fn get(&self, path: &str) -> Answer {
        self.send(self.request(path).as_bytes())
    }

    /// The most memory that the server has held, in bytes.
    pub fn most_memory(&self) -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
        1024 * line.trim().trim_end_matches(" kB").parse::<u64>().unwrap()
    }

    /// Ends the server, which must still run; what it wrote to standard error.
    pub fn end(mut self) -> String {
        assert!(self.child.try_wait().unwrap().is_none(), "the server has ended");
        self.child.kill().unwrap();
        self.child.wait().unwrap();
        let mut text = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut text).unwrap();
        text
    }

    /// Waits for the end; whether it came in time.
    pub fn ends_within(&mut self, time: Duration) -> bool {
        let start = std::time::Instant::now();
        while start.elapsed() < time {
            if self.child.try_wait().unwrap().is_some() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        false
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An answer read to its end.
#[derive(Debug)]
pub struct Answer {
    pub status: u16,
    /// In lower case, one header a line.
    pub head: String,
    pub body: Vec<u8>,
}

impl Answer {
    /// `None` where the connection ends before an answer begins.
    pub fn read(stream: &mut impl BufRead) -> Option<Answer> {
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            if stream.read_line(&mut head).ok()? == 0 {
                return None;
            }
        }
        let status = head.split(' ').nth(1)?.parse().ok()?;
        let head = head.to_ascii_lowercase();
        let length = head
            .lines()
            .find_map(|line| line.strip_prefix("content-length: "))
            .map_or(0, |n| n.parse().unwrap());
        let mut body = vec![0; length];
        stream.read_exact(&mut body).ok()?;
        Some(Answer { status, head, body })
    }

    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body)
            .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&self.body)))
    }
}
