//! Decides which requests the server answers.
//!
//! On loopback, any web page that the user visits can send requests here. So the `Host` header must name this machine (which refuses a
//! domain that an attacker points at it), and a request that changes something must be JSON and come from our own page. On other
//! interfaces a token is required, which the printed address carries and the page keeps in a cookie. Browsers send the cookies of a
//! machine to all of its ports, so the cookie's name has the port that the browser sees: several servers keep their tokens apart.

use super::ApiProblem;
use axum::body::Body;
use axum::extract::State;
use axum::http::{HeaderMap, Method, Request, Uri, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Redirect, Response};
use std::net::IpAddr;
use std::sync::Arc;

/// The cookie's name, before the port.
const COOKIE: &str = "enfilade_token";

/// 128 random bits, as 32 hexadecimal digits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token(String);

impl Token {
    /// A new one.
    ///
    /// # Errors
    /// When the system has no random numbers.
    pub fn random() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        Ok(Self(bytes.iter().map(|b| format!("{b:02x}")).collect()))
    }

    /// Compares in time that does not depend on where the two differ.
    fn is(&self, other: &str) -> bool {
        let pairs = self.0.bytes().zip(other.bytes());
        self.0.len() == other.len() && pairs.fold(0, |difference, (a, b)| difference | (a ^ b)) == 0
    }
}

/// The rules of one server.
#[derive(Clone, Debug)]
pub struct Guard {
    loopback: bool,
    token: Option<Token>,
}

impl Guard {
    /// Rules for a server on `address`: a token where it is not loopback, or where `always` asks for one.
    ///
    /// # Errors
    /// When the system has no random numbers.
    pub fn new(address: IpAddr, always: bool) -> Result<Self, getrandom::Error> {
        let loopback = address.is_loopback();
        let token = if always || !loopback { Some(Token::random()?) } else { None };
        Ok(Self { loopback, token })
    }

    /// The address of a page on a host with a port, with the token where there is one.
    pub fn url(&self, host: &str, page: &str) -> String {
        match &self.token {
            Some(Token(token)) => format!("http://{host}{page}?token={token}"),
            None => format!("http://{host}{page}"),
        }
    }

    fn allows(&self, method: &Method, uri: &Uri, headers: &HeaderMap) -> Result<(), ApiProblem> {
        let host = text(headers, header::HOST);
        if self.loopback && !host.is_some_and(is_this_machine) {
            let error = format!("the request is for host {:?}, and this server is for this machine only", host.unwrap_or(""));
            return Err(ApiProblem::forbidden(error, "open http://localhost with the port that the program printed"));
        }
        if let Some(token) = &self.token
            && !tokens(uri, headers).any(|found| token.is(found))
        {
            return Err(ApiProblem::forbidden("the token is missing or wrong", "open the whole address that the program printed"));
        }
        if matches!(*method, Method::GET | Method::HEAD) {
            return Ok(());
        }
        let origin = text(headers, header::ORIGIN);
        let ours = |origin: &str| origin.split_once("://").map(|(_, rest)| rest) == host;
        if origin.is_some_and(|origin| !ours(origin)) {
            return Err(ApiProblem::forbidden(format!("the request comes from {:?}", origin.unwrap_or("")), "use this server's own page"));
        }
        if !text(headers, header::CONTENT_TYPE).is_some_and(|kind| kind.starts_with("application/json")) {
            return Err(ApiProblem::bad_request("the request is not of type application/json", "send JSON, and say so in Content-Type"));
        }
        Ok(())
    }
}

fn text(headers: &HeaderMap, name: header::HeaderName) -> Option<&str> {
    headers.get(name)?.to_str().ok()
}

/// True for the names of this machine, with any port, because a tunnel may have another port than ours.
fn is_this_machine(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or(""),
        None => host.split(':').next().unwrap_or(""),
    };
    name.eq_ignore_ascii_case("localhost") || name.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
}

/// Every place of a request where the token may be: address, bearer header, cookie.
fn tokens<'a>(uri: &'a Uri, headers: &'a HeaderMap) -> impl Iterator<Item = &'a str> {
    let bearer = text(headers, header::AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
    let cookies = text(headers, header::COOKIE).unwrap_or("").split(';');
    let cookie =
        cookies.filter_map(|pair| pair.trim().split_once('=')).filter(|(name, _)| name.starts_with(COOKIE)).map(|(_, value)| value);
    query_token(uri).into_iter().chain(bearer).chain(cookie)
}

/// The name of the cookie for the host that a browser names.
fn cookie_name(host: Option<&str>) -> String {
    let port = host.and_then(|host| host.rsplit_once(':')).map(|(_, port)| port).filter(|port| port.parse::<u16>().is_ok());
    format!("{COOKIE}_{}", port.unwrap_or("80"))
}

fn query_token(uri: &Uri) -> Option<&str> {
    uri.query()?.split('&').find_map(|pair| pair.strip_prefix("token="))
}

/// A path as a target on this host: with two slashes in front it would name another host, and browsers take a backslash for a slash.
fn on_this_host(path: &str) -> String {
    format!("/{}", path.trim_start_matches(['/', '\\']))
}

/// Refuses a request, or moves a token from the address into a cookie, or lets the request through.
pub(super) async fn check(State(guard): State<Arc<Guard>>, request: Request<Body>, next: Next) -> Response {
    if let Err(problem) = guard.allows(request.method(), request.uri(), request.headers()) {
        return problem.answer_to(request.headers());
    }
    if let (Some(token), true, &Method::GET) = (query_token(request.uri()), guard.token.is_some(), request.method()) {
        let name = cookie_name(text(request.headers(), header::HOST));
        let cookie = format!("{name}={token}; HttpOnly; SameSite=Strict; Path=/");
        let rest: Vec<&str> = request.uri().query().unwrap_or("").split('&').filter(|pair| !pair.starts_with("token=")).collect();
        let query = if rest.is_empty() { String::new() } else { format!("?{}", rest.join("&")) };
        let target = format!("{}{query}", on_this_host(request.uri().path()));
        return ([(header::SET_COOKIE, cookie)], Redirect::temporary(&target)).into_response();
    }
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    for (name, value) in [
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::X_FRAME_OPTIONS, "DENY"),
        (
            header::CONTENT_SECURITY_POLICY,
            "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob:",
        ),
    ] {
        headers.entry(name).or_insert(header::HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::Router;
    use axum::http::StatusCode;
    use axum::routing::{get, post};
    use std::net::Ipv4Addr;
    use tower::ServiceExt;

    async fn answer(guard: &Guard, method: &str, path: &str, headers: &[(&str, &str)]) -> Response {
        let app = Router::new().route("/a", get(|| async { "read" })).route("/a", post(|| async { "changed" }));
        let mut request = Request::builder().method(method).uri(path);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        crate::guarded(app, crate::tests::PAGE, guard.clone()).oneshot(request.body(Body::empty()).unwrap()).await.unwrap()
    }

    #[tokio::test]
    async fn loopback_answers_this_machine_alone() {
        let guard = Guard::new(Ipv4Addr::LOCALHOST.into(), false).unwrap();
        for host in ["localhost:7000", "127.0.0.1", "[::1]:80", "LOCALHOST"] {
            assert_eq!(answer(&guard, "GET", "/a", &[("host", host)]).await.status(), StatusCode::OK, "{host}");
        }
        for host in ["evil.example:7000", "localhost.evil.example", "10.0.0.1"] {
            assert_eq!(answer(&guard, "GET", "/a", &[("host", host)]).await.status(), StatusCode::FORBIDDEN, "{host}");
        }
    }

    #[tokio::test]
    async fn changes_come_as_json_from_our_own_page() {
        let guard = Guard::new(Ipv4Addr::LOCALHOST.into(), false).unwrap();
        let host = ("host", "localhost:7000");
        let json = ("content-type", "application/json");
        let status = async |headers: &[(&str, &str)]| answer(&guard, "POST", "/a", headers).await.status();
        assert_eq!(status(&[host, json]).await, StatusCode::OK);
        assert_eq!(status(&[host, json, ("origin", "http://localhost:7000")]).await, StatusCode::OK);
        assert_eq!(status(&[host, json, ("origin", "http://evil.example")]).await, StatusCode::FORBIDDEN);
        assert_eq!(status(&[host, ("content-type", "text/plain")]).await, StatusCode::BAD_REQUEST);
    }

    #[tokio::test]
    async fn elsewhere_a_token_is_demanded_and_kept() {
        let guard = Guard::new(Ipv4Addr::UNSPECIFIED.into(), false).unwrap();
        let Some(Token(token)) = &guard.token else { panic!("no token") };
        let host = ("host", "10.0.0.1:7000");
        assert_eq!(answer(&guard, "GET", "/a", &[host]).await.status(), StatusCode::FORBIDDEN);
        assert_eq!(answer(&guard, "GET", "/a?token=0", &[host]).await.status(), StatusCode::FORBIDDEN);
        let first = answer(&guard, "GET", &format!("/a?x=1&token={token}"), &[host]).await;
        assert_eq!(first.headers()[header::LOCATION], "/a?x=1");
        let cookie = first.headers()[header::SET_COOKIE].to_str().unwrap().split(';').next().unwrap().to_string();
        assert_eq!(answer(&guard, "GET", "/a", &[host, ("cookie", &cookie)]).await.status(), StatusCode::OK);
        for path in ["//evil.example/", "///evil.example/", "/"] {
            let moved = answer(&guard, "GET", &format!("{path}?token={token}"), &[host]).await;
            let target = moved.headers()[header::LOCATION].to_str().unwrap();
            assert!(target.starts_with('/') && !target.starts_with("//"), "{path}: {target}");
        }
    }

    #[tokio::test]
    async fn whom_a_browser_shows_the_refusal_reads_a_page() {
        let guard = Guard::new(Ipv4Addr::UNSPECIFIED.into(), false).unwrap();
        let kind = async |headers: &[(&str, &str)]| {
            let response = answer(&guard, "GET", "/a", headers).await;
            assert_eq!(response.status(), StatusCode::FORBIDDEN);
            response.headers()[header::CONTENT_TYPE].to_str().unwrap().to_string()
        };
        assert!(kind(&[("host", "10.0.0.1"), ("accept", "text/html,*/*;q=0.8")]).await.starts_with("text/html"));
        assert_eq!(kind(&[("host", "10.0.0.1"), ("accept", "*/*")]).await, "application/json");
    }

    #[tokio::test]
    async fn servers_on_two_ports_keep_their_cookies_apart() {
        let mut jar = std::collections::BTreeMap::new();
        let guards = ["10.0.0.1:7000", "10.0.0.1:8000"].map(|host| (host, Guard::new(Ipv4Addr::UNSPECIFIED.into(), false).unwrap()));
        for (host, guard) in &guards {
            let Some(Token(token)) = &guard.token else { panic!("no token") };
            let first = answer(guard, "GET", &format!("/a?token={token}"), &[("host", host)]).await;
            let cookie = first.headers()[header::SET_COOKIE].to_str().unwrap().split(';').next().unwrap().to_string();
            let (name, value) = cookie.split_once('=').unwrap();
            jar.insert(name.to_string(), value.to_string());
        }
        let cookies = jar.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join("; ");
        for (host, guard) in &guards {
            let response = answer(guard, "GET", "/a", &[("host", host), ("cookie", &cookies)]).await;
            assert_eq!(response.status(), StatusCode::OK, "{host}: {cookies}");
        }
    }

    #[tokio::test]
    async fn what_the_binary_does_not_carry_is_not_found() {
        let guard = Guard::new(Ipv4Addr::LOCALHOST.into(), false).unwrap();
        for path in ["/nothing.js", "/../Cargo.toml", "/%2e%2e/Cargo.toml"] {
            assert_eq!(answer(&guard, "GET", path, &[("host", "localhost")]).await.status(), StatusCode::NOT_FOUND, "{path}");
        }
    }
}
