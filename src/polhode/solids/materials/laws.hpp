// SPDX-License-Identifier: Apache-2.0
// Lists of all materials and all fibres. To add one: its file, and its name here.
#pragma once

#include <polhode/solids/materials/exponential_fibre.hpp>
#include <polhode/solids/materials/holzapfel_gasser_ogden.hpp>
#include <polhode/solids/materials/mooney_rivlin.hpp>
#include <polhode/solids/materials/mooney_rivlin_uncoupled.hpp>
#include <polhode/solids/materials/neo_hookean.hpp>
#include <polhode/solids/materials/ogden.hpp>
#include <polhode/solids/materials/ogden_uncoupled.hpp>
#include <polhode/solids/materials/power_linear_fibre.hpp>
#include <polhode/solids/materials/st_venant_kirchhoff.hpp>
#include <polhode/solids/materials/toe_fibre.hpp>
#include <polhode/solids/materials/veronda_westmann.hpp>

namespace polhode::solids {

template <class... Law>
struct LawList {};

/// In the order of the reference page.
using MaterialLaws = LawList<StVenantKirchhoff, NeoHookean, MooneyRivlin, MooneyRivlinUncoupled,
                             Ogden, OgdenUncoupled, VerondaWestmann, HolzapfelGasserOgden>;
using FibreLaws = LawList<ExponentialFibre, ToeFibre, PowerLinearFibre>;

}  // namespace polhode::solids
