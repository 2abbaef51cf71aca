// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/shared_player.hpp>

#include <stdexcept>

#include <polhode/core/format.hpp>

namespace polhode {

namespace {

constexpr const char* kBegin = "<script>";
constexpr const char* kEnd = "</script>";
constexpr const char* kPolicy = "script-src 'sha256-";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<' || c == '&' || c == '"')
      out += format("&#{};", static_cast<int>(c));
    else
      out += c;
  }
  return out;
}

/// Removes the script from a page, which then refers to player.js; its security policy allows
/// scripts from the page's location instead of that script.
std::string take_script(std::string& page) {
  const std::size_t begin = page.rfind(kBegin), from = begin + std::string(kBegin).size(),
                    end = begin == std::string::npos ? begin : page.find(kEnd, from),
                    policy = page.find(kPolicy);
  if (end == std::string::npos || policy == std::string::npos)
    throw std::invalid_argument("shared_pages: a page has no script of its own");
  std::string script = page.substr(from, end - from);
  page.replace(begin, end - begin, "<script src=\"player.js\">");
  const std::size_t value = policy + std::string("script-src ").size(),
                    stop = page.find(';', value);
  page.replace(value, stop - value, "'self' file:");
  return script;
}

}  // namespace

std::vector<ZipEntry> shared_pages(const std::vector<SharedRecording>& recordings) {
  std::vector<ZipEntry> files;
  std::string script, rows;
  for (const SharedRecording& one : recordings) {
    std::string page = one.page;
    script = take_script(page);
    files.push_back({one.name + ".html", std::move(page)});
    rows += format("<li><a href=\"{0}.html\">{0}</a> {1}</li>\n", escaped(one.name),
                   escaped(one.title));
  }
  files.push_back({"player.js", std::move(script)});
  files.push_back({"index.html",
                   "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                   "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'\">\n"
                   "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                   "<meta name=\"color-scheme\" content=\"light dark\">\n"
                   "<title>Recordings of "
                   "Polhode</title>\n</head>\n<body>\n<main>\n<h1>Recordings</h1>\n<ul>\n" +
                       rows + "</ul>\n</main>\n</body>\n</html>\n"});
  return files;
}

}  // namespace polhode
