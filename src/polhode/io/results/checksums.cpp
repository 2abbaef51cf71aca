// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <polhode/io/results/checksums.hpp>
#include <polhode/io/results/hdf5_id.hpp>

namespace polhode::io::results {

namespace {

using hdf5::Id;

/// Longest walk through a file [s of processor time]: damage can make HDF5 go in circles. The index
/// of a terabyte is walked through in less.
constexpr rlim_t kLongestWalk = 10;
/// Largest list of texts that is read [entries], and frame that is read [bytes].
constexpr hsize_t kMostTexts = 10'000'000;
constexpr hsize_t kLargestFrame = hsize_t{1} << 30;

/// Multiplier of Fibonacci hashing, 2⁶⁴ over the golden ratio.
constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15u;

void walk_text(hid_t type, hid_t space, const std::vector<hsize_t>& dims,
               herr_t (*read)(hid_t, hid_t, void*), hid_t object) {
  hsize_t count = 1;
  for (const hsize_t n : dims) count *= n;
  if (H5Tget_class(type) != H5T_STRING || count > kMostTexts) return;
  if (H5Tis_variable_str(type) > 0) {
    std::vector<char*> texts(count, nullptr);
    if (read(object, type, static_cast<void*>(texts.data())) >= 0)
      H5Dvlen_reclaim(type, space, H5P_DEFAULT, static_cast<void*>(texts.data()));
  } else {
    std::vector<char> bytes(count * H5Tget_size(type) + 1);
    read(object, type, bytes.data());
  }
}

std::vector<hsize_t> dims_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> dims(static_cast<std::size_t>(rank > 0 ? rank : 0));
  if (!dims.empty()) H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims;
}

herr_t walk_attribute(hid_t object, const char* name, const H5A_info_t*, void*) {
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) return 0;
  const Id type(H5Aget_type(attribute.get()), H5Tclose),
      space(H5Aget_space(attribute.get()), H5Sclose);
  walk_text(
      type.get(), space.get(), dims_of(space.get()),
      [](hid_t a, hid_t t, void* to) { return H5Aread(a, t, to); }, attribute.get());
  return 0;
}

/// Reads the first and last entries of a data set, and the index of all its chunks.
void walk_numbers(hid_t dataset, hid_t space, const std::vector<hsize_t>& dims) {
  const Id creation(H5Dget_create_plist(dataset), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout == H5D_CHUNKED) {
    hsize_t chunks = 0;
    H5Dget_num_chunks(dataset, space, &chunks);
  }
  // A view shows chunks of other data sets, which are walked through themselves.
  if (layout == H5D_VIRTUAL || dims.empty() || dims[0] == 0) return;
  std::vector<hsize_t> start(dims.size(), 0), count = dims;
  count[0] = 1;
  hsize_t size = 1;
  for (const hsize_t n : count)
    if (n == 0 || (size *= n) > kLargestFrame / sizeof(double)) return;
  std::vector<double> values(size);
  const Id memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                  H5Sclose);
  for (const hsize_t frame : {hsize_t{0}, dims[0] - 1}) {
    start[0] = frame;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    H5Dread(dataset, H5T_NATIVE_DOUBLE, memory.get(), space, H5P_DEFAULT, values.data());
  }
}

herr_t walk_object(hid_t place, const char* name, const H5O_info_t* info, void*) {
  const Id object(H5Oopen(place, name, H5P_DEFAULT), H5Oclose);
  if (!object.valid()) return 0;
  H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, walk_attribute, nullptr);
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Id type(H5Dget_type(object.get()), H5Tclose), space(H5Dget_space(object.get()), H5Sclose);
  if (!type.valid() || !space.valid()) return 0;
  const std::vector<hsize_t> dims = dims_of(space.get());
  if (H5Tget_class(type.get()) == H5T_STRING)
    walk_text(
        type.get(), space.get(), dims,
        [](hid_t d, hid_t t, void* to) { return H5Dread(d, t, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); },
        object.get());
  else
    walk_numbers(object.get(), space.get(), dims);
  return 0;
}

[[noreturn]] void walk_and_exit(const std::string& path) {
  for (const int fault : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU})
    std::signal(fault, SIG_DFL);
  struct rlimit limit {
    0, 0
  };
  setrlimit(RLIMIT_CORE, &limit);
  limit = {kLongestWalk, kLongestWalk + 1};
  setrlimit(RLIMIT_CPU, &limit);
  const Id file = hdf5::open_to_read(path);
  if (file.valid()) H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, walk_object, nullptr);
  _exit(0);
}

}  // namespace

double checksum(std::span<const double> numbers, bool integer) {
  std::uint64_t hash = kGolden + numbers.size();
  for (double x : numbers) {
    if (integer) x = std::isfinite(x) ? std::trunc(x) + 0.0 : 0.0;  // as it is read again
    hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * kGolden;
    hash ^= hash >> 29;
  }
  return static_cast<double>(hash >> 16);
}

double checksum(const std::vector<std::string>& texts) {
  std::uint64_t hash = kGolden + texts.size();
  for (const std::string& text : texts) {
    for (const char c : text) {
      hash = (hash ^ static_cast<unsigned char>(c)) * kGolden;
      hash ^= hash >> 29;
    }
    hash = (hash ^ 256) * kGolden;  // the end of a text, which is no byte
  }
  return static_cast<double>(hash >> 16);
}

bool survives_a_walk(const std::string& path) {
  const pid_t child = fork();
  if (child < 0) return true;  // No process is left: the file is read as it is.
  if (child == 0) walk_and_exit(path);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return true;
  return WIFEXITED(status);
}

}  // namespace polhode::io::results
