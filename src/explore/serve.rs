//! The page over HTTP, for this machine alone.
//!
//! The server binds 127.0.0.1 and answers addresses that begin with a token, 128 random bits made at each
//! start, so that no other page and no other user of the machine can ask; it answers requests whose `Host` is
//! its own alone, so that no name that an attacker's DNS points here reaches it. What the page may load is
//! what the server sends: a content security policy keeps everything else out.
//!
//! Work is bounded: connections, questions that wait, questions at work. A client that goes away drops its
//! question, which sets the flag that the kernels look at.

use std::convert::Infallible;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::{ConnectInfo, Request, State};
use axum::http::header::{self, HeaderName};
use axum::http::request::Parts;
use axum::http::{HeaderValue, Method, Response, StatusCode};
use tokio::net::{TcpListener, TcpSocket};
use tokio::runtime::{self, Runtime};
use tokio::sync::Semaphore;
use tokio::time::timeout;

use super::listen::{Bounded, Caller, OPEN};
use super::reply::Reply;
use super::session::Session;
use super::{LONGEST, Question, ask, asset, assets, named, overdue};
use number::{Error, Result};

/// The longest path and query, in bytes.
const LONGEST_ADDRESS: usize = 8192;

/// Questions that wait for their turn.
const WAITING: usize = 64;

/// Connections that the system holds before they are accepted.
const BACKLOG: u32 = 1024;

/// Questions that are answered at once, side by side.
const AT_ONCE: usize = 2;

const HEADERS: [(HeaderName, &str); 7] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; img-src 'self' blob: data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("permissions-policy"), "camera=(), geolocation=(), microphone=()"),
];

/// A page bound to an address, not yet served.
#[derive(Debug)]
pub struct Server {
    runtime: Runtime,
    listener: TcpListener,
    shared: Shared,
}

#[derive(Debug)]
struct Shared {
    session: Arc<Session>,
    /// The page, with what it starts on.
    index: Reply,
    token: String,
    /// The values of `Host` that are served.
    hosts: [String; 3],
    /// Places of connections that have shown the token.
    places: Arc<Semaphore>,
    /// Places to wait in, for all questions.
    queue: Semaphore,
    /// Places to work in: for questions that take long, and for those that are answered at once.
    lanes: [Arc<Semaphore>; 2],
    /// [`LONGEST`].
    longest: Duration,
}

impl Server {
    /// Binds 127.0.0.1 at this port, 0 for a free one, to work on so many threads, 0 for one a core.
    ///
    /// # Errors
    /// A port that is taken or not allowed, and a machine without random numbers.
    pub fn bind(session: Session, port: u16, threads: usize) -> Result<Server> {
        let failed = |cause: std::io::Error| {
            let text = format!("cannot listen ({cause}): choose another port");
            Error::io(format!("127.0.0.1:{port}"), text).caused_by(cause)
        };
        let runtime = runtime::Builder::new_current_thread().enable_all().build().map_err(failed)?;
        let listener = {
            let _entered = runtime.enter();
            let socket = TcpSocket::new_v4().map_err(failed)?;
            // A port whose last connections linger may be used again; elsewhere the option means something
            // else.
            #[cfg(unix)]
            socket.set_reuseaddr(true).map_err(failed)?;
            socket.bind((Ipv4Addr::LOCALHOST, port).into()).map_err(failed)?;
            socket.listen(BACKLOG).map_err(failed)?
        };
        let port = listener.local_addr().map_err(failed)?.port();
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { cores } else { threads };
        let begun = ask(&session, "start", "", &Arc::default()).filter(|reply| reply.status == 200);
        let shared = Shared {
            index: assets::index(&begun.map_or_else(Vec::new, |reply| reply.bytes.into_owned())),
            session: Arc::new(session),
            token: token()?,
            hosts: ["127.0.0.1", "localhost", "[::1]"].map(|host| format!("{host}:{port}")),
            places: Arc::new(Semaphore::new(OPEN)),
            queue: Semaphore::new(WAITING),
            lanes: [threads, AT_ONCE].map(|places| Arc::new(Semaphore::new(places))),
            longest: LONGEST,
        };
        Ok(Server { runtime, listener, shared })
    }

    /// The page's address.
    pub fn address(&self) -> String {
        format!("http://{}/{}/", self.shared.hosts[0], self.shared.token)
    }

    /// Serves until the process ends.
    ///
    /// # Errors
    /// Where the system takes the port away.
    pub fn run(self) -> Result<Infallible> {
        let failed = |cause: std::io::Error| Error::io("the port", &cause).caused_by(cause);
        self.runtime.block_on(async {
            let router = Router::new().fallback(handle).with_state(Arc::new(self.shared));
            let service = router.into_make_service_with_connect_info::<Caller>();
            axum::serve(Bounded::new(self.listener), service).await.map_err(failed)?;
            unreachable!("axum serves for ever")
        })
    }
}

/// 128 random bits in hex.
fn token() -> Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|cause| Error::io("random numbers", cause))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

async fn handle(
    State(shared): State<Arc<Shared>>,
    ConnectInfo(caller): ConnectInfo<Caller>,
    request: Request,
) -> Response<Body> {
    match shared.answer(&request.into_parts().0, &caller).await {
        Ok(reply) => respond(reply),
        Err((status, words)) => refuse(status, words),
    }
}

/// A refusal without content of ours.
type Refused = (StatusCode, &'static str);

impl Shared {
    async fn answer(&self, head: &Parts, caller: &Caller) -> std::result::Result<Reply, Refused> {
        if !self.is_own_host(head) {
            return Err((StatusCode::FORBIDDEN, "this host is not served here"));
        }
        if !matches!(head.method, Method::GET | Method::HEAD) {
            return Err((StatusCode::METHOD_NOT_ALLOWED, "GET or HEAD"));
        }
        let (path, query) = (head.uri.path(), head.uri.query().unwrap_or(""));
        if path.len() + query.len() > LONGEST_ADDRESS {
            return Err((StatusCode::URI_TOO_LONG, "the address is too long"));
        }
        let (token, path) = path.trim_start_matches('/').split_once('/').unwrap_or_default();
        if !self.is_own_token(token) {
            return Err((StatusCode::FORBIDDEN, "open the address that the program printed"));
        }
        if !caller.admit(&self.places) {
            return Err((StatusCode::SERVICE_UNAVAILABLE, "too many connections are open: ask again"));
        }
        if path.is_empty() {
            return Ok(self.index.clone());
        }
        match (asset(path), named(path)) {
            (Some(reply), _) => Ok(reply),
            (None, Some(question)) => self.work(question, query).await,
            (None, None) => Err((StatusCode::NOT_FOUND, "there is nothing here")),
        }
    }

    /// Every `Host`, and the authority of an absolute address, is one of ours.
    fn is_own_host(&self, head: &Parts) -> bool {
        let own = |host: &[u8]| self.hosts.iter().any(|known| known.as_bytes().eq_ignore_ascii_case(host));
        let mut hosts = head.headers.get_all(header::HOST).iter();
        let authority = head.uri.authority().map(|authority| authority.as_str().as_bytes());
        hosts.next().is_some_and(|host| own(host.as_bytes()))
            && hosts.next().is_none()
            && authority.is_none_or(own)
    }

    /// Compared to the last byte, however early they differ.
    fn is_own_token(&self, token: &str) -> bool {
        let differ = self.token.bytes().zip(token.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
        token.len() == self.token.len() && differ == 0
    }

    /// Waits for a place and answers on a thread of its own; dropped with the client, it leaves the queue, or
    /// stops the work.
    async fn work(&self, question: &'static Question, query: &str) -> std::result::Result<Reply, Refused> {
        let busy = (StatusCode::SERVICE_UNAVAILABLE, "too many questions wait: ask again");
        let waiting = self.queue.try_acquire().map_err(|_| busy)?;
        let place =
            self.lanes[usize::from(question.at_once)].clone().acquire_owned().await.map_err(|_| busy)?;
        drop(waiting);
        let (session, query) = (self.session.clone(), query.to_owned());
        let stop = Stop::default();
        let stopped = stop.0.clone();
        let done = tokio::task::spawn_blocking(move || {
            let _place = place;
            ask(&session, question.name, &query, &stopped)
        });
        let failed = (StatusCode::INTERNAL_SERVER_ERROR, "this question broke the program: please report it");
        match timeout(self.longest, done).await {
            Ok(done) => done.ok().flatten().ok_or(failed),
            Err(_) => Ok(overdue(question.name)),
        }
    }
}

/// Sets its flag when it is dropped.
#[derive(Default)]
struct Stop(Arc<AtomicBool>);

impl Drop for Stop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

fn respond(reply: Reply) -> Response<Body> {
    let mut response = Response::new(Body::from(reply.bytes.into_owned()));
    *response.status_mut() = StatusCode::from_u16(reply.status).expect("a status of ours");
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(reply.media));
    if let Some(name) = reply.file {
        let value = HeaderValue::from_str(&format!("attachment; filename=\"{name}\""));
        headers.insert(header::CONTENT_DISPOSITION, value.expect("a name of ours"));
    }
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

/// A refusal ends the connection, except for one that asks the client to come again.
fn refuse(status: StatusCode, words: &'static str) -> Response<Body> {
    let reply =
        Reply { status: status.as_u16(), ..Reply::new("text/plain; charset=utf-8", words.as_bytes()) };
    let mut response = respond(reply);
    let (name, value) = match status {
        StatusCode::SERVICE_UNAVAILABLE => (header::RETRY_AFTER, "1"),
        StatusCode::METHOD_NOT_ALLOWED => (header::ALLOW, "GET, HEAD"),
        _ => (header::CONNECTION, "close"),
    };
    response.headers_mut().insert(name, HeaderValue::from_static(value));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_too_long_is_cut_off_and_ends() {
        let mut server = Server::bind(Session::figure1(), 0, 1).unwrap();
        server.shared.longest = Duration::from_millis(200);
        let (token, host) = (&server.shared.token, &server.shared.hosts[0]);
        // Millions of pairs: more than a second of any machine.
        let uri = format!("/{token}/picture?h1=1/2..3/5&h2=1/2..3/5&step=1/19000");
        let head = Request::get(uri).header(header::HOST, host).body(Body::empty()).unwrap().into_parts().0;
        server.runtime.block_on(async {
            let reply = server.shared.answer(&head, &Caller::default()).await.unwrap();
            let body: serde_json::Value = serde_json::from_slice(&reply.bytes).unwrap();
            let message = body["too_costly"]["message"].as_str();
            assert_eq!((reply.status, message), (422, Some("this takes longer than half a minute")));
            // The place that it held is free soon.
            let place = timeout(Duration::from_secs(20), server.shared.lanes[0].acquire()).await.unwrap();
            assert!(place.is_ok());
        });
    }
}
