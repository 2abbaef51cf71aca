// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/import_model.hpp>

#include <polhode/core/format.hpp>
#include <polhode/io/importers/feb.hpp>
#include <polhode/io/importers/mjcf.hpp>
#include <polhode/io/importers/sdf.hpp>
#include <polhode/io/importers/urdf.hpp>
#include <polhode/io/importers/xacro.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

/// Whether tags of xacro stand in a text, outside of comments.
bool has_xacro_tags(const std::string& text) {
  for (std::size_t at = text.find("<xacro:"); at != std::string::npos;
       at = text.find("<xacro:", at + 1)) {
    const std::size_t comment = text.rfind("<!--", at);
    if (comment == std::string::npos || text.find("-->", comment) < at) return true;
  }
  return false;
}

bool is_sdf(const std::string& file) { return file.ends_with(".sdf") || file.ends_with(".world"); }

}  // namespace

bool is_importable(const std::string& file) {
  return file.ends_with(".urdf") || file.ends_with(".xacro") || file.ends_with(".xml") ||
         file.ends_with(".feb") || is_sdf(file);
}

Imported import_model(const ImportOptions& options, const std::string& folder) {
  std::string text = options.file.ends_with(".xacro")
                         ? expanded_by_xacro(options.file, options.arguments)
                         : read_file(options.file);
  if (options.file.ends_with(".urdf") && has_xacro_tags(text))
    text = expanded_by_xacro(options.file, options.arguments);
  auto source = std::make_shared<SourceText>(options.file, std::move(text));
  if (!options.keyframe.empty() && !options.file.ends_with(".xml")) {
    Diagnostics diagnostics(*source);
    diagnostics.add({options.file, 0, 0}, "import.keyframe",
                    "is given, and only an MJCF has keyframes", "Leave it out.");
    diagnostics.throw_if_any();
  }
  if (options.file.ends_with(".feb")) return import_feb(std::move(source), options, folder);
  if (is_sdf(options.file)) return import_sdf(std::move(source), options, folder);
  return options.file.ends_with(".xml") ? import_mjcf(std::move(source), options, folder)
                                        : import_urdf(std::move(source), options, folder);
}

const char* word_of(ImportNote::Kind kind) {
  switch (kind) {
    case ImportNote::Kind::approximated:
      return "approximated";
    case ImportNote::Kind::left_out:
      return "left out";
    case ImportNote::Kind::ignored:
      break;
  }
  return "ignored";
}

}  // namespace polhode::io
