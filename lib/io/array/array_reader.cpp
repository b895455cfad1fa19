#include "io/array/array_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/memory.hpp"
#include "io/array/private/npy_parser.hpp"
#include "io/array/private/npz.hpp"
#include "io/stream/apart.hpp"
#include "io/stream/signature.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t most_packed = std::uint64_t{16} << 30;  // bytes of a .npz
constexpr std::uint64_t most_ratio = 1032;                      // bytes of which deflate makes one
constexpr std::string_view zip_magic = "PK\3\4";

// All of an archive, as its list is at its end.
std::string whole(InputFile& file) {
  std::string bytes;
  for (auto piece = file.peek(); !piece.empty(); piece = file.peek()) {
    if (bytes.size() + piece.size() > most_packed) {
      throw Error{Fault::data, file.name() + ": is larger than 16 GiB; unpack it and give the .npy"};
    }
    bytes.append(piece.data(), piece.size());
    file.skip(piece.size());
  }
  return bytes;
}

void send(npy::Parser parser, Sender& out) {
  for (const std::size_t size : parser.size()) out.put(std::uint64_t{size});
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
    require_known();
    if (packed) bytes = whole(file);
    // What repeats packs well: an array may unpack to as much as its bytes can hold, and as there is memory for.
    const std::uint64_t unpacked = packed ? std::min(most_ratio * bytes.size(), memory_left() / 2) : 0;
    apart.emplace(Foreign{file.name(), packed ? bytes.size() : file.size(), file.descriptor(), unpacked},
                  [this, &options](Sender& out) { parse(options, out); });
    apart->take([this](Receiver& in) { take_size(in); });
  }

  void require_known() {
    const auto head = file.peek();
    const std::string_view text(head.data(), head.size());
    packed = text.starts_with(zip_magic);
    const std::string_view start = text.substr(0, npy::magic.size());
    if (packed || (!start.empty() && npy::magic.starts_with(start))) return;
    const std::string foreign = foreign_format(text);
    throw Error{Fault::data, file.name() + ": " +
                                 (text.empty()      ? "is empty"
                                  : foreign.empty() ? "is not a NumPy array"
                                                    : "is " + foreign + ", not a NumPy array")};
  }

  void parse(const ArrayOptions& options, Sender& out) {
    if (!packed) {
      return send({[this](void* to, std::size_t count) { return file.read(to, count); }, file.name(), options.axes},
                  out);
    }
    npy::PackedArray array(bytes, options.name, file.name());
    send({[&](void* to, std::size_t count) { return array.read(to, count); }, file.name(), options.axes}, out);
  }

  // What a child sends is not believed.
  void take_size(Receiver& in) {
    size.images = static_cast<int>(in.get_count(npy::most_side));
    size.rows = static_cast<int>(in.get_count(npy::most_side));
    size.columns = static_cast<int>(in.get_count(npy::most_side));
    if (product(size.rows, size.columns) > npy::most_image) {
      throw Error{Fault::data, file.name() + ": is damaged: its reader failed"};
    }
  }

  InputFile file;
  bool packed = false;
  std::string bytes;
  std::optional<Apart> apart;
  ArraySize size;
  int done = 0;
};

ArrayReader::ArrayReader(const std::string& path, const ArrayOptions& options)
    : state_(std::make_unique<State>(path, options)) {}

ArrayReader::~ArrayReader() = default;

const ArraySize& ArrayReader::size() const { return state_->size; }

bool ArrayReader::next(Image& image) {
  if (state_->done == state_->size.images) return false;
  image = Image(state_->size.columns, state_->size.rows);
  state_->apart->take([&](Receiver& in) { in.get(image.values.data(), image.values.size() * sizeof(float)); });
  if (++state_->done == state_->size.images) state_->apart->finish();
  return true;
}

}  // namespace vam::io
