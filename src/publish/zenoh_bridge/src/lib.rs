//! The part of zenoh that bole uses, as typed functions for C++ (see `zenoh_session.h`, the only
//! user). A session opens in the background and survives everything that the network does;
//! nothing here waits for a link. No panic leaves this crate: `guarded` turns it into an error.

mod config;
mod log;
mod session;

use session::Session;

#[cxx::bridge(namespace = "bole::zenoh_bridge")]
mod ffi {
    /// A setting that is given or left to the configuration file and the defaults.
    enum Switch {
        Unset,
        Off,
        On,
    }

    /// Something that this session answers queries for, and publishes unless priority is 0.
    struct Topic {
        key: String,
        /// Of what is published.
        encoding: String,
        /// zenoh's own scale: 1 (real time) .. 7 (background).
        priority: u8,
    }

    /// Empty texts and lists are settings left to the configuration file and the defaults.
    struct Settings {
        mode: String,
        listen: Vec<String>,
        connect: Vec<String>,
        multicast_scouting: Switch,
        tls_ca: String,
        tls_certificate: String,
        tls_private_key: String,
        tls_mutual: Switch,
        config_file: String,
        topics: Vec<Topic>,
        alive_key: String,
        subscribe: Vec<String>,
    }

    /// What is wrong with which setting (as the daemon's configuration spells it), and a remedy.
    #[derive(Default)]
    struct Problem {
        key: String,
        problem: String,
        remedy: String,
    }

    struct State {
        open: bool,
        routers: u32,
        peers: u32,
        /// Counts every link that came or went.
        changes: u64,
        /// Why the session does not open yet; empty once it is open.
        error: String,
        /// Received samples that found the queue full.
        overrun: u64,
    }

    enum Event {
        Sample,
        Alive,
        Gone,
    }

    struct Message {
        event: Event,
        key: String,
        encoding: String,
        payload: Vec<u8>,
    }

    /// A warning of zenoh's; equal ones are counted until they are taken.
    struct Warning {
        text: String,
        count: u64,
    }

    extern "Rust" {
        type Session;

        fn check(settings: &Settings, problem: &mut Problem) -> Result<()>;
        fn open(settings: &Settings, problem: &mut Problem) -> Result<Box<Session>>;
        fn overridden(self: &Session) -> Vec<String>;
        fn put(self: &Session, topic: usize, payload: &[u8]) -> Result<bool>;
        fn set_answer(self: &Session, topic: usize, encoding: &str, payload: &[u8]) -> Result<()>;
        fn state(self: &Session) -> Result<State>;
        fn receive(self: &Session, timeout_ms: u32) -> Result<Vec<Message>>;
        fn take_warnings() -> Result<Vec<Warning>>;
    }
}

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Runs one entry of the library: a panic inside becomes an error of the caller.
fn guarded<T>(body: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(body))
        .unwrap_or_else(|_| Err("zenoh failed inside (panic); see the log".into()))
}

/// What is wrong with the settings goes to C++ beside the error.
fn told<T>(result: Result<T, ffi::Problem>, problem: &mut ffi::Problem) -> Result<T, Error> {
    result.map_err(|found| {
        *problem = found;
        "bad configuration".into()
    })
}

/// Looks the settings over as `open` does, and opens nothing.
fn check(settings: &ffi::Settings, problem: &mut ffi::Problem) -> Result<(), Error> {
    guarded(|| told(config::build(settings).map(|_| ()), problem))
}

fn open(settings: &ffi::Settings, problem: &mut ffi::Problem) -> Result<Box<Session>, Error> {
    guarded(|| {
        log::install();
        told(Session::open(settings).map(Box::new), problem)
    })
}

fn take_warnings() -> Result<Vec<ffi::Warning>, Error> {
    guarded(|| Ok(log::take()))
}
