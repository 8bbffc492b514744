//! Collects what zenoh has to say, so that the daemon says it in its own log.

use std::fmt::{Debug, Write};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

use crate::ffi::Warning;

/// Different texts kept between two calls of `take`; what comes on top is not kept.
const CAPACITY: usize = 64;

static WARNINGS: Mutex<Vec<Warning>> = Mutex::new(Vec::new());

fn warnings() -> MutexGuard<'static, Vec<Warning>> {
    WARNINGS.lock().unwrap_or_else(PoisonError::into_inner)
}

fn add(text: String) {
    let mut kept = warnings();
    if let Some(warning) = kept.iter_mut().find(|warning| warning.text == text) {
        warning.count += 1;
    } else if kept.len() < CAPACITY {
        kept.push(Warning { text, count: 1 });
    }
}

pub fn take() -> Vec<Warning> {
    std::mem::take(&mut *warnings())
}

/// Listens to zenoh's warnings and to panics in its threads, once for the process.
pub fn install() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Fails only where somebody listens already, who then reports in our place.
        let _ = tracing::subscriber::set_global_default(Collector);
        std::panic::set_hook(Box::new(|info| add(format!("panic: {info}").replace('\n', " "))));
    });
}

struct Collector;

/// zenoh retries quietly: why a link cannot be made is a debug event of this module.
const CONNECTOR: &str = "zenoh::net::runtime::orchestrator";

impl Subscriber for Collector {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event()
            && (*metadata.level() <= Level::WARN
                || (*metadata.level() <= Level::DEBUG && metadata.target() == CONNECTOR))
    }

    fn event(&self, event: &Event<'_>) {
        let mut text = Text(String::new());
        event.record(&mut text);
        let mut text = text.0;
        if *event.metadata().level() > Level::WARN {
            // "... Retry in 1s." would make every step of the back-off a text of its own.
            match text.find(" Retry in") {
                Some(end) if text.starts_with("Unable to connect") => text.truncate(end),
                _ => return,
            }
        }
        add(without_places(&text));
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }
    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// zenoh's errors end in " at FILE.rs:LINE.", layer upon layer: nothing for an operator's log.
pub fn without_places(text: &str) -> String {
    let mut words = Vec::new();
    for word in text.split(' ') {
        match word.find(".rs:") {
            Some(_) if words.last() == Some(&"at") => {
                words.pop();
                words.extend(word.ends_with(']').then_some("]"));
            }
            _ => words.push(word),
        }
    }
    words.join(" ").replace(" ]", "]")
}

/// The system's reason, which zenoh puts last and in brackets, ahead of the address: a status has
/// room for 80 bytes.
pub fn reason_first(text: &str) -> String {
    let innermost = text.strip_suffix(']').and_then(|layers| layers.rsplit_once(": ["));
    match innermost.and_then(|(_, cause)| cause.split_once(": ")) {
        Some((address, reason)) => format!("{reason}: {address}"),
        None => text.to_owned(),
    }
}

struct Text(String);

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "message" {
            let _ = write!(self.0, "{value:?}");
        }
    }
}
