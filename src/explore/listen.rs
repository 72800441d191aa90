//! Connections: not too many at once, none that is silent for long, and none that keeps its place without the
//! token.
//!
//! Who has not yet asked with the token is a *stranger*: has a short time to do so, however the bytes drip,
//! and leaves for those who come later. Who has asked with it takes a place.

use std::collections::VecDeque;
use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::{Arc, OnceLock};
use std::task::{Context, Poll};
use std::time::Duration;

use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};
use tokio::time::{Instant, Sleep, sleep, timeout_at};

/// Connections with a place, and as many strangers, that are open at once; hyper buffers some 400 kB of a
/// request's head at worst. Further ones wait in the system's queue.
pub(super) const OPEN: usize = 256;

/// A connection on which nothing moves for so long is closed: no question takes as long.
const SILENT: Duration = Duration::from_secs(60);

/// A stranger's time for the head of a request: a browser on this machine needs milliseconds.
const HEAD: Duration = Duration::from_secs(20);

/// A stranger's time while others wait at the door.
const CROWDED: Duration = Duration::from_secs(1);

/// A listener with room for so many strangers.
pub(super) struct Bounded {
    listener: TcpListener,
    /// The oldest first: since when, and what bids it leave.
    strangers: VecDeque<(Instant, oneshot::Sender<()>)>,
}

impl Bounded {
    pub fn new(listener: TcpListener) -> Self {
        Bounded { listener, strangers: VecDeque::new() }
    }

    /// Waits until there is room; the oldest strangers leave for it.
    async fn make_room(&mut self) {
        self.strangers.retain(|(_, leave)| !leave.is_closed());
        while self.strangers.len() >= OPEN
            && let Some((since, mut leave)) = self.strangers.pop_front()
        {
            // It goes, or is no stranger any more, or is bidden to leave as its sender is dropped.
            let _ = timeout_at(since + CROWDED, leave.closed()).await;
        }
    }
}

impl Listener for Bounded {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        self.make_room().await;
        let (stream, peer) = Listener::accept(&mut self.listener).await;
        // Without it answers may wait for the client's delayed acknowledgements; they are right all the same.
        let _ = stream.set_nodelay(true);
        let (leave, bidden) = oneshot::channel();
        self.strangers.push_back((Instant::now(), leave));
        let deadline = Box::pin(sleep(HEAD));
        (Connection { stream, deadline, bidden: Some(bidden), caller: Caller::default() }, peer)
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// Who is at the other end of a connection: a stranger, or one with a place.
#[derive(Clone, Debug, Default)]
pub(super) struct Caller(Arc<OnceLock<OwnedSemaphorePermit>>);

impl Caller {
    /// Gives one who has shown the token a place; whether there was one.
    pub fn admit(&self, places: &Arc<Semaphore>) -> bool {
        self.is_known()
            || places.clone().try_acquire_owned().is_ok_and(|place| {
                // A second request of the same connection comes after the first one.
                let _ = self.0.set(place);
                true
            })
    }

    fn is_known(&self) -> bool {
        self.0.get().is_some()
    }
}

impl Connected<IncomingStream<'_, Bounded>> for Caller {
    fn connect_info(stream: IncomingStream<'_, Bounded>) -> Self {
        stream.io().caller.clone()
    }
}

/// An open connection.
pub(super) struct Connection {
    stream: TcpStream,
    deadline: Pin<Box<Sleep>>,
    /// Sent to a stranger to make it leave.
    bidden: Option<oneshot::Receiver<()>>,
    caller: Caller,
}

impl Connection {
    /// Polls the stream, until it was silent too long, or a stranger for too long.
    fn in_time<T>(&mut self, context: &mut Context, moved: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        // From here on the question's own time counts: the first one may wait longer than a stranger may.
        if self.caller.is_known() && self.bidden.take().is_some() {
            self.deadline.as_mut().reset(Instant::now() + SILENT);
        }
        if self.bidden.as_mut().is_some_and(|bidden| Pin::new(bidden).poll(context).is_ready()) {
            return Poll::Ready(Err(io::ErrorKind::TimedOut.into()));
        }
        if moved.is_ready() {
            if self.bidden.is_none() {
                self.deadline.as_mut().reset(Instant::now() + SILENT);
            }
            return moved;
        }
        self.deadline.as_mut().poll(context).map(|()| Err(io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for Connection {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context, to: &mut ReadBuf) -> Poll<io::Result<()>> {
        let moved = Pin::new(&mut self.stream).poll_read(context, to);
        self.in_time(context, moved)
    }
}

impl AsyncWrite for Connection {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context, from: &[u8]) -> Poll<io::Result<usize>> {
        let moved = Pin::new(&mut self.stream).poll_write(context, from);
        self.in_time(context, moved)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context,
        from: &[io::IoSlice],
    ) -> Poll<io::Result<usize>> {
        let moved = Pin::new(&mut self.stream).poll_write_vectored(context, from);
        self.in_time(context, moved)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
