// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

bool is_endless(const AnalysisSpec& analysis) {
  return analysis.type == "dynamics" && std::isinf(analysis.duration);
}

void require_end(const AnalysisSpec& analysis) {
  if (is_endless(analysis))
    throw InputError("analysis.duration", "is none, but a run needs an end",
                     "Give a duration, in the model or by --duration \"10 s\", or take steps in "
                     "Python, with Simulation.step");
}

}  // namespace polhode
