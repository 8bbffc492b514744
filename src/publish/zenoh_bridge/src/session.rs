//! One zenoh session: opened in the background, and everything that hangs on it.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use zenoh::bytes::Encoding;
use zenoh::config::WhatAmI;
use zenoh::key_expr::KeyExpr;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::sample::{Sample, SampleKind};
use zenoh::session::ZenohId;
use zenoh::{Config, Wait};

use crate::ffi::{Event, Message, Problem, Settings, State};
use crate::{Error, config, guarded, log};

/// Pause between two tries to open.
const RETRY: Duration = Duration::from_millis(500);
/// Closing tells the others that we go; a link that is stuck must not hold up the daemon's end.
const CLOSE_TIMEOUT: Duration = Duration::from_millis(500);
/// Received samples kept for `receive`; the oldest makes room for the newest.
const QUEUE_CAPACITY: usize = 4096;

/// A lock whose holder panicked is still good: every value here is whole at any time.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A topic of the session, and the last bytes given for it: the answer to queries.
struct Topic {
    key: KeyExpr<'static>,
    encoding: Encoding,
    /// Of what is published; nothing is where this is absent.
    priority: Option<Priority>,
    last: Mutex<Option<Answer>>,
}

#[derive(Clone, Default)]
struct Answer {
    encoding: Encoding,
    payload: Vec<u8>,
}

impl Topic {
    fn keep(&self, encoding: &Encoding, payload: &[u8]) {
        let mut last = lock(&self.last);
        let answer = last.get_or_insert_default();
        answer.encoding.clone_from(encoding);
        answer.payload.clear();
        answer.payload.extend_from_slice(payload);
    }
}

#[derive(Default)]
struct Links {
    up: HashMap<ZenohId, WhatAmI>,
    changes: u64,
}

#[derive(Default)]
struct Queue {
    messages: VecDeque<Message>,
    overrun: u64,
}

#[derive(Default)]
struct Inbox {
    queue: Mutex<Queue>,
    filled: Condvar,
}

impl Inbox {
    fn push(&self, event: Event, sample: &Sample) {
        let mut queue = lock(&self.queue);
        if queue.messages.len() == QUEUE_CAPACITY {
            queue.messages.pop_front();
            queue.overrun += 1;
        }
        queue.messages.push_back(Message {
            event,
            key: sample.key_expr().to_string(),
            encoding: sample.encoding().to_string(),
            payload: sample.payload().to_bytes().into_owned(),
        });
        self.filled.notify_one();
    }
}

/// What exists once the session is open. Dropping the parts undeclares them.
struct Open {
    session: zenoh::Session,
    publishers: Vec<Option<Publisher<'static>>>,
    _alive: Option<LivelinessToken>,
}

#[derive(Default)]
enum Opening {
    #[default]
    Trying,
    Failed(String),
    Done(Open),
    Ended,
}

/// What the session, the thread that opens it and zenoh's callbacks share.
struct Shared {
    topics: Vec<Arc<Topic>>,
    alive_key: Option<KeyExpr<'static>>,
    subscribe: Vec<KeyExpr<'static>>,
    opening: Mutex<Opening>,
    ended: Condvar,
    links: Arc<Mutex<Links>>,
    inbox: Arc<Inbox>,
}

pub struct Session {
    shared: Arc<Shared>,
    overridden: Vec<String>,
}

impl Session {
    pub fn open(settings: &Settings) -> Result<Session, Problem> {
        let (config, overridden) = config::build(settings)?;
        let shared = Arc::new(Shared {
            topics: settings.topics.iter().map(topic).collect::<Result<_, _>>()?,
            alive_key: match settings.alive_key.as_str() {
                "" => None,
                text => Some(concrete_key(text)?),
            },
            subscribe: settings.subscribe.iter().map(|text| key(text)).collect::<Result<_, _>>()?,
            opening: Mutex::default(),
            ended: Condvar::new(),
            links: Arc::default(),
            inbox: Arc::default(),
        });
        let opener = Arc::clone(&shared);
        let spawned = std::thread::Builder::new()
            .name("zenoh-open".into())
            .spawn(move || opener.open_until_ended(&config));
        match spawned {
            Ok(_) => Ok(Session { shared, overridden }),
            Err(e) => Err(problem("zenoh", format!("no thread to open the session: {e}"), "")),
        }
    }

    pub fn overridden(&self) -> Vec<String> {
        self.overridden.clone()
    }

    /// Publishes the bytes, which are the answer to queries from now on. Says whether they were
    /// handed to an open session (which has a link or not).
    pub fn put(&self, topic: usize, payload: &[u8]) -> Result<bool, Error> {
        guarded(|| {
            let kept = &self.shared.topics[topic];
            kept.keep(&kept.encoding, payload);
            let Opening::Done(open) = &*lock(&self.shared.opening) else {
                return Ok(false);
            };
            let publisher = open.publishers[topic].as_ref();
            publisher.ok_or("this topic is not published")?.put(payload).wait()?;
            Ok(true)
        })
    }

    pub fn set_answer(&self, topic: usize, encoding: &str, payload: &[u8]) -> Result<(), Error> {
        guarded(|| {
            self.shared.topics[topic].keep(&Encoding::from(encoding), payload);
            Ok(())
        })
    }

    pub fn state(&self) -> Result<State, Error> {
        guarded(|| {
            let (open, error) = match &*lock(&self.shared.opening) {
                Opening::Done(_) => (true, String::new()),
                Opening::Failed(error) => (false, error.clone()),
                _ => (false, String::new()),
            };
            let links = lock(&self.shared.links);
            let routers = links.up.values().filter(|what| **what == WhatAmI::Router).count();
            Ok(State {
                open,
                routers: routers as u32,
                peers: (links.up.len() - routers) as u32,
                changes: links.changes,
                error,
                overrun: lock(&self.shared.inbox.queue).overrun,
            })
        })
    }

    /// What arrived since the last call; waits up to the timeout if that is nothing.
    pub fn receive(&self, timeout_ms: u32) -> Result<Vec<Message>, Error> {
        guarded(|| {
            let inbox = &self.shared.inbox;
            let timeout = Duration::from_millis(timeout_ms.into());
            let (mut queue, _) = inbox
                .filled
                .wait_timeout_while(lock(&inbox.queue), timeout, |queue| queue.messages.is_empty())
                .unwrap_or_else(PoisonError::into_inner);
            Ok(queue.messages.drain(..).collect())
        })
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = guarded(|| {
            let opening = std::mem::replace(&mut *lock(&self.shared.opening), Opening::Ended);
            self.shared.ended.notify_all();
            if let Opening::Done(open) = opening {
                close(open);
            }
            Ok(())
        });
    }
}

impl Shared {
    /// The opener's thread: ends when the session is open or no longer wanted. It is not waited
    /// for, since a try may take as long as the network likes.
    fn open_until_ended(&self, config: &Config) {
        loop {
            let tried = guarded(|| self.try_open(config.clone()));
            let mut opening = lock(&self.opening);
            if let Opening::Ended = *opening {
                drop(opening);
                let _ = tried.map(close);
                return;
            }
            match tried {
                Ok(open) => {
                    *opening = Opening::Done(open);
                    return;
                }
                Err(e) => {
                    let text = log::without_places(&e.to_string());
                    *opening = Opening::Failed(log::reason_first(&text));
                }
            }
            let waited = self
                .ended
                .wait_timeout_while(opening, RETRY, |opening| !matches!(opening, Opening::Ended));
            let (opening, _) = waited.unwrap_or_else(PoisonError::into_inner);
            if let Opening::Ended = *opening {
                return;
            }
        }
    }

    fn try_open(&self, config: Config) -> Result<Open, Error> {
        config::check_ports(&config)?;
        let session = zenoh::open(config).wait()?;

        let links = Arc::clone(&self.links);
        let info = session.info();
        info.transport_events_listener()
            .history(true)
            .callback(move |event| {
                let (peer, mut links) = (event.transport(), lock(&links));
                let changed = match event.kind() {
                    SampleKind::Put => links.up.insert(*peer.zid(), peer.whatami()).is_none(),
                    SampleKind::Delete => links.up.remove(peer.zid()).is_some(),
                };
                links.changes += u64::from(changed);
            })
            .background()
            .wait()?;

        let mut publishers = Vec::new();
        for topic in &self.topics {
            publishers.push(declare_publisher(&session, topic)?);
            declare_queryable(&session, topic)?;
        }
        for key in &self.subscribe {
            self.declare_subscriber(&session, key)?;
        }
        let alive = match &self.alive_key {
            Some(key) => Some(session.liveliness().declare_token(key.clone()).wait()?),
            None => None,
        };
        Ok(Open { session, publishers, _alive: alive })
    }

    fn declare_subscriber(
        &self,
        session: &zenoh::Session,
        key: &KeyExpr<'static>,
    ) -> Result<(), Error> {
        let inbox = Arc::clone(&self.inbox);
        let on_sample = move |sample: Sample| inbox.push(Event::Sample, &sample);
        session.declare_subscriber(key.clone()).callback(on_sample).background().wait()?;

        let inbox = Arc::clone(&self.inbox);
        let on_alive = move |sample: Sample| match sample.kind() {
            SampleKind::Put => inbox.push(Event::Alive, &sample),
            SampleKind::Delete => inbox.push(Event::Gone, &sample),
        };
        let liveliness = session.liveliness();
        let tokens = liveliness.declare_subscriber(key.clone()).history(true);
        tokens.callback(on_alive).background().wait()?;
        Ok(())
    }
}

fn declare_publisher(
    session: &zenoh::Session,
    topic: &Topic,
) -> Result<Option<Publisher<'static>>, Error> {
    let Some(priority) = topic.priority else {
        return Ok(None);
    };
    let publisher = session
        .declare_publisher(topic.key.clone())
        .encoding(topic.encoding.clone())
        .congestion_control(CongestionControl::Drop)
        .priority(priority)
        .express(true)
        .wait()?;
    Ok(Some(publisher))
}

fn declare_queryable(session: &zenoh::Session, topic: &Arc<Topic>) -> Result<(), Error> {
    let topic = Arc::clone(topic);
    session
        .declare_queryable(topic.key.clone())
        .callback(move |query| {
            let last = lock(&topic.last).clone();
            if let Some(answer) = last {
                let reply = query.reply(topic.key.clone(), answer.payload);
                // A querier that has left by now needs no answer.
                let _ = reply.encoding(answer.encoding).wait();
            }
        })
        .background()
        .wait()?;
    Ok(())
}

fn close(open: Open) {
    // First, since a session that is closed with publishers is never freed.
    drop(open.publishers);
    let _ = open.session.close().timeout(CLOSE_TIMEOUT).wait();
}

fn problem(key: &str, problem: String, remedy: &str) -> Problem {
    Problem { key: key.into(), problem, remedy: remedy.into() }
}

fn key(text: &str) -> Result<KeyExpr<'static>, Problem> {
    let remedy = "use names without / * $ ? #";
    KeyExpr::new(text.to_owned())
        .map_err(|e| problem("zenoh key", format!("{text:?}: {e}"), remedy))
}

fn concrete_key(text: &str) -> Result<KeyExpr<'static>, Problem> {
    let key = key(text)?;
    match key.is_wild() {
        true => Err(problem("zenoh key", format!("{text:?} is a pattern"), "use names without *")),
        false => Ok(key),
    }
}

fn topic(settings: &crate::ffi::Topic) -> Result<Arc<Topic>, Problem> {
    let priority = match settings.priority {
        0 => None,
        number => Some(Priority::try_from(number).map_err(|_| {
            let what = format!("{} has priority {number}", settings.key);
            problem("zenoh key", what, "use 1 to 7, or 0 for what is not published")
        })?),
    };
    Ok(Arc::new(Topic {
        key: concrete_key(&settings.key)?,
        encoding: Encoding::from(settings.encoding.as_str()),
        priority,
        last: Mutex::default(),
    }))
}
