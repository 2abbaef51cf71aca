// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace polhode::io {

/// Tags one in the other, at most: a rope of MJCF has one body in the other.
inline constexpr int kDeepestXml = 500;
/// Tag that stands for a part of a text, with its `number`.
inline constexpr const char* kPartTag = "polhode-part";

/// An XML text in parts that are nested few enough deep for the parser. The first part is the text
/// itself, in which tags that are too deep are replaced by a kPartTag; their text is a part, which
/// may have such tags in turn. Lines of the parts have the numbers that they have in the text.
///
/// Whether tags match is left to the parser.
/// @returns nothing if tags are nested deeper than kDeepestXml.
[[nodiscard]] std::optional<std::vector<std::string>> xml_parts(const std::string& text);

}  // namespace polhode::io
