"""The server: addresses, and what a request must be before anything is done for it.

Every address begins with a random token. The name of the host is that of this machine, so that no other name can be
bound to it; what changes something is sent by a page of this server (Origin), and has a limited size.
"""

import contextlib
import hmac
import http.server
import json
import os
import re
import secrets
import shutil
import socket
import sys
import threading
import urllib.parse

from traverse_report.language import LANGUAGES

HOSTS = ("127.0.0.1", "localhost")
MOST_BYTES, MOST_CONNECTIONS, SECONDS = 3_000_000, 32, 30.0
POLICY = ("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
          "frame-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'self'")
RESULTS_POLICY = "sandbox allow-scripts; frame-ancestors 'self'"  # for pages of results, which have a policy of their own
HEAD = {"X-Content-Type-Options": "nosniff", "Referrer-Policy": "same-origin", "Cache-Control": "no-store",
        "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Resource-Policy": "same-origin"}


class Answer(Exception):
    """What is sent back: a text, bytes, or an open file, which is closed. As an exception, from the middle of the work."""

    def __init__(self, status, content=b"", kind="text/plain; charset=utf-8", head=None):
        super().__init__(status)
        self.status, self.kind, self.head = status, kind, head or {}
        self.content = content.encode("utf-8") if isinstance(content, str) else content

    def length(self):
        return len(self.content) if isinstance(self.content, bytes) else os.fstat(self.content.fileno()).st_size

    def write_to(self, stream):
        if isinstance(self.content, bytes):
            stream.write(self.content)
        else:
            shutil.copyfileobj(self.content, stream)

    def close(self):
        if not isinstance(self.content, bytes):
            self.content.close()


def as_json(data, status=200):
    return Answer(status, json.dumps(data, allow_nan=False), "application/json")


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "traverse", ""
    timeout = SECONDS

    def do_GET(self):
        self.answer("GET")

    def do_HEAD(self):
        self.answer("GET")

    def do_POST(self):
        self.answer("POST")

    def answer(self, method):
        try:
            try:
                place = self.checked_place()
                sent = self.sent() if method == "POST" else None
                answer = self.server.site.answer(method, *place, sent)
            except Answer as early:
                answer = early
            except ConnectionError:
                raise
            except OSError as error:  # a full disk, for example
                answer = Answer(500, f"{error.filename or 'The server'}: {error.strerror or error}")
            with contextlib.closing(answer):
                self.send(answer)
        except (BrokenPipeError, ConnectionResetError, TimeoutError):
            self.close_connection = True

    def checked_place(self):
        """(language, parts of the path, {name: value} of the query) of a permitted request."""
        if self.headers.get_all("Host", []) not in [[f"{host}:{self.server.server_port}"] for host in HOSTS]:
            raise Answer(421, "This server answers to 127.0.0.1 only.")
        path, _, query = self.path.partition("?")
        parts = path.split("/")
        if parts[0] or not hmac.compare_digest(parts[1].encode() if len(parts) > 1 else b"", self.server.token.encode()):
            raise Answer(403, "The address needs the token that traverse serve prints at its start.")
        parts = parts[2:]
        if len(parts) < 2 and parts in ([], [""]):
            raise Answer(303, head={"Location": f"/{self.server.token}/{self.wanted_language()}/"})
        if not all(re.fullmatch(r"[A-Za-z0-9_-]+(\.[a-z0-9]+)?", part) for part in parts[:-1] + [parts[-1] or "index"]):
            raise Answer(404, "There is no such page.")
        return parts, dict(urllib.parse.parse_qsl(query, max_num_fields=10))

    def wanted_language(self):
        """The first language of the browser that the page has."""
        asked = re.findall(r"\b([a-z]{2})\b", self.headers.get("Accept-Language", ""))
        return next((language for language in asked if language in LANGUAGES), LANGUAGES[0])

    def sent(self):
        """The JSON object in the body of a request of a page of this server."""
        origin = self.headers.get("Origin", "")
        if origin not in [f"http://{host}:{self.server.server_port}" for host in HOSTS]:
            self.close_connection = True
            raise Answer(403, "Only pages of this server may send something.")
        if self.headers.get("Content-Type", "").partition(";")[0] != "application/json":
            self.close_connection = True
            raise Answer(415, "Only JSON is taken.")
        length, *others = self.headers.get_all("Content-Length", [""])
        if others or not re.fullmatch(r"[0-9]{1,1000}", length) or "Transfer-Encoding" in self.headers:
            self.close_connection = True
            raise Answer(411, "The length is missing.")
        if int(length) > MOST_BYTES:
            self.close_connection = True
            raise Answer(413, f"Allowed: at most {MOST_BYTES:,} bytes.")
        try:
            found = json.loads(self.rfile.read(int(length)))
        except (ValueError, RecursionError):
            raise Answer(400, "This is no JSON.") from None
        if not isinstance(found, dict):
            raise Answer(400, "This is no JSON object.")
        return found

    def send(self, answer):
        self.send_response(answer.status)
        head = HEAD | {"Content-Security-Policy": POLICY, "Content-Type": answer.kind,
                       "Content-Length": str(answer.length())} | answer.head
        for name, value in head.items():
            self.send_header(name, value)
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        if self.command != "HEAD":
            answer.write_to(self.wfile)

    def log_message(self, form, *words):
        """Nothing: an address has the token."""


class Server(http.server.ThreadingHTTPServer):
    """On this machine only. site: what answers permitted requests."""
    daemon_threads = True

    def __init__(self, site, port=0):
        self.site, self.token = site, secrets.token_urlsafe(24)
        self.free = threading.BoundedSemaphore(MOST_CONNECTIONS)
        site.root = f"/{self.token}/"
        super().__init__(("127.0.0.1", port), Handler)

    @property
    def address(self):
        return f"http://127.0.0.1:{self.server_port}/{self.token}/"

    def server_bind(self):
        """Without the look-up of names of http.server."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_name, self.server_port = self.server_address[:2]

    def process_request(self, request, client_address):
        """Leaves out connections beyond the limit."""
        if not self.free.acquire(blocking=False):
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    def process_request_thread(self, request, client_address):
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.free.release()

    def handle_error(self, request, client_address):
        """A broken connection is no error of the server; others are printed as one line."""
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            print(f"traverse serve: {type(error).__name__}: {error}", file=sys.stderr)
