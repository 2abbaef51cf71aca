// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <polhode/io/text/model_errors.hpp>
#include <polhode/model/model.hpp>

namespace polhode::io {

/// Overrides as on the command line, each "path=value": the name of a variable ("L=1.2"), or keys
/// and list indices joined by dots ("bodies.crank.mass=2", "joints.A.at.0=0.1"). The value is
/// written as it would be in the file.
using Overrides = std::vector<std::string>;

/// Reads a model file (YAML or JSON) and resolves it: SI units, checked names, mass properties and
/// frames computed.
/// @throws ModelErrors with all errors of the model at once.
/// @throws FileError if the file cannot be read.
[[nodiscard]] Model read_model(const std::filesystem::path& file, const Overrides& overrides = {});

/// Reads a model like read_model(), from a text in memory.
/// @param filename  For messages; paths of mesh files are relative to its folder.
[[nodiscard]] Model read_model_text(std::string text, const std::string& filename,
                                    const Overrides& overrides = {});

/// Spin of an analysis of modes, written as in a model file: spin_axis and others may be left out.
struct SpinText {
  std::string spin, axis, through, ground;  ///< JSON or a bare text; empty: left out.
  [[nodiscard]] bool empty() const {
    return spin.empty() && axis.empty() && through.empty() && ground.empty();
  }
};

/// Replaces what is given of the spin of a model. @throws ModelErrors if it cannot be read.
void set_spin(const SpinText& text, AnalysisSpec& analysis);

}  // namespace polhode::io
