// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

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
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*closer_)(hid_t) = nullptr;
};

}  // namespace polhode::io::hdf5
