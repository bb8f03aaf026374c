"""Files, jobs, scripts, the picture and backups of a printer as an operator handles them, through the service and directly, over a
transfer in which many blocks fail; nothing is ever half there."""

import hashlib
import json
import os
import resource
import struct
import subprocess
import zlib

import harness
from service_commands_test import ServiceTest

MEGABYTE = 1 << 20


def png_dots(data):
    """The black dots of a PNG with one bit a pixel and no filters but those of PNG."""
    width, height, depth, colour = struct.unpack(">IIBB", data[16:26])
    assert (depth, colour) == (1, 3), (depth, colour)
    packed, at = b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += size + 12
    raw, row_bytes, before, rows = zlib.decompress(packed), (width + 7) // 8, bytes((width + 7) // 8), []
    for y in range(height):
        line = bytearray(raw[y * (row_bytes + 1) + 1:(y + 1) * (row_bytes + 1)])
        kind = raw[y * (row_bytes + 1)]
        assert kind in (0, 1, 2), kind
        for x in range(row_bytes):
            line[x] = (line[x] + (before[x] if kind == 2 else line[x - 1] if kind == 1 and x else 0)) & 255
        before = bytes(line)
        rows.append("".join("#" if line[x // 8] >> (7 - x % 8) & 1 else "." for x in range(width)))
    return rows


class Files(harness.TestCase):
    """Directly: commissioning."""

    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", "500", "--block-errors", "50")

    def linefeed(self, *words, **more):
        job = harness.Job([str(harness.BIN / "linefeed"), "printer", self.printer.address, *map(str, words)], **more)
        self.addCleanup(job.kill)
        return job.wait()

    def done(self, *words):
        result = self.linefeed(*words)
        self.assertEqual(0, result.code, result)
        return result

    def test_a_megabyte_up_and_down_though_half_of_the_blocks_fail(self):
        content, up, down = os.urandom(MEGABYTE), self.directory / "up.job", self.directory / "down.job"
        up.write_bytes(content)
        put = self.done("files", "put", up, "FFSDISK/Jobs/big.job", "-o", "json").json()
        self.assertEqual(hashlib.sha256(content).hexdigest(), put["sha256"])
        self.done("files", "get", "FFSDISK/Jobs/big.job", down)
        self.assertEqual(content, down.read_bytes())
        self.assert_one_clear_line(2, self.linefeed("files", "put", up, "FFSDISK/Jobs/big.job"), "already")
        self.assert_one_clear_line(2, self.linefeed("files", "get", "FFSDISK/Jobs/big.job", down), "already")
        self.done("files", "put", up, "FFSDISK/Jobs/big.job", "--replace")
        self.assert_one_clear_line(2, self.linefeed("files", "rm", "FFSDISK/Jobs/big.job"), "--yes")
        self.done("files", "rm", "FFSDISK/Jobs/big.job", "--yes")
        self.assert_one_clear_line(5, self.linefeed("files", "get", "FFSDISK/Jobs/big.job", "x"), "answers alike")
        self.assertFalse((self.directory / "x").exists())

    def test_never_half_a_file(self):
        up, folder = self.directory / "up.job", self.directory / "folder"
        folder.mkdir()
        up.write_bytes(os.urandom(MEGABYTE // 8))
        self.done("files", "put", up, "FFSDISK/Jobs/big.job")
        small = subprocess.run([harness.BIN / "linefeed", "printer", self.printer.address, "files", "get", "FFSDISK/Jobs/big.job",
                                folder / "a.job"], capture_output=True, text=True, check=False,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50000, 50000)))
        self.assertNotEqual(0, small.returncode, small)
        cancel = self.simulator("--fault", "frame 1 cancel-transfer")
        result = harness.Job([str(harness.BIN / "linefeed"), "printer", cancel.address, "files", "get", "FFSDISK/Fonts/ISO1_5x5.lft",
                              str(folder / "b.job")]).wait()
        self.assert_one_clear_line(4, result, "cancelled")
        self.assertEqual([], [name for name in os.listdir(folder) if not name.startswith(".linefeed-")])

    def test_backup_and_restore(self):
        folder = self.directory / "saved"
        self.done("backup", folder)
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        self.assertEqual((15, "104711"), (len(manifest["files"]), manifest["printer"]["serial_number"]))
        for entry in manifest["files"]:
            content = (folder / entry["file"]).read_bytes()
            self.assertEqual((entry["size"], entry["sha256"]), (len(content), hashlib.sha256(content).hexdigest()))
        self.done("files", "rm", "FFSDISK/Jobs/DM.JOB", "--yes")
        self.assert_one_clear_line(2, self.linefeed("restore", folder), "--yes")
        restored = self.done("restore", folder, "--yes", "-o", "json").json()
        self.assertEqual((1, 14), (restored["written"], restored["alike"]))
        (folder / manifest["files"][0]["file"]).write_bytes(b"?")
        self.assert_one_clear_line(5, self.linefeed("restore", folder, "--yes"), "not the file that was saved")
        other = self.simulator("--serial-number", "7")
        again = self.directory / "again"
        self.done("backup", again)
        job = harness.Job([str(harness.BIN / "linefeed"), "printer", other.address, "restore", str(again), "--yes"])
        self.assert_one_clear_line(2, job.wait(), "--other-printer")

    def test_jobs_scripts_and_the_picture(self):
        self.assertEqual(r"FFSDISK\Jobs\DM.JOB", self.done("load", "DM.JOB", "-o", "json").json()["loaded"])
        self.assert_one_clear_line(5, self.linefeed("load", "none.job"), "no such job")
        script = self.directory / "job.ljs"
        script.write_text("BEGINLJSCRIPT\nBEGINJOB [0 (Größe ^ \\)]\nENDJOB []\nENDLJSCRIPT\n", encoding="utf-8")
        self.assert_one_clear_line(2, self.linefeed("script", "send", script), "--yes")
        self.assertEqual("loaded: EXTERN\n", self.done("script", "send", script, "--yes").out)
        back = self.directory / "back.ljs"
        self.done("script", "get", back)
        self.assertEqual(script.read_text(encoding="utf-8"), back.read_text(encoding="utf-8"))
        self.assert_one_clear_line(2, self.linefeed("script", "get", back), "already")
        self.done("script", "get", back, "--replace")
        self.done("text", "--set", "W" * 100)
        rows = self.done("preview", "-o", "json").json()["rows"]
        self.assertEqual((7, 600), (len(rows), len(rows[0])))
        png = self.directory / "p.png"
        self.done("preview", "--png", png, "--scale", "1")
        self.assert_one_clear_line(2, self.linefeed("preview", "--png", png), "already")
        self.done("preview", "--png", png, "--scale", "1", "--replace")
        self.assertEqual(rows, png_dots(png.read_bytes()))
        self.assertEqual(rows[0], self.done("preview", "--ascii").out.splitlines()[0], "no line is broken where there is no terminal")
        for words in (("files", "frob"), ("files",), ("script", "frob", "x")):
            self.assert_one_clear_line(2, self.linefeed(*words), f"{words[0]} get")

    def test_while_it_prints(self):
        folder, records = self.directory / "saved", harness.names(1500)
        self.done("backup", folder)
        self.done("files", "rm", "FFSDISK/Jobs/DM.JOB", "--yes")
        script = self.directory / "job.ljs"
        script.write_text("OBJ [1]\n", encoding="utf-8")
        self.done("files", "get", "FFSDISK/Jobs/LINIE.job", self.directory / "line.job")
        self.assertEqual((self.directory / "line.job").read_text(encoding="utf-8"), self.done("files", "get", "FFSDISK/Jobs/LINIE.job", "-").out)
        risky = self.directory / "risky.jsonl"
        risky.write_text('{"time_ns":1,"direction":"sent","bytes":"^0!FF\\\\x0D"}\n', encoding="utf-8")
        job = self.start(self.write_csv(harness.rows(records)), self.printer)
        self.printer.wait_for_prints(100)
        for words in (("script", "send", script, "--yes"), ("load", "LINIE.job"), ("files", "rm", "FFSDISK/Jobs/LINIE.job", "--yes"),
                      ("files", "put", script, "FFSDISK/Jobs/LINIE.job", "--replace"), ("replay", risky, "--against", self.printer.address, "--yes")):
            self.assert_one_clear_line(4, self.linefeed(*words))
        self.done("files", "ls", "FFSDISK/Jobs")
        self.done("preview")
        self.assert_done(job.wait())
        self.assert_printed(records, self.printer)


class FilesThroughService(ServiceTest):
    simulator_options = ("--rate", "500", "--block-errors", "50")

    def test_files_go_both_ways(self):
        self.start_service()
        content, up, down, saved = (os.urandom(MEGABYTE), *(self.directory / name for name in ("up.job", "down.job", "saved")))
        up.write_bytes(content)
        self.done("printer", "line1", "files", "put", up, "FFSDISK/Jobs/Größe.job")
        self.done("printer", "line1", "files", "get", "FFSDISK/Jobs/Größe.job", down)
        self.assertEqual(content, down.read_bytes())
        self.refused(2, "printer", "line1", "files", "put", up, "FFSDISK/Jobs/Größe.job", words=("already",))
        self.done("printer", "line1", "backup", saved)
        self.done("printer", "line1", "files", "rm", "FFSDISK/Jobs/Größe.job", "--yes")
        self.assertIn("1 files written", self.done("printer", "line1", "restore", saved, "--yes").out)
        self.done("printer", "line1", "load", "DM.JOB")
        self.done("printer", "line1", "preview")
        audit = [entry for entry in self.done("audit", "-o", "json").json() if entry["what"] == "write file"]
        self.assertEqual(3, len(audit), audit)
        records = harness.names(1500)
        number = self.imported(records)
        self.done("printer", "line1", "load", "Testprint.job")
        self.done("start", number)
        self.printer.wait_for_prints(100)
        self.refused(4, "printer", "line1", "files", "put", up, "FFSDISK/Jobs/Größe.job", "--replace", words=("stop it first",))
        self.refused(4, "printer", "line1", "load", "DM.JOB", words=("stop it first",))
        self.wait_for_phase(number, "finished")
        self.assert_printed(records, self.printer)


if __name__ == "__main__":
    harness.main()
