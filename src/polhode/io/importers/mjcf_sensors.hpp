// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/importers/mjcf_bodies.hpp>

namespace polhode::io {

/// Reads all <sensor> sections as things to be recorded. A probe records all of its object, and so
/// more than the sensor has.
void read_sensors(MjcfFile& file, const MjcfBodies& bodies, Robot& robot);

}  // namespace polhode::io
