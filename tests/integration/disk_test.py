"""A disk that runs full under linefeedd, while it imports and while it prints, and has room again later. Nothing is lost, nothing is
printed twice, and the service says what is wrong. An import needs no more than the room; a line whose ledger could not be written goes
on when the service has been started again.

The disk is a file system in memory, mounted for the service alone: that takes root.
"""

import contextlib
import os
import pathlib
import subprocess
import unittest

import harness
import plant_test
import service
from harness import names, rows

RATE = 400
COUNT = 3000
MEBIBYTES = 16


def may_mount():
    return os.geteuid() == 0 and subprocess.run(["unshare", "--mount", "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, check=False).returncode == 0


class SmallDisk:
    """So many MiB at `directory`, for those that are run on it. Goes with the process that holds it."""

    def __init__(self, directory, mebibytes):
        self.directory = directory
        script = 'mount -t tmpfs -o "size=$1m" none "$2" && echo mounted && exec cat'
        self.holder = subprocess.Popen(["unshare", "--mount", "--propagation", "private", "sh", "-c", script, "sh", str(mebibytes), str(directory)],
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        if self.holder.stdout.readline() != b"mounted\n":
            raise AssertionError("there is no small disk")

    def close(self):
        self.holder.communicate()

    def run(self, command):
        return ["nsenter", f"--mount=/proc/{self.holder.pid}/ns/mnt", "--", *command]

    def ballast(self):
        return pathlib.Path(f"/proc/{self.holder.pid}/root{self.directory}/ballast")

    def fill(self, spare_bytes=0):
        with open(self.ballast(), "wb", buffering=0) as ballast, contextlib.suppress(OSError):
            while ballast.write(bytes(4096)):
                pass
        os.truncate(self.ballast(), max(0, self.ballast().stat().st_size - spare_bytes))

    def make_room(self):
        self.ballast().unlink()


class ServiceOnDisk(service.Service):
    def __init__(self, disk, *arguments):
        super().__init__(*arguments)
        self.disk = disk

    def command(self):
        return self.disk.run(super().command())


@unittest.skipUnless(may_mount(), "mounting takes root")
class DiskFull(plant_test.PlantCase):
    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", RATE)
        self.drops = self.folder("drop")
        self.spool.parent.mkdir()
        self.disk = SmallDisk(self.spool.parent, MEBIBYTES)
        self.addCleanup(self.disk.close)
        self.service = ServiceOnDisk(self.disk, self.directory, {
            "layouts": {"codes": {"columns": ["code"]}},
            "printers": {"line1": {"address": self.printer.address}},
            "folders": {"drop": {"path": str(self.drops), "layout": "codes", "printer": "line1", "settle": "rename"}}})
        self.addCleanup(self.service.kill)
        self.service.start()

    def order(self, records):
        file = self.write_csv(rows(records), header=("code",))
        return {"file": str(file), "layout": "codes", "printer": "line1"}

    def finding(self, check):
        return next(finding for finding in self.service.get("/api/v1/doctor")["items"] if finding["check"] == check)

    def finish(self, records):
        self.service.wait_for(service.Operator(self.service, "line1", self.printer).step, words="the end of the job")
        self.assert_printed(records, self.printer)
        self.service.post("ledger/verify")
        self.assertEqual(0, self.service.stop(), self.service.log())

    def test_a_dropped_file_waits_until_there_is_room(self):
        records = names(COUNT)
        self.disk.fill()
        self.put(self.drops, "batch.csv", [text for _, text in records], "rename")
        self.service.wait_for(lambda: self.finding("folder drop")["severity"] != "ok", words="the trouble of the folder")
        self.assertIn("the disk is full", self.finding("folder drop")["words"])
        self.assertEqual(([], []), (self.inside(self.drops, "done"), self.inside(self.drops, "failed")))
        self.disk.make_room()
        self.service.wait_for(lambda: self.inside(self.drops, "done"), words="the import")
        self.assertEqual("ok", self.finding("folder drop")["severity"])
        self.assertEqual([COUNT], [job["records"]["count"] for job in self.service.jobs()])
        self.finish(records)

    def test_an_import_that_does_not_fit_leaves_nothing(self):
        too_large = self.order(names(MEBIBYTES * 50_000))
        self.disk.fill(spare_bytes=MEBIBYTES << 19)
        with self.assertRaises(service.Problem) as refused:
            self.service.post("jobs", too_large)
        self.assertEqual(503, refused.exception.status)
        self.assertIn("the disk is full", refused.exception.body["detail"])
        self.assertEqual("ok", self.finding("storage")["severity"])
        self.disk.make_room()
        self.service.wait_for(lambda: not self.service.jobs(), words="the removal of what was imported")
        records = names(COUNT)
        self.service.post("jobs", self.order(records))
        self.finish(records)

    def test_a_line_stops_and_goes_on_when_the_service_has_room_again(self):
        records = names(COUNT)
        job = self.service.post("jobs", self.order(records))["job"]
        self.service.post(f"jobs/{job}/start")
        self.printer.wait_for_prints(100)
        self.disk.fill()
        self.service.wait_for(lambda: self.service.printer("line1")["phase"] == "idle", words="the stop of the line")
        self.assertIn("the disk is full", self.finding("storage")["words"])
        self.assertIn("start linefeedd again", self.finding("storage")["advice"])
        self.assertLess(len(self.printer.prints()), COUNT)
        self.disk.make_room()
        self.assertEqual(0, self.service.stop(), self.service.log())
        self.service.start()
        self.finish(records)


if __name__ == "__main__":
    harness.main()
