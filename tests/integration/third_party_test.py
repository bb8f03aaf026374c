"""linefeed-sim as a program of somebody else sees it: a client written from the manual alone, with framing, nibbles and sums of its own,
so that the simulator and linefeed cannot share a mistake. And the simulator's command line for faults and scenarios."""

import socket
import subprocess
import zlib

import harness
from harness import BIN


def to_nibbles(data):
    return "".join(chr(ord("A") + (byte >> 4)) + chr(ord("A") + (byte & 15)) for byte in data)


def from_nibbles(text):
    return bytes((ord(text[i]) - ord("A")) << 4 | (ord(text[i + 1]) - ord("A")) for i in range(0, len(text), 2))


class Stranger:
    """Sends frames and reads frames; knows nothing of linefeed."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        self.stream = self.socket.makefile("rb")

    def send(self, *frames):
        self.socket.sendall(b"".join(b"^0" + frame.encode("latin-1") + b"\r" for frame in frames))

    def read(self):
        line = b""
        while not line.endswith(b"\r"):
            byte = self.stream.read(1)
            if not byte:
                raise EOFError("closed")
            line += byte
        assert line.startswith(b"^0"), line
        return line[2:-1].decode("latin-1")

    def ask(self, *frames):
        self.send(*frames)
        return self.read()

    def ask_with_crc(self, frame):
        """The answer line, its CRC checked; None if the printer found ours wrong."""
        crc = zlib.crc32(b"^0" + frame.encode("latin-1"))
        self.send(f"=NR{crc}", frame)
        if self.read().startswith("=FC"):
            return None
        announced = self.read()
        assert announced.startswith("=NR"), announced
        answer = self.read()
        return answer if int(announced[3:]) == zlib.crc32(b"^0" + answer.encode("latin-1")) else None

    def listing(self, path):
        self.send("$RD" + path)
        names = []
        while True:
            block = self.read()
            assert block.startswith("$DI"), block
            last, count, *entries = block[3:].split("\t")
            assert len(entries) == int(count) <= 32
            names += entries
            if last == "1":
                return names

    def put(self, path, data):
        """The number of blocks that had to be sent again; None if the printer cancelled."""
        blocks = [data[i:i + 2048] for i in range(0, len(data), 2048)] or [b""]
        self.send(f"$FH{path}\t{len(blocks)}")
        again = 0
        for number, block in enumerate(blocks, 1):
            verdict = "0"
            while verdict == "0":
                acknowledged, verdict = self.ask(f"$FT{number}\t{sum(block) % 256}\t{to_nibbles(block)}")[3:].split("\t")
                assert int(acknowledged) == number
                again += verdict == "0"
            if verdict == "2":
                return None
        return again

    def get(self, path):
        """The bytes and the number of blocks that had to be sent again."""
        header = self.ask("$RF" + path)
        assert header.startswith("$FH" + path + "\t"), header
        data, again, taken = b"", 0, 0
        while taken < int(header.split("\t")[1]):
            number, checksum, text = self.read()[3:].split("\t")
            block = from_nibbles(text)
            good = sum(block) % 256 == int(checksum)
            if good:
                data += block
                taken += 1
            again += not good
            self.send(f"$FA{number}\t{1 if good else 0}")
        return data, again


class ThirdParty(harness.TestCase):
    def stranger(self, *options):
        return self.stranger_at(self.simulator(*options))

    def stranger_at(self, printer):
        stranger = Stranger(printer.port)
        self.addCleanup(stranger.socket.close)
        return stranger

    def test_files_up_and_down(self):
        stranger = self.stranger()
        self.assertEqual(["!Jobs"], stranger.listing("FFSDISK\\Jobs"))
        self.assertEqual([], stranger.listing("FFSDISK\\Jobis"))
        self.assertEqual(["COUNTER.JOB", "DATE.JOB", "DM.JOB", "Testprint.job", "LINIE.job", "LJ24 Test.job"],
                         stranger.listing("FFSDISK\\Jobs*"))
        data = bytes(range(256)) * 33
        self.assertEqual(0, stranger.put("FFSDISK\\Graphics\\all.bmp", data))
        self.assertEqual(["all.bmp"], stranger.listing("FFSDISK\\Graphics\\*"))
        self.assertEqual((data, 0), stranger.get("FFSDISK\\Graphics\\all.bmp"))
        stranger.send("$DFFFSDISK\\Graphics\\all.bmp")
        self.assertEqual((b"", 0), stranger.get("FFSDISK\\Graphics\\all.bmp"))
        self.assertIsNone(stranger.put("C:\\x", b"x"))

    def test_a_megabyte_with_bad_blocks(self):
        stranger = self.stranger("--block-errors", 10, "--seed", 3)
        data = bytes((i * i + i // 257) % 256 for i in range(1 << 20))
        self.assertGreater(stranger.put("FFSDISK\\Jobs\\big.job", data), 20)
        back, again = stranger.get("FFSDISK\\Jobs\\big.job")
        self.assertTrue(back == data)
        self.assertGreater(again, 20)

    def test_with_crc(self):
        stranger = self.stranger("--fault", "frame 1 refuse-crc", "--fault", "frame 1 wrong-crc")
        self.assertIsNone(stranger.ask_with_crc("?JL"))
        self.assertIsNone(stranger.ask_with_crc("?JL"))
        self.assertEqual("=JL\\FFSDISK\\JOBS\\Testprint.job", stranger.ask_with_crc("?JL"))

    def test_a_script(self):
        stranger = self.stranger()
        stranger.send("*BEGINLJSCRIPT", "*OBJ 1", "*OBJ 2", "*ENDLJSCRIPT")
        while stranger.ask("?JL") != "=JLEXTERN":
            pass
        stranger.send("?JB")
        self.assertEqual(["*BEGINLJSCRIPT", "*OBJ 1", "*OBJ 2", "*ENDLJSCRIPT"], [stranger.read() for _ in range(4)])

    def test_an_extern_text_on_products(self):
        printer = self.simulator("--rate", 100)
        stranger = self.stranger_at(printer)
        for text in ("Hallo", "Welt"):
            stranger.send(f"=ET{text}")
            while stranger.ask("?ET") != f"=ET{text}":
                pass
            stranger.send("!GO")
            printed = len(printer.prints())
            printer.wait_for_prints(printed + 3)
            stranger.send("!ST")
            self.assertEqual("=RS2\t5\t0", stranger.ask("?RS")[:8])
        printed = printer.prints()
        self.assertEqual({(0, "Hallo"), (0, "Welt")}, set(printed))
        self.assertEqual(sorted(printed), printed, "one text behind the other")
        self.assertEqual(["0", "0", "1"], stranger.ask("?SM").split("\t")[2:5], "no record was printed")
        summary = printer.stop()
        self.assertEqual(({}, 0, summary["prints"]), (summary["errors"], summary["underruns"], summary["without_record"]))

    def test_a_static_job_on_products(self):
        printer = self.simulator("--rate", 100)
        stranger = self.stranger_at(printer)
        stranger.send("!GO", "*BEGINLJSCRIPT [()]", "*BEGINJOB [0 (Lot)]", "*OBJ [1 0 0 0 (ISO1_7x5) (Lot 4711) 1 0 ()]", "*ENDJOB []",
                      "*ENDLJSCRIPT []")
        while stranger.ask("?JL") != "=JLEXTERN":
            pass
        printed = len(printer.prints())
        printer.wait_for_prints(printed + 5)
        self.assertEqual("6", stranger.ask("?RS").split("\t")[1])
        self.assertEqual((0, "Lot 4711"), printer.prints()[-1])
        self.assertEqual({}, printer.stop()["errors"])

    def test_mailing_behind_an_extern_text(self):
        printer = self.simulator("--rate", 100)
        stranger = self.stranger_at(printer)
        stranger.send("=ETtext", "!GO")
        printer.wait_for_prints(2)
        stranger.send("=CM3", "=MR1\ta", "=MR2\tb", "=MR3\tc")
        printer.wait_for_prints(5)
        while stranger.ask("?RS").split("\t")[1] == "6":
            pass
        self.assertEqual([(1, "a"), (2, "b"), (3, "c")], printer.prints()[-3:])
        self.assertEqual("3", stranger.ask("?SM").split("\t")[2])
        stranger.send("!EQ", "!GO")
        while stranger.ask("?RS").split("\t")[2] == "0":
            pass
        self.assertEqual({"1223": 1, "5043": 1}, printer.stop()["errors"], "an empty FIFO is an error behind a number")

    def test_a_record_without_number(self):
        printer = self.simulator("--rate", 100)
        stranger = self.stranger_at(printer)
        stranger.send("=MR1\ta", "=MR", "=MR2\tb")
        self.assertEqual("=SM256\t2\t0", stranger.ask("?SM")[:10])
        self.assertEqual("0", stranger.ask("?RS").split("\t")[2])
        stranger.send("!GO")
        while stranger.ask("?RS").split("\t")[1] == "6":
            pass
        self.assertEqual([(1, "a")], printer.prints())
        self.assertEqual({"1018": 1}, printer.stop()["errors"])

    def test_the_picture(self):
        stranger = self.stranger()
        stranger.send("=MR1\t(8 3 FF81FF)", "?GW")
        lines = []
        while (line := stranger.read()) != "!EN":
            self.assertTrue(line.startswith("=GW") and len(line) <= 63)
            lines.append(line[3:])
        picture = from_nibbles("".join(lines))
        self.assertEqual([3, 8, 1, 3], [int.from_bytes(picture[i:i + 4], "little") for i in range(0, 16, 4)])
        self.assertEqual(b"\xff\x81\xff", picture[16:])

    def test_the_firmware_without_stop_point(self):
        for options, kept in ((), "0"), (("--habit", "ignore-stop-at=off"), "5"), (("--firmware", "V75.0.12.0"), "5"):
            stranger = self.stranger("--profile", "jet2neo", *options)
            stranger.send("=CM5")
            self.assertEqual(kept, stranger.ask("?SM").split("\t")[3], options)

    def test_a_job_without_mailing_field(self):
        printer = self.simulator("--rate", 100, "--habit", "no-mailing-field")
        stranger = self.stranger_at(printer)
        stranger.send("=MR1\ta", "=MR2\tb")
        self.assertEqual("=SM256\t0\t0", stranger.ask("?SM")[:10])
        stranger.send("!GO")
        printer.wait_for_prints(3)
        self.assertEqual({(0, "Testprint")}, set(printer.prints()))

    def test_old_firmware(self):
        stranger = self.stranger("--profile", "jet3", "--firmware", "V60.0.1.17", "--speed", 300)
        self.assertEqual("=RS2\t5\t0\t0\t30\t1", stranger.ask("?RS"))
        self.assertEqual("V60.0.1.17", stranger.ask("?VS").split("\t")[8])
        self.assertEqual(["!Jobs"], stranger.listing("Storage Card\\LJ3\\Jobs"))

    def test_a_scenario(self):
        scenario = self.directory / "scenario"
        scenario.write_text("# the cover, then an input\nframe 2 cover open\nframe 3 input X4.22 on\ntime 0.3 cover closed\n"
                            "time 0.4 cut\n", encoding="utf-8")
        stranger = self.stranger("--scenario", scenario, "--input-function", "X4.22=2", "--counter", "1-9x2")
        self.assertEqual("0", stranger.ask("?RS").split("\t")[3])
        self.assertEqual("1", stranger.ask("?RS").split("\t")[3])
        self.assertEqual("=EX9\t2", "\t".join(stranger.ask("?EX").split("\t")[:2]))
        self.assertEqual("=RS3\t4", "\t".join(stranger.ask("?RS").split("\t")[:2]), "the input closes the nozzle")
        self.assertEqual("=AC1\t1\t0\t1", stranger.ask("?AC"))
        while stranger.ask("?RS").split("\t")[3] == "1":
            pass
        with self.assertRaises((EOFError, ConnectionError)):
            while True:
                stranger.ask("?RS")


class SimulatorOptions(harness.TestCase):
    def refuse(self, *options, says):
        done = subprocess.run([BIN / "linefeed-sim", "--listen", "127.0.0.1:0", *options], capture_output=True, text=True, timeout=10,
                              check=False)
        self.assertEqual((2, ""), (done.returncode, done.stdout))
        self.assertIn(says, done.stderr)
        self.assertEqual(1, done.stderr.count("\n"), done.stderr)

    def test_wrong_input(self):
        self.refuse("--fault", "print 1 explode", says='--fault: "print 1 explode": no such fault')
        self.refuse("--fault", "soon cut", says='expected "print N"')
        self.refuse("--scenario", "/nowhere", says="cannot read /nowhere")
        self.refuse("--scenario", str(self.directory), says="cannot read")
        scenario = self.directory / "scenario"
        scenario.write_text("print 1 cut\nprint x cut\n", encoding="utf-8")
        self.refuse("--scenario", str(scenario), says=f"{scenario}, line 2:")
        self.refuse("--firmware", "new", says="--firmware: a version expected")
        self.refuse("--counter", "9", says="--counter: START-END")
        self.refuse("--counter", "1-99999999999", says="--counter: START-END")
        self.refuse("--input-function", "X4.9=13", says="--input-function: CONTACT=NUMBER")
        self.refuse("--input-function", "X4.23=3", "--profile", "jet2neo", says="--input-function: CONTACT=NUMBER")
        self.refuse("--error-at-print", "5", says="N:CODE expected")
        self.refuse("--error-at-print", "0:5", says="N:CODE expected")
        self.refuse("--block-errors", "100", says="--block-errors")

    def test_the_list_of_commands(self):
        done = subprocess.run([BIN / "linefeed-sim", "--commands"], capture_output=True, text=True, timeout=10, check=True)
        self.assertEqual(22 + 24 + 31 + 3 + 7, done.stdout.count("\n| `^0"))


if __name__ == "__main__":
    harness.main()
