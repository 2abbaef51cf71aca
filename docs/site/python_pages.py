# SPDX-License-Identifier: Apache-2.0
"""The page of the Python interface, out of the signatures and docstrings of the sources: the engine need not be built."""

import ast
import inspect


def _modules(folder):
    return {path.stem: ast.parse(path.read_text()) for path in sorted(folder.glob("*.py"))}


def _public(tree):
    for node in tree.body:
        if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == "__all__" for t in node.targets):
            return [ast.literal_eval(e) for e in node.value.elts]
    return []


def _found(modules, name):
    for module, tree in modules.items():
        if module in ("__init__", "__main__"):
            continue
        for node in tree.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name == name:
                return node
    return None


def _signature(node, method=False):
    arguments = node.args
    if method:
        arguments = ast.parse(f"def f({ast.unparse(arguments)}): pass").body[0].args
        drop = arguments.posonlyargs or arguments.args
        if drop and drop[0].arg in ("self", "cls"):
            drop.pop(0)
    for a in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]:
        if a is not None:
            a.annotation = None
    return f"({ast.unparse(arguments)})"


def _doc(node):
    """The docstring as Markdown."""
    return inspect.cleandoc(ast.get_docstring(node) or "")


def _entry(kind, name, text, inner=()):
    mark = "`" * (3 + 2 * bool(inner))
    body = [f"{mark}{{py:{kind}}} {name}", "", text, ""]
    for entry in inner:
        body += [entry, ""]
    return "\n".join([*body, mark, ""])


def _class(node):
    init, entries = "", []
    bases = [ast.unparse(b) for b in node.bases if ast.unparse(b) not in ("object",)]
    for item in node.body:
        if not isinstance(item, ast.FunctionDef):
            continue
        marks = {ast.unparse(d) for d in item.decorator_list}
        if item.name == "__init__":
            init = _signature(item, True)
        if item.name.startswith("_") or not ast.get_docstring(item) or any(m.endswith(".setter") for m in marks):
            continue
        kind = "property" if marks & {"property", "functools.cached_property", "cached_property"} else "method"
        entries.append(_entry(kind, item.name if kind == "property" else item.name + _signature(item, "staticmethod" not in marks), _doc(item)))
    text = _doc(node) + (f"\n\nA {', '.join(f'`{b}`' for b in bases)}." if bases else "")
    return _entry("class", f"{node.name}{init}", text, entries)


def page(folder):
    modules = _modules(folder)
    text = ["# Python interface", "", "Signatures and docstrings of the package; [Polhode in Python](../python/README.md) is the guide with snippets that the tests execute.",
            "Models have a class for each shape, `polhode.Box`, `polhode.Sphere` and so on, with the keys of [shapes](../reference/shapes.md).", "",
            "```{py:module} polhode", "```", ""]
    for name in _public(modules["__init__"]):
        node = _found(modules, name)
        if isinstance(node, ast.FunctionDef):
            text.append(_entry("function", name + _signature(node), _doc(node)))
        elif isinstance(node, ast.ClassDef):
            text.append(_class(node))
    text += ["## Rotations", "", _doc(modules["rotations"]), "", "```{py:module} polhode.rotations", "```", ""]
    for node in modules["rotations"].body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            text.append(_entry("function", node.name + _signature(node), _doc(node)))
    return "\n".join(text)
