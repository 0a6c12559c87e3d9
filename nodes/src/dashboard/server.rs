//! The page and its stream over HTTP.

use std::convert::Infallible;
use std::net::TcpListener;
use std::sync::Arc;

use axum::Router;
use axum::extract::State;
use axum::http::header;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{Html, IntoResponse};
use axum::routing::get;
use futures::Stream;
use tokio::sync::watch;

use super::Board;
use super::page::page;

/// Serves a board until `stop` says so: `/` is the page, `/stream` its frames as server-sent events, `/history` those of
/// the last half minute.
///
/// # Errors
/// When the listener cannot be used.
pub async fn serve(
    listener: TcpListener,
    board: Arc<Board>,
    stop: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    listener.set_nonblocking(true)?;
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let html: Arc<str> = Arc::from(page());
    let router = Router::new()
        .route("/", get(move || std::future::ready(Html(html.to_string()))))
        .route("/stream", get(stream))
        .route("/history", get(history))
        .with_state(board);
    // Streams never end by themselves, so the server is dropped with them instead of waiting.
    tokio::select! {
        served = async { axum::serve(listener, router).await } => served,
        () = stop => Ok(()),
    }
}

async fn history(State(board): State<Arc<Board>>) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], board.history())
}

async fn stream(State(board): State<Arc<Board>>) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    Sse::new(frames(board.subscribe())).keep_alive(KeepAlive::default())
}

/// The newest frame each time that the connection has room for one: what came in between is not sent.
fn frames(newest: watch::Receiver<Arc<str>>) -> impl Stream<Item = Result<Event, Infallible>> {
    futures::stream::unfold(newest, |mut newest| async move {
        newest.changed().await.ok()?;
        let frame = newest.borrow_and_update().to_string();
        Some((Ok(Event::default().data(frame)), newest))
    })
}
