// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/checksums.hpp>
#include <polhode/io/results/hdf5_file.hpp>
#include <polhode/io/results/hdf5_id.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/io/text/output_file.hpp>

namespace polhode::io {

namespace {

using Clock = std::chrono::steady_clock;
using Dims = std::vector<hsize_t>;

/// Chunks of about this many bytes: few enough to index, small enough to rewrite.
constexpr std::size_t kChunkBytes = 65536;
/// Half the number of entries of an index node: no node splits before a channel has 1,024 chunks,
/// and a split is the only change of the index that could be corrupted by a kill.
constexpr unsigned kIndexHalfSize = 512;
/// Buffer size for the conversion of a list of names [bytes]. HDF5 would clear a whole mebibyte for
/// every list, a third of the time of a short run.
constexpr std::size_t kNamesBytes = 4096;
/// Step of the length that is announced ahead [bytes]; the disk holds nothing of it.
constexpr hsize_t kAheadBytes = hsize_t{4} << 20;
/// Largest memory for buffered frames.
constexpr std::size_t kHoldBytes = std::size_t{8} << 20;

using hdf5::Id;

Id access_properties() {
  Id fapl(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(fapl.get(), false, true);  // A run may be read while it continues.
#endif
  return fapl;
}

Id link_properties() {
  Id lcpl(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(lcpl.get(), 1);
  return lcpl;
}

Id dataspace(const Dims& now, const Dims& most) {
  return {H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), H5Sclose};
}

/// Shape of a channel with that many frames.
Dims shape(const Channel& channel, hsize_t frames) {
  Dims dims{frames};
  dims.insert(dims.end(), channel.dims.begin(), channel.dims.end());
  return dims;
}

Id text_type() {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

}  // namespace

std::size_t Channel::size() const {
  return std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
}

struct Hdf5File::Impl {
  std::string path;
  std::unique_ptr<UnfinishedFile> unnamed;  ///< Until publish().
  std::vector<Channel> channels;
  Id file;
  std::vector<Id> datasets;
  hsize_t written = 0;       ///< Frames in the file.
  std::vector<double> held;  ///< Buffered frames.
  std::size_t held_frames = 0;
  std::size_t frame_size = 0, given_size = 0;  ///< Numbers of a frame, with and without checksums.
  Clock::time_point last_write = Clock::now();
  double hold = kHold;  ///< Buffering time of the next frames [s].
  std::optional<double> last_time;
  bool failed = false;

  [[noreturn]] void fail(const char* what) {
    failed = true;
    throw FileError(path, what, "Check that the folder exists, is writable and has space");
  }
  void require(herr_t status, const char* what) {
    if (status < 0) fail(what);
  }

  /// @param checked  Checksums are stored: a last channel with a number for each other one.
  void set_channels(std::vector<Channel> list, bool checked) {
    channels = std::move(list);
    given_size = 0;
    for (const Channel& c : channels) given_size += c.size();
    frame_size = given_size;
    if (!checked) return;
    frame_size += channels.size();
    channels.push_back({results::kChecksums, {channels.size()}, "-", true});
  }

  void create_channel(const Channel& c) {
    const Dims now = shape(c, 0);
    const Dims most = shape(c, H5S_UNLIMITED);
    const std::size_t per_chunk =
        std::clamp<std::size_t>(kChunkBytes / std::max<std::size_t>(1, 8 * c.size()), 1, 1024);
    Dims chunk = shape(c, per_chunk);
    for (hsize_t& n : chunk) n = std::max<hsize_t>(n, 1);
    const Id space = dataspace(now, most);
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
    const Id links = link_properties();
    Id dataset(H5Dcreate2(file.get(), c.path.c_str(), c.integer ? H5T_STD_I64LE : H5T_IEEE_F64LE,
                          space.get(), links.get(), properties.get(), H5P_DEFAULT),
               H5Dclose);
    if (!dataset.valid()) fail("cannot be written");
    text_attribute(dataset.get(), "unit", c.unit);
    if (c.path != results::kChecksums)
      number_attribute(dataset.get(), results::kChecksumColumn,
                       static_cast<double>(datasets.size()));
    datasets.push_back(std::move(dataset));
  }

  void create_view(const ChannelView& v) {
    const Channel& c = channels[v.channel];
    const Dims inner(c.dims.begin() + 1, c.dims.end());
    const Dims source_now = shape(c, 0);
    const Dims source_most = shape(c, H5S_UNLIMITED);
    Dims now{0};
    if (!v.squeeze) now.push_back(v.count);
    now.insert(now.end(), inner.begin(), inner.end());
    Dims most = now;
    most[0] = H5S_UNLIMITED;

    const Id view = dataspace(now, most), source = dataspace(source_now, source_most);
    const auto select = [&](const Id& space, Dims start, Dims block) {
      Dims count(block.size(), 1);
      count[0] = H5S_UNLIMITED;
      const Dims stride(block.size(), 1);
      require(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), stride.data(),
                                  count.data(), block.data()),
              "cannot be written");
    };
    Dims start(source_now.size(), 0);
    start[1] = v.first;
    Dims block = source_now;
    block[0] = 1;
    block[1] = v.count;
    select(source, start, block);
    Dims view_block = now;
    view_block[0] = 1;
    select(view, Dims(now.size(), 0), view_block);

    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require(H5Pset_virtual(properties.get(), view.get(), ".", c.path.c_str(), source.get()),
            "cannot be written");
    const Id links = link_properties();
    const Id dataset(
        H5Dcreate2(file.get(), v.path.c_str(), c.integer ? H5T_STD_I64LE : H5T_IEEE_F64LE,
                   view.get(), links.get(), properties.get(), H5P_DEFAULT),
        H5Dclose);
    if (!dataset.valid()) fail("cannot be written");
    text_attribute(dataset.get(), "unit", v.unit.empty() ? c.unit : v.unit);
  }

  void text_attribute(hid_t object, const std::string& name, const std::string& value) {
    const Id type = text_type();  // Of any length: Python reads it as text, not as bytes.
    const char* text = value.c_str();
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    // A new text takes the place of the old one, so that the header of the object does not grow.
    const Id attribute(
        H5Aexists(object, name.c_str()) > 0
            ? H5Aopen(object, name.c_str(), H5P_DEFAULT)
            : H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    if (!attribute.valid()) fail("cannot be written");
    require(H5Awrite(attribute.get(), type.get(), &text), "cannot be written");
  }

  void number_attribute(hid_t object, const std::string& name, double value) {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    const Id attribute(
        H5Acreate2(object, name.c_str(), H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    if (!attribute.valid()) fail("cannot be written");
    require(H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &value), "cannot be written");
  }

  /// The group of that path, made if it is missing.
  Id group(const std::string& name) {
    if (name == "/" || H5Lexists(file.get(), name.c_str(), H5P_DEFAULT) > 0)
      return {H5Oopen(file.get(), name.c_str(), H5P_DEFAULT), H5Oclose};
    const Id links = link_properties();
    return {H5Gcreate2(file.get(), name.c_str(), links.get(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
  }

  /// Writes the buffered frames of one channel, whose numbers start at `offset` in a frame.
  void write_channel(std::size_t index, std::size_t offset) {
    const Channel& c = channels[index];
    const std::size_t size = c.size();
    std::vector<double> values(held_frames * size);
    for (std::size_t k = 0; k < held_frames; ++k)
      std::copy_n(held.begin() + static_cast<std::ptrdiff_t>(k * frame_size + offset), size,
                  values.begin() + static_cast<std::ptrdiff_t>(k * size));
    const Dims all = shape(c, written + held_frames);
    require(H5Dset_extent(datasets[index].get(), all.data()), "cannot be extended");
    const Dims part = shape(c, held_frames);
    Dims start(part.size(), 0);
    start[0] = written;
    const Id memory = dataspace(part, part);
    const Id target(H5Dget_space(datasets[index].get()), H5Sclose);
    H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
    require(H5Dwrite(datasets[index].get(), H5T_NATIVE_DOUBLE, memory.get(), target.get(),
                     H5P_DEFAULT, values.data()),
            "cannot be written");
  }

  /// Writes the future length of the file into its first block before any reference to the new
  /// data. HDF5 itself would write it last: a kill in between would leave data beyond the recorded
  /// end, and a reader that has read the first block would not accept what comes then.
  /// @param ahead  Announces more than is needed now, in large steps, so that it seldom changes;
  /// the file itself is one step longer, as readers ask for its length first.
  void announce_length(bool ahead) {
    hsize_t length = 0;
    if (H5Fget_filesize(file.get(), &length) < 0) return;
    if (ahead) length = (length / kAheadBytes + 2) * kAheadBytes;
    const auto size = static_cast<off_t>(length + (ahead ? kAheadBytes : 0));
    const std::string& name = unnamed ? unnamed->path() : path;
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) return;
    std::array<unsigned char, 9> head{};
    const bool readable = ::pread(descriptor, head.data(), head.size(), 0) == 9;
    // Format of the first block: the length is at byte 40 in version 0, at 44 in version 1.
    if (readable && head[0] == 0x89 && head[1] == 'H' && head[8] <= 1) {
      const off_t place = head[8] == 0 ? 40 : 44;
      const off_t now = ::lseek(descriptor, 0, SEEK_END);
      if (now >= size || ::ftruncate(descriptor, size) == 0) {
        const std::uint64_t value = length;
        if (::pwrite(descriptor, &value, sizeof value, place) != sizeof value)
          errno = 0;  // The following flush has and reports the same error.
      }
    }
    ::close(descriptor);
  }

  void flush_file() {
    announce_length(true);
    require(H5Fflush(file.get(), H5F_SCOPE_LOCAL), "cannot be written to the disk");
    announce_length(true);  // HDF5 has announced its own.
  }

  /// Cuts off what was announced and not needed.
  void end_exactly() {
    announce_length(false);
    hsize_t length = 0;
    if (H5Fget_filesize(file.get(), &length) >= 0 &&
        ::truncate(path.c_str(), static_cast<off_t>(length)) != 0)
      errno = 0;  // A longer file is read as well.
  }

  void write_held() {
    if (held_frames == 0) return;
    const Clock::time_point begin = Clock::now();
    // Nobody reads a file without a name: a time before all else keeps its index before the frames.
    const bool first = written == 0 && unnamed;
    if (first) write_channel(0, 0);
    std::size_t offset = channels[0].size();
    for (std::size_t i = 1; i < channels.size(); offset += channels[i++].size())
      write_channel(i, offset);
    flush_file();
    if (!first) {
      write_channel(0, 0);  // The time last: its length is the number of complete frames.
      flush_file();
    }
    written += held_frames;
    held_frames = 0;
    held.clear();
    last_write = Clock::now();
    const std::chrono::duration<double> took = last_write - begin;
    hold = std::clamp(took.count() / kWritingShare, kHold, kLongestHold);
  }
};

Hdf5File::Hdf5File() : impl_(std::make_unique<Impl>()) {}
Hdf5File::Hdf5File(Hdf5File&&) noexcept = default;

Hdf5File::Hdf5File(const std::string& path, std::vector<Channel> channels,
                   const std::vector<ChannelView>& views)
    : Hdf5File() {
  hdf5::prepare();
  Impl& m = *impl_;
  m.path = path;
  m.set_channels(std::move(channels), true);
  const Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_istore_k(creation.get(), kIndexHalfSize);
  const Id access = access_properties();
  m.unnamed = std::make_unique<UnfinishedFile>(path);
  m.file = Id(H5Fcreate(m.unnamed->path().c_str(), H5F_ACC_TRUNC, creation.get(), access.get()),
              H5Fclose);
  if (!m.file.valid()) m.fail("cannot be written");
  for (const Channel& c : m.channels) m.create_channel(c);
  for (const ChannelView& v : views) m.create_view(v);
  m.number_attribute(m.group("/").get(), results::kChecksumColumns,
                     static_cast<double>(m.channels.size() - 1));
}

Hdf5File Hdf5File::append_to(const std::string& path, std::vector<Channel> channels, double t) {
  hdf5::prepare();
  Hdf5File result;
  Impl& m = *result.impl_;
  m.path = path;
  if (!results::survives_a_walk(path)) m.fail("is damaged: its structure is broken");
  const Id access = access_properties();
  m.file = Id(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()), H5Fclose);
  if (!m.file.valid()) m.fail("cannot be opened as results");
  // Files of earlier versions have no checksums.
  const Id checksums(H5Dopen2(m.file.get(), results::kChecksums, H5P_DEFAULT), H5Dclose);
  m.set_channels(std::move(channels), checksums.valid());
  const auto misfit = [&](const std::string& what) {
    return InputError(path, what, "Name another folder for the results with -o");
  };
  for (const Channel& c : m.channels) {
    Id dataset(H5Dopen2(m.file.get(), c.path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.valid()) throw misfit(format("has no data set '{}'", c.path));
    const Id space(H5Dget_space(dataset.get()), H5Sclose);
    Dims found(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
    H5Sget_simple_extent_dims(space.get(), found.data(), nullptr);
    if (found != shape(c, found.empty() ? 0 : found[0]))
      throw misfit(format("belongs to another model: '{}' has another shape", c.path));
    m.datasets.push_back(std::move(dataset));
    if (m.datasets.size() == 1) {
      std::vector<double> times(found[0]);
      m.require(H5Dread(m.datasets[0].get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                        times.data()),
                "cannot be read");
      // Times that do not grow are of frames that a kill left incomplete.
      for (const double time : times) {
        if (time > t * (1.0 + 1e-14) || (m.last_time && time <= *m.last_time)) break;
        m.last_time = time;
        ++m.written;
      }
    }
  }
  for (std::size_t i = 0; i < m.channels.size(); ++i) {
    const Dims all = shape(m.channels[i], m.written);
    m.require(H5Dset_extent(m.datasets[i].get(), all.data()),
              "cannot be shortened to the time of the restart");
  }
  m.flush_file();
  return result;
}

Hdf5File::~Hdf5File() {
  if (!impl_) return;
  try {
    if (!impl_->failed) close();
  } catch (const FileError&) {  // close() reports errors.
  }
  if (!impl_->failed) return;
  for (Id& dataset : impl_->datasets) dataset.abandon();
  impl_->file.abandon();
}

void Hdf5File::attribute(const std::string& group, const std::string& name,
                         const std::string& value) {
  const Id object = impl_->group(group);
  impl_->text_attribute(object.get(), name, value);
}

void Hdf5File::attribute(const std::string& group, const std::string& name, double value) {
  const Id object = impl_->group(group);
  impl_->number_attribute(object.get(), name, value);
}

void Hdf5File::names(const std::string& path, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  pointers.reserve(values.size());
  for (const std::string& v : values) pointers.push_back(v.c_str());
  const Id type = text_type();
  const Id space = dataspace({values.size()}, {values.size()});
  const Id links = link_properties();
  const Id dataset(H5Dcreate2(impl_->file.get(), path.c_str(), type.get(), space.get(), links.get(),
                              H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  if (!dataset.valid()) impl_->fail("cannot be written");
  const Id transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_buffer(transfer.get(), kNamesBytes, nullptr, nullptr);
  if (!values.empty())
    impl_->require(
        H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, transfer.get(), pointers.data()),
        "cannot be written");
  impl_->number_attribute(dataset.get(), results::kListChecksum, results::checksum(values));
}

void Hdf5File::numbers(const std::string& path, const std::vector<std::int64_t>& values) {
  const Id space = dataspace({values.size()}, {values.size()});
  const Id links = link_properties();
  const Id dataset(H5Dcreate2(impl_->file.get(), path.c_str(), H5T_STD_I64LE, space.get(),
                              links.get(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  if (!dataset.valid()) impl_->fail("cannot be written");
  if (!values.empty())
    impl_->require(
        H5Dwrite(dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "cannot be written");
  impl_->number_attribute(
      dataset.get(), results::kListChecksum,
      results::checksum(std::vector<double>(values.begin(), values.end()), true));
}

void Hdf5File::vectors(const std::string& path, const std::vector<Vec3>& values,
                       const std::string& unit) {
  const Dims dims{values.size(), 3};
  const Id space = dataspace(dims, dims);
  const Id links = link_properties();
  const Id dataset(H5Dcreate2(impl_->file.get(), path.c_str(), H5T_IEEE_F64LE, space.get(),
                              links.get(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  if (!dataset.valid()) impl_->fail("cannot be written");
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  if (!values.empty())
    impl_->require(
        H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "cannot be written");
  impl_->text_attribute(dataset.get(), "unit", unit);
  const std::span<const double> numbers(values.empty() ? nullptr : values.front().data(),
                                        3 * values.size());
  impl_->number_attribute(dataset.get(), results::kListChecksum, results::checksum(numbers, false));
}

void Hdf5File::append(const std::vector<double>& frame) {
  Impl& m = *impl_;
  if (frame.size() != m.given_size)
    throw std::logic_error("Hdf5File::append: a frame of another size");
  if (m.held.capacity() == 0) m.held.reserve(kHoldBytes / 8 + m.frame_size);  // no copies later
  m.held.insert(m.held.end(), frame.begin(), frame.end());
  m.last_time = frame.front();
  if (m.frame_size > m.given_size) {
    const double* numbers = frame.data();
    for (std::size_t i = 0; i + 1 < m.channels.size(); ++i) {
      const std::size_t size = m.channels[i].size();
      m.held.push_back(results::checksum({numbers, size}, m.channels[i].integer));
      numbers += size;
    }
  }
  ++m.held_frames;
  const std::chrono::duration<double> waited = Clock::now() - m.last_write;
  if (m.written == 0 || waited.count() > m.hold || 8 * m.held.size() > kHoldBytes) m.write_held();
  publish();  // With its first frame, so that every data set has its index.
}

std::size_t Hdf5File::frames() const { return impl_->written + impl_->held_frames; }

std::optional<double> Hdf5File::last_time() const { return impl_->last_time; }

void Hdf5File::flush() {
  impl_->write_held();
  impl_->flush_file();
  publish();
}

void Hdf5File::sync() {
  flush();
  wait_for_disk(impl_->path);
}

void Hdf5File::publish() {
  if (!impl_->unnamed) return;
  if (impl_->written == 0) impl_->flush_file();
  impl_->unnamed->keep(false);
  impl_->unnamed.reset();
}

void Hdf5File::close() {
  Impl& m = *impl_;
  if (!m.file.valid()) return;
  m.write_held();
  publish();
  m.datasets.clear();
  m.flush_file();
  m.end_exactly();
  m.require(m.file.close(), "cannot be closed");
}

}  // namespace polhode::io
