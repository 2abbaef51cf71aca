# SPDX-License-Identifier: Apache-2.0
"""All cases of the refinement suite."""
import central_impacts
import deformables
import eccentric_impacts
import examples_in_motion
import examples_with_contact
import flat
import incline
import motions
import published_statics
import rest
import rigid_rows
import scenes
import several_contacts
import stops
import stresses
import surfaces
import validation_models

MODULES = (central_impacts, deformables, eccentric_impacts, examples_in_motion, examples_with_contact, flat, incline, motions, published_statics, rest, rigid_rows, scenes, several_contacts, stops,
           stresses, surfaces, validation_models)
ALL = [case for module in MODULES for case in module.CASES]
CASES = [case for case in ALL if not case.open]
OPEN = [case for case in ALL if case.open]
assert len({case.name for case in ALL}) == len(ALL), "two cases have the same name"
