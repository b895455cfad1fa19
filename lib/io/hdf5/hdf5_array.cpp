// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/hdf5_array.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "io/hdf5/private/hdf5_file.hpp"
#include "io/hdf5/private/hdf5_images.hpp"
#include "io/hdf5/private/hdf5_tree.hpp"
#include "io/hdf5/private/hdf5_views.hpp"

namespace vam::io {

namespace {

using hdf5::api;
using hdf5::Handle;

/// Names of printable ASCII as a shell takes them; else a word for them.
bool is_shown(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= ' ' && c < 0x7f; });
}

std::string replaced(const std::string& text, char wanted, const std::string& by) {
  std::string out;
  for (const char c : text) out += c == wanted ? by : std::string(1, c);
  return out;
}

/// A word of the shell: in apostrophes where it has more than letters, figures and signs that the shell leaves alone.
std::string shell_word(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("/._-+").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return plain ? name : "'" + replaced(name, '\'', "'\\''") + "'";
}

/// A file name that no program takes for an option.
std::string shell_file(const std::string& name) {
  if (!is_shown(name)) return "FILE";
  return shell_word(name.starts_with('-') ? "./" + name : name);
}

/// A text of Python, in quotation marks.
std::string python_text(const std::string& text) {
  return "\"" + (is_shown(text) ? replaced(replaced(text, '\\', "\\\\"), '"', "\\\"") : std::string("DATASET")) + "\"";
}

/// What unpacks a dataset: Python knows LZF, and other filters by a package of it. h5repack knows neither.
std::string unpacking(H5Z_filter_t filter, const std::string& name, const std::string& path) {
  constexpr H5Z_filter_t lzf = 32000;
  const std::string data = python_text(path);
  return std::string("; unpack a copy in Python, by h5py") + (filter == lzf ? "" : " and hdf5plugin") + ": cp " +
         shell_file(name) + " plain.h5 && python3 -c '" +
         replaced(std::string("import h5py") + (filter == lzf ? "" : ", hdf5plugin") +
                      "; f = h5py.File(\"plain.h5\", \"a\"); v = f[" + data + "][()]; a = dict(f[" + data +
                      "].attrs); del f[" + data + "]; f[" + data + "] = v; f[" + data + "].attrs.update(a)",
                  '\'', "'\\''") +
         "'";
}

/// Throws Fault::data for values that are in other files or packed by no known filter.
void require_packing(hid_t properties, const std::string& name, const std::string& path) {
  const auto& h5 = api();
  const std::string subject = name + ": " + printable(path);
  if (h5.H5Pget_layout(properties) == H5D_VIRTUAL || h5.H5Pget_external_count(properties) > 0) {
    throw Error{Fault::data, subject + " has its values in other files; copy them into one"};
  }
  for (int i = 0; i < h5.H5Pget_nfilters(properties); ++i) {
    unsigned flags = 0;
    unsigned configuration = 0;
    std::size_t values = 0;
    std::array<char, 64> title{};
    const H5Z_filter_t filter = h5.H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &values, nullptr,
                                                  title.size() - 1, title.data(), &configuration);
    if (filter >= 0 && h5.H5Zfilter_avail(filter) > 0) continue;
    const std::string which = title[0] == '\0' ? "filter " + std::to_string(filter) : printable(title.data());
    throw Error{Fault::data,
                subject + " is packed by " + which + ", which is not read" + unpacking(filter, name, path)};
  }
}

/// What was never written would be read as zeros.
void require_written(hid_t dataset, const std::string& subject) {
  H5D_space_status_t status{};
  if (api().H5Dget_space_status(dataset, &status) < 0 || status != H5D_SPACE_STATUS_NOT_ALLOCATED) return;
  throw Error{Fault::data, subject + " has no values; the program that wrote it did not finish"};
}

std::vector<double> of_rows(const std::vector<double>& all, const std::vector<std::size_t>& rows, std::size_t frames) {
  if (all.size() != frames) return all;  // the user of them examines their number
  std::vector<double> kept;
  for (const std::size_t row : rows) kept.push_back(all[row]);
  return kept;
}

}  // namespace

void load_hdf5() { (void)api(); }

struct Hdf5Array::State {
  State(const Hdf5Bytes& there, const Hdf5Options& options, const std::string& name)
      : bytes(there), file(hdf5::open_file(bytes, name)) {
    const std::string path = hdf5::chosen_path(file.id(), options.dataset, name);
    const std::string subject = name + ": " + printable(path);
    dataset = hdf5::open_dataset(file.id(), path);
    const hdf5::Dataset about = hdf5::describe(dataset.id(), path);
    if (!about.holds.empty()) throw Error{Fault::data, subject + " holds " + about.holds + ", not numbers"};
    const auto shape = hdf5::three_axes(about.shape, subject);
    const Handle properties(api().H5Dget_create_plist(dataset.id()));
    require_packing(properties.id(), name, path);
    require_written(dataset.id(), subject);

    hdf5::Order order;
    std::copy(options.axes.begin(), options.axes.end(), order.axes.begin());
    hdf5::Convention convention;
    if (options.projections) convention = hdf5::convention_of(file.id(), path);
    if (convention.known && options.own_order && about.shape.size() == 3) {
      order.axes = {1, 0, 2};
      order.backwards = views.top_first = true;
    }
    const std::size_t frames = shape[order.axes[1]];
    order.rows.resize(frames);
    std::iota(order.rows.begin(), order.rows.end(), std::size_t{0});
    if (!convention.image_keys.empty()) {
      order.rows = hdf5::projections(file.id(), convention.image_keys, frames, name);
    }
    if (!convention.angles.empty()) {
      views.source = convention.angles;
      views.angles_deg = of_rows(hdf5::angles_deg(file.id(), convention.angles, name), order.rows, frames);
    }
    images.emplace(dataset.id(), std::move(order), options.memory, subject);
  }

  Hdf5Bytes bytes;
  Handle file;
  Handle dataset;
  StatedViews views;
  std::optional<hdf5::Images> images;
  std::vector<float> image;
  std::size_t used = 0;  // bytes of it
};

Hdf5Array::Hdf5Array(const Hdf5Bytes& bytes, const Hdf5Options& options, const std::string& name)
    : state_(std::make_unique<State>(bytes, options, name)) {}

Hdf5Array::~Hdf5Array() = default;

const std::array<std::uint64_t, 3>& Hdf5Array::size() const { return state_->images->size(); }

const StatedViews& Hdf5Array::views() const { return state_->views; }

std::size_t Hdf5Array::read(void* to, std::size_t size) {
  State& s = *state_;
  std::size_t got = 0;
  while (got < size) {
    if (s.used == s.image.size() * sizeof(float)) {
      if (!s.images->next(s.image)) break;
      s.used = 0;
    }
    const std::size_t step = std::min(size - got, s.image.size() * sizeof(float) - s.used);
    std::memcpy(static_cast<char*>(to) + got, reinterpret_cast<const char*>(s.image.data()) + s.used, step);
    s.used += step;
    got += step;
  }
  return got;
}

}  // namespace vam::io
