// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// Version of Polhode, such as "0.2.0": that of the CMake project.
[[nodiscard]] const char* version();

}  // namespace polhode
