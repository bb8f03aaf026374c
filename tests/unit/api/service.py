"""The server over a service in memory (fake_service.cpp) as a process, and clients that can misbehave."""

import http.client
import json
import os
import pathlib
import socket
import subprocess
import tempfile
import uuid

PROGRAM = os.environ["LINEFEED_FAKE_SERVICE"]


class Service:
    """A running server with a directory of its own; leave() by `with`."""

    def __init__(self, *options, tokens=None):
        self.directory = tempfile.TemporaryDirectory(prefix="linefeed_api_")
        self.path = pathlib.Path(self.directory.name)
        self.socket_path = self.path / "linefeed.sock"
        self.options = [str(option) for option in options]
        if tokens is not None:
            self.tokens_file = self.path / "tokens"
            self.tokens_file.write_text(tokens)
            self.tokens_file.chmod(0o640)
            self.options += ["--tokens", str(self.tokens_file)]
        self.start()

    def start(self):
        self.process = subprocess.Popen([PROGRAM, str(self.path), *self.options], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        first = self.process.stdout.readline().strip()
        if not first.isdigit():
            self.process.wait()
            self.process.stdin.close()
            self.process.stdout.close()
            raise RuntimeError(first)
        self.port = int(first)

    def tell(self, line):
        """One line of fake_service.cpp; its answer."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().strip()

    def changes(self):
        return int(self.tell("changes"))

    def kill(self):
        self.process.kill()
        self.end()

    def end(self):
        if self.process.poll() is None:
            self.process.stdin.write("quit\n")
            self.process.stdin.flush()
        code = self.process.wait(20)
        self.process.stdin.close()
        self.process.stdout.close()
        return code

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        code = None if self.process.stdin.closed else self.end()
        self.directory.cleanup()
        if exception == (None, None, None) and code not in (None, 0):
            raise AssertionError(f"the server ended with {code}")

    def raw(self, over_socket=False):
        if over_socket:
            connection = socket.socket(socket.AF_UNIX)
            connection.settimeout(20)
            connection.connect(str(self.socket_path))
        else:
            connection = socket.create_connection(("127.0.0.1", self.port), 20)
        return connection

    def ask(self, method, target, body=None, headers=None, over_socket=True, key=True):
        """An Answer. A JSON body unless it is bytes. With a new Idempotency-Key, a given one (text), or none (False)."""
        headers = dict(headers or {})
        if body is not None and not isinstance(body, bytes):
            body = json.dumps(body).encode()
            headers.setdefault("Content-Type", "application/json")
        if method == "POST" and key:
            headers.setdefault("Idempotency-Key", key if isinstance(key, str) else str(uuid.uuid4()))
        if method == "POST" and body is None:
            headers.setdefault("Content-Length", "0")
        headers.setdefault("Host", f"127.0.0.1:{self.port}")
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.sock = self.raw(over_socket)
        try:
            connection.putrequest(method, target, skip_host=True, skip_accept_encoding=True)
            if body is not None:
                headers.setdefault("Content-Length", str(len(body)))
            for name, value in headers.items():
                for one in value if isinstance(value, list) else [value]:
                    connection.putheader(name, one)
            connection.endheaders(body)
            return Answer(connection.getresponse())
        finally:
            connection.close()


class Answer:
    def __init__(self, response):
        self.status = response.status
        self.headers = response.headers
        self.media_type = (response.getheader("Content-Type") or "").split(";")[0]
        self.body = response.read()

    @property
    def json(self):
        return json.loads(self.body)

    @property
    def problem(self):
        """The last word of the problem's type."""
        assert self.media_type == "application/problem+json", (self.status, self.body)
        return self.json["type"].removeprefix("urn:linefeed:problem:")


def read_all(connection):
    """Until the other side closes."""
    received = b""
    while True:
        try:
            piece = connection.recv(65536)
        except ConnectionResetError:
            return received
        if not piece:
            return received
        received += piece


def read_answer(connection):
    """One answer of a connection that stays open: (status, head, body)."""
    received = b""
    while b"\r\n\r\n" not in received:
        piece = connection.recv(65536)
        if not piece:
            raise ConnectionError(received)
        received += piece
    head, _, body = received.partition(b"\r\n\r\n")
    length = next((int(line.split(b":")[1]) for line in head.split(b"\r\n") if line.lower().startswith(b"content-length:")), 0)
    while len(body) < length:
        body += connection.recv(65536)
    return int(head.split()[1]), head.decode(), body
