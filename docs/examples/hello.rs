// A text, then a stop, over HTTP with Rust's standard library alone:
// mmmd run --http 127.0.0.1:5880; rustc -o hello docs/examples/hello.rs && ./hello 127.0.0.1:5880
use std::io::{Error, Read, Result, Write};
use std::net::TcpStream;
use std::{env, thread, time::Duration};

/// Posts a body and returns the daemon's event; an error where the daemon has refused it.
fn post(at: &str, path: &str, body: &str) -> Result<String> {
    let mut socket = TcpStream::connect(at)?;
    socket.set_read_timeout(Some(Duration::from_secs(10)))?;
    let length = body.len();
    write!(socket, "POST {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n{body}")?;
    let mut reply = String::new();
    socket.read_to_string(&mut reply)?;
    match reply.split_once("\r\n\r\n") {
        Some((head, event)) if head.starts_with("HTTP/1.1 200") => Ok(event.trim().to_string()),
        _ => Err(Error::other(reply)),
    }
}

fn main() -> Result<()> {
    let at = env::args().nth(1).unwrap_or("127.0.0.1:5880".to_string());
    println!("{}", post(&at, "/v1/cmd", "wave with your right hand")?);
    thread::sleep(Duration::from_secs(2));
    println!("{}", post(&at, "/v1/ctl", "stop")?);
    Ok(())
}
