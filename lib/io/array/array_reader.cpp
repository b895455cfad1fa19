// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/system_error.hpp"
#include "io/array/array_file.hpp"
#include "io/array/private/array.hpp"
#include "io/image/tiff_pages.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/sandboxed_reader.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t most_held = std::uint64_t{16} << 30;  // bytes of a file that is not read front to back
constexpr std::uint64_t most_ratio = 1032;                    // bytes of which deflate makes one

constexpr const char* known_formats = "an array (NumPy, HDF5, NRRD, TIFF)";

enum class Format { npy, npz, hdf5, nrrd, tiff };

// Behind a block of the writer's own (MATLAB's), too.
bool is_hdf5(std::string_view head) {
  constexpr std::string_view magic = "\x89HDF\r\n\x1a\n";
  for (const std::size_t at : {0, 512, 1024, 2048}) {
    if (head.size() > at && head.substr(at).starts_with(magic)) return true;
  }
  return !head.empty() && magic.starts_with(head);
}

std::optional<Format> format_of(std::string_view head) {
  using namespace std::string_view_literals;
  const auto begins = [&](std::string_view magic) {  // a pipe may show less of it
    const std::string_view start = head.substr(0, magic.size());
    return !start.empty() && magic.starts_with(start);
  };
  if (begins(arrays::npy_magic)) return Format::npy;
  if (begins("PK\3\4"sv)) return Format::npz;
  if (is_hdf5(head)) return Format::hdf5;
  if (begins(arrays::nrrd_magic)) return Format::nrrd;
  if (begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv)) return Format::tiff;
  return std::nullopt;
}

// Those of a file, which take addresses and no memory; the child inherits them.
std::shared_ptr<const char> mapped_bytes(const InputFile& file) {
  void* bytes = mmap(nullptr, file.size(), PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
  if (bytes == MAP_FAILED) {
    throw system_error(Fault::memory, file.name() + ": cannot map it", errno,
                       "raise the limit on addresses (ulimit -v)");
  }
  return {static_cast<const char*>(bytes), [size = file.size(), bytes](const char*) { munmap(bytes, size); }};
}

void send(arrays::Parser parser, Sender& out, double voxel_mm = 0) {
  for (const std::size_t size : parser.size()) out.put(std::uint64_t{size});
  out.put(voxel_mm);
  out.flush();
  Image image;
  for (std::size_t k = 0; k < parser.size()[0]; ++k) {
    parser.next(image);
    out.put(image.values.data(), image.values.size() * sizeof(float));
    out.flush();
  }
}

}  // namespace

struct ArrayReader::State {
  State(const std::string& path, const ArrayOptions& options) : file(path) {
    const auto start = file.peek();
    const std::string_view head(start.data(), start.size());
    const auto known = format_of(head);
    if (!known) refuse(head);
    format = *known;
    if (format == Format::hdf5) arrays::load_hdf5();
    const bool mapped = format == Format::hdf5 && file.size() > 0;
    const bool held = format == Format::npz || format == Format::tiff || (format == Format::hdf5 && !mapped);
    if (held) bytes = read_all(file, most_held);  // its list of contents may be at the end
    if (mapped) map = mapped_bytes(file);
    // What repeats packs well: an array may unpack to as much as its bytes can hold, and as there is memory for.
    const std::uint64_t length = held ? bytes.size() : file.size();
    const bool packed = held || mapped;
    const std::uint64_t unpacked = packed ? std::min(most_ratio * length, memory_left() / 2) : 0;
    apart.emplace(Foreign{file.name(), length, file.descriptor(), unpacked},
                  [this, &options](Sender& out) { parse(options, out); });
    apart->take([this](Receiver& in) { take_size(in); });
  }

  [[noreturn]] void refuse(std::string_view head) const {
    const std::string foreign = foreign_format(head);
    throw Error{Fault::data,
                file.name() + ": " +
                    (head.empty()      ? "is empty"
                     : foreign.empty() ? std::string("is not ") + known_formats
                                       : "is " + foreign + ", not " + known_formats + foreign_remedy(head))};
  }

  void parse(const ArrayOptions& options, Sender& out) {
    using arrays::Bytes;
    if (format == Format::npz) {
      ZipArchive archive(bytes, ".npz", false);
      std::uint64_t stated = 0;
      Bytes unpacked = arrays::open_array(archive, options.name, file.name(), stated);
      const arrays::Head head = take_npy_head(unpacked);
      arrays::require_values(head, stated);
      return send({head, std::move(unpacked), options.axes, options.reversed}, out);
    }
    if (format == Format::tiff) {
      TiffPages about;
      Bytes values(open_tiff_pages(std::move(bytes), about));
      arrays::Head head;
      head.kind = about.kind;
      head.bytes = about.value_bytes;
      set_shape({about.pages, about.rows, about.columns}, head);
      return send({head, std::move(values), options.axes, options.reversed}, out);
    }
    if (format == Format::hdf5) {
      const std::string_view all = map == nullptr ? std::string_view(bytes) : std::string_view(map.get(), file.size());
      arrays::Head head;
      Bytes values = arrays::open_hdf5(all, options.name, file.name(), head);
      return send({head, std::move(values), options.axes, options.reversed}, out);
    }
    Bytes front([this](void* to, std::size_t wanted) { return file.read(to, wanted); });
    double stated_mm = 0;
    const arrays::Head head = format == Format::npy ? take_npy_head(front) : take_nrrd_head(front, stated_mm);
    send({head, std::move(front), options.axes, options.reversed}, out, stated_mm);
  }

  // What a child sends is not believed.
  void take_size(Receiver& in) {
    size.images = static_cast<int>(in.get_count(arrays::most_side));
    size.rows = static_cast<int>(in.get_count(arrays::most_side));
    size.columns = static_cast<int>(in.get_count(arrays::most_side));
    if (product(size.rows, size.columns) > arrays::most_image) {
      throw Error{Fault::data, file.name() + ": is damaged (its parser failed)"};
    }
    in.fill(voxel_mm);
  }

  InputFile file;
  Format format = Format::npy;
  std::string bytes;
  std::shared_ptr<const char> map;
  std::optional<SandboxedReader> apart;
  ArraySize size;
  double voxel_mm = 0;
  int done = 0;
};

ArrayReader::ArrayReader(const std::string& path, const ArrayOptions& options)
    : state_(std::make_unique<State>(path, options)) {}

ArrayReader::~ArrayReader() = default;

const ArraySize& ArrayReader::size() const { return state_->size; }

double ArrayReader::voxel_mm() const { return state_->voxel_mm; }

bool ArrayReader::has_pages() const { return state_->format == Format::tiff; }

bool ArrayReader::next(Image& image) {
  if (state_->done == state_->size.images) return false;
  image = Image(state_->size.columns, state_->size.rows);
  state_->apart->take([&](Receiver& in) { in.get(image.values.data(), image.values.size() * sizeof(float)); });
  if (++state_->done == state_->size.images) state_->apart->finish();
  return true;
}

}  // namespace vam::io
