// SPDX-License-Identifier: Apache-2.0
// Public interface of Polhode: to describe or read a model, run it, and evaluate the results.
//
//   polhode::Simulation simulation(polhode::read_model("pendulum.yaml"));
//   while (simulation.time() < 1.0) simulation.step(1.0);
//   std::cout << simulation.body("lower").r.transpose() << '\n';
//
// SI units everywhere; angles in radians; world axes unless a name or a comment says otherwise.
#pragma once

#include <polhode/core/error.hpp>
#include <polhode/core/types.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/model/model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode {

using geometry::composed;
using geometry::find_shape_kind;
using geometry::MassProperties;
using geometry::placed;
using geometry::shape_mass_properties;
using geometry::ShapeKind;
using io::ModelErrors;
using io::Overrides;
using io::read_model;
using io::read_model_text;

}  // namespace polhode
