// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::io {

/// A quantity that grows by one entry per frame.
struct Channel {
  std::string path;               ///< In the file, e.g. /packed/bodies/position.
  std::vector<std::size_t> dims;  ///< Shape of one frame's entry; empty: a number.
  std::string unit;               ///< e.g. m/s; "-" for none.
  bool integer = false;

  [[nodiscard]] std::size_t size() const;  ///< Numbers in one frame's entry.
};

/// A named view of a part of a channel: entries first to first+count-1 of the channel's second
/// dimension. Nothing is stored twice.
struct ChannelView {
  std::string path;
  std::size_t channel = 0;
  std::size_t first = 0, count = 1;
  /// One entry without its dimension: (frames, 3) rather than (frames, 1, 3).
  bool squeeze = false;
  std::string unit{};  ///< For channels with several units; "": the channel's.
};

/// An HDF5 file with channels that grow frame by frame, consistent after a kill at any moment.
///
/// The first channel is the time; its length is the number of complete frames and is written last.
/// Frames are buffered for kHold of wall time, then written together; for up to kLongestHold if
/// writing would take more than kWritingShare of the time.
class Hdf5File {
 public:
  /// Buffering times of a frame [s], and part of the time for writing [-].
  static constexpr double kHold = 0.05, kLongestHold = 0.5, kWritingShare = 0.02;

  /// Starts a new file. @throws FileError
  Hdf5File(const std::string& path, std::vector<Channel> channels,
           const std::vector<ChannelView>& views);
  /// Continues an existing file: keeps the frames up to t, drops later ones.
  /// @throws FileError; InputError if its channels differ.
  [[nodiscard]] static Hdf5File append_to(const std::string& path, std::vector<Channel> channels,
                                          double t);
  ~Hdf5File();  ///< Writes buffered frames; errors are lost, so call close() first.
  Hdf5File(Hdf5File&&) noexcept;

  void attribute(const std::string& group, const std::string& name, const std::string& value);
  void attribute(const std::string& group, const std::string& name, double value);
  void names(const std::string& path, const std::vector<std::string>& values);
  void numbers(const std::string& path, const std::vector<std::int64_t>& values);
  /// Writes constant vectors: one row each.
  void vectors(const std::string& path, const std::vector<Vec3>& values, const std::string& unit);

  /// Adds a frame: the numbers of all channels in order. @throws FileError
  void append(const std::vector<double>& frame);
  [[nodiscard]] std::size_t frames() const;
  /// Time of the last frame; nothing if there is none.
  [[nodiscard]] std::optional<double> last_time() const;
  /// Writes buffered frames. @throws FileError
  void flush();
  /// Waits until the disk has all frames. @throws FileError
  void sync();
  /// Gives a new file its name; append() does with the first frame. Until then it is beside it
  /// under a temporary one, so that readers find either no file or one that they can open. @throws
  /// FileError
  void publish();
  void close();

 private:
  Hdf5File();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode::io
