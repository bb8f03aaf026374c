"""kill -9 of linefeedd while it migrates the spool of an old linefeed. After every kill the database is whole and has every row of the
ledger, before or after a migration and never between; and in the end the service opens it, the chain holds, and its job goes on.

LINEFEED_SEED=N repeats the moments of a run (not the machine's scheduling).
"""

import contextlib
import hashlib
import os
import pathlib
import random
import sqlite3
import time

import harness
import plant_test
import service

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "schema"
OLD_VERSION = 2  # the ledger is made anew by the migration behind it
RECORDS = 20
RUNS = 20_000 if not harness.LONG else 400_000
KILLS = 10 if not harness.LONG else 60


def ledger_rows():
    """(sequence, job, kind, run, first, records, evidence, time_ns, hash) of a job that was started again and again, to print nothing, and
    was then printed up to the tenth record: as linefeed of those days wrote it."""
    above = bytes(32)
    sequence = 0

    def row(kind, run, first, records, evidence):
        nonlocal above, sequence
        sequence += 1
        text = "\n".join(map(str, (above.hex(), sequence, 1, kind, run, first, records, 5, len(evidence), evidence)))
        above = hashlib.sha256(text.encode()).digest()
        return sequence, 1, kind, run, first, records, evidence, 5, above

    for _ in range(RUNS):
        run = sequence + 1
        yield row("run_started", run, 1, RECORDS, "{}")
        yield row("intent", run, 1, RECORDS, "")
        yield row("unused", run, 1, RECORDS, '{"why":"stopped"}')
        yield row("run_ended", run, 0, 0, "")
    run = sequence + 1
    yield row("run_started", run, 1, RECORDS, "{}")
    yield row("intent", run, 1, RECORDS, "")
    yield row("printed", run, 1, 10, "{}")
    yield row("unused", run, 11, RECORDS - 10, "{}")
    yield row("run_ended", run, 0, 0, "")


class MigrationKill(plant_test.PlantCase):
    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", 100)
        self.records = harness.names(RECORDS)
        self.service = self.make_service({"layouts": {"names": {"columns": ["name"]}}, "printers": {"line1": {"address": self.printer.address}}})
        self.make_old_spool()

    def make_old_spool(self):
        """A job that linefeed imported, without what today's linefeed adds."""
        self.service.start()
        file = self.write_csv(harness.rows(self.records))
        job = self.service.post("jobs", {"file": str(file), "layout": "names"})["job"]
        self.assertEqual((1, 0), (job, self.service.stop()))
        today = self.spool.with_name("today.db")
        self.spool.rename(today)
        with contextlib.closing(sqlite3.connect(self.spool)) as old:
            for migration in sorted(SCHEMA.glob("*.sql"))[:OLD_VERSION]:
                old.executescript(migration.read_text(encoding="utf-8"))
            old.execute("ATTACH ? AS today", (str(today),))
            for table in ("jobs", "pages"):
                columns = ", ".join(row[1] for row in old.execute(f"PRAGMA main.table_info({table})"))
                old.execute(f"INSERT INTO {table} ({columns}) SELECT {columns} FROM today.{table}")
            old.executemany("INSERT INTO ledger VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)", ledger_rows())
            (last_run,), = old.execute("SELECT max(run) FROM ledger")
            old.executemany("INSERT INTO ledger_segments VALUES (1, ?, ?, ?, ?)", [(1, 10, "printed", last_run), (11, RECORDS - 10, "unused", last_run)])
            old.execute(f"PRAGMA user_version = {OLD_VERSION}")
            old.commit()
            self.ledger = self.digest(old)

    def digest(self, database):
        """Of every row of the ledger."""
        digest = hashlib.sha256()
        for row in database.execute("SELECT sequence, kind, run, first, records, evidence, hash FROM ledger ORDER BY sequence"):
            digest.update(repr(row).encode())
        return digest.hexdigest()

    def judge_spool(self):
        """Gives its version. The judge opens it as any program would, which takes up what the write-ahead log holds."""
        with contextlib.closing(sqlite3.connect(self.spool)) as database:
            self.assertEqual([("ok",)], database.execute("PRAGMA integrity_check").fetchall())
            self.assertEqual(self.ledger, self.digest(database))
            (version,), = database.execute("PRAGMA user_version")
            tables = {name for name, in database.execute("SELECT name FROM sqlite_schema WHERE type = 'table'")}
        self.assertEqual(version > OLD_VERSION, "tickets" in tables, "a migration and its version are one")
        self.assertNotIn("ledger_of_003", tables)
        return version

    def kill_in_migration(self, old, after_s):
        for file in self.spool.parent.glob("spool.db*"):
            file.unlink()
        self.spool.write_bytes(old.read_bytes())
        self.service.launch()
        time.sleep(after_s)
        self.service.kill()

    def test_killed_at_random_moments(self):
        seed = int(os.environ.get("LINEFEED_SEED", random.randrange(2**32)))
        chance = random.Random(seed)
        old = self.spool.with_name("old.db")
        self.spool.rename(old)
        self.spool.write_bytes(old.read_bytes())
        started = time.monotonic()
        self.service.start()
        takes_s = time.monotonic() - started
        self.service.kill()
        versions = []
        for _ in range(KILLS):
            self.kill_in_migration(old, chance.uniform(0, takes_s))
            versions.append(self.judge_spool())
        self.kill_in_migration(old, takes_s / 2)  # and nobody but the service opens it then
        print(f"{self.id()}: {4 * RUNS + 5} rows, a migration takes {takes_s:.2f} s; killed with the spool at version {versions}; seed {seed}", flush=True)
        self.assertIn(OLD_VERSION, versions, "moments that are worth a test")
        self.service.start()
        self.service.post("ledger/verify")
        self.service.post("jobs/1/queue", {"printer": "line1"})
        self.service.post("jobs/1/start")
        self.service.wait_for(lambda: self.service.job(1)["phase"] == "finished", words="the end of the job")
        self.assert_printed(self.records[10:], self.printer)
        self.assertEqual(0, self.service.stop())


if __name__ == "__main__":
    harness.main()
