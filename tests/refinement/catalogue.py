# SPDX-License-Identifier: Apache-2.0
"""All cases of the refinement suite."""
import central_impacts
import flat
import rest
import stops

CASES = [case for module in (central_impacts, flat, rest, stops) for case in module.CASES]
assert len({case.name for case in CASES}) == len(CASES), "two cases have one name"
