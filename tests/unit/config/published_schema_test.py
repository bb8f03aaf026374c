"""The published JSON schema as other programs see it: it is a schema, the example fits, and common mistakes do not.

usage: published_schema_test.py CONFIG_DIRECTORY [unittest arguments]
"""

import copy
import json
import pathlib
import sys
import unittest

import jsonschema
import yaml

CONFIG = pathlib.Path(__file__).resolve().parents[3] / "config"


def with_text_keys(value):
    """YAML keys that are numbers (error numbers) as JSON has them."""
    if isinstance(value, dict):
        return {str(key): with_text_keys(inner) for key, inner in value.items()}
    return [with_text_keys(inner) for inner in value] if isinstance(value, list) else value


class PublishedSchema(unittest.TestCase):
    def setUp(self):
        self.schema = json.loads((CONFIG / "linefeed.schema.json").read_text(encoding="utf-8"))
        self.example = with_text_keys(yaml.safe_load((CONFIG / "linefeed.yaml").read_text(encoding="utf-8")))
        self.validator = jsonschema.Draft202012Validator(self.schema)

    def test_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(self.schema)

    def test_takes_the_example(self):
        self.assertEqual([], [error.message for error in self.validator.iter_errors(self.example)])

    def test_takes_every_default(self):
        def check(schema):
            for name, prop in schema.get("properties", {}).items():
                if "default" in prop:
                    resolved = dict(prop)
                    if "$ref" in prop:
                        resolved.update(self.schema["$defs"][prop["$ref"].rsplit("/", 1)[1]])
                        del resolved["$ref"]
                    jsonschema.validate(prop["default"], resolved)
                check(prop)
                if isinstance(prop.get("additionalProperties"), dict):
                    check(prop["additionalProperties"])
        check(self.schema)

    def test_refuses_mistakes(self):
        mistakes = [
            lambda c: c.update(colour="red"),
            lambda c: c["http"].update(port=0),
            lambda c: c["http"].update(port="80"),
            lambda c: c["http"].update(max_body="16 MB"),
            lambda c: c["http"].update(request_timeout=30),
            lambda c: c["printers"]["line1"].pop("address"),
            lambda c: c["printers"]["line1"].update(address="192.168.1.20"),
            lambda c: c["printers"]["line1"]["errors"].update({"05": "stop"}),
            lambda c: c["printers"]["line1"]["errors"].update({"5": "halt"}),
            lambda c: c["printers"].update({"a/b": {"address": "tcp://h"}}),
            lambda c: c["layouts"]["names"].update(table="a", query="b"),
            lambda c: c["layouts"]["names"].update(orientation=45),
            lambda c: c["folders"]["names-line1"].update(watch="always"),
        ]
        for number, mistake in enumerate(mistakes):
            changed = copy.deepcopy(self.example)
            mistake(changed)
            self.assertFalse(self.validator.is_valid(changed), f"mistake {number}")


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        CONFIG = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
