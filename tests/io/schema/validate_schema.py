# SPDX-License-Identifier: Apache-2.0
"""Checks the published JSON Schema against the corpus of model files: validate_schema.py SCHEMA CORPUS.

Exits with 77 if the Python modules for it are not installed."""
import json
import pathlib
import sys

try:
    import jsonschema
    import yaml
except ImportError:
    sys.exit(77)

# Faults that a schema can see; most others are of numbers, names and physics.
SEEN = ["unknown_top_key", "format_missing", "format_2", "body_unknown_key", "shape_unknown",
        "joint_unknown_type", "joint_misspelt_type", "joint_axis_not_taken", "joint_type_missing",
        "joint_three_bodies", "load_unknown_type", "solver_unknown", "order_5", "yes_for_true",
        "quoted_true", "gravity_two_numbers", "hold_unknown", "name_ground", "name_with_blank",
        "inertia_entry_missing", "variable_bad_name",
        "material_unknown_type", "material_fibre_law", "solid_material_missing"]

schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
corpus = pathlib.Path(sys.argv[2])
validator_class = getattr(jsonschema, "Draft202012Validator", jsonschema.Draft7Validator)
validator_class.check_schema(schema)
validator = validator_class(schema)
failed = False
for path in sorted((corpus / "good").glob("*")):
    for error in validator.iter_errors(yaml.safe_load(path.read_text())):
        failed = True
        print(f"{path.name}: {'.'.join(map(str, error.absolute_path))}: {error.message[:300]}")
for name in SEEN:
    text = (corpus / "broken" / f"{name}.yaml").read_text()
    if name == "yes_for_true":  # Python's reader is of YAML 1.1, where yes is true.
        text = text.replace("yes", "'yes'")
    if validator.is_valid(yaml.safe_load(text)):
        failed = True
        print(f"{name}.yaml: the schema takes it")
sys.exit(1 if failed else 0)
