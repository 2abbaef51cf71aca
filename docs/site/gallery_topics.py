# SPDX-License-Identifier: Apache-2.0
"""What an example is about, by the sections and kinds of its model: the topics that the gallery is filtered by."""

import re

# Topic -> what a model with it has at the beginning of a line, or as a kind.
_TOPICS = {
    "mechanisms": r"^joints:|\.sdf\b|\.urdf\b",
    "motors": r"\btype: (?:rotary|linear)_(?:motor|servo)\b|^ +motion:|\bmotion: \{",
    "gears": r"gear|planetary",
    "springs": r"\btype: (?:spring_damper|torsional_spring|translational_spring|bushing)\b",
    "contact": r"^contacts:",
    "friction": r"\bfriction\b",
    "solids": r"^solids:",
    "beams": r"^beams:",
    "cables": r"^cables:",
    "muscles": r"\bmuscle\b",
    "events": r"^events:",
    "statics": r"\btype: statics\b",
    "robots": r"\.sdf\b|\.urdf\b",
}


def topics(model):
    """The topics of a model, in a fixed order."""
    text = re.sub(r"#.*", "", model)
    return [name for name, pattern in _TOPICS.items() if re.search(pattern, text, re.M)] or ["free bodies"]
