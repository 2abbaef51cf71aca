// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/exporters/export_model.hpp>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/exporters/mjcf_writer.hpp>
#include <polhode/io/exporters/urdf_writer.hpp>

namespace polhode::io {

namespace {

/// A format that can be written.
struct ExportFormat {
  const char* ending;
  Exported (*write)(const Simulation& simulation, const ExportOptions& options);
};

constexpr ExportFormat kFormats[] = {
    {".urdf", export_urdf},
    {".xml", export_mjcf},
};

const ExportFormat* format_of(const std::string& file) {
  for (const ExportFormat& known : kFormats)
    if (file.ends_with(known.ending)) return &known;
  return nullptr;
}

}  // namespace

bool is_exportable(const std::string& file) { return format_of(file) != nullptr; }

Exported export_model(const Simulation& simulation, const ExportOptions& options) {
  const ExportFormat* known = format_of(options.file);
  if (known != nullptr) return known->write(simulation, options);
  std::string endings;
  for (const ExportFormat& f : kFormats)
    endings += (endings.empty() ? "" : " or ") + std::string(f.ending);
  throw InputError("export",
                   format("{} is no name of a format that can be written", quote(options.file)),
                   format("Name a file that ends in {}", endings));
}

const char* word_of(ExportNote::Kind kind) {
  switch (kind) {
    case ExportNote::Kind::left_out:
      return "left out";
    case ExportNote::Kind::elsewhere:
      return "not in the file";
    case ExportNote::Kind::differs:
      break;
  }
  return "differs";
}

}  // namespace polhode::io
