// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/checksums.hpp>
#include <polhode/io/results/hdf5_id.hpp>
#include <polhode/io/results/results_reader.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>
#include <utility>

#include <unistd.h>

#include <polhode/core/format.hpp>
#include <polhode/io/results/folder_lock.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;

using hdf5::Id;

/// Attempts to open the file of a run that goes on: one may meet the moment of a write.
constexpr int kTries = 10;
constexpr std::chrono::milliseconds kPause{20};

constexpr const char* kHint = "Name the results.h5 that 'polhode run' wrote";
constexpr const char* kCopyAgain = "Copy the file again, or run the model again";
/// Most numbers that are read at once: a quantity of more than 64 GB is a damaged size.
constexpr std::size_t kMostNumbers = std::size_t{1} << 33;
/// Longest list of names, elements or nodes: the numbers of the program have 31 bits.
constexpr std::size_t kLongestList = std::size_t{1} << 31;

/// Length recorded in the first block of an HDF5 file; 0 if it is no such file. Format of that
/// block: HDF5 File Format Specification 3.0, section II.A.
std::uint64_t promised_length(const std::string& path) {
  std::array<char, 64> head{};
  std::ifstream in(path, std::ios::binary);
  if (!in.read(head.data(), head.size()) || std::memcmp(head.data(), "\x89HDF\r\n\x1a\n", 8) != 0)
    return 0;
  const int version = head[8];
  const int place = version == 0 ? 40 : version == 1 ? 44 : 28;
  std::uint64_t length = 0;
  std::memcpy(&length, head.data() + place, sizeof length);
  return length;
}

/// Temporary copy of a truncated file, with zeros for the missing part.
class FullLengthCopy {
 public:
  FullLengthCopy(const std::string& path, std::uint64_t length) {
    std::string name = (fs::temp_directory_path() / "polhode-results-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    if (descriptor < 0) throw FileError::from_errno(name, "cannot be written");
    ::close(descriptor);
    path_ = name;
    fs::copy_file(path, path_, fs::copy_options::overwrite_existing);
    fs::resize_file(path_, length);
  }
  ~FullLengthCopy() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  FullLengthCopy(const FullLengthCopy&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::vector<hsize_t> extent(hid_t dataset) {
  const Id space(H5Dget_space(dataset), H5Sclose);
  std::vector<hsize_t> dims(
      static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
  if (!dims.empty()) H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  return dims;
}

std::string text_of(hid_t attribute) {
  const Id type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_STRING) return "";
  if (H5Tis_variable_str(type.get()) > 0) {
    char* value = nullptr;
    if (H5Aread(attribute, type.get(), static_cast<void*>(&value)) < 0 || value == nullptr)
      return "";
    std::string text = value;
    H5free_memory(value);
    return text;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute, type.get(), text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

std::string attribute_of(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  return text_of(attribute.get());
}

/// Number of complete frames of a data set before its first part beyond the end of the file.
hsize_t frames_before(hid_t dataset, std::uint64_t end, hsize_t frames) {
  hsize_t chunks = 0;
  const Id space(H5Dget_space(dataset), H5Sclose);
  if (H5Dget_num_chunks(dataset, space.get(), &chunks) < 0) return 0;
  const std::vector<hsize_t> dims = extent(dataset);
  const std::size_t rank = dims.size();
  std::vector<hsize_t> chunk(rank);
  const Id creation(H5Dget_create_plist(dataset), H5Pclose);
  H5Pget_chunk(creation.get(), static_cast<int>(rank), chunk.data());
  const bool all_of_a_frame = std::equal(dims.begin() + 1, dims.end(), chunk.begin() + 1);
  const hsize_t depth = all_of_a_frame ? chunk[0] : 0;
  std::vector<hsize_t> offset(rank);
  hsize_t whole = frames;
  for (hsize_t i = 0; i < chunks; ++i) {
    unsigned filter = 0;
    haddr_t address = 0;
    hsize_t bytes = 0;
    if (H5Dget_chunk_info(dataset, space.get(), i, offset.data(), &filter, &address, &bytes) < 0)
      return 0;
    if (address + bytes <= end) continue;
    // Frames of a chunk are consecutive: those before the cut are complete.
    const hsize_t rows = address < end && bytes > 0 ? (end - address) * depth / bytes : 0;
    whole = std::min(whole, offset[0] + rows);
  }
  return chunks == 0 ? 0 : whole;
}

}  // namespace

std::size_t ResultsReader::DataSet::size() const {
  return std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
}

struct ResultsReader::Impl {
  std::string path;
  std::unique_ptr<FullLengthCopy> copy;  // Outlives the open file.
  Id file;
  std::uint64_t end = 0;  ///< Length of the file on the disk.
  std::size_t frames = 0;
  std::vector<DataSet> sets;
  std::size_t checked = 0;           ///< Data sets with a column of checksums.
  mutable std::vector<double> sums;  ///< Checksums read last, of one frame in sums_every.
  mutable std::size_t sums_every = 0;

  [[nodiscard]] Id open(const std::string& name) const {
    return {H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose};
  }
  [[noreturn]] void fail(const std::string& what, const char* hint = kHint) const {
    throw FileError(path, what, hint);
  }

  /// Numbers of the first `frames` frames of a data set, one in `every`, with those between left
  /// out; its shape must be that of a channel.
  [[nodiscard]] std::vector<double> frames_of(const Id& dataset, const std::string& name,
                                              std::size_t every) const {
    std::vector<hsize_t> count = extent(dataset.get()), start(count.size(), 0),
                         stride(count.size(), 1);
    if (count.empty() || count[0] < frames) fail(format("has too few frames of '{}'", name));
    count[0] = frames == 0 ? 0 : (frames - 1) / every + 1;
    stride[0] = every;
    std::size_t size = 1;
    for (const hsize_t n : count) {
      if (n > 0 && size > kMostNumbers / n)
        fail(format("is damaged: '{}' is too long", name), kCopyAgain);
      size *= n;
    }
    std::vector<double> values(size);
    if (size == 0) return values;
    const Id memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                    H5Sclose);
    const Id source(H5Dget_space(dataset.get()), H5Sclose);
    H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), stride.data(), count.data(),
                        nullptr);
    if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), source.get(), H5P_DEFAULT,
                values.data()) < 0)
      fail(format("cannot be read at '{}'", name), kCopyAgain);
    return values;
  }

  /// A length that a list of a results file may have.
  [[nodiscard]] std::size_t sensible(const std::string& name, hsize_t length) const {
    if (length >= kLongestList) fail(format("is damaged: '{}' is too long", name), kCopyAgain);
    return length;
  }

  /// Compares a constant list with its checksum.
  void check_list(const Id& dataset, const std::string& name, double sum) const {
    if (H5Aexists(dataset.get(), results::kListChecksum) <= 0) return;
    const Id attribute(H5Aopen(dataset.get(), results::kListChecksum, H5P_DEFAULT), H5Aclose);
    double stored = -1.0;
    H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &stored);
    if (stored != sum) fail(format("is damaged: '{}' differs from its checksum", name), kCopyAgain);
  }

  /// Compares the numbers that were read with their checksums, of files that have them.
  void check(const Id& dataset, const std::string& name, std::size_t every,
             const std::vector<double>& values) const {
    if (values.empty() || H5Aexists(dataset.get(), results::kChecksumColumn) <= 0) return;
    const Id attribute(H5Aopen(dataset.get(), results::kChecksumColumn, H5P_DEFAULT), H5Aclose);
    double column = -1.0;
    H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &column);
    const Id type(H5Dget_type(dataset.get()), H5Tclose);
    const bool integer = H5Tget_class(type.get()) == H5T_INTEGER;
    if (sums.empty() || sums_every != every) {
      const Id all = open(results::kChecksums);
      if (all.valid()) sums = frames_of(all, results::kChecksums, every);
      sums_every = every;
    }
    const std::size_t shown = (frames - 1) / every + 1, width = sums.size() / shown;
    const std::size_t size = values.size() / shown;
    if (!(column >= 0.0 && column < static_cast<double>(width)))
      fail(format("is damaged: '{}' has lost its checksums", name), kCopyAgain);
    for (std::size_t k = 0; k < shown; ++k)
      if (results::checksum({values.data() + k * size, size}, integer) !=
          sums[k * width + static_cast<std::size_t>(column)])
        fail(format("is damaged: '{}' differs from its checksum in frame {}", name, k * every),
             kCopyAgain);
  }

  static herr_t visit(hid_t object, const char* name, const H5O_info_t* info, void* data) {
    auto& self = *static_cast<Impl*>(data);
    const std::string path = std::string("/") + name;
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Id dataset(H5Dopen2(object, name, H5P_DEFAULT), H5Dclose);
    const Id creation(H5Dget_create_plist(dataset.get()), H5Pclose);
    // Growing data sets are stored in chunks; lists are not, and views are virtual.
    if (!dataset.valid() || H5Pget_layout(creation.get()) != H5D_CHUNKED) return 0;
    const std::vector<hsize_t> dims = extent(dataset.get());
    if (dims.empty()) return 0;
    if (H5Aexists(dataset.get(), results::kChecksumColumn) > 0) ++self.checked;
    if (self.copy)  // A frame without its checksums is not complete either.
      self.frames =
          std::min<std::size_t>(self.frames, frames_before(dataset.get(), self.end, self.frames));
    if (path == results::kChecksums) return 0;
    self.sets.push_back(
        {path, {dims.begin() + 1, dims.end()}, attribute_of(dataset.get(), "unit")});
    return 0;
  }
};

ResultsReader::ResultsReader(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  for (int k = 0;; ++k) {
    try {
      impl_ = std::move(ResultsReader(path, Once{}).impl_);
      return;
    } catch (const FileError&) {
      if (k == kTries || !FolderLock::is_held(folder.empty() ? "." : folder)) throw;
      std::this_thread::sleep_for(kPause);
    }
  }
}

ResultsReader::ResultsReader(const std::string& path, Once) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.path = path;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw FileError(path, "cannot be read", "Check the path and the permissions");
  if (!fs::is_regular_file(status)) m.fail("is no file");  // a pipe would not end
  // First the promise: a run that goes on lengthens its file before it promises the length.
  const std::uint64_t promised = promised_length(path);
  m.end = fs::file_size(path, error);
  if (error) throw FileError(path, "cannot be read", "Check the path and the permissions");
  if (promised == 0) m.fail("is no HDF5 file");
  if (promised > m.end && promised < (std::uint64_t{1} << 46))
    m.copy = std::make_unique<FullLengthCopy>(path, promised);
  const std::string opened = m.copy ? m.copy->path() : path;
  const char* rerun = "Run the model again, or copy the file again";
  if (!results::survives_a_walk(opened)) m.fail("is damaged: its structure is broken", rerun);
  m.file = hdf5::open_to_read(opened);
  if (!m.file.valid()) m.fail("is damaged: its index cannot be read", rerun);
  if (attribute("/", "format") != "polhode results")
    m.fail(m.copy ? "is damaged: its header is missing" : "holds no results of Polhode",
           m.copy ? rerun : kHint);
  const Id version(H5Aopen(m.file.get(), "format_version", H5P_DEFAULT), H5Aclose);
  double number = 0.0;
  H5Aread(version.get(), H5T_NATIVE_DOUBLE, &number);
  if (number < 1.0 || number > results::kFormatVersion)
    m.fail(format("has format version {:g}, and this program reads versions up to {}", number,
                  results::kFormatVersion),
           "Use the version of Polhode that wrote it, or a later one");
  const Id time = m.open(results::kTime);
  if (!time.valid()) m.fail("has no data set '/time'");
  m.frames = extent(time.get())[0];
  const bool all = H5Ovisit(m.file.get(), H5_INDEX_NAME, H5_ITER_INC, Impl::visit, &m) >= 0;
  // The index of every data set is stored with the first frame.
  if (m.copy && (!all || m.frames == 0)) m.fail("is cut short, and has no complete frame", rerun);
  if (H5Aexists(m.file.get(), results::kChecksumColumns) > 0) {
    const Id columns(H5Aopen(m.file.get(), results::kChecksumColumns, H5P_DEFAULT), H5Aclose);
    double wanted = -1.0;
    H5Aread(columns.get(), H5T_NATIVE_DOUBLE, &wanted);
    if (wanted != static_cast<double>(m.checked))
      m.fail("is damaged: data sets are missing", rerun);
  }
}

ResultsReader::~ResultsReader() = default;
ResultsReader::ResultsReader(ResultsReader&&) noexcept = default;

std::size_t ResultsReader::frames() const { return impl_->frames; }
bool ResultsReader::cut_short() const { return impl_->copy != nullptr; }

std::string ResultsReader::cut_text() const {
  if (!cut_short()) return {};
  return format("{} is cut short: only {} complete frames of it are read. {}.", impl_->path,
                frames(), kCopyAgain);
}

const std::string& ResultsReader::opened_path() const {
  return impl_->copy ? impl_->copy->path() : impl_->path;
}

const std::vector<ResultsReader::DataSet>& ResultsReader::data_sets() const { return impl_->sets; }

const ResultsReader::DataSet* ResultsReader::find(const std::string& path) const {
  for (const DataSet& set : impl_->sets)
    if (set.path == path) return &set;
  return nullptr;
}

bool ResultsReader::has(const std::string& path) const { return impl_->open(path).valid(); }

void ResultsReader::refuse(const std::string& what) const {
  impl_->fail("is damaged: " + what, kCopyAgain);
}

std::vector<double> ResultsReader::read(const std::string& path, std::size_t every) const {
  const Impl& m = *impl_;
  const Id dataset = m.open(path);
  if (!dataset.valid()) m.fail(format("has no data set '{}'", path));
  std::vector<double> values = m.frames_of(dataset, path, every);
  m.check(dataset, path, every, values);
  return values;
}

std::vector<std::string> ResultsReader::names(const std::string& path) const {
  const Id dataset = impl_->open(path);
  if (!dataset.valid()) return {};
  const std::vector<hsize_t> dims = extent(dataset.get());
  std::vector<char*> pointers(dims.empty() ? 1 : impl_->sensible(path, dims[0]), nullptr);
  const Id type(H5Dget_type(dataset.get()), H5Tclose);
  if (pointers.empty() || H5Tis_variable_str(type.get()) <= 0 ||
      H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
              static_cast<void*>(pointers.data())) < 0)
    return {};
  std::vector<std::string> values;
  for (char* p : pointers) {
    values.emplace_back(p == nullptr ? "" : p);
    if (p != nullptr) H5free_memory(p);
  }
  impl_->check_list(dataset, path, results::checksum(values));
  return values;
}

std::vector<std::int64_t> ResultsReader::numbers(const std::string& path) const {
  const Id dataset = impl_->open(path);
  if (!dataset.valid()) return {};
  const std::vector<hsize_t> dims = extent(dataset.get());
  std::vector<std::int64_t> values(dims.empty() ? 0 : impl_->sensible(path, dims[0]));
  if (!values.empty() &&
      H5Dread(dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    impl_->fail(format("cannot be read at '{}'", path), kCopyAgain);
  impl_->check_list(dataset, path,
                    results::checksum(std::vector<double>(values.begin(), values.end()), true));
  return values;
}

std::vector<double> ResultsReader::vectors(const std::string& path) const {
  const Id dataset = impl_->open(path);
  if (!dataset.valid()) return {};
  const std::vector<hsize_t> dims = extent(dataset.get());
  std::size_t size = 1;
  for (const hsize_t n : dims) size = impl_->sensible(path, size * impl_->sensible(path, n));
  std::vector<double> values(size);
  if (!values.empty() &&
      H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    impl_->fail(format("cannot be read at '{}'", path), kCopyAgain);
  impl_->check_list(dataset, path, results::checksum(values, false));
  return values;
}

std::string ResultsReader::attribute(const std::string& group, const std::string& name) const {
  const Id object(H5Oopen(impl_->file.get(), group.c_str(), H5P_DEFAULT), H5Oclose);
  return object.valid() ? attribute_of(object.get(), name.c_str()) : "";
}

std::vector<std::string> ResultsReader::groups(const std::string& path) const {
  const Id group(H5Gopen2(impl_->file.get(), path.c_str(), H5P_DEFAULT), H5Gclose);
  std::vector<std::string> list;
  if (!group.valid()) return list;
  H5G_info_t info;
  if (H5Gget_info(group.get(), &info) < 0) return list;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    std::array<char, 1024> name{};
    if (H5Lget_name_by_idx(group.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(),
                           name.size(), H5P_DEFAULT) >= 0)
      list.emplace_back(name.data());
  }
  return list;
}

}  // namespace polhode::io
