"""The proxy of the operator's manual: nginx loads the recipe as it is written there, and serves by it."""

import re
import shutil
import socket
import ssl
import subprocess
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import httpx
import pytest

from app.settings import ROOT

SECRET = "jO3a-9xYz0123Ab_"
WHOLE = "events {{}}\npid {directory}/nginx.pid;\nerror_log {directory}/main.log;\nhttp {{\n{recipe}\n}}\n"
PICTURES = 60  # of a page, asked for at once
WRITES = 60


def program() -> str:
    found = shutil.which("nginx", path="/usr/sbin:/usr/local/sbin:/usr/local/bin:/usr/bin:/bin")
    assert found, "nginx is missing: run scripts/test-packages"
    return found


def documented() -> str:
    text = (ROOT / "docs" / "operations.md").read_text(encoding="utf-8")
    found = re.search(r"^```nginx\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert found
    return found[1]


class Service(BaseHTTPRequestHandler):
    """Says which headers it got, after a moment."""

    arrived = threading.Event()

    def do_GET(self) -> None:
        self.arrived.wait(0.2)
        body = str(self.headers).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    do_POST = do_GET  # noqa: N815 - the names are the server's

    def log_message(self, *_arguments: object) -> None:
        """Print nothing."""


@pytest.fixture(scope="module")
def upstream() -> Iterator[int]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), Service)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield server.server_address[1]
    server.shutdown()
    thread.join()
    server.server_close()


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("nginx")
    key, certificate = made / "key.pem", made / "certificate.pem"
    arguments = ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-subj", "/CN=texture.example.org"]
    names = [*arguments, "-keyout", str(key), "-out", str(certificate)]
    subprocess.run(["openssl", *names], check=True, capture_output=True)
    return made


def configuration(directory: Path, changed: dict[str, str]) -> Path:
    """Write the recipe with what a machine has of its own: paths, and here the ports."""
    recipe = documented()
    own = {
        "/etc/ssl/texture.example.org.pem": f"{directory}/certificate.pem",
        "/etc/ssl/texture.example.org.key": f"{directory}/key.pem",
        "/var/log/nginx/": f"{directory}/",
        **changed,
    }
    for text, replacement in own.items():
        assert text in recipe, text
        recipe = recipe.replace(text, replacement)
    path = directory / "nginx.conf"
    path.write_text(WHOLE.format(directory=directory, recipe=recipe), encoding="utf-8")
    return path


def test_nginx_takes_the_recipe_as_it_is_written(directory: Path) -> None:
    path = configuration(directory, {})
    done = subprocess.run(
        [program(), "-t", "-p", directory, "-c", path], capture_output=True, text=True, check=False, timeout=30
    )
    assert done.returncode == 0, done.stderr
    assert "test is successful" in done.stderr


@pytest.fixture(scope="module")
def proxy(directory: Path, upstream: int) -> Iterator[httpx.Client]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    ports = {
        "listen 443": f"listen 127.0.0.1:{port}",
        "listen [::]:443 ssl http2;": "",
        "server 127.0.0.1:8000;": f"server 127.0.0.1:{upstream};",
    }
    path = configuration(directory, ports)
    running = subprocess.Popen([program(), "-p", directory, "-c", path, "-g", "daemon off;"], stderr=subprocess.PIPE)
    trust = ssl.create_default_context(cafile=str(directory / "certificate.pem"))
    trust.check_hostname = False
    transport = httpx.HTTPTransport(verify=trust, retries=20)  # until it listens
    limits = httpx.Limits(max_connections=PICTURES)
    try:
        with httpx.Client(
            base_url=f"https://127.0.0.1:{port}", transport=transport, limits=limits, timeout=30
        ) as client:
            yield client
    finally:
        running.terminate()
        running.communicate(timeout=10)


def test_a_pages_pictures_and_a_script_that_reads_are_never_throttled(proxy: httpx.Client) -> None:
    """At once, also at the very addresses whose writes are."""
    with ThreadPoolExecutor(PICTURES) as threads:
        for path in ("/api/v1/experiments/x/outputs/.preview", "/api/v1/experiments", "/experiments"):
            answers = list(threads.map(lambda _, path=path: proxy.get(path).status_code, range(PICTURES)))
            assert set(answers) == {200}


def test_writes_are_refused_beyond_a_burst(proxy: httpx.Client) -> None:
    with ThreadPoolExecutor(PICTURES) as threads:
        answers = list(threads.map(lambda _: proxy.post("/api/v1/experiments").status_code, range(WRITES)))
    assert set(answers) == {200, 429}


def test_the_service_learns_who_asks_and_by_which_name(proxy: httpx.Client) -> None:
    headers = {"Host": "texture.example.org:8443", "X-Forwarded-For": "203.0.113.9", "X-Forwarded-Proto": "http"}
    for path in ("/", "/api/v1/experiments/x/events", "/samples"):
        told = proxy.get(path, headers=headers).text
        assert "Host: texture.example.org:8443" in told
        assert "X-Forwarded-For: 127.0.0.1\n" in told.replace("\r", "")
        assert "X-Forwarded-Proto: https" in told


def test_the_metrics_are_for_nobody_outside(proxy: httpx.Client) -> None:
    assert proxy.get("/metrics").status_code == 403


@pytest.mark.parametrize(
    "path",
    [
        f"/experiments/{SECRET}?view=flip",
        f"/api/v1/experiments/{SECRET}/events",
        f"/samples/{SECRET}",
        f"/compare/x/{SECRET}",
        f"/?sample={SECRET}",
    ],
)
def test_its_access_log_tells_no_id(proxy: httpx.Client, directory: Path, path: str) -> None:
    proxy.get(path, headers={"Referer": f"https://texture.example.org{path}"})
    proxy.get("/archive")
    log = (directory / "microtexture.log").read_text(encoding="utf-8")
    assert '"GET /archive HTTP/1.1" 200' in log
    assert SECRET not in log
