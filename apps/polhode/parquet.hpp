// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/view/probe_tables.hpp>

namespace polhode::cli {

/// Writes channels as a Parquet file, with a column for each number and "t" first, and units as
/// metadata of the columns. Python's pyarrow is used, as a C++ library would add some hundred
/// megabytes: $POLHODE_PYTHON names the Python, else it is python3.
/// @param names  As for channels_csv(). @throws FileError, InputError if there is no pyarrow.
void write_parquet(const io::ResultsReader& results, const ProbeTables& probes,
                   const std::vector<std::string>& names, const std::string& file);

}  // namespace polhode::cli
