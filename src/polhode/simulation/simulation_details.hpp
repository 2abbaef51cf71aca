// SPDX-License-Identifier: Apache-2.0
// A simulation with the internals of its reports, for results, checks, bindings, tests. Programs
// that only run models need <polhode/polhode.hpp>.
#pragma once

#include <polhode/compile/build_solids.hpp>
#include <polhode/compile/solid_point.hpp>
#include <polhode/simulation/contact_statistics.hpp>
#include <polhode/simulation/simulation.hpp>
#include <polhode/solids/nodal_recovery.hpp>
#include <polhode/statics/statics.hpp>
#include <polhode/stepping/ledger.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>
#include <polhode/surface_contact/surface_contact.hpp>
#include <polhode/system/system.hpp>
