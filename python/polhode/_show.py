# SPDX-License-Identifier: Apache-2.0
"""The viewer's page in a notebook."""

from __future__ import annotations

import html
import os
import subprocess
import tempfile
from typing import Union


class Page:
    """A page of the viewer, shown by a notebook cell or saved to a file."""

    def __init__(self, text: str, height: int) -> None:
        self.text = text
        self.height = height

    def save(self, path: "Union[str, os.PathLike[str]]") -> None:
        """Writes the page as one HTML file, which needs no network."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)

    def _repr_html_(self) -> str:
        page = html.escape(self.text, quote=True)
        return (f'<iframe srcdoc="{page}" width="100%" height="{self.height}" style="border:0" '
                'sandbox="allow-scripts allow-downloads" allow="fullscreen"></iframe>')

    def __repr__(self) -> str:
        return f"<Page of the viewer: {len(self.text) / 1e6:.1f} MB; save(path) writes it>"


def page_of(what: str, height: int) -> Page:
    """The page of a model file, or of a results file or folder. Raises RuntimeError with the reason."""
    program = os.path.join(os.path.dirname(__file__), "bin", "polhode")
    what = os.path.abspath(what).removesuffix(os.sep + "results.h5")  # one name for a folder and its file
    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "page.html")
        made = subprocess.run([program, "view", what, "--html", page], capture_output=True, text=True)
        if made.returncode != 0:
            raise RuntimeError(made.stderr.strip() or f"polhode view ended with status {made.returncode}")
        with open(page, encoding="utf-8") as file:
            return Page(file.read(), height)
