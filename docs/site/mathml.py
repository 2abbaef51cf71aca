# SPDX-License-Identifier: Apache-2.0
"""Formulas as MathML, made when the site is built: readers need neither a script nor a network."""

import html
import re

import latex2mathml.converter

# What the converter does not know, in words that it does.
_PLAIN = [
    (re.compile(r"\\(begin|end)\{aligned\}"), r"\\\1{align*}"),
    (re.compile(r"\\arg\\(min|max)"), r"\\operatorname{arg\\,\1}"),
    (re.compile(r"\\texttt\{([^{}]*)\}"), lambda m: r"\mathtt{" + m[1].replace(r"\_", "_").replace("_", "\uff3f") + "}"),
    (re.compile(r"(?<!\\)\\ "), r"\\;"),
    (re.compile(r"\\label\{[^{}]*\}"), ""),
]


_SIZED = re.compile(r'<mo ([^>]*minsize="[^"]*"[^>]*)>\\?([^<]+)</mo>')


def _grown(match):
    """A bracket of a given size, as a fence with its side, since browsers stretch no other. \\Big ones are around sums and
    fractions and cover them."""
    attributes = re.sub(r'\s*(?:stretchy|fence)="[^"]*"', "", match[1]).strip()
    attributes = attributes.replace(' maxsize="1.623em"', "")
    form = {"(": "prefix", "[": "prefix", "{": "prefix", ")": "postfix", "]": "postfix", "}": "postfix"}.get(html.unescape(match[2]))
    return f'<mo stretchy="true" fence="true" {f"""form="{form}" """ if form else ""}{attributes}>{match[2]}</mo>'


def convert(latex, display=False):
    """MathML of a formula. Raises ValueError if a command is left that nobody understood."""
    for pattern, plain in _PLAIN:
        latex = pattern.sub(plain, latex)
    try:
        text = latex2mathml.converter.convert(latex.strip(), display="block" if display else "inline")
    except Exception as error:
        raise ValueError(f"{type(error).__name__} {error}") from error
    text = _SIZED.sub(_grown, text)
    if left := re.search(r"\\[A-Za-z]+", html.unescape(text)):
        raise ValueError(f"'{left[0]}' is not understood")
    return text.replace("\uff3f", "_")


def _converted(self, node, display):
    from sphinx.util import logging

    try:
        return convert(node.astext(), display)
    except ValueError as fault:
        logging.getLogger(__name__).warning("formula '%s': %s", node.astext(), fault, location=node)
        return html.escape(node.astext())


def visit_math(self, node):
    from docutils import nodes

    self.body.append(_converted(self, node, False))
    raise nodes.SkipNode


def visit_displaymath(self, node):
    from docutils import nodes

    label, place = node.get("label"), (node.get("ids") or [""])[0]
    self.body.append(f'<div class="formula" id="{place}">' if place else '<div class="formula">')
    self.body.append(_converted(self, node, True))
    if label:
        self.body.append(f'<a class="label" href="#{place}">{html.escape(label)}</a>')
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(visit_math, None), block_renderers=(visit_displaymath, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
