// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/importers/mjcf_bodies.hpp>

namespace polhode::io {

/// Reads all <contact> sections: pairs of bodies that do not touch, and pairs of geoms with
/// properties of their own. They act where the model has contacts.
void read_contacts(MjcfFile& file, const MjcfBodies& bodies, const ImportOptions& options,
                   Robot& robot);

}  // namespace polhode::io
