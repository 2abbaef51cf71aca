// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

// The functions of HDF5 1.10, which later versions offer too. This file comes first where HDF5 is
// used.
#define H5_USE_110_API
#include <hdf5.h>

namespace polhode::io::hdf5 {

/// Owner of an HDF5 object, closed with it.
class Id {
 public:
  Id() = default;
  Id(hid_t id, herr_t (*closer)(hid_t)) : id_(id), closer_(closer) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  ~Id() { close(); }
  herr_t close() { return id_ < 0 ? 0 : closer_(std::exchange(id_, -1)); }
  /// Leaves the object open. HDF5 crashes when it closes a file that cannot be written.
  void abandon() { id_ = -1; }
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*closer_)(hid_t) = nullptr;
};

/// Prepares HDF5: it prints no errors, and does nothing at the end of the program, where it would
/// crash on files that could not be written.
inline void prepare() {
  static const bool once = H5dont_atexit() >= 0;
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// Opens a file that another program may be writing; not valid if it cannot be opened.
inline Id open_to_read(const std::string& path) {
  prepare();
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access.get(), false, true);
#endif
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose};
}

}  // namespace polhode::io::hdf5
