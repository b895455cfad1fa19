// The headers are parsed by OpenEXR from memory, the chunks are taken in the order of the stream, and the pixels of one
// image at a time are decoded by OpenEXR from memory. So a pipe does, memory is one image whatever the number of parts
// (Imf::MultiPartInputFile keeps the buffers of every part it has opened), and no size is believed before it is
// checked.
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "io/exr/private/attributes.hpp"
#include "io/exr/private/format.hpp"
#include "io/exr/private/layout.hpp"
#include "io/exr/private/seal_check.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

using model::ImageInfo;
using model::StackInfo;

// Parts may be interleaved; what has come too early waits in memory up to here.
constexpr std::size_t max_waiting_bytes = std::size_t{1} << 30;
constexpr std::size_t batch = 16;  // compressed images decoded at a time, in parallel
constexpr std::size_t absent = ~std::size_t{0};

struct Arriving {
  exr::Chunks chunks;
  int missing = 0;
};

void check_finite(const Image& image, std::size_t index) {
  if (all_finite(image.values.data(), image.size())) return;
  const auto bad = std::find_if(image.values.begin(), image.values.end(), [](float v) { return !std::isfinite(v); });
  const auto at = bad - image.values.begin();
  throw std::runtime_error("pixel " + std::to_string(at % image.width) + ", " + std::to_string(at / image.width) +
                           " of image " + std::to_string(index) + " is not a finite number");
}

void require_own_poses(const StackInfo& info) {
  if (info.poses.empty()) return;
  if (info.poses.size() != static_cast<std::size_t>(info.height)) {
    throw std::runtime_error("vam:poses has " + std::to_string(info.poses.size()) + " lines, but the images have " +
                             std::to_string(info.height) + " angles");
  }
  if (const std::string why = objection(info.poses, info.angle_start_deg, info.angle_step_deg); !why.empty()) {
    throw std::runtime_error("vam:poses: " + why);
  }
}

}  // namespace

struct StackReader::State {
  explicit State(const std::string& path) : in(path) { open(); }

  void open();
  void read_head();
  void add_part(const Imf::Header& header);
  void refill();
  Arriving complete_part();
  void take_chunk();
  void take(void* to, std::size_t size);
  template <class Number>
  Number take_number() {
    Number value{};
    take(&value, sizeof value);
    return value;
  }
  template <class Work>
  void as_data_fault(const Work& work) const;

  InputFile in;
  StackInfo info;
  std::vector<ImageInfo> about;
  bool multi_part = false;
  int announced = 0;                   // vam:count, 0 where it is absent
  std::vector<exr::Layout> layouts;    // distinct ones; nearly always one
  std::vector<std::size_t> layout_of;  // of every part
  std::map<std::size_t, Arriving> arriving;
  std::size_t waiting_bytes = 0;
  std::optional<exr::SealCheck> seals;  // of this stack
  std::uint64_t begin = 0;              // of the stack on the stream
  std::size_t complete = 0;             // parts taken off the stream
  std::deque<Image> ready;              // decoded images
  std::size_t done = 0;                 // images handed out
};

// What OpenEXR and the checks throw becomes an Error that names the file.
template <class Work>
void StackReader::State::as_data_fault(const Work& work) const {
  try {
    work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& problem) {
    std::string line = in.name() + ": " + problem.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    throw Error{Fault::data, line};
  }
}

void StackReader::State::take(void* to, std::size_t size) {
  if (in.read(to, size) == size) return;
  std::string where = "in its header";
  if (info.count > 0) where = "in image " + std::to_string(complete) + " of " + std::to_string(info.count);
  throw Error{Fault::data, in.name() + ": is cut off after " + std::to_string(in.position()) + " bytes, " + where +
                               "; the program that wrote it did not finish"};
}

void StackReader::State::open() {
  info = {};
  about.clear();
  layouts.clear();
  layout_of.clear();
  arriving.clear();
  seals.emplace();
  waiting_bytes = 0;
  complete = done = 0;
  begin = in.position();
  as_data_fault([this] { read_head(); });
}

void StackReader::State::read_head() {
  if (in.at_end()) throw std::runtime_error("is empty; the program that should have written it failed");
  std::int32_t first = 0;
  if (in.read(&first, sizeof first) != sizeof first || first != exr::magic) throw std::runtime_error("is not OpenEXR");
  const auto flags = take_number<std::int32_t>();
  if ((flags & 0xff) != exr::version) throw std::runtime_error("is of an OpenEXR version that is not known");
  if ((flags & (exr::tiled_flag | exr::deep_flag)) != 0) throw std::runtime_error("holds tiles or deep pixels");
  multi_part = (flags & exr::multi_part_flag) != 0;

  const auto take_bytes = [this](char* to, std::size_t size) { take(to, size); };
  do {
    const std::string bytes = exr::take_header(take_bytes);
    if (bytes.empty()) break;
    add_part(exr::parse_header(bytes, flags));
  } while (multi_part);
  if (about.empty()) throw std::runtime_error("has no image");
  const int parts = static_cast<int>(about.size());
  if (announced != 0 && announced != parts) {
    throw std::runtime_error("holds " + std::to_string(parts) + " of the " + std::to_string(announced) +
                             " images that vam:count announces");
  }
  info.count = parts;

  // The offset tables serve those who seek; here the chunks say themselves what they are.
  for (const std::size_t layout : layout_of) {
    for (int i = 0; i < layouts[layout].chunks; ++i) seals->note_offset(take_number<std::uint64_t>());
  }
  const std::string line = seals->chained();
  const bool named = !info.history.empty() && !chained_seal(info.history.back()).empty();
  if (!line.empty() && !named) info.history.push_back(line);
}

void StackReader::State::add_part(const Imf::Header& header) {
  exr::Layout layout = exr::checked_layout(header);
  if (about.empty()) {
    info = exr::stack_info(header);
    info.width = layout.width;
    info.height = layout.height;
    announced = std::exchange(info.count, 0);
    if (info.kind == model::Kind::sinogram) require_own_poses(info);
  }
  const std::string part = "part " + std::to_string(about.size());
  if (layout.width != info.width || layout.height != info.height) {
    throw std::runtime_error(part + " has another size than part 0");
  }
  about.push_back(exr::image_info(header, info, static_cast<int>(about.size())));
  StackInfo own = exr::stack_info(header);
  own.width = layout.width;
  own.height = layout.height;
  seals->begin_part(header, multi_part, own, about.back());
  const auto known =
      std::find_if(layouts.begin(), layouts.end(), [&](const exr::Layout& l) { return l.key == layout.key; });
  layout_of.push_back(static_cast<std::size_t>(known - layouts.begin()));
  if (known == layouts.end()) layouts.push_back(std::move(layout));
}

void StackReader::State::take_chunk() {
  const std::uint64_t start = in.position() - begin;
  const std::int32_t part = multi_part ? take_number<std::int32_t>() : 0;
  const auto y = take_number<std::int32_t>();
  const auto size = take_number<std::int32_t>();
  const auto index = static_cast<std::size_t>(part);
  if (part < 0 || index >= layout_of.size() || index < complete) throw std::runtime_error("has a chunk of no part");
  const exr::Layout& layout = layouts[layout_of[index]];
  const std::int64_t row = std::int64_t{y} - layout.header.dataWindow().min.y;
  const int rows = exr::rows_per_chunk(layout.header.compression());
  const auto place = static_cast<std::size_t>(row / rows);
  Arriving& image = arriving[index];
  if (image.chunks.starts.empty()) {
    image.chunks.starts.assign(layout.chunks, absent);
    image.missing = layout.chunks;
  }
  if (row < 0 || row >= layout.height || row % rows != 0 || image.chunks.starts[place] != absent || size < 0 ||
      static_cast<std::size_t>(size) > layout.max_chunk_bytes) {
    throw std::runtime_error("image " + std::to_string(index) + " has a damaged chunk near byte " +
                             std::to_string(in.position()));
  }
  // The table's order is part by part, row by row.
  const bool in_order =
      index == complete && place + static_cast<std::size_t>(image.missing) == image.chunks.starts.size();
  seals->note_chunk(start, in_order);
  std::string& bytes = image.chunks.bytes;
  image.chunks.starts[place] = bytes.size();
  exr::append(bytes, y);
  exr::append(bytes, size);
  const std::size_t at = bytes.size();
  bytes.resize(at + static_cast<std::size_t>(size));
  take(bytes.data() + at, static_cast<std::size_t>(size));
  --image.missing;
  waiting_bytes += bytes.size() - at + 8;
  if (waiting_bytes > max_waiting_bytes && index != complete) {
    throw std::runtime_error("has its parts interleaved; exrmultipart -combine puts them in order");
  }
}

Arriving StackReader::State::complete_part() {
  while (arriving[complete].chunks.starts.empty() || arriving[complete].missing > 0) take_chunk();
  Arriving image = std::move(arriving[complete]);
  arriving.erase(complete);
  waiting_bytes -= image.chunks.bytes.size();
  ++complete;
  return image;
}

// Uncompressed images come one by one, so that a live stream is not held up; compressed ones are decoded in parallel.
void StackReader::State::refill() {
  const std::size_t first = complete;
  const bool raw = layouts[layout_of[first]].header.compression() == Imf::NO_COMPRESSION;
  const std::size_t count = std::min(raw ? 1 : batch, about.size() - first);
  std::vector<exr::Chunks> taken;
  for (std::size_t i = 0; i < count; ++i) taken.push_back(complete_part().chunks);
  ready.assign(count, Image(info.width, info.height));
  parallel_for(static_cast<int>(count), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    exr::decode(layouts[layout_of[first + at]].header, taken[at], ready[at]);
    check_finite(ready[at], first + at);
    seals->note_image(first + at, ready[at]);
  });
  seals->judge(first, first + count);
  if (complete == about.size()) seals->finish([this](char* to, std::size_t size) { take(to, size); });
}

StackReader::StackReader(const std::string& path) : state_(std::make_unique<State>(path)) {}
StackReader::~StackReader() = default;
std::string StackReader::seal() const { return chained_seal(state_->seals->chained()); }
bool StackReader::is_sealed() const { return state_->seals->sealed(); }
const StackInfo& StackReader::info() const { return state_->info; }
const std::vector<ImageInfo>& StackReader::about() const { return state_->about; }

bool StackReader::next(Image& image, ImageInfo& about) {
  State& state = *state_;
  if (state.done == state.about.size()) return false;
  if (state.ready.empty()) state.as_data_fault([&state] { state.refill(); });
  image = std::move(state.ready.front());
  state.ready.pop_front();
  about = state.about[state.done++];
  return true;
}

bool StackReader::next_stack() {
  if (state_->done != state_->about.size()) throw Error{Fault::bug, state_->in.name() + ": images are left unread"};
  if (state_->in.at_end()) return false;
  state_->open();
  return true;
}

void require(const std::string& path, const StackInfo& info, model::Kind kind) {
  if (info.kind == kind) return;
  throw Error{Fault::data, input_name(path) + ": holds " + exr::kind_name(info.kind) + " (" +
                               exr::space_name(info.space) + "), but " + exr::kind_name(kind) + " is needed"};
}

void require(const std::string& path, const StackInfo& info, model::Kind kind, model::Space space) {
  if (info.kind == kind && info.space == space) return;
  throw Error{Fault::data, input_name(path) + ": holds " + exr::kind_name(info.kind) + " (" +
                               exr::space_name(info.space) + "), but " + exr::kind_name(kind) + " (" +
                               exr::space_name(space) + ") is needed"};
}

}  // namespace vam::io
