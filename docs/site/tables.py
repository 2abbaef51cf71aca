# SPDX-License-Identifier: Apache-2.0
"""Names in tables whose lines may break, so that columns of text have the room."""

import html
import re

from docutils import nodes

# Shorter names stay whole.
LONG_NAME = 18
_BREAK = re.compile(r"(?<=[_/])(?=\w)|(?<=::)(?=\w)|(?<=\.)(?=[A-Z])|(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def breakable(name):
    """HTML of a name whose line may break after its underscores, slashes and colons and before its capitals."""
    return "<wbr>".join(html.escape(part) for part in _BREAK.split(name))


def setup(app):
    from sphinx.writers.html5 import HTML5Translator

    class Translator(HTML5Translator):
        def visit_literal(self, node):
            text, parent = node.astext(), node.parent
            while parent is not None and not isinstance(parent, nodes.entry):
                parent = parent.parent
            if parent is None or max(map(len, text.split() or [""])) <= LONG_NAME:
                super().visit_literal(node)
                return
            self.body.append(self.starttag(node, "code", "", CLASS="docutils literal notranslate") + breakable(text) + "</code>")
            raise nodes.SkipNode

    app.set_translator("html", Translator)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
