// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

/// Name of a joint that a load acts in, with its bodies; empty if there is none, which is reported.
std::string read_joint_of_load(ReadContext& context, const Section& section, const char* key,
                               const SourceNode* value, int* a, int* b);

/// Reads the coordinates of a coupling, their factors and its offset, in units of its first one.
void read_coupling(ReadContext& context, Section& section, LoadSpec& load);

}  // namespace polhode::io
