"""What goes over the wire, judged by other implementations: http.client, jsonschema, promtool, and raw sockets.

usage: wire_test.py [CLASS]
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import socket
import stat
import subprocess
import sys
import time
import unittest
import uuid

import jsonschema
import yaml

from service import PROGRAM, Answer, Service, read_all, read_answer

SOURCE = pathlib.Path(__file__).resolve().parents[3]
OPENAPI = SOURCE / "src" / "api" / "openapi.yaml"
SECRETS = {"viewer": "linefeed_" + "1" * 64, "operator": "linefeed_" + "2" * 64}
TOKENS = "# who may what\n\n" + "".join(
    f"{role}-token {role} sha256:{hashlib.sha256(secret.encode()).hexdigest()}\n" for role, secret in SECRETS.items())


def bearer(role):
    return {"Authorization": "Bearer " + SECRETS[role]}


class Schemas(unittest.TestCase):
    """Every route of openapi.yaml is there, and what it answers fits the schema of that status and type."""

    BODIES = {
        "printerStart": {"job": 12}, "printerAcknowledge": {"error": 1223}, "printerAccept": {"serial_number": "104711"}, "printerSuspend": {"suspend": True},
        "printerCommand": {"what": "outputs set", "output": 3, "state": "on"},
        "jobQueue": {"printer": "line1"}, "jobReprint": {"records": "1-5", "reason": "smudged"},
        "jobSettle": {"last_printed": "17"}, "import": {"file": "/etc/hostname"}, "writePrinterFile": b"\x00file",
    }
    QUERIES = {"readyz": "?verbose", "printerFrames": "?error=true", "printerInspect": "?type=1", "jobs": "?limit=2&phase=queued,finished,in_doubt",
               "jobLedger": "?records=5-400&limit=3", "jobLedgerRows": "?limit=3", "jobRecords": "?records=3-9&limit=2", "events": "?limit=1", "audit": "?limit=2"}

    @classmethod
    def setUpClass(cls):
        cls.openapi = yaml.safe_load(OPENAPI.read_text())

    def validator(self, schema):
        document = dict(schema, components=self.openapi["components"])
        return jsonschema.Draft202012Validator(document, format_checker=jsonschema.FormatChecker())

    def send(self, service, method, path, name):
        body = self.BODIES.get(name)
        return service.ask(method, path, body, {"Content-Type": "application/octet-stream"} if isinstance(body, bytes) else None)

    def check(self, operation, answer):
        described = operation["responses"].get(str(answer.status)) or operation["responses"]["default"]
        if "$ref" in described:
            described = self.openapi["components"]["responses"][described["$ref"].rsplit("/", 1)[1]]
        self.assertIn(answer.media_type, described["content"])
        if answer.media_type.endswith("json"):
            self.validator(described["content"][answer.media_type]["schema"]).validate(answer.json)

    def operations(self):
        for path, item in self.openapi["paths"].items():
            for method in ("get", "post"):
                if method in item and item[method]["operationId"] != "eventStream":
                    yield path.replace("{printer}", "line1").replace("{job}", "12").replace("{what}", "parameter"), method.upper(), item[method]

    def test_every_route_answers_as_its_schema_says(self):
        with Service() as service:
            service.ask("POST", "/api/v1/printers/line1/stop")  # so that the audit log has something to show
            for path, method, operation in self.operations():
                name = operation["operationId"]
                with self.subTest(name):
                    answer = self.send(service, method, path + self.QUERIES.get(name, ""), name)
                    self.assertIn(answer.status, (200, 201, 202), answer.body)
                    self.check(operation, answer)
                    if isinstance(self.BODIES.get(name), dict):  # what the tests send is as described, too
                        body = operation["requestBody"]["content"]["application/json"]["schema"]
                        self.validator(body).validate(self.BODIES[name])

    def test_every_failure_is_a_problem_of_its_kind(self):
        statuses = {"usage": 422, "unreachable": 502, "stopped": 409, "input": 422, "in_doubt": 409, "storage": 503, "internal": 500}
        with Service() as service:
            for kind, status in statuses.items():
                service.tell(f"fail {kind} it is \\ so")
                for path, method, operation in self.operations():
                    if method == "POST":
                        with self.subTest(kind=kind, operation=operation["operationId"]):
                            answer = self.send(service, method, path, operation["operationId"])
                            self.assertEqual(answer.status, status, answer.body)
                            self.check(operation, answer)
                            self.assertEqual(answer.json["kind"], kind)
                            self.assertEqual(answer.json["detail"], "it is \\ so")
                answer = service.ask("GET", "/readyz")
                self.assertEqual((answer.status, answer.json), (503, {"ready": False}))

    def test_what_does_not_exist_is_not_found(self):
        with Service() as service:
            for path, method, operation in self.operations():
                wrong = path.replace("line1", "line%209").replace("/12", "/99")
                if wrong != path:
                    with self.subTest(operation["operationId"]):
                        answer = self.send(service, method, wrong, operation["operationId"])
                        self.assertEqual((answer.status, answer.problem), (404, "not-found"))
                        self.check(operation, answer)
            for path in ("/api/v1/jobs/0", "/api/v1/jobs/x", "/api/v1/jobs/-1", "/api/v1/jobs/99999999999999999999",
                         "/nothing", "/api/v1/jobs/", "/api/v1/jobs/1/2", "/api/v1//jobs", "/api/v1/printers/a%2fb"):
                self.assertEqual(service.ask("GET", path).problem, "not-found", path)

    def test_looks_and_commands_carry_their_arguments(self):
        with Service() as service:
            for target, arguments in (("parameter?type=1", {"type": "1"}), ("query?code=PR&argument=1", {"code": "PR", "argument": "1"}), ("status", {})):
                seen = service.ask("GET", f"/api/v1/printers/line1/inspect/{target}")
                self.assertEqual((200, arguments), (seen.status, seen.json["arguments"]), seen.body)
            for target, status in (("status?type=1", 422), ("query", 422), ("status?other=1", 400), ("", 404), ("a/b", 404)):
                self.assertEqual(status, service.ask("GET", f"/api/v1/printers/line1/inspect/{target}").status, target)
            done = service.ask("POST", "/api/v1/printers/line1/command", {"what": "outputs set", "output": 3, "state": "on"})
            self.assertEqual({"what": "outputs set", "arguments": {"output": 3, "state": "on"}}, done.json)
            for body in ({}, {"what": 1}, {"what": ""}):
                self.assertEqual(422, service.ask("POST", "/api/v1/printers/line1/command", body).status)

    def test_the_document_that_is_served_is_the_file(self):
        with Service() as service:
            answer = service.ask("GET", "/api/v1/openapi.yaml", over_socket=False)
            self.assertEqual((answer.media_type, answer.body), ("application/yaml", OPENAPI.read_bytes()))

    def test_every_reference_of_the_document_leads_somewhere(self):
        text = OPENAPI.read_text()
        for reference in set(re.findall(r'\$ref: "#/([^"]+)"', text)):
            place = self.openapi
            for step in reference.split("/"):
                place = place[step]
        for schema in self.openapi["components"]["schemas"].values():
            jsonschema.Draft202012Validator.check_schema(schema)

    def test_texts_that_are_not_utf8_show_their_bytes(self):
        with Service() as service:
            printer = service.ask("GET", "/api/v1/printers/line1").json
            self.assertEqual(printer["serial_number"], '12\\xFF"\n')
            self.assertEqual(service.ask("GET", "/api/v1/jobs/11").json["name"], "names\\xE4.csv")
            frames = service.ask("GET", "/api/v1/printers/line1/frames").json["items"]
            self.assertEqual(frames[1]["text"], "^0=SM256\\x09\\x00\\xFF\\x0D")
            self.assertEqual(bytes.fromhex(frames[1]["hex"]), b"^0=SM256\t\x00\xff\r")
            self.assertEqual(service.ask("GET", "/api/v1/printers/Stra%C3%9Fe%202").json["name"], "Straße 2")

    def test_pages_follow_each_other(self):
        with Service() as service:
            def walk(target):
                items = []
                while target:
                    page = service.ask("GET", target).json
                    items += page["items"]
                    target = page["next"]
                return items
            self.assertEqual([job["id"] for job in walk("/api/v1/jobs?limit=1")], [13, 12, 11])
            self.assertEqual([job["id"] for job in walk("/api/v1/jobs?limit=1&printer=line1&phase=queued,in_doubt")], [13, 12])
            self.assertEqual([event["id"] for event in walk("/api/v1/events?limit=1")], [1, 2])
            self.assertEqual([row["sequence"] for row in walk("/api/v1/jobs/12/ledger/rows?limit=3")], [1, 2, 3, 4, 5, 6, 7])
            self.assertEqual([r["number"] for r in walk("/api/v1/jobs/12/records?records=4996-9999&limit=2")], [4996, 4997, 4998, 4999, 5000])
            self.assertEqual(walk("/api/v1/jobs/12/records?records=5001"), [])
            stretches = walk("/api/v1/jobs/12/ledger?records=5-44&limit=2")
            self.assertEqual([(s["first"], s["last"]) for s in stretches], [(5, 10), (11, 20), (21, 30), (31, 40), (41, 44)])


class Rights(unittest.TestCase):
    CHANGE = "/api/v1/printers/line1/stop"

    def test_without_tokens_the_loopback_looks_and_the_socket_changes(self):
        with Service() as service:
            self.assertEqual(service.ask("GET", "/api/v1/status", over_socket=False).status, 200)
            answer = service.ask("POST", self.CHANGE, over_socket=False)
            self.assertEqual((answer.status, answer.problem), (403, "not-permitted"))
            self.assertEqual(service.ask("GET", "/api/v1/status", headers=bearer("viewer"), over_socket=False).status, 401)
            self.assertEqual(service.changes(), 0)
            self.assertEqual(service.ask("POST", self.CHANGE).status, 200)
            self.assertRegex(service.tell("last"), r"^\S+ \(uid [0-9]+\): stop printer line1$")

    def test_a_token_decides(self):
        with Service(tokens=TOKENS) as service:
            for target, anyone in (("/livez", 200), ("/readyz", 200), ("/version", 200), ("/api/v1/openapi.yaml", 200),
                                   ("/readyz?verbose", 401), ("/metrics", 401), ("/api/v1/jobs", 401)):
                answer = service.ask("GET", target, over_socket=False)
                self.assertEqual(answer.status, anyone, target)
                if anyone == 401:
                    self.assertEqual(answer.headers["WWW-Authenticate"], 'Bearer realm="linefeed"')
                    self.assertEqual(answer.problem, "token-missing")
                self.assertEqual(service.ask("GET", target, headers=bearer("viewer"), over_socket=False).status, 200)
            self.assertEqual(service.ask("POST", self.CHANGE, over_socket=False).status, 401)
            self.assertEqual(service.ask("POST", self.CHANGE, headers=bearer("viewer"), over_socket=False).problem, "not-permitted")
            self.assertEqual(service.changes(), 0)
            self.assertEqual(service.ask("POST", self.CHANGE, headers=bearer("operator"), over_socket=False).status, 200)
            self.assertEqual(service.tell("last"), "token operator-token: stop printer line1")
            for wrong in ("Bearer linefeed_" + "3" * 64, "Bearer ", "Basic abc", SECRETS["operator"], "Bearer " + "x" * 9000):
                answer = service.ask("GET", "/livez", headers={"Authorization": wrong}, over_socket=False)
                self.assertEqual(answer.problem, "token-unknown", wrong[:40])

    def test_a_path_is_taken_over_the_socket_only(self):
        with Service(tokens=TOKENS) as service:
            answer = service.ask("POST", "/api/v1/jobs", {"file": "/etc/hostname"}, bearer("operator"), over_socket=False)
            self.assertEqual((answer.status, answer.problem), (403, "not-permitted"))
            self.assertEqual(service.changes(), 0)

    def test_tokens_are_read_again(self):
        with Service(tokens=TOKENS) as service:
            service.tokens_file.write_text("\n".join(TOKENS.splitlines()[:-1]) + "\n")
            open_before = service.raw()
            self.assertEqual(service.ask("POST", "/api/v1/reload", headers=bearer("operator"), over_socket=False).status, 200)
            self.assertEqual(service.ask("POST", self.CHANGE, headers=bearer("operator"), over_socket=False).problem, "token-unknown")
            with open_before:
                open_before.sendall(f"GET /metrics HTTP/1.1\r\nHost: localhost:{service.port}\r\nAuthorization: {bearer('operator')['Authorization']}\r\n\r\n".encode())
                self.assertEqual(read_answer(open_before)[0], 401)
            service.tokens_file.write_text("nonsense\n")
            answer = service.ask("POST", "/api/v1/reload")
            self.assertEqual(answer.status, 422)
            self.assertIn("tokens:1:", answer.json["detail"])
            self.assertEqual(service.ask("GET", "/metrics", headers=bearer("viewer"), over_socket=False).status, 200)

    def test_what_others_could_read_or_reach_is_not_started(self):
        service = Service(tokens=TOKENS)
        with service:
            service.end()
            service.tokens_file.chmod(0o644)
            with self.assertRaisesRegex(RuntimeError, "usage: .*others may read it"):
                service.start()
        with self.assertRaisesRegex(RuntimeError, "usage: .*tokens_file"):
            Service("--listen", "0.0.0.0")


class Browsers(unittest.TestCase):
    """Pages in somebody's browser must not get at the service."""

    def test_the_host_must_be_a_name_of_the_service(self):
        with Service("--host", "print.plant.example") as service:
            port = service.port
            for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"LOCALHOST:{port}", "print.plant.example", f"print.plant.example:{port}"):
                self.assertEqual(service.ask("GET", "/livez", headers={"Host": host}, over_socket=False).status, 200, host)
            for host in ("127.0.0.1", "localhost", f"evil.example:{port}", f"127.0.0.1:{port + 1}", f"localhost.evil.example:{port}",
                         f"print.plant.example.:{port}", f"xprint.plant.example:{port}", "", f"user@localhost:{port}", f"0.0.0.0:{port}"):
                answer = service.ask("GET", "/api/v1/status", headers={"Host": host}, over_socket=False)
                self.assertEqual((answer.status, answer.problem), (421, "host-not-allowed"), host)
            for head in (b"GET /livez HTTP/1.1\r\n\r\n", b"GET /livez HTTP/1.1\r\nHost: localhost:%d\r\nHost: x\r\n\r\n" % port):
                with service.raw() as raw:
                    raw.sendall(head)
                    self.assertEqual(read_answer(raw)[0], 400)
            with service.raw() as raw:
                raw.sendall(b"GET http://evil.example/livez HTTP/1.1\r\nHost: localhost:%d\r\n\r\n" % port)
                self.assertEqual(read_answer(raw)[0], 421)
                raw.sendall(b"GET http://localhost:%d/livez HTTP/1.1\r\nHost: evil.example\r\n\r\n" % port)
                self.assertEqual(read_answer(raw)[0], 200)

    def test_a_foreign_page_changes_nothing_and_reads_nothing(self):
        with Service(tokens=TOKENS) as service:
            for origin in ("http://evil.example", "null", f"http://127.0.0.1:{service.port + 1}", f"https://127.0.0.1:{service.port}"):
                headers = dict(bearer("operator"), Origin=origin)
                answer = service.ask("POST", Rights.CHANGE, headers=headers, over_socket=False)
                self.assertEqual((answer.status, answer.problem), (403, "origin-not-allowed"), origin)
                answer = service.ask("GET", "/api/v1/status", headers=headers, over_socket=False)
                self.assertIsNone(answer.headers["Access-Control-Allow-Origin"])
                answer = service.ask("OPTIONS", Rights.CHANGE, headers={"Origin": origin, "Access-Control-Request-Method": "POST"}, over_socket=False)
                self.assertEqual(answer.status, 403)
            self.assertEqual(service.changes(), 0)
            own = dict(bearer("operator"), Origin=f"http://127.0.0.1:{service.port}")
            self.assertEqual(service.ask("POST", Rights.CHANGE, headers=own, over_socket=False).status, 200)

    def test_a_form_of_a_page_is_no_json(self):
        with Service() as service:
            for kind in ("application/x-www-form-urlencoded", "text/plain", "multipart/form-data; boundary=x"):
                answer = service.ask("POST", Rights.CHANGE, b"", {"Content-Type": kind})
                self.assertEqual((answer.status, answer.problem), (415, "unsupported-type"))

    def test_a_configured_page_may_call(self):
        page = "https://mes.plant.example"
        with Service("--origin", page, tokens=TOKENS) as service:
            asked = {"Origin": page, "Access-Control-Request-Method": "POST", "Access-Control-Request-Headers": "authorization"}
            answer = service.ask("OPTIONS", Rights.CHANGE, headers=asked, over_socket=False)
            self.assertEqual((answer.status, answer.headers["Access-Control-Allow-Origin"]), (204, page))
            self.assertIn("Idempotency-Key", answer.headers["Access-Control-Allow-Headers"])
            answer = service.ask("POST", Rights.CHANGE, headers=dict(bearer("operator"), Origin=page), over_socket=False)
            self.assertEqual((answer.status, answer.headers["Access-Control-Allow-Origin"], answer.headers["Vary"]), (200, page, "Origin"))
            answer = service.ask("GET", "/api/v1/jobs", headers={"Origin": page}, over_socket=False)
            self.assertEqual((answer.status, answer.headers["Access-Control-Allow-Origin"]), (401, page))

    def test_every_answer_says_what_browsers_must_not_do(self):
        with Service() as service:
            for target in ("/livez", "/nothing", "/metrics", "/api/v1/openapi.yaml"):
                headers = service.ask("GET", target, over_socket=False).headers
                self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
                self.assertEqual(headers["Cache-Control"], "no-store")
                self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
                self.assertEqual(headers["X-Frame-Options"], "DENY")


class Wire(unittest.TestCase):
    """HTTP itself: methods, types, limits, times."""

    def test_methods(self):
        with Service() as service:
            for method, target, allow in (("DELETE", "/api/v1/jobs", "GET, HEAD, POST, OPTIONS"), ("POST", "/livez", "GET, HEAD, OPTIONS"),
                                          ("GET", Rights.CHANGE, "POST, OPTIONS"), ("PUT", "/metrics", "GET, HEAD, OPTIONS"),
                                          ("TRACE", "/livez", "GET, HEAD, OPTIONS"), ("FOO", "/livez", "GET, HEAD, OPTIONS")):
                answer = service.ask(method, target)
                self.assertEqual((answer.status, answer.problem, answer.headers["Allow"]), (405, "method-not-allowed", allow))
            answer = service.ask("OPTIONS", "/api/v1/jobs")
            self.assertEqual((answer.status, answer.headers["Allow"], answer.body), (204, "GET, HEAD, POST, OPTIONS", b""))
            full, head = service.ask("GET", "/version"), service.ask("HEAD", "/version")
            self.assertEqual((head.status, head.headers["Content-Length"], head.body), (200, str(len(full.body)), b""))
            self.assertEqual(service.ask("HEAD", "/api/v1/events/stream").status, 200)

    def test_what_is_accepted(self):
        with Service() as service:
            for accept, status in (("application/json", 200), ("text/html, */*;q=0.1", 200), ("application/*", 200), ("text/html", 406),
                                   ("application/json;q=0, */*", 406), ("application/xml;q=0.9", 406), ("", 200)):
                self.assertEqual(service.ask("GET", "/api/v1/status", headers={"Accept": accept}).status, status, accept)

    def test_parameters_and_bodies_are_read_strictly(self):
        with Service() as service:
            for target in ("/api/v1/jobs?limit=0", "/api/v1/jobs?limit=1001", "/api/v1/jobs?limit=5&limit=6", "/api/v1/jobs?limt=5",
                           "/api/v1/jobs?phase=gone", "/api/v1/jobs?after=-1", "/api/v1/jobs?printer=%zz", "/api/v1/jobs?printer=%00",
                           "/api/v1/jobs/12/ledger?records=9-5", "/api/v1/jobs/12/ledger?records=0x5", "/livez?x=1",
                           "/api/v1/printers/line1/frames?error=maybe", "/api/v1/events/stream?after=x"):
                answer = service.ask("GET", target)
                self.assertEqual((answer.status, answer.problem), (400, "malformed"), target)
                self.assertTrue(answer.json["advice"])
            reprint = "/api/v1/jobs/12/reprint"
            for body, status in ((b"{", 400), (b"[]", 400), (b"", 400), (b'{"records":"1","records":"2","reason":"x"}', 400), (b"\xff", 400),
                                 ({"records": "1", "reason": ""}, 422), ({"records": "1"}, 422), ({"records": 1, "reason": "x"}, 422),
                                 ({"records": "1", "reason": "x", "more": 1}, 422), ({"records": "1", "reason": "x" * 1001}, 422)):
                headers = {"Content-Type": "application/json"}
                answer = service.ask("POST", reprint, body, headers)
                self.assertEqual(answer.status, status if body != b"" else 422, (body, answer.body))
            for body in ({}, {"in_doubt": "skip", "printed": "none"}, {"in_doubt": "ask"}):
                self.assertEqual(service.ask("POST", "/api/v1/jobs/13/settle", body).problem, "not-valid")
            for body in ({"error": 0}, {"error": 1 << 25}, {"error": 1.5}, {"error": True}, {"error": 18446744073709551615}):
                self.assertEqual(service.ask("POST", "/api/v1/printers/line1/acknowledge", body).problem, "not-valid")
            self.assertEqual(service.ask("POST", Rights.CHANGE, {"x": 1}).problem, "not-valid")
            self.assertEqual(service.ask("POST", "/api/v1/printers/line1/start", {"job": 11}).problem, "not-valid")
            self.assertEqual(service.changes(), 0)
            self.assertEqual(service.ask("POST", Rights.CHANGE, {}).status, 200)

    def test_lengths_types_and_expectations(self):
        with Service() as service:
            def raw(head, body=b""):
                with service.raw(over_socket=True) as connection:
                    connection.sendall(head + b"\r\n" + body)
                    return read_answer(connection)[0]
            post = b"POST /api/v1/jobs/12/queue HTTP/1.1\r\nHost: x\r\nIdempotency-Key: %s\r\n"
            json_type = b"Content-Type: application/json\r\n"
            body = b'{"printer":"line1"}'
            key = lambda: uuid.uuid4().hex.encode()
            self.assertEqual(raw(post % key() + json_type), 411)
            self.assertEqual(raw(post % key() + json_type + b"Transfer-Encoding: chunked\r\n", b"13\r\n" + body + b"\r\n0\r\n\r\n"), 200)
            self.assertEqual(raw(post % key() + b"Content-Length: 19\r\n", body), 415)
            self.assertEqual(raw(post % key() + json_type + b"Content-Encoding: gzip\r\nContent-Length: 19\r\n", body), 415)
            self.assertEqual(raw(post % key() + json_type + b"Expect: gold\r\nContent-Length: 19\r\n", body), 417)
            self.assertEqual(raw(post % key() + json_type + b"Content-Length: 65537\r\n"), 413)
            self.assertEqual(raw(post % key() + json_type + b"Transfer-Encoding: chunked\r\n", b"20000\r\n" + b" " * 0x20000 + b"\r\n0\r\n\r\n"), 413)
            self.assertEqual(raw(b"GET /livez HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n", b"{}"), 400)
            # What could be read as two different requests is read as none.
            self.assertEqual(raw(post % key() + json_type + b"Content-Length: 19\r\nTransfer-Encoding: chunked\r\n", body), 400)
            self.assertEqual(raw(post % key() + json_type + b"Content-Length: 19\r\nContent-Length: 18\r\n", body), 400)
            with service.raw(over_socket=True) as connection:
                connection.sendall(post % key() + json_type + b"Expect: 100-continue\r\nContent-Length: 19\r\n\r\n")
                self.assertEqual(connection.recv(100), b"HTTP/1.1 100 Continue\r\n\r\n")
                connection.sendall(body)
                self.assertEqual(read_answer(connection)[0], 200)
            self.assertEqual(raw(b"GET /" + b"x" * 20000 + b" HTTP/1.1\r\nHost: x\r\n"), 431)
            self.assertEqual(raw(b"GET /livez HTTP/1.1\r\nHost: x\r\n" + b"".join(b"X-%d: y\r\n" % k for k in range(4000))), 431)
            for nonsense in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n", b"hello\r\n", b"GET /livez\r\n", b"GET /livez HTTP/3.0\r\n",
                             b"GET livez HTTP/1.1\r\nHost: x\r\n", b"GET /liv\xc3\xa9z HTTP/1.1\r\nHost: x\r\n", b"GET /livez HTTP/1.1\r\nHo st: x\r\n"):
                self.assertEqual(raw(nonsense), 400, nonsense)

    def test_requests_follow_each_other_on_one_connection(self):
        with Service() as service, service.raw(over_socket=True) as raw:
            get = b"GET /livez HTTP/1.1\r\nHost: x\r\n\r\n"
            for _ in range(3):
                raw.sendall(get)
                self.assertEqual(read_answer(raw)[0], 200)
            raw.sendall(get * 5 + get.replace(b"\r\n\r\n", b"\r\nConnection: close\r\n\r\n"))
            self.assertEqual(read_all(raw).count(b"HTTP/1.1 200 OK"), 6)
            with service.raw(over_socket=True) as old:
                old.sendall(b"GET /livez HTTP/1.0\r\n\r\n")
                self.assertTrue(read_all(old).startswith(b"HTTP/1.1 200"))

    def test_who_is_silent_or_slow_is_cut_off_in_time(self):
        with Service("--timeout", 1000) as service:
            def ends(sent, drip=b""):
                started = time.monotonic()
                with service.raw() as raw:
                    raw.sendall(sent)
                    raw.settimeout(0.1)
                    received = b""
                    while time.monotonic() - started < 10:
                        try:
                            if drip:
                                raw.sendall(drip)
                            piece = raw.recv(4096)
                            if not piece:
                                return received
                            received += piece
                        except TimeoutError:
                            continue
                        except (ConnectionResetError, BrokenPipeError):
                            return received
                self.fail("it is still open after 10 s")
            host = b"Host: localhost:%d\r\n" % service.port
            self.assertEqual(ends(b""), b"")
            self.assertIn(b" 408 ", ends(b"GET /livez HTTP/1.1\r\n" + host))
            self.assertIn(b" 408 ", ends(b"GET /livez HTTP/1.1\r\n" + host, b"X: y\r\n"))
            keyed = b"POST /api/v1/jobs/12/queue HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 500\r\n\r\n"
            started = time.monotonic()
            with service.raw(over_socket=True) as raw:
                raw.sendall(keyed + b"{")
                self.assertEqual(read_answer(raw)[0], 408)
            self.assertGreater(time.monotonic() - started, 0.5)

    def test_there_is_room_for_a_newcomer_among_silent_ones(self):
        with Service("--max-connections", 20) as service:
            silent = [service.raw() for _ in range(60)]
            self.assertEqual(service.ask("GET", "/livez", over_socket=False).status, 200)
            self.assertEqual(service.ask("GET", "/livez").status, 200)
            for connection in silent:
                connection.close()

    def test_a_stop_gets_through_while_everything_else_is_busy(self):
        with Service() as service, concurrent.futures.ThreadPoolExecutor(12) as threads:
            service.tell("hold")
            waiting = [threads.submit(service.ask, "POST", "/api/v1/jobs/12/start") for _ in range(8)]
            while service.ask("GET", "/livez").status != 200:
                pass
            stop = threads.submit(service.ask, "POST", Rights.CHANGE)
            self.assertEqual(service.ask("GET", "/api/v1/jobs/12").status, 200)
            service.tell("go")
            self.assertEqual([stop.result().status] + [w.result().status for w in waiting], [200] + [202] * 8)

    def test_the_end_answers_what_is_being_carried_out(self):
        with Service() as service, concurrent.futures.ThreadPoolExecutor(1) as threads, service.raw() as idle:
            service.tell("hold")
            waiting = threads.submit(service.ask, "POST", "/api/v1/jobs/12/start")
            time.sleep(0.3)
            self.assertEqual(service.end(), 0)
            self.assertEqual(waiting.result().status, 202)
            self.assertEqual(read_all(idle), b"")


class Keys(unittest.TestCase):
    START = "/api/v1/jobs/12/start"

    def test_the_same_request_is_carried_out_once(self):
        with Service() as service:
            first = service.ask("POST", self.START, key="k1")
            again = service.ask("POST", self.START, key="k1")
            self.assertEqual((first.status, first.body, first.headers["Idempotency-Replayed"]), (202, again.body, None))
            self.assertEqual((again.status, again.headers["Idempotency-Replayed"]), (202, "true"))
            self.assertEqual(service.changes(), 1)
            self.assertEqual(service.ask("POST", self.START, key="k2").status, 202)
            self.assertEqual(service.changes(), 2)

    def test_every_post_is_carried_out_once_for_its_key(self):
        with Service() as service:
            for path, item in yaml.safe_load(OPENAPI.read_text())["paths"].items():
                if "post" in item:
                    with self.subTest(path):
                        target = path.replace("{printer}", "line1").replace("{job}", "12")
                        body = Schemas.BODIES.get(item["post"]["operationId"])
                        headers = {"Content-Type": "application/octet-stream"} if isinstance(body, bytes) else {}
                        first = service.ask("POST", target, body, headers, key=path)
                        changes = service.changes()
                        again = service.ask("POST", target, body, headers, key=path)
                        self.assertEqual((first.status, first.body, "true"), (again.status, again.body, again.headers["Idempotency-Replayed"]))
                        other = {} if body is None else body + b"x" if isinstance(body, bytes) else dict(body, more=1)
                        self.assertEqual(service.ask("POST", target, other, headers, key=path).problem, "key-reused")
                        self.assertEqual(changes, service.changes())

    def test_a_key_belongs_to_one_request(self):
        with Service() as service:
            queue = "/api/v1/jobs/12/queue"
            self.assertEqual(service.ask("POST", queue, {"printer": "line1"}, key="k").status, 200)
            for target, body in ((queue, {"printer": "line2"}), ("/api/v1/jobs/11/queue", {"printer": "line1"}), (self.START, None)):
                answer = service.ask("POST", target, body, key="k")
                self.assertEqual((answer.status, answer.problem), (422, "key-reused"))
            self.assertEqual(service.changes(), 1)

    def test_a_key_is_needed_where_a_repetition_prints(self):
        with Service() as service:
            document = yaml.safe_load(OPENAPI.read_text())
            for path, item in document["paths"].items():
                if "post" in item:
                    needed = any("RequiredKey" in p.get("$ref", "") for p in item["post"].get("parameters", []))
                    target = path.replace("{printer}", "line1").replace("{job}", "12")
                    answer = service.ask("POST", target, Schemas.BODIES.get(item["post"]["operationId"]), key=False)
                    self.assertEqual(answer.status == 400, needed, path)
            for key in ("", "a b", "x" * 129, "\xe4"):
                self.assertEqual(service.ask("POST", self.START, headers={"Idempotency-Key": key}).problem, "malformed")
            self.assertEqual(service.ask("POST", self.START, headers={"Idempotency-Key": ["a", "b"]}).problem, "malformed")

    def test_refusals_are_final_and_failures_are_not(self):
        with Service() as service:
            service.tell("fail stopped the line is printing")
            self.assertEqual(service.ask("POST", self.START, key="refused").status, 409)
            service.tell("fail storage the disk is gone")
            self.assertEqual(service.ask("POST", self.START, key="failed").status, 503)
            service.tell("fail")
            again = service.ask("POST", self.START, key="refused")
            self.assertEqual((again.status, again.problem, again.headers["Idempotency-Replayed"]), (409, "conflict", "true"))
            self.assertEqual(service.ask("POST", self.START, key="failed").status, 202)

    def test_while_it_is_carried_out_the_key_is_in_use(self):
        with Service() as service, concurrent.futures.ThreadPoolExecutor(1) as threads:
            service.tell("hold")
            first = threads.submit(service.ask, "POST", self.START, key="k")
            deadline = time.monotonic() + 10
            while time.monotonic() < deadline:
                time.sleep(0.05)
                answer = service.ask("POST", self.START, key="k")
                if answer.status == 409:
                    break
            self.assertEqual((answer.problem, answer.headers["Retry-After"]), ("key-in-use", "1"))
            service.tell("go")
            self.assertEqual(first.result().status, 202)
            self.assertEqual(service.changes(), 1)

    def test_without_a_store_only_a_stop_is_carried_out(self):
        with Service() as service:
            service.tell("forget storage the disk is gone")
            self.assertEqual(service.ask("POST", self.START).status, 503)
            self.assertEqual(service.changes(), 0)
            self.assertEqual(service.ask("POST", Rights.CHANGE).status, 200)
            self.assertEqual(service.changes(), 1)


class Uploads(unittest.TestCase):
    CSV = {"Content-Type": "text/csv"}

    def left(self, service):
        return list((service.path / "uploads").iterdir())

    def assert_nothing_is_left(self, service):
        deadline = time.monotonic() + 10
        while self.left(service) and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertEqual(self.left(service), [])

    def test_a_file_becomes_a_job_and_nothing_stays(self):
        with Service(tokens=TOKENS) as service:
            content = b"name\r\n" + b"a\r\n" * 2_000_000
            headers = dict(bearer("operator"), **self.CSV)
            answer = service.ask("POST", "/api/v1/jobs?name=caf%C3%A9.csv&printer=line1", content, headers, over_socket=False)
            self.assertEqual((answer.status, answer.headers["Location"]), (201, f"/api/v1/jobs/{answer.json['job']}"))
            self.assertEqual(service.tell("bytes"), str(len(content)))
            self.assertEqual(service.ask("GET", answer.headers["Location"]).json["name"], "café.csv")
            self.assertEqual(self.left(service), [])
            again = service.ask("POST", "/api/v1/jobs", content, self.CSV)
            self.assertEqual((again.status, again.json["duplicate"]), (200, True))
            bad = service.ask("POST", "/api/v1/jobs", b"bad", {"Content-Type": "application/vnd.sqlite3"})
            self.assertEqual((bad.status, bad.problem, bad.json["report"]["rejected"][0]["row"]), (422, "input-rejected", 2))
            self.assertEqual(self.left(service), [])

    def test_the_same_file_with_the_same_key_is_one_job(self):
        with Service() as service:
            first = service.ask("POST", "/api/v1/jobs?again=true", b"x,y", self.CSV, key="k")
            again = service.ask("POST", "/api/v1/jobs?again=true", b"x,y", self.CSV, key="k")
            self.assertEqual((again.status, again.body, again.headers["Location"]), (201, first.body, first.headers["Location"]))
            self.assertEqual(service.ask("POST", "/api/v1/jobs?again=true", b"x,z", self.CSV, key="k").problem, "key-reused")
            self.assertEqual(service.changes(), 1)

    def test_what_is_too_large_is_not_read(self):
        with Service("--max-body", 1_000_000) as service:
            head = b"POST /api/v1/jobs HTTP/1.1\r\nHost: x\r\nIdempotency-Key: k\r\nContent-Type: text/csv\r\n"
            with service.raw(over_socket=True) as raw:
                raw.sendall(head + b"Content-Length: 1000001\r\n\r\n")
                self.assertEqual(read_answer(raw)[0], 413)
            with service.raw(over_socket=True) as raw:
                raw.sendall(head + b"Transfer-Encoding: chunked\r\n\r\n")
                answer = b""
                for _ in range(40):
                    try:
                        raw.sendall(b"10000\r\n" + b"x" * 0x10000 + b"\r\n")
                    except (BrokenPipeError, ConnectionResetError):
                        break
                answer = read_all(raw)
                self.assertIn(b" 413 ", answer)
            self.assertEqual(service.changes(), 0)
            self.assert_nothing_is_left(service)

    def test_a_client_that_goes_away_leaves_nothing(self):
        with Service() as service:
            with service.raw(over_socket=True) as raw:
                raw.sendall(b"POST /api/v1/jobs HTTP/1.1\r\nHost: x\r\nIdempotency-Key: k\r\nContent-Type: text/csv\r\nContent-Length: 1000000\r\n\r\n" + b"x" * 200_000)
                deadline = time.monotonic() + 10
                while not self.left(service) and time.monotonic() < deadline:
                    time.sleep(0.01)
                self.assertEqual(len(self.left(service)), 1)
                self.assertEqual(stat.S_IMODE(self.left(service)[0].stat().st_mode), 0o600)
            self.assert_nothing_is_left(service)
            self.assertEqual(service.changes(), 0)

    def test_what_a_killed_service_left_is_removed(self):
        with Service() as service:
            raw = service.raw(over_socket=True)
            raw.sendall(b"POST /api/v1/jobs HTTP/1.1\r\nHost: x\r\nIdempotency-Key: k\r\nContent-Type: text/csv\r\nContent-Length: 1000000\r\n\r\n" + b"x" * 200_000)
            deadline = time.monotonic() + 10
            while not self.left(service) and time.monotonic() < deadline:
                time.sleep(0.01)
            service.kill()
            self.assertEqual(len(self.left(service)), 1)
            service.start()
            self.assertEqual(self.left(service), [])
            raw.close()

    def test_only_so_many_at_once(self):
        with Service() as service:
            head = b"POST /api/v1/jobs HTTP/1.1\r\nHost: x\r\nIdempotency-Key: %d\r\nContent-Type: text/csv\r\nContent-Length: 5\r\n\r\n"
            sending = []
            for number in range(4):
                sending.append(service.raw(over_socket=True))
                sending[-1].sendall(head % number + b"ab")
            deadline = time.monotonic() + 10
            while len(self.left(service)) < 4 and time.monotonic() < deadline:
                time.sleep(0.01)
            answer = service.ask("POST", "/api/v1/jobs", b"x", self.CSV)
            self.assertEqual((answer.status, answer.problem, answer.headers["Retry-After"]), (503, "busy", "1"))
            for number, raw in enumerate(sending):
                raw.sendall(b"%03d" % number)
                self.assertEqual(read_answer(raw)[0], 201)
                raw.close()
            self.assertEqual(service.ask("POST", "/api/v1/jobs", b"x", self.CSV).status, 201)


class Events(unittest.TestCase):
    def open(self, service, headers=b"", over_socket=True):
        raw = service.raw(over_socket)
        raw.sendall(b"GET /api/v1/events/stream HTTP/1.1\r\nHost: localhost:%d\r\n%s\r\n" % (service.port, headers))
        return raw, raw.makefile("rb")

    def read(self, file, count):
        """The next events: (id, kind, data)."""
        events, fields = [], {}
        while len(events) < count:
            line = file.readline()
            if not line:
                raise ConnectionError(events)
            line = line.rstrip(b"\n").decode()
            if line == "" and "data" in fields:
                events.append((int(fields["id"]), fields["event"], json.loads(fields["data"])))
                fields = {}
            elif ": " in line:
                name, _, value = line.partition(": ")
                fields[name] = value
        return events

    def head(self, file):
        lines = []
        while (line := file.readline().strip()) != b"":
            lines.append(line)
        return lines

    def test_what_happens_is_told_and_what_was_missed_too(self):
        with Service() as service:
            raw, file = self.open(service)
            self.assertIn(b"Content-Type: text/event-stream", self.head(file))
            service.tell("event printer.error the ink\u2028is out")
            (number, kind, data), = self.read(file, 1)
            self.assertEqual((number, kind, data["message"]), (3, "printer.error", "the ink\u2028is out"))
            raw.close()
            service.tell("events 600 10")
            raw, file = self.open(service, b"Last-Event-ID: 2\r\n")
            self.assertEqual([event[0] for event in self.read(file, 601)], list(range(3, 604)))
            service.tell("event job.started x")
            self.assertEqual(self.read(file, 1)[0][0], 604)
            raw.close()
            raw, file = self.open(service, b"Last-Event-ID: 0\r\n")
            self.assertEqual([event[0] for event in self.read(file, 604)], list(range(1, 605)))
            raw.close()
            raw, file = self.open(service, b"Last-Event-ID: 99999\r\n")
            self.head(file)
            service.tell("event job.started y")
            self.assertEqual(self.read(file, 1)[0][0], 605)
            raw.close()

    def test_a_reader_who_comes_too_late_is_told_that_he_missed_something(self):
        with Service() as service:
            service.tell("events 3 10")
            service.tell("prune 4")
            for position, gap in ((b"1", {"after": 1, "first": 5}), (b"4", None), (b"0", None)):
                raw, file = self.open(service, b"Last-Event-ID: " + position + b"\r\n")
                lines = self.head(file) + self.head(file)  # and "retry"
                first = [file.readline().decode().strip() for _ in range(3)]
                if gap:
                    self.assertEqual(first[0], "event: gap", lines)
                    self.assertEqual(json.loads(first[1].removeprefix("data: ")), gap)
                    self.assertEqual(first[2], "", "without a number")
                    self.assertEqual(self.read(file, 1)[0][0], 5)
                else:
                    self.assertEqual(first[0], "id: 5", lines)
                raw.close()

    def test_many_listeners_hear_everything_while_one_does_not_listen(self):
        with Service() as service:
            deaf, _ = self.open(service, b"Last-Event-ID: 0\r\n")
            listeners = [self.open(service) for _ in range(20)]
            for _, file in listeners:
                self.head(file)
            service.tell("events 3000 2000")
            for raw, file in listeners:
                self.assertEqual([event[0] for event in self.read(file, 3000)], list(range(3, 3003)))
                raw.close()
            started = time.monotonic()
            deaf.settimeout(30)
            received = 0
            time.sleep(11)  # longer than EventStream::write_timeout
            try:
                while piece := deaf.recv(1 << 20):
                    received += len(piece)
            except ConnectionResetError:
                pass
            deaf.close()
            self.assertLess(time.monotonic() - started, 25)
            self.assertLess(received, 3000 * 2000)  # it was cut off, and would come again for the rest

    def test_streams_are_bounded_and_end_with_the_service(self):
        with Service() as service:
            streams = [self.open(service) for _ in range(64)]
            for _, file in streams:
                self.assertIn(b"200 OK", file.readline())
            answer = service.ask("GET", "/api/v1/events/stream")
            self.assertEqual((answer.status, answer.problem), (429, "too-many"))
            self.assertEqual(service.ask("GET", "/livez").status, 200)
            streams[0][0].shutdown(socket.SHUT_RDWR)
            streams[0][0].close()
            deadline = time.monotonic() + 10
            while time.monotonic() < deadline:
                raw, file = self.open(service)
                if b"200 OK" in file.readline():
                    break
                raw.close()
            else:
                self.fail("no room was made")
            self.assertEqual(service.end(), 0)
            self.assertEqual(streams[1][1].read()[-2:], b"\n\n")
            for stream, _ in streams + [(raw, file)]:
                stream.close()

    def test_new_rights_end_streams_over_tcp(self):
        with Service(tokens=TOKENS) as service:
            auth = f"Authorization: Bearer {SECRETS['viewer']}\r\n".encode()
            raw, file = self.open(service, auth, over_socket=False)
            local, local_file = self.open(service)
            self.head(file), self.head(local_file)
            self.assertEqual(service.ask("POST", "/api/v1/reload").status, 200)
            file.readline(), file.readline()  # retry
            self.assertEqual(file.read(), b"")
            service.tell("event job.started x")
            self.assertEqual(len(self.read(local_file, 1)), 1)
            raw.close(), local.close()


class Socket(unittest.TestCase):
    def test_the_socket_belongs_to_owner_and_group(self):
        with Service() as service:
            mode = service.socket_path.stat()
            self.assertEqual((stat.S_IMODE(mode.st_mode), mode.st_gid), (0o660, os.getgid()))
            service.end()
            self.assertFalse(service.socket_path.exists())

    def test_a_dead_service_is_replaced_a_living_one_is_not(self):
        with Service() as service:
            with self.assertRaisesRegex(RuntimeError, "in use"):
                other = Service.__new__(Service)
                other.path, other.options = service.path, []
                other.start()
            self.assertEqual(service.ask("GET", "/livez").status, 200)
            service.kill()
            self.assertTrue(service.socket_path.exists())
            service.start()
            self.assertEqual(service.ask("GET", "/livez").status, 200)
            service.end()
            service.socket_path.write_text("a file of somebody")
            with self.assertRaisesRegex(RuntimeError, "another kind"):
                service.start()
            self.assertEqual(service.socket_path.read_text(), "a file of somebody")

    def test_tcp_does_not_starve_the_socket(self):
        with Service("--max-connections", 10) as service:
            busy = [service.raw() for _ in range(10)]
            self.assertEqual(service.ask("GET", "/livez").status, 200)
            for raw in busy:
                raw.close()


class Metrics(unittest.TestCase):
    def test_promtool_accepts_them(self):
        with Service() as service:
            service.ask("GET", "/nothing")
            text = service.ask("GET", "/metrics", headers={"Accept": "application/openmetrics-text;version=1.0.0,text/plain;version=0.0.4;q=0.5,*/*;q=0.1"}).body
            checked = subprocess.run(["promtool", "check", "metrics"], input=text, capture_output=True, check=False)
            self.assertEqual((checked.returncode, checked.stdout, checked.stderr), (0, b"", b""))
            lines = text.decode().splitlines()
            self.assertIn('linefeed_printer_records_total{printer="line1",outcome="printed"} 900', lines)
            self.assertIn('linefeed_printer_lead_time_seconds_bucket{printer="line1",le="0.3"} 900', lines)
            self.assertIn('linefeed_printer_lead_time_seconds_count{printer="line1"} 900', lines)
            self.assertIn('linefeed_printer_in_doubt_records{printer="line1"} 3', lines)
            self.assertIn('linefeed_http_requests_total{code="404"} 1', lines)
            self.assertIn('linefeed_folder_up{folder="names"} 0', lines)
            self.assertIn('linefeed_printer_refills_total{printer="quoted \\"line\\"\\\\\\n\\\\xFF"} 0', lines)
            self.assertFalse([line for line in lines if "job=" in line or "record=" in line])
            connected = [line for line in lines if line.startswith("linefeed_printer_link_up{")]
            self.assertEqual([], connected, "an idle printer is not one whose link is lost")

    def test_every_name_that_was_promised_is_there(self):
        names = """build_info start_time_seconds printer_up printer_link_up printer_cover_open printer_other_machine printer_printing printer_error_code printer_fifo_entries
            printer_fifo_depth_entries printer_credit_records printer_print_rate_per_second printer_time_to_empty_seconds printer_data_left_seconds
            printer_queue_jobs printer_in_doubt_records printer_records_total printer_underruns_total printer_refills_total
            printer_links_lost_total printer_frames_unexpected_total printer_damaged_bytes_total printer_lead_time_seconds printer_refill_seconds
            intake_records_total intake_files_total ledger_commit_seconds folder_up http_requests_total http_request_seconds http_connections"""
        with Service() as service:
            service.ask("GET", "/livez")
            text = service.ask("GET", "/metrics").body.decode()
            self.assertEqual({name for name in names.split() if f"# TYPE linefeed_{name} " not in text}, set())


if __name__ == "__main__":
    unittest.main()
