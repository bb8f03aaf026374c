"""linefeedd with a printer on a serial line whose bytes get damaged: the adapter is pulled out in mid-job, the service is killed, and an
operator does what he is told. The judge is the tape."""

import harness
import plant_test
import service

RATE = 40
RECORDS = 150  # of a batch


class SerialPlant(plant_test.PlantCase):
    def setUp(self):
        super().setUp()
        port = self.directory / "port"
        self.printer = self.simulator("--serial", port, "--baud", 115200, "--rate", RATE, "--damage", 1000, "--cut-at-print", 200)
        self.drops = self.folder("drop")
        self.service = self.make_service({
            "layouts": {"codes": {"columns": ["code"]}},
            "printers": {"line1": {"address": f"serial://{port}?baud=115200&crc=on", "expected_rate": 5000, "queue": {"autostart": True}}},
            "folders": {"in": {"path": str(self.drops), "layout": "codes", "printer": "line1", "autostart": True}}})
        self.operator = service.Operator(self.service, "line1", self.printer)

    def printed(self):
        return [text for _, text in self.printer.prints()]

    def wait_until_printed(self, count):
        self.service.wait_for(lambda: len(self.printed()) >= count, words=f"print {count}")

    def drop(self, name):
        texts = self.texts(name, RECORDS)
        self.put(self.drops, f"{name}.csv", texts, "in-place")
        return texts

    def test_noise_an_adapter_pulled_out_and_a_killed_service(self):
        self.service.start()
        wanted = self.drop("one")
        self.wait_until_printed(60)
        self.service.kill()
        self.service.start()
        self.assertEqual("stopped", self.service.jobs()[0]["phase"], "nothing prints by itself after a restart")
        wanted += self.drop("two")
        self.service.wait_for(self.operator.step, patience_s=180, words="print both batches")
        self.assertEqual(wanted, self.printed())
        self.assertGreater(self.printer.stop()["damaged_frames"], 0, "the noise did not reach the printer")
        self.assertEqual(0, self.service.stop(), self.service.log())

    def test_it_is_said_before_a_start_that_the_line_is_too_slow(self):
        self.service.start()
        findings = {finding["check"]: finding for finding in self.service.post("printers/line1/preflight")["items"]}
        self.assertEqual("warning", findings["line"]["severity"], findings["line"])
        self.assertIn("to bring 5000 products a second", str(findings["line"]))


if __name__ == "__main__":
    harness.main()
