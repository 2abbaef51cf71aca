#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of the examples and of the README from runs. Needs numpy, matplotlib and h5py.

    POLHODE=build/release/apps/polhode/polhode python3 tools/render_example.py [NAME ...] [hero]
"""
import sys

import drawing
import render_connectors
import render_contact
import render_hero
import render_mechanisms

MECHANISMS = ("tumbling_body", "heavy_top", "double_pendulum", "spatial_slider_crank", "crank_rocker", "n_four_bar", "andrews_squeezer", "bricard",
              "flyball_governor", "gyroscope", "reaction_wheels", "door_on_two_hinges", "beam_roll_up", "flexible_four_bar")
CONTACT = ("bouncing_ball", "incline", "newtons_cradle", "tippe_top", "rattleback", "stack", "card_house", "rolling_coin",
           "spheres_in_a_bin", "gear_pair", "crossed_lines")
CONNECTORS = ("planetary_gearbox", "suspension_corner", "shaking_table", "stewart_platform", "three_rrr", "delta_robot", "geneva_drive", "excavator", "trebuchet",
              "cable_crane", "trolley_on_bridge", "arm_with_muscles", "elbow", "bicycle", "falling_cat", "governor_on_motor", "stick_slip")


def picture(name):
    if name in MECHANISMS:
        return getattr(render_mechanisms, name)()
    if name in CONTACT:
        return getattr(render_contact.Pictures(drawing), name)()
    return getattr(render_connectors, name)(drawing)


def main():
    known = (*MECHANISMS, *CONTACT, *CONNECTORS, "hero")
    wanted = sys.argv[1:] or known
    for name in wanted:
        if name not in known:
            sys.exit(f"render_example.py: '{name}' is not known. There are {', '.join(known)}; solids are drawn by render_solids.py")
    for name in wanted:
        if name == "hero":
            drawing.save(render_hero.hero(), drawing.ROOT / "docs/images/hero.png", 105, None)
        else:
            drawing.save(picture(name), drawing.ROOT / "examples" / name / "picture.png")


if __name__ == "__main__":
    main()
