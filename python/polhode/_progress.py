# SPDX-License-Identifier: Apache-2.0
"""A progress bar, where tqdm is installed."""

from __future__ import annotations

import time
from typing import Any, Optional


class Bar:
    """A bar over simulated time; None shows it after a second if the output is interactive."""

    def __init__(self, end: float, wanted: Optional[bool]) -> None:
        self._end, self._wanted = end, wanted
        self._started = time.monotonic()
        self._bar: Any = None

    def __enter__(self) -> "Bar":
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    @property
    def show(self) -> Any:
        """Function that shows the time reached, or None without a bar."""
        return None if self._wanted is False else self._show

    def _show(self, t: float) -> None:
        if self._bar is None:
            if self._wanted is None and time.monotonic() - self._started < 1.0:
                return
            try:
                from tqdm.auto import tqdm
            except ImportError:
                self._wanted, self._started = None, float("inf")
                return
            form = "{percentage:3.0f}% |{bar}| {n:.4g}/{total:.4g} s [{elapsed}<{remaining}]"
            self._bar = tqdm(total=self._end, disable=False if self._wanted else None, bar_format=form)
        self._bar.update(t - self._bar.n)
