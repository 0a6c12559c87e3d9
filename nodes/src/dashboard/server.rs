//! Serves the page and its stream over HTTP.

use std::convert::Infallible;
use std::net::{IpAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::{HeaderName, Request, StatusCode, header};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{Html, IntoResponse, Response};
use axum::routing::get;
use futures::Stream;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use nix::sys::socket::{setsockopt, sockopt::TcpUserTimeout};
use tokio::net::TcpStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};

use super::page::page;
use super::{Board, Hosts};

/// Most connections at a time: a browser needs three, and a handful of people watch.
const MOST_CONNECTIONS: usize = 64;
/// Time for a client to send the header of its request. A browser sends it at once.
const HEADER_TIME: Duration = Duration::from_secs(5);
/// Time after which a client that reads nothing is disconnected.
const TAKING_TIME: Duration = Duration::from_secs(30);
/// Pause after a connection that could not be accepted, for example because the process has no free file descriptors.
const PAUSE: Duration = Duration::from_millis(100);
/// Most bytes of a response that are buffered for a client.
const BUFFER: usize = 64 * 1024;

const FULL: &[u8] = b"HTTP/1.1 503 Service Unavailable\r\nconnection: close\r\ncontent-length: 27\r\n\r\n\
    too many pages are open now";

/// Forbids framing and embedding by other pages, content sniffing and caching.
const HEADERS: [(HeaderName, &str); 5] = [
    (header::CONTENT_SECURITY_POLICY, "frame-ancestors 'none'"),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::CACHE_CONTROL, "no-store"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Serves a board until `stop` completes: `/` is the page, `/stream` its frames as server-sent events, `/history` the frames of
/// the last half minute, `/machine` the robot description and the scales of the cylinders. Only requests for one of `hosts` are
/// answered.
///
/// # Errors
/// If the listener cannot be used.
pub async fn serve(
    listener: TcpListener,
    board: Arc<Board>,
    hosts: Hosts,
    stop: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    listener.set_nonblocking(true)?;
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let html: Bytes = page().into();
    let router = Router::new()
        .route("/", get(move || std::future::ready(Html(html.clone()))))
        .route("/stream", get(stream))
        .route("/history", get(history))
        .route("/machine", get(machine))
        .with_state(board);
    let connections = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    let accepting = async {
        loop {
            let Ok((stream, _)) = listener.accept().await else {
                tokio::time::sleep(PAUSE).await;
                continue;
            };
            match Arc::clone(&connections).try_acquire_owned() {
                Ok(permit) => connect(stream, router.clone(), hosts.clone(), permit),
                // The connection is closed, whether or not the client receives the reason.
                Err(_) => drop(stream.try_write(FULL)),
            }
        }
    };
    // Streams never end by themselves, so the server is dropped without waiting for them.
    tokio::select! {
        () = accepting => Ok(()),
        () = stop => Ok(()),
    }
}

/// Serves one request of a connection. The permit is released when the connection ends.
fn connect(stream: TcpStream, router: Router, hosts: Hosts, permit: OwnedSemaphorePermit) {
    let Ok(own) = stream.local_addr().map(|address| address.ip()) else { return };
    // Frees the place of a peer that has gone or reads nothing. Without the option, that only takes longer.
    let _ = setsockopt(&stream, TcpUserTimeout, &(TAKING_TIME.as_millis() as u32));
    let checked = axum::middleware::from_fn(move |request: Request<Body>, next: axum::middleware::Next| {
        let allowed = hosts.accept(request.uri(), request.headers(), own);
        async move { if allowed { next.run(request).await } else { misdirected(own) } }
    });
    let service = TowerToHyperService::new(router.layer(checked).layer(axum::middleware::map_response(with_headers)));
    tokio::spawn(async move {
        let serving = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(HEADER_TIME)
            .keep_alive(false)
            .max_buf_size(BUFFER)
            .serve_connection(TokioIo::new(stream), service);
        // An error of the client ends its connection and affects no others.
        let _ = serving.await;
        drop(permit);
    });
}

async fn with_headers(mut response: Response) -> Response {
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, axum::http::HeaderValue::from_static(value));
    }
    response
}

fn misdirected(own: IpAddr) -> Response {
    let reason = format!(
        "This page answers to localhost, to {own} and to the names that it was started with: excavator dashboard \
         --allow-host NAME.\n"
    );
    (StatusCode::MISDIRECTED_REQUEST, reason).into_response()
}

/// The frames of the last half minute as a JSON array. They are shared with the board, not copied per client.
async fn history(State(board): State<Arc<Board>>) -> impl IntoResponse {
    let frames = board.history();
    let separated = frames.into_iter().enumerate().flat_map(|(index, frame)| {
        let separator: &'static [u8] = if index == 0 { b"" } else { b"," };
        [Bytes::from_static(separator), Bytes::from_owner(Shared(frame))]
    });
    let all = std::iter::once(Bytes::from_static(b"[")).chain(separated).chain([Bytes::from_static(b"]")]);
    let body = Body::from_stream(futures::stream::iter(all.map(Ok::<Bytes, Infallible>)));
    ([(header::CONTENT_TYPE, "application/json")], body)
}

async fn machine(State(board): State<Arc<Board>>) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], board.machine())
}

struct Shared(Arc<str>);

impl AsRef<[u8]> for Shared {
    fn as_ref(&self) -> &[u8] {
        self.0.as_bytes()
    }
}

async fn stream(State(board): State<Arc<Board>>) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    Sse::new(frames(board.subscribe())).keep_alive(KeepAlive::default())
}

/// The newest frame each time that the connection has room for one. Frames in between are skipped.
fn frames(newest: watch::Receiver<Arc<str>>) -> impl Stream<Item = Result<Event, Infallible>> {
    futures::stream::unfold(newest, |mut newest| async move {
        newest.changed().await.ok()?;
        let frame = newest.borrow_and_update().to_string();
        Some((Ok(Event::default().data(frame)), newest))
    })
}
