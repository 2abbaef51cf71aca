// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/paraview_series.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <polhode/core/clock.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/xml_text.hpp>
#include <polhode/io/results/earlier_results.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/io/text/output_file.hpp>

namespace polhode::io {

namespace {

/// Shortest interval between updates of the list of times, except in slow runs [s].
constexpr double kListEvery = 0.2;

/// Times of a list written earlier, up to t.
std::vector<double> listed_times(const std::string& path, double t) {
  std::vector<double> times;
  if (!std::filesystem::exists(path)) return times;
  const std::string text = read_file(path);
  constexpr std::string_view kKey = "timestep=\"";
  for (std::size_t at = text.find(kKey); at != std::string::npos; at = text.find(kKey, at)) {
    at += kKey.size();
    const double time = std::strtod(text.c_str() + at, nullptr);
    if (time <= t * (1.0 + 1e-14)) times.push_back(time);
  }
  return times;
}

}  // namespace

ParaviewSeries::ParaviewSeries(std::string folder, std::string name, std::string extension,
                               std::optional<double> keep)
    : folder_(std::move(folder)), name_(std::move(name)), extension_(std::move(extension)) {
  make_folder(folder_ + "/" + name_);
  if (keep) times_ = listed_times(format("{}/{}.pvd", folder_, name_), *keep);
  remove_numbered_files(folder_ + "/" + name_, extension_, times_.size());
  synced_ = times_.size();
  write_list(false);
}

std::string ParaviewSeries::file(std::size_t frame) const {
  return format("{}/{:06}.{}", name_, frame, extension_);
}

void ParaviewSeries::append(double t, const std::string& bytes) {
  const std::string path = folder_ + "/" + file(times_.size());
  // A new file: on many file systems overwriting an old one waits for the disk.
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw FileError::from_errno(path, "cannot be written");
  times_.push_back(t);
  if (wall_clock() >= next_listing_) write_list(false);
}

void ParaviewSeries::sync() {
  // Two passes: the disk then writes all of them at once.
  for (std::size_t i = synced_; i < times_.size(); ++i) start_writing(folder_ + "/" + file(i));
  for (; synced_ < times_.size(); ++synced_) wait_for_disk(folder_ + "/" + file(synced_));
  wait_for_disk(folder_ + "/" + name_);
  write_list(true);
}

void ParaviewSeries::write_list(bool durable) {
  std::string text = R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">
<Collection>
)";
  for (std::size_t i = 0; i < times_.size(); ++i)
    text += format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", times_[i], file(i));
  text += "</Collection>\n</VTKFile>\n";
  const double begin = wall_clock();
  write_file_atomically(format("{}/{}.pvd", folder_, name_), text, durable);
  // Long lists are written less often, so that they take a small part of the run.
  next_listing_ = wall_clock() + std::max(kListEvery, 20.0 * (wall_clock() - begin));
}

void VtkFile::entry(const char* type, const char* name, int components) {
  xml_ += format(
      R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
      "\n",
      type, name, components, bytes_.size());
}

void VtkFile::names(const char* name, const std::vector<std::string>& values) {
  xml_ += format(R"(<FieldData><Array type="String" Name="{}" NumberOfTuples="{}" format="ascii">)",
                 name, values.size());
  for (const std::string& value : values) {
    for (const char c : value) xml_ += format("{} ", static_cast<unsigned char>(c));
    xml_ += "0 ";
  }
  xml_ += "</Array></FieldData>\n";
}

void VtkFile::indices(const char* kind, const std::vector<std::string>& names) {
  xml_ += "<FieldData>\n";
  for (std::size_t i = 0; i < names.size(); ++i)
    xml_ += format(
        R"(<DataArray type="Int32" Name="{} {}" NumberOfTuples="1" format="ascii">{}</DataArray>)"
        "\n",
        kind, xml_text(names[i]), i);
  xml_ += "</FieldData>\n";
}

std::string VtkFile::bytes() const {
  return format(
             R"(<?xml version="1.0"?>
<VTKFile type="{0}" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<{0}>
)",
             type_) +
         xml_ + format("</{}>\n<AppendedData encoding=\"raw\">\n_", type_) + bytes_ +
         "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace polhode::io
