"""Two hundred clients of the API while a line prints at 1000/s: good ones, slow ones, silent ones, and such that send far too much. The
line does not notice, and the good ones are still served.
"""

import asyncio
import json
import random
import time

import harness
import plant_test

RATE = 1000
SECONDS = 20
GOOD, SILENT, SLOW, OVERSIZED, LISTENING = 80, 40, 40, 20, 20
# All of 127.0.0.0/8 is this machine: the good ones do not come from where the bad ones do.
GOOD_FROM, BAD_FROM = "127.0.0.1", "127.0.0.66"


class Clients(plant_test.PlantCase):
    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", RATE)
        self.service = self.make_service({"layouts": {"codes": {"columns": ["code"]}}, "printers": {"line1": {"address": self.printer.address}},
                                          "http": {"port": harness.free_port(), "request_timeout": "5 s"}})
        self.port = self.service.settings["http"]["port"]
        self.service.start()
        self.times = []  # of requests that were answered
        self.failures = []  # of good clients
        self.over = 0.0

    async def connect(self, source):
        return await asyncio.open_connection("127.0.0.1", self.port, local_addr=(source, 0), limit=1 << 20)

    def head(self, target="/api/v1/printers"):
        return f"GET {target} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n".encode()

    async def good(self):
        chance = random.Random(GOOD)
        while time.monotonic() < self.over:
            try:
                reader, writer = await self.connect(GOOD_FROM)
                try:
                    for _ in range(10):
                        await asyncio.sleep(chance.uniform(0.1, 0.5))
                        started = time.monotonic()
                        writer.write(self.head(chance.choice(["/api/v1/printers", "/api/v1/jobs", "/metrics", "/readyz"])) + b"\r\n")
                        answer = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), 10)
                        length = int(answer.lower().split(b"content-length:")[1].split()[0])
                        await asyncio.wait_for(reader.readexactly(length), 10)
                        self.times.append(time.monotonic() - started)
                        if b" 200 " not in answer.split(b"\r\n")[0]:
                            self.failures.append(answer.split(b"\r\n")[0].decode())
                finally:
                    writer.close()
            except Exception as error:  # any: a good client must not meet one
                self.failures.append(repr(error))

    async def again_and_again(self, misbehave):
        while time.monotonic() < self.over:
            try:
                reader, writer = await self.connect(BAD_FROM)
                try:
                    await misbehave(reader, writer)
                finally:
                    writer.close()
            except (OSError, EOFError, asyncio.TimeoutError, ValueError):
                pass  # thrown out, as it should be
            await asyncio.sleep(0.2)

    async def silent(self, reader, _):
        await asyncio.wait_for(reader.read(), max(0.1, self.over - time.monotonic()))

    async def slow(self, _, writer):
        for byte in self.head() + b"X: " + b"y" * 10_000:
            writer.write(bytes([byte]))
            await writer.drain()
            await asyncio.sleep(0.2)

    async def oversized(self, reader, writer):
        if random.random() < 0.5:
            writer.write(self.head() + b"X: " + b"y" * (1 << 20))
        else:
            writer.write(b"POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nContent-Type: text/csv\r\nContent-Length: 99999999999\r\n\r\n" % self.port)
            for _ in range(64):
                writer.write(b"z" * 65536)
                await writer.drain()
        await writer.drain()
        await asyncio.wait_for(reader.read(), 10)

    async def listening(self, reader, writer):
        """Asks for events and never reads them."""
        writer.write(self.head("/api/v1/events/stream?after=0") + b"\r\n")
        await writer.drain()
        await asyncio.sleep(max(0.0, self.over - time.monotonic()))

    async def everybody(self):
        bad = [(SILENT, self.silent), (SLOW, self.slow), (OVERSIZED, self.oversized), (LISTENING, self.listening)]
        await asyncio.gather(*(self.good() for _ in range(GOOD)),
                             *(self.again_and_again(misbehave) for count, misbehave in bad for _ in range(count)))

    def test_the_line_does_not_notice_and_the_good_ones_are_served(self):
        texts = self.texts("code", RATE * (SECONDS + 4))
        file = self.write_csv([[text] for text in texts], header=("code",))
        job = self.service.post("jobs", {"file": str(file), "layout": "codes", "printer": "line1"})["job"]
        self.service.post(f"jobs/{job}/start")
        self.printer.wait_for_prints(RATE)
        self.over = time.monotonic() + SECONDS
        asyncio.run(self.everybody())
        self.service.wait_for(lambda: self.service.job(job)["phase"] == "finished", words="the end of the job")
        self.assert_printed(list(enumerate(texts, 1)), self.printer)
        self.assert_clean(self.printer.stop())
        self.times.sort()
        at = lambda share: 1000 * self.times[int(share * (len(self.times) - 1))]
        print(json.dumps({"requests": len(self.times), "p50_ms": round(at(0.5), 1), "p99_ms": round(at(0.99), 1), "worst_ms": round(at(1), 1),
                          "peak_memory_mib": round(self.service.peak_memory_mib(), 1)}), flush=True)
        self.assertEqual([], self.failures[:5])
        self.assertGreater(len(self.times), GOOD * SECONDS)
        self.assertEqual(0, self.service.stop())


if __name__ == "__main__":
    harness.main()
