//! From typed settings to zenoh's configuration: checks what can be checked before the start, and
//! lays three layers over each other: our defaults, the configuration file, the typed settings.

use std::io::ErrorKind;
use std::net::TcpListener;

use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use rustls::sign::CertifiedKey;
use serde_json::{Value, json};
use zenoh::Config;
use zenoh::config::EndPoint;

use crate::Error;
use crate::ffi::{Problem, Settings, Switch};
use crate::log::without_places;

type Checked<T> = Result<T, Problem>;

fn problem(key: &str, problem: impl ToString, remedy: impl ToString) -> Problem {
    Problem {
        key: key.to_owned(),
        problem: without_places(&problem.to_string()),
        remedy: remedy.to_string(),
    }
}

/// Of an error text: a parser may quote the whole file, and what is secret in it.
fn beginning(text: &str) -> String {
    text.chars().take(100).collect()
}

/// The configuration, and the typed settings that the configuration file contradicted.
pub fn build(settings: &Settings) -> Checked<(Config, Vec<String>)> {
    check_endpoints("zenoh.connect", &settings.connect)?;
    check_endpoints("zenoh.listen", &settings.listen)?;
    check_regular(settings)?;
    check_tls(settings)?;

    let mut config = match settings.config_file.as_str() {
        "" => Config::default(),
        path => Config::from_file(path).map_err(|e| {
            let remedy = format!("give a zenoh configuration in JSON5, not {path}");
            problem("zenoh.config_file", beginning(&e.to_string()), remedy)
        })?,
    };
    let untouched = Config::default();
    let in_file = |key: &str| {
        let value = config.get_json(key).ok()?;
        (untouched.get_json(key).ok()? != value).then_some(value)
    };

    let mut insertions = typed(settings);
    let contradicted = |(typed_key, key, value): &(&str, &str, Value)| {
        let there = in_file(key)?;
        let file = &settings.config_file;
        (there != value.to_string()).then(|| format!("{typed_key} overrides {key} of {file}"))
    };
    let overridden = insertions.iter().filter_map(contradicted).collect();

    let connects = !settings.connect.is_empty() || in_file("connect/endpoints").is_some();
    let listens = !settings.listen.is_empty() || in_file("listen/endpoints").is_some();
    let mode = match (settings.mode.as_str(), in_file("mode")) {
        ("", Some(there)) => there.trim_matches('"').to_owned(),
        // A router carries what comes from a client to everybody, but not from peer to peer.
        ("", None) if connects && !listens => "client".to_owned(),
        ("", None) => "peer".to_owned(),
        (given, _) => given.to_owned(),
    };
    if mode == "client" && !connects {
        let remedy = "name the router, as in [\"tcp/127.0.0.1:7447\"]";
        return Err(problem("zenoh.connect", "empty, but zenoh.mode is client", remedy));
    }
    for (key, value) in defaults(&mode, connects || listens) {
        let given = insertions.iter().any(|(_, taken, _)| *taken == key);
        if !given && in_file(key).is_none() {
            insertions.push(("zenoh", key, value));
        }
    }
    for (typed_key, key, value) in insertions {
        let result = config.insert_json5(key, &value.to_string());
        result.map_err(|e| problem(typed_key, e, format!("{value} is no {key} of zenoh's")))?;
    }
    Ok((config, overridden))
}

/// What the daemon's configuration says: its key, zenoh's key, the value.
fn typed(settings: &Settings) -> Vec<(&'static str, &'static str, Value)> {
    let mut list = Vec::new();
    if !settings.mode.is_empty() {
        list.push(("zenoh.mode", "mode", json!(settings.mode)));
    }
    if !settings.listen.is_empty() {
        list.push(("zenoh.listen", "listen/endpoints", json!(settings.listen)));
    }
    if !settings.connect.is_empty() {
        list.push(("zenoh.connect", "connect/endpoints", json!(settings.connect)));
    }
    for (typed_key, keys, path) in [
        ("zenoh.tls.ca", &["transport/link/tls/root_ca_certificate"][..], &settings.tls_ca),
        (
            "zenoh.tls.certificate",
            &["transport/link/tls/listen_certificate", "transport/link/tls/connect_certificate"],
            &settings.tls_certificate,
        ),
        (
            "zenoh.tls.private_key",
            &["transport/link/tls/listen_private_key", "transport/link/tls/connect_private_key"],
            &settings.tls_private_key,
        ),
    ] {
        let given = keys.iter().filter(|_| !path.is_empty());
        list.extend(given.map(|key| (typed_key, *key, json!(path))));
    }
    for (typed_key, key, switch) in [
        ("zenoh.multicast_scouting", "scouting/multicast/enabled", settings.multicast_scouting),
        ("zenoh.tls.mutual", "transport/link/tls/enable_mtls", settings.tls_mutual),
    ] {
        if switch != Switch::Unset {
            list.push((typed_key, key, json!(switch == Switch::On)));
        }
    }
    list
}

/// What holds where neither the typed settings nor the file say anything.
fn defaults(mode: &str, has_endpoints: bool) -> Vec<(&'static str, Value)> {
    let mut list = vec![
        ("mode", json!(mode)),
        // Nobody is found and nobody gets in unless the operator says so.
        ("scouting/multicast/enabled", json!(false)),
        // A client tries each endpoint once, and `session` tries again; the others try for ever.
        ("connect/timeout_ms", json!(if mode == "client" { 0 } else { -1 })),
        ("connect/exit_on_failure", json!(false)),
        // A peer that comes back is found within these and the time to open: three seconds.
        (
            "connect/retry",
            json!({"period_init_ms": 250, "period_max_ms": 1000, "period_increase_factor": 2}),
        ),
        ("transport/unicast/open_timeout", json!(2000)),
        ("open/return_conditions/connect_scouted", json!(false)),
    ];
    if mode != "client" {
        let loopback = if has_endpoints { vec![] } else { vec!["tcp/127.0.0.1:7447"] };
        list.push(("listen/endpoints", json!(loopback)));
    }
    if mode != "router" {
        // A list that waits is a list too old: a full queue drops at once, the kernel keeps a few
        // lists and not megabytes of them, and a dead link is given up soon, with what it holds.
        list.extend([
            ("transport/link/tx/lease", json!(3000)),
            ("transport/link/tx/queue/congestion_control/drop/wait_before_drop", json!(0)),
            (
                "transport/link/tx/queue/congestion_control/block/wait_before_close",
                json!(1_000_000),
            ),
            ("transport/link/tcp/so_sndbuf", json!(16384)),
            ("transport/link/tls/so_sndbuf", json!(16384)),
        ]);
    }
    list
}

fn check_endpoints(key: &str, endpoints: &[String]) -> Checked<()> {
    for text in endpoints {
        let wrong = |why: &str| {
            let remedy = "write tcp/HOST:PORT or tls/HOST:PORT";
            problem(key, format!("{text:?} {why}"), remedy)
        };
        let endpoint: EndPoint = text.parse().map_err(|_| wrong("is no endpoint"))?;
        if !["tcp", "tls"].contains(&endpoint.protocol().as_str()) {
            return Err(wrong("has a protocol that is not built in"));
        }
        let address = endpoint.address();
        let (host, port) = address.as_str().rsplit_once(':').unwrap_or_default();
        if host.is_empty() || port.parse::<u16>().is_err() {
            return Err(wrong("has no host and port"));
        }
    }
    Ok(())
}

/// An error while another program has the port of an endpoint to listen on, given or by default:
/// zenoh's own says neither which nor what to do.
pub fn check_ports(config: &Config) -> Result<(), Error> {
    for text in listen_endpoints(config) {
        let Ok(endpoint) = text.parse::<EndPoint>() else { continue };
        // Other failures may pass, as an address that the interface has not got yet.
        let bound = TcpListener::bind(endpoint.address().as_str());
        if bound.is_err_and(|e| e.kind() == ErrorKind::AddrInUse) {
            let remedy = "set another zenoh.listen, or connect to who has it: zenoh.connect";
            return Err(format!("{text}: the port is in use; {remedy}=[{text:?}]").into());
        }
    }
    Ok(())
}

/// Of the configuration's mode: zenoh keeps a list for all modes, or one for each.
fn listen_endpoints(config: &Config) -> Vec<String> {
    let get = |key| serde_json::from_str::<Value>(&config.get_json(key).ok()?).ok();
    let endpoints = get("listen/endpoints").unwrap_or_default();
    let list = match get("mode") {
        Some(Value::String(mode)) if endpoints.is_object() => &endpoints[mode],
        _ => &endpoints,
    };
    serde_json::from_value(list.clone()).unwrap_or_default()
}

/// A pipe would be waited for, and nobody could interrupt that. What is missing is told later.
fn check_regular(settings: &Settings) -> Checked<()> {
    for (key, path) in [
        ("zenoh.tls.ca", &settings.tls_ca),
        ("zenoh.tls.certificate", &settings.tls_certificate),
        ("zenoh.tls.private_key", &settings.tls_private_key),
        ("zenoh.config_file", &settings.config_file),
    ] {
        if std::fs::metadata(path).is_ok_and(|there| !there.is_file()) {
            return Err(problem(key, format!("{path} is not a regular file"), "name a file"));
        }
    }
    Ok(())
}

fn check_tls(settings: &Settings) -> Checked<()> {
    let unreadable = |key: &str, path: &str, why: &dyn ToString| {
        let what = format!("{path}: {}", why.to_string());
        problem(key, what, "name a readable PEM file")
    };
    let certificates = |key: &str, path: &str| -> Checked<Vec<CertificateDer<'static>>> {
        let read = CertificateDer::pem_file_iter(path).and_then(|all| all.collect());
        match read {
            Ok(list) if Vec::is_empty(&list) => Err(unreadable(key, path, &"holds no certificate")),
            Ok(list) => Ok(list),
            Err(e) => Err(unreadable(key, path, &e)),
        }
    };

    let (certificate, key) = (&settings.tls_certificate, &settings.tls_private_key);
    if !settings.tls_ca.is_empty() {
        certificates("zenoh.tls.ca", &settings.tls_ca)?;
    }
    if certificate.is_empty() != key.is_empty() {
        let (missing, given) = if key.is_empty() {
            ("zenoh.tls.private_key", "zenoh.tls.certificate")
        } else {
            ("zenoh.tls.certificate", "zenoh.tls.private_key")
        };
        return Err(problem(missing, format!("empty, but {given} is set"), "give both or none"));
    }
    if !certificate.is_empty() {
        let chain = certificates("zenoh.tls.certificate", certificate)?;
        let private = PrivateKeyDer::from_pem_file(key)
            .map_err(|e| unreadable("zenoh.tls.private_key", key, &e))?;
        let provider = rustls::crypto::ring::default_provider();
        CertifiedKey::from_der(chain, private, &provider).map_err(|e| {
            let what = format!("{key} does not fit {certificate}: {e}");
            problem("zenoh.tls.private_key", what, "name the key that the certificate was made for")
        })?;
    }
    if !settings.config_file.is_empty() {
        return Ok(()); // which may say what is missing here
    }
    let need = |key, path: &String, why| match path.is_empty() {
        true => Err(problem(key, format!("empty, but {why}"), "name a PEM file")),
        false => Ok(()),
    };
    if settings.tls_mutual == Switch::On {
        need("zenoh.tls.ca", &settings.tls_ca, "zenoh.tls.mutual is set")?;
        need("zenoh.tls.certificate", certificate, "zenoh.tls.mutual is set")?;
    }
    if settings.listen.iter().any(|endpoint| endpoint.starts_with("tls/")) {
        need("zenoh.tls.certificate", certificate, "zenoh.listen has a tls endpoint")?;
    }
    Ok(())
}
