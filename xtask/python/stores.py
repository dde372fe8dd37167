"""The same job in a bucket of moto's S3 server, alone and behind a proxy that loses answers or withholds conditions."""

import contextlib
import http.client
import http.server
import subprocess
import threading
import time

from farm import DIVISION, FarmError, audit
from slurm import Cluster, free_ports

BUCKET = "farm"
KEYS = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "test", "AWS_REGION": "us-east-1", "AWS_ALLOW_HTTP": "true"}
# Asked without it, the server takes the reader for a stranger.
SIGNED = {"Authorization": "AWS4-HMAC-SHA256 Credential=test/20260101/us-east-1/s3/aws4_request, SignedHeaders=host, Signature=0"}
# Headers that belong to one connection.
OWN = {"connection", "transfer-encoding", "keep-alive", "host"}
PATIENCE = 420


class Server:
    """moto's server on a free port; use as a context."""

    def __init__(self, python, log):
        self.python, self.log, (self.port,) = python, log, free_ports(1)
        self.url = f"http://127.0.0.1:{self.port}"

    def __enter__(self):
        with open(self.log, "wb") as log:
            words = [self.python, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(self.port)]
            self.process = subprocess.Popen(words, stdout=log, stderr=log)
        for _ in range(1200):
            with contextlib.suppress(OSError):
                request(self.port, "PUT", f"/{BUCKET}")
                return self
            time.sleep(0.1)
        self.__exit__()
        raise FarmError(f"moto's server does not answer; it said what is in {self.log}")

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def env(self, port=None):
        return {**KEYS, "AWS_ENDPOINT_URL": f"http://127.0.0.1:{port or self.port}"}

    def download(self, prefix, folder):
        """All objects below a prefix, as a folder."""
        listing = self.get(f"?list-type=2&max-keys=1000&prefix={prefix}/").decode()
        for part in listing.split("<Key>")[1:]:
            key = part.split("</Key>")[0]
            path = folder / key.removeprefix(f"{prefix}/")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(self.get(f"/{key}"))
        return folder

    def get(self, what):
        status, _, answer = request(self.port, "GET", f"/{BUCKET}{what}", headers=SIGNED)
        if status != 200:
            raise FarmError(f"the server answers {status} to {what}")
        return answer


def request(port, method, path, body=None, headers=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    with contextlib.closing(connection):
        connection.request(method, path, body, headers or {})
        answer = connection.getresponse()
        return answer.status, answer.getheaders(), answer.read()


class Proxy:
    """Stands before a server. `lose` has conditional writes of markers done, and their answers lost the first time: every other
    connection is closed without one, and every other gets status 500. `ignore` takes the conditions away, `keep` does nothing more than to
    pass conditional writes on one after the other."""

    def __init__(self, port, mode):
        self.to, self.mode, self.lost, self.lock, self.one = port, mode, {}, threading.Lock(), threading.Lock()
        proxy = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def handle_any(self):
                proxy.handle(self)

            do_GET = do_PUT = do_POST = do_DELETE = do_HEAD = handle_any

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.port = self.server.server_address[1]

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def handle(self, handler):
        body = handler.rfile.read(int(handler.headers.get("Content-Length", 0)))
        headers = {name: value for name, value in handler.headers.items() if name.lower() not in OWN}
        conditional = headers.pop("If-None-Match", None) or headers.pop("if-none-match", None)
        if conditional and self.mode != "ignore":
            headers["If-None-Match"] = conditional
        # moto looks and then writes: it keeps conditions only for writers that come one after the other.
        with self.one if conditional else contextlib.nullcontext():
            status, fields, answer = request(self.to, handler.command, handler.path, body, headers)
        loss = self.loss(handler.path) if self.mode == "lose" and conditional and "/done/" in handler.path else None
        if loss == "closed":
            handler.close_connection = True
            return
        if loss == "error":
            status, fields, answer = 500, [], b"<Error><Code>InternalError</Code></Error>"
        handler.send_response(status)
        for name, value in fields:
            if name.lower() not in OWN and name.lower() not in ("content-length", "server", "date"):
                handler.send_header(name, value)
        handler.send_header("Content-Length", str(len(answer)))
        handler.end_headers()
        if handler.command != "HEAD":
            handler.wfile.write(answer)

    def loss(self, path):
        with self.lock:
            if path in self.lost:
                return None
            self.lost[path] = ["closed", "error"][len(self.lost) % 2]
            return self.lost[path]


def two_workers(farm, server, folder):
    """Two workers at once with all tasks each: of every frame one wins."""
    with Proxy(server.port, "keep") as proxy:
        return race(farm, server, folder, server.env(proxy.port))


def race(farm, server, folder, env):
    place = f"s3://{BUCKET}/two"
    farm.run("farm", "plan", str(farm.config), "-o", place, *DIVISION, env=env)
    begun = time.monotonic()
    command = [farm.program, "--threads", "1", "--quiet", "farm", "work", place, "--shard", "0/1", "--scratch"]
    workers = [subprocess.Popen([*command, str(folder / f"scratch{i}")], env={**env}, stdout=subprocess.DEVNULL) for i in range(2)]
    codes = [worker.wait() for worker in workers]
    if codes != [0, 0]:
        raise FarmError(f"two workers at once ended with {codes}")
    return finish(farm, server, place, env, folder, begun)


def lost_replies(farm, server, folder):
    """Slurm's nodes work on a bucket whose answers to the first writing of every marker are lost."""
    with Proxy(server.port, "lose") as proxy, Cluster(folder / "slurm") as cluster:
        place, env = f"s3://{BUCKET}/lost", server.env(proxy.port)
        farm.run("farm", "plan", str(farm.config), "-o", place, *DIVISION, env=env)
        wrapper = farm.write_wrapper(folder / "program", folder, folder / "disks", "")
        begun = time.monotonic()
        farm.run("farm", "submit", place, "--engine", "slurm", "--program", str(wrapper), "-o", str(folder / "slurm"), env={**cluster.env, **env}, cwd=folder)
        cluster.wait_for_jobs(PATIENCE)
        found = finish(farm, server, place, env, folder, begun)
        found["restarts"] = sum(int(job.get("Restarts", 0)) for job in cluster.jobs())
    kinds = sorted(proxy.lost.values())
    if len(kinds) != found["frames"] or len(set(kinds)) != 2:
        raise FarmError(f"expected a lost answer for each of {found['frames']} markers, found {kinds}")
    if found["payloads"] != found["frames"] or found["lost"]:
        raise FarmError(f"an attempt took its own marker for another's: {found}")
    return found


def ignored_conditions(farm, server, folder):
    """A store that does not honour conditional writes is refused before anything is planned."""
    with Proxy(server.port, "ignore") as proxy:
        begun = time.monotonic()
        said = farm.run("farm", "plan", str(farm.config), "-o", f"s3://{BUCKET}/ignored", *DIVISION, code=None, env=server.env(proxy.port))
    if "cannot hold a job" not in said:
        raise FarmError(f"a store without conditional writes was accepted: {said}")
    return {"seconds": round(time.monotonic() - begun, 1), "refused": said.strip().splitlines()[-1].partition("cannot hold a job: ")[2]}


def finish(farm, server, place, env, folder, begun):
    farm.judge(place, folder / "dataset", env=env)
    seconds = time.monotonic() - begun
    found = audit(server.download(place.removeprefix(f"s3://{BUCKET}/"), folder / "downloaded"))
    if found["different"]:
        raise FarmError(f"{found['different']} frames were made twice with different bytes")
    return {**found, "seconds": round(seconds, 1)}


STORES = [
    ("S3, two workers at once", "each does all tasks, in one bucket", two_workers),
    ("S3, answers lost", "every marker is written, and the first answer is an error 500 or none", lost_replies),
    ("S3 without conditional writes", "a proxy takes `If-None-Match` away: `farm plan` must refuse the store", ignored_conditions),
]
