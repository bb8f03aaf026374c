"""linefeedd as a process, its API over the Unix socket, and the operator of the tests, who does what people at the line do."""

import contextlib
import grp
import http.client
import json
import os
import pathlib
import signal
import socket
import subprocess
import time
import urllib.parse
import uuid

from harness import BIN, PATIENCE_S, free_port


class UnixConnection(http.client.HTTPConnection):
    def __init__(self, path, timeout_s):
        super().__init__("localhost", timeout=timeout_s)
        self.path = str(path)

    def connect(self):
        self.sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.sock.settimeout(self.timeout)
        self.sock.connect(self.path)


class Problem(Exception):
    """What the service has refused, and why."""

    def __init__(self, status, body):
        super().__init__(f"{status}: {body}")
        self.status, self.body = status, body


class Service:
    """`settings` as in linefeed.yaml; where the spool and the sockets are is added."""

    def __init__(self, directory, settings):
        self.directory = pathlib.Path(directory)
        self.socket = self.directory / "control.sock"
        self.spool = self.directory / "state" / "spool.db"
        self.port = free_port()
        self.log_file = self.directory / "linefeedd.log"
        self.settings = {"spool": str(self.spool), "control": {"socket": str(self.socket), "group": grp.getgrgid(os.getgid()).gr_name},
                         "http": {"port": self.port}, "logging": {"target": "stderr"}, **settings}
        self.file = self.directory / "linefeed.yaml"
        self.process = None
        self.write_settings()

    def write_settings(self):
        self.spool.parent.mkdir(exist_ok=True)
        self.file.write_text(json.dumps(self.settings, indent=1), encoding="utf-8")  # JSON is YAML

    def command(self):
        return [str(BIN / "linefeedd"), "--config", str(self.file)]

    def launch(self):
        with open(self.log_file, "ab") as log:
            self.process = subprocess.Popen(self.command(), stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def start(self):
        self.launch()
        deadline = time.monotonic() + PATIENCE_S
        while True:
            if self.process.poll() is not None:
                raise AssertionError(f"linefeedd ended with {self.process.returncode}: {self.log()}")
            try:
                self.get("/livez", timeout_s=5)
                return self
            except OSError:
                if time.monotonic() > deadline:
                    raise AssertionError(f"linefeedd does not answer: {self.log()}") from None
                time.sleep(0.02)

    def log(self):
        return self.log_file.read_text(encoding="utf-8", errors="replace")[-4000:]

    def stop(self, patience_s=PATIENCE_S):
        """As systemd does. Gives the exit code."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=patience_s)

    def kill(self):
        if self.process and self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def peak_memory_mib(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(status.split("VmHWM:")[1].split()[0]) / 1024

    def request(self, method, target, body=None, timeout_s=PATIENCE_S):
        connection = UnixConnection(self.socket, timeout_s)
        try:
            headers = {"Idempotency-Key": str(uuid.uuid4())} if method == "POST" else {}
            if body is not None:
                headers["Content-Type"] = "application/json"
            connection.request(method, target, None if body is None else json.dumps(body), headers)
            answer = connection.getresponse()
            text = answer.read()
            content = json.loads(text) if "json" in (answer.getheader("Content-Type") or "") else text
            if answer.status >= 300:
                raise Problem(answer.status, content)
            return content
        finally:
            connection.close()

    def get(self, target, **keywords):
        return self.request("GET", target, **keywords)

    def post(self, target, body=None, **keywords):
        return self.request("POST", f"/api/v1/{target}", body, **keywords)

    def printer(self, name):
        return self.get(f"/api/v1/printers/{name}")

    def items(self, target):
        """All pages."""
        items, target = [], f"/api/v1/{target}"
        while target:
            page = self.get(target)
            items += page["items"]
            target = page.get("next")
        return items

    def jobs(self, printer=None):
        """Oldest first."""
        query = f"?limit=1000&printer={urllib.parse.quote(printer)}" if printer else "?limit=1000"
        return self.items("jobs" + query)[::-1]

    def job(self, number):
        return self.get(f"/api/v1/jobs/{number}")

    def wait_for(self, what, patience_s=PATIENCE_S, words="it"):
        deadline = time.monotonic() + patience_s
        while not (found := what()):
            if time.monotonic() > deadline:
                raise AssertionError(f"{words} did not come about within {patience_s} s; {self.jobs()}; {self.log()}")
            time.sleep(0.05)
        return found


class Operator:
    """Looks after one printer until its jobs are done: resumes what has stopped, starts what is queued, acknowledges what he is told, and
    looks at the products when records are in doubt."""

    def __init__(self, service, printer, simulator):
        self.service, self.printer, self.simulator = service, printer, simulator
        self.asked = 0  # how often records were in doubt

    def step(self):
        """True when nothing is left to be done."""
        state = self.service.printer(self.printer)
        if state["phase"] != "idle":
            return False
        jobs = self.service.jobs(self.printer)
        for job in jobs:
            if job["phase"] == "in_doubt":
                self.settle(job)
                return False
        for job in jobs:
            if job["phase"] in ("stopped", "queued"):
                self.start(job, state)
                return False
        return all(job["phase"] in ("finished", "cancelled") for job in jobs)

    def start(self, job, state):
        try:
            self.service.post(f"jobs/{job['id']}/{'resume' if job['phase'] == 'stopped' else 'start'}")
        except Problem as problem:
            if problem.status not in (409, 502, 503):
                raise
            if state["error"]:
                self.acknowledge(state["error"]["code"])

    def acknowledge(self, error):
        with contextlib.suppress(Problem):  # it shows another, or none any more
            self.service.post(f"printers/{self.printer}/acknowledge", {"error": error})

    def settle(self, job):
        """By the products: numbers begin anew with each job, so the texts tell which is which."""
        self.asked += 1
        doubt = self.service.get(f"/api/v1/jobs/{job['id']}/doubt")
        on_products = {text for _, text in self.simulator.prints()}
        printed = [str(record["number"]) for record in doubt["records"] if " ".join(record["fields"]) in on_products]
        self.service.post(f"jobs/{job['id']}/settle", {"printed": ",".join(printed) or "none", "as_of": doubt["as_of"]})
