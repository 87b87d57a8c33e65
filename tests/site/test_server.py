"""`wale library serve`: the site on 127.0.0.1 alone, until a signal."""

import http.client
import pathlib
import signal
import socket
import subprocess

import pytest

from conftest import SOURCE, WALE

pytestmark = pytest.mark.skipif(not (pathlib.Path(WALE).parent / "libexec/wale/wale-site-server").exists(),
                                reason="built without cpp-httplib (Debian: libcpp-httplib-dev)")


def a_free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def test_it_serves_the_site_alone_and_ends_by_a_signal(tmp_path):
    port = a_free_port()
    (tmp_path / "secret.txt").write_text("secret")
    server = subprocess.Popen([WALE, "library", "serve", "library/wood", "-o", tmp_path / "site", "--port", str(port)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=SOURCE)
    try:
        assert f"http://127.0.0.1:{port}/" in server.stdout.readline()

        def get(path):
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
            connection.putrequest("GET", path, skip_host=False)
            connection.endheaders()
            answer = connection.getresponse()
            return answer.status, answer.getheader("Content-Type"), answer.read()

        first = (tmp_path / "site/index.html").read_bytes()
        assert get("/") == get("/index.html") == (200, "text/html; charset=utf-8", first)
        page = next((tmp_path / "site/material").glob("*.html"))
        assert get("/material/" + page.stem)[2] == page.read_bytes()  # the stable link
        assert get("/material/" + page.stem + ".json")[1] == "application/ld+json"
        for path in ("/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "//../secret.txt", "/material/../../secret.txt",
                     "/.wale-site-notes", "/.wale-site-files", "/nothing", "/material", "/index.html%00"):
            status, _, body = get(path)
            assert status in (400, 404) and b"secret" not in body, path
        listening = subprocess.run(["cat", "/proc/net/tcp"], capture_output=True, text=True).stdout
        sockets = [line.split()[1] for line in listening.splitlines()[1:] if line.split()[3] == "0A"]
        assert [each for each in sockets if each.endswith(":%04X" % port)] == ["0100007F:%04X" % port]
        taken = subprocess.run([WALE, "library", "serve", "library/wood", "-o", tmp_path / "site", "--port", str(port)],
                               capture_output=True, text=True, cwd=SOURCE, timeout=60)
        assert taken.returncode == 1 and "--port" in taken.stderr
        server.send_signal(signal.SIGINT)
        assert server.wait(timeout=30) == 0
    finally:
        server.kill()
        server.wait()
