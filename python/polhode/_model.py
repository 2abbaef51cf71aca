# SPDX-License-Identifier: Apache-2.0
"""Models in code, with the keywords of the model file."""

from __future__ import annotations

import copy
import json
import os
import tempfile
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

from . import _native, _schema, _text
from ._errors import ModelError, fault
from ._functions import LoadCall
from ._tree import Named, Section, counted, plain

if TYPE_CHECKING:
    from ._result import Result
    from ._show import Page

Overrides = Optional[Mapping[str, Any]]


class _Origin(NamedTuple):
    """The file that a model was loaded from, for locations of faults."""

    file: str
    text: str
    tree: "dict[str, Any]"


class ExportNote(NamedTuple):
    """A difference between a model and the file that Model.export wrote of it."""

    kind: str
    """"left out", "differs" (programs that read the file treat it in another way) or "not in the file"."""
    path: str
    """Path in the model, such as "joints.hinge.limits"."""
    what: str
    """A sentence."""


def overrides_list(overrides: Overrides) -> "list[str]":
    """Overrides in the form of the command line: {"variables.L": 2} → ["variables.L=2"]."""
    return [f"{path}={_text.flow(plain(value))}" for path, value in (overrides or {}).items()]


class Model(Section):
    """A model: bodies, joints, loads, analysis and output.

    Its keys are those of the model file (docs/reference/model_file.md), and so are its units: numbers
    are in `units`, by default SI and radians; texts such as "5 ms" have their own unit. Vectors are
    in world axes unless the description of the key states otherwise.

        m = polhode.Model(gravity=[0, 0, -9.81])
        arm = m.add_body("arm", shape=polhode.Box(1, 0.05, 0.05), density=1000, position=[0.5, 0, 0])
        m.add_joint("hinge", "revolute", ["ground", arm], at=[0, 0, 0], axis="y")

    Unknown keys, and names that exist already, raise ModelError at once, also in all add_... functions;
    conditions on several keys are checked by check().
    """

    __slots__ = ("_root", "_origin")

    def __init__(self, **keys: Any) -> None:
        super().__init__(None, "", "")
        object.__setattr__(self, "_root", {"format": 1})
        object.__setattr__(self, "_origin", None)
        for key, value in keys.items():
            self[key] = value

    # The tree

    def _tree(self, create: bool = False) -> "dict[str, Any]":
        return self._root  # type: ignore[no-any-return]

    def _path(self) -> str:
        return ""

    def _kind(self) -> Optional[str]:
        return ""

    def _known(self) -> "dict[str, str]":
        return _schema.keys("")

    def _wrap(self, key: str, value: Any) -> Any:
        item = _schema.named_of("", key)
        if item:
            return Named(self, key, item)
        section = _schema.section_of("", key)
        return Section(self, key, section) if section or key in ("variables",) else value

    # Adding entries

    def add_body(self, name: str, **fields: Any) -> Section:
        """Adds a rigid body and returns it.

        mass [kg], inertia [kg m²] about the centre of mass in body axes; or shape with density [kg/m³].
        position [m] (3,) of the centre of mass, orientation, velocity [m/s] (3,), angular_velocity
        [rad/s] (3,): world axes. fixed, point_mass, contact, hold as in the model file.
        Raises ModelError for an unknown key or a name that exists already.
        """
        return self._add("bodies", name, fields)

    def add_joint(self, name: str, type: str, bodies: "list[Any]", **fields: Any) -> Section:
        """Adds a joint between two bodies ("ground" is one) and returns it.

        at [m] (3,) and axis (a direction: "x", "-z" or three numbers) are those at the start, world axes;
        at_body and axis_body give both in body coordinates. friction and limits as in the model file.
        """
        return self._add("joints", name, {"type": type, "bodies": bodies, **fields})

    def add_load(self, name: str, type: str, **fields: Any) -> Section:
        """Adds a force, moment, spring, motor or load of a solid, and returns it.

        Force, moment, pull and the drive of a motor may be Python functions, in SI units:
          f(t)           three numbers at a time [s], or one for a component or a motor;
          f(t, body)     a force or moment on a body that depends on its motion: body.position, .velocity (3,) of
                         the point of application, .orientation (4,), .angular_velocity (3,);
          f(t, q, rate)  the force, moment or pull along a coordinate: for a motor that of the joint, for an
                         axial_force the distance of its points.
        They are called at times of the method's choice; an exception in them stops the run and is raised.
        polhode.StateFunction(f, tangent=...) adds derivatives.
        """
        return self._add("loads", name, {"type": type, **fields})

    def add_material(self, name: str, type: str, **fields: Any) -> Section:
        """Adds a material of solids and beams, and returns it."""
        return self._add("materials", name, {"type": type, **fields})

    def add_section(self, name: str, **fields: Any) -> Section:
        """Adds a cross-section of beams, and returns it."""
        return self._add("sections", name, fields)

    def add_beam(self, name: str, **fields: Any) -> Section:
        """Adds a beam, and returns it."""
        return self._add("beams", name, fields)

    def add_cable(self, name: str, **fields: Any) -> Section:
        """Adds a cable or rod, and returns it."""
        return self._add("cables", name, fields)

    def add_solid(self, name: str, **fields: Any) -> Section:
        """Adds a deformable solid, and returns it."""
        return self._add("solids", name, fields)

    def add_event(self, name: str, **fields: Any) -> Section:
        """Adds an event, which switches joints, loads and contacts, and returns it.

        It occurs at a time, at ("0.2 s"), or when a channel crosses a level, above or below:
        when={"joint": "pivot", "channel": "rz", "above": "70 deg"}; a channel is a column of a probe of a body, joint,
        load, solid, beam, cable or contact, {"cable": rope, "channel": "tension", "above": 500}.
        off and on: lists of joints, loads, pairs of contacts, bodies (with all of their contacts), or their names;
        after: an event that must have occurred before; repeat, stop: True or False.
        The ledger of a run has `events`: time [s], energy loss [J] and largest impulse of each.
        """
        return self._add("events", name, fields)

    def add_controller(self, name: str, **fields: Any) -> Section:
        """Adds a controller of a channel, and returns it: loads use its output by {"controller": name}.

        body, joint, load, solid, beam, cable or contact with channel, as in an event; setpoint, a number, an
        expression of t or a table.
        Gains proportional, integral, derivative with filter [s]; or numerator and denominator, polynomials in s, the
        highest power first. sample [s]: sampling interval, with constant output between samples; default: continuous.
        minimum and maximum are bounds of the output.
        """
        return self._add("controllers", name, fields)

    def add_probe(self, name: str, **fields: Any) -> Section:
        """Adds an entry of output.probes: a table that a run writes at its own rate."""
        return self.output.probes.add(name, **fields)  # type: ignore[no-any-return]

    def add_contact_material(self, name: str, **fields: Any) -> Section:
        """Adds a contact material, for the key contact of bodies and shapes."""
        return self.contacts.materials.add(name, **fields)  # type: ignore[no-any-return]

    def add_contact_pair(self, name: str, **fields: Any) -> Section:
        """Adds the law of a pair of bodies or contact materials."""
        return self.contacts.pairs.add(name, **fields)  # type: ignore[no-any-return]

    def add_contact_sensor(self, name: str, **fields: Any) -> Section:
        """Adds a sensor that reports begin and end of an overlap of two bodies, without force."""
        return self.contacts.sensors.add(name, **fields)  # type: ignore[no-any-return]

    def attach(
        self,
        part: "Union[Model, str, os.PathLike[str]]",
        name: Optional[str] = None,
        *,
        prefix: Optional[str] = None,
        at: Any = None,
        orientation: Any = None,
        mirror: Optional[str] = None,
        variables: "Optional[Mapping[str, Any]]" = None,
    ) -> Section:
        """Adds a part, a model within this one, and returns its entry in `parts`.

        part:        a Model, copied (its file, if it was loaded and not changed since), or the path of a
                     model file, relative to the folder of this model's file.
        name:        name of the entry; default: the prefix without its last "_".
        prefix:      prefix of the names of the part in this model; default: the name and "_".
        at:          (3,) position of the part's origin, in the units of this model.
        orientation: rotation from the part's axes to these, as of a body.
        mirror:      "x", "y" or "z": the sign of this coordinate of the part is changed first.
        variables:   values for variables of the part.

        Joints and loads of this model may use the names of the part: m.attach(leg, prefix="l_") gives
        "l_thigh". Raises ModelError if the name exists already.
        """
        if name is None and not prefix:
            raise fault("parts", "a part needs a name", 'Give prefix="l_" or a name')
        chosen = name if name is not None else str(prefix).rstrip("_-") or str(prefix)
        what: "dict[str, Any]" = {"file": os.fspath(part)} if not isinstance(part, Model) else {"model": part.to_dict()}
        if isinstance(part, Model) and part._source()[2]:  # unchanged: mesh paths are relative to its own folder
            what = {"file": os.path.abspath(part._source()[1])}
        return self._add("parts", chosen, {**what, "prefix": prefix, "position": at, "orientation": orientation,
                                           "mirror": mirror, "variables": variables})

    def _add(self, group: str, name: str, fields: "dict[str, Any]") -> Section:
        named: Named = self._wrap(group, None)
        return named.add(name, **fields)

    # Reading and writing

    def to_dict(self) -> "dict[str, Any]":
        """A copy of the model as dicts, lists, numbers and texts. Callables are unchanged."""
        return dict(plain(self._tree()))

    def to_yaml(self) -> str:
        """The text of a model file."""
        return _text.block(self._tree())

    def save(self, path: "Union[str, os.PathLike[str]]") -> None:
        """Writes a model file: JSON if the name ends with .json, else YAML.

        Only comments are lost. Paths of meshes in the model are unchanged: they are relative to the
        folder of the file. Raises ModelError for a model with callables, OSError if the file cannot be
        written.
        """
        name = os.fspath(path)
        for call in self._calls()[1]:
            raise fault(f"loads.{call.load}", f"{call.function!r} cannot be written to a file",
                        "Write an expression of t instead")
        text = json.dumps(self._tree(), indent=2, ensure_ascii=False) if name.endswith(".json") else self.to_yaml()
        with open(name, "w", encoding="utf-8") as file:
            file.write(text if text.endswith("\n") else text + "\n")

    def export(self, path: "Union[str, os.PathLike[str]]", *, allow_partial: bool = False,
               overrides: Overrides = None) -> "list[ExportNote]":
        """Writes the model at its start as a file of another program: a URDF if the name ends with .urdf, an MJCF if
        it ends with .xml. Returns what differs, and what was left out.

        Bodies and joints must form a tree, in an MJCF apart from loops that spherical or fixed joints close. Raises
        ModelError with all that the format cannot represent, unless allow_partial is True, and for other endings;
        OSError if the file cannot be written.
        """
        notes = _native.export_file(self._compile(overrides), os.fspath(path), allow_partial)
        return [ExportNote(*note) for note in notes]

    def copy(self) -> "Model":
        """An independent copy of the model."""
        return _restore(self.to_dict(), self._origin)

    def check(self, overrides: Overrides = None) -> None:
        """Checks the model as before a run. Raises ModelError with all of its faults."""
        self._compile(overrides)

    def run(self, **options: Any) -> "Result":
        """Runs the model: polhode.run(model, **options)."""
        from ._run import run

        return run(self, **options)

    def show(self, height: int = 600) -> "Page":
        """The model at its start in the viewer, as output of a notebook cell, with a height in pixels.

        Raises ModelError for a model with faults or with callables.
        """
        from ._show import page_of

        self.check()
        _, name, in_file = self._source()
        if in_file:
            return page_of(name, height)
        # In the folder of the meshes, since their paths are relative to it.
        handle, file = tempfile.mkstemp(".yaml", ".polhode-", os.path.dirname(name) or ".")
        os.close(handle)
        try:
            self.save(file)
            return page_of(file, height)
        finally:
            os.unlink(file)

    def _source(self) -> "tuple[str, str, bool]":
        """Text, name and whether both are those of a file."""
        origin: Optional[_Origin] = self._origin
        if origin and origin.tree == self._tree():
            return origin.text, origin.file, True
        folder = os.path.dirname(origin.file) if origin else ""
        return json.dumps(self._calls()[0], ensure_ascii=False), os.path.join(folder, "model.json"), False

    def _calls(self) -> "tuple[dict[str, Any], list[LoadCall]]":
        """The tree without callables, and those of loads."""
        calls: "list[LoadCall]" = []

        def without(value: Any, path: "tuple[Any, ...]", model: "dict[str, Any]", prefix: str, depth: int) -> Any:
            """`model` is the part at the first `depth` keys of the path, `prefix` that of its names."""
            if isinstance(value, dict):
                if len(path) == depth + 3 and path[depth] == "parts" and path[-1] == "model":
                    part = model["parts"][path[-2]]
                    model, depth = value, len(path)
                    prefix += f"{path[-2]}_" if part.get("prefix") is None else str(part["prefix"])
                return {k: without(v, (*path, k), model, prefix, depth) for k, v in value.items()}
            if isinstance(value, list):
                return [without(v, (*path, i), model, prefix, depth) for i, v in enumerate(value)]
            if not callable(value):
                return value
            inner = path[depth:]
            if len(inner) not in (3, 4) or inner[0] != "loads":
                raise fault(".".join(map(str, path)), "a callable is not possible here",
                            "Use callables for vectors and drives of loads only")
            call = LoadCall(prefix + inner[1], model["loads"][inner[1]], inner[2:], value)
            calls.append(call)
            zero = "0*t" if not call.of_motion else 0  # a function of the motion has no breaks in time to search for
            return [zero] * 3 if call.is_vector and call.component < 0 else zero

        return without(self._tree(), (), self._tree(), "", 0), calls

    def _compile(self, overrides: Overrides = None) -> "_native.CompiledModel":
        text, name, in_file = self._source()
        try:
            compiled = _native.compile(text, name, overrides_list(overrides))
            for call in () if in_file else self._calls()[1]:
                call.install(compiled)
            return compiled
        except ModelError as error:
            if in_file:
                raise
            # Line numbers of a generated text are of no use.
            raise ModelError([
                (f.file if not f.line and f.file != name else None, None, None, f.path, f.what, f.hint, "")
                for f in error.faults
            ]) from None

    # Shared by all objects

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self._tree() == other._tree()

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> "tuple[Any, ...]":
        return (_restore, (self.to_dict(), self._origin))

    def __dir__(self) -> "list[str]":
        own = [name for name in type(self).__dict__ if not name.startswith("_")]
        return sorted({*own, *self._known()})

    def __repr__(self) -> str:
        tree = self._tree()
        counts = [counted(len(tree[k]), k) for k in tree if _schema.named_of("", k) and tree[k]]
        title = f" '{tree['title']}'" if tree.get("title") else ""
        return f"<polhode.Model{title}: {', '.join(counts) or 'empty'}>"


def _restore(tree: "dict[str, Any]", origin: "Optional[_Origin]") -> Model:
    model = Model()
    object.__setattr__(model, "_root", tree)
    object.__setattr__(model, "_origin", origin)
    return model


def load(path: "Union[str, os.PathLike[str]]", **options: Any) -> Model:
    """Reads a model file, YAML or JSON, or a file of another program (.urdf, .xacro, .xml, .sdf, .world, .feb).
    Raises ModelError if it is not well-formed, OSError if it cannot be read. Values are checked by check() and before
    a run.

    Options are those of `import` in the model file: load("robot.urdf", base="floating", start={"elbow": 0.5})."""
    name = os.fspath(path)
    return from_text(_native.expanded(name, overrides_list({f"import.{k}": v for k, v in options.items()})), name)


def from_text(text: str, name: str = "model.yaml") -> Model:
    """A model from the text of a model file. Paths of its meshes are relative to the folder of `name`."""
    tree = _native.parse(text, name)
    if not isinstance(tree, dict):
        raise ModelError([(name, None, None, "", "the model is not a map", "Begin with the line 'format: 1'.", "")])
    return _restore(tree, _Origin(name, text, copy.deepcopy(tree)))
