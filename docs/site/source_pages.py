# SPDX-License-Identifier: Apache-2.0
"""Pages of the source files that the documentation cites: coloured, with an anchor for each line and for each equation's label."""

import html
import posixpath
import re

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound

_STYLE = """body { font: 0.9rem/1.4 monospace; margin: 1rem; background: #fff; color: #222; }
.linenos a, .linenos { color: #888; text-decoration: none; padding-right: 1em; user-select: none; }
pre { margin: 0; overflow-x: auto; } span:target { background: #ffe9a8; }
@media (prefers-color-scheme: dark) { body { background: #14191f; color: #dde3e8; } a { color: #7fb2ea; } span:target { background: #5a4a14; }
"""


def _style():
    light = HtmlFormatter(style="a11y-high-contrast-light").get_style_defs(".highlight")
    dark = HtmlFormatter(style="a11y-high-contrast-dark").get_style_defs(".highlight")
    return light + "\n" + _STYLE + dark + "\n}\n"


def write(site, root):
    formatter = HtmlFormatter(linenos="inline", linespans="L", anchorlinenos=False)
    (site.target / "extra/code").mkdir(parents=True, exist_ok=True)
    (site.target / "extra/code/code.css").write_text(_style())
    for path, labels in sorted(site.cited.items()):
        text = (root / path).read_text(errors="replace")
        try:
            lexer = get_lexer_for_filename(path, stripnl=False)
        except ClassNotFound:
            lexer = TextLexer(stripnl=False)
        body = highlight(text, lexer, formatter).replace('id="L-', 'id="L')
        for label in sorted(labels):   # the line that says @eq{label} or @tests{label}
            for number, line in enumerate(text.split("\n"), 1):
                if re.search(r"@(eq|tests)\{" + re.escape(label) + r"\}", line):
                    body = body.replace(f'<span id="L{number}">', f'<a id="{label}"></a><span id="L{number}">', 1)
                    break
            else:
                body = f'<a id="{label}"></a>' + body
        place = f"extra/code/{path}.html"
        up = posixpath.relpath("extra/code", posixpath.dirname(place))
        site.write(place, f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
                          f'<title>{html.escape(path)}</title><link rel="stylesheet" href="{up}/code.css"></head>\n'
                          f'<body><p><a href="{up}/../index.html">Polhode</a> / {html.escape(path)}</p>\n{body}</body></html>\n')
