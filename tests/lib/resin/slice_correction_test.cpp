// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/slice_correction.hpp"

#include <cstdlib>
#include <limits>

#include "base/compute/parallel.hpp"
#include "lib/resin/corrected_column.hpp"
#include "testing.hpp"

using namespace vam;
using resin::ExposureMode;

namespace {

constexpr int width = 23;
constexpr int height = 5;

// Voxels of random runs along the columns, value(k, p) at k * width * height + p; every third column is empty at the
// end.
std::vector<float> random_part(int slices, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> length(1, 40);
  std::vector<float> values(static_cast<std::size_t>(width * height * slices));
  for (int p = 0; p < width * height; ++p) {
    bool solid = random() % 2 == 0;
    for (int k = 0; k < slices;) {
      const int end = std::min(slices, k + length(random));
      for (; k < end; ++k) {
        const bool kept = solid && p != 7 && (p % 3 != 0 || k < slices - 30);
        values[k * width * height + p] = kept ? 0.75F : 0.25F;
      }
      solid = !solid;
    }
  }
  return values;
}

std::vector<std::uint8_t> column_of(const std::vector<float>& values, int slices, int p) {
  std::vector<std::uint8_t> column;
  for (int k = 0; k < slices; ++k) column.push_back(values[k * width * height + p] > 0.5F);
  return column;
}

resin::PartColumns part_of(const std::vector<float>& values, int slices, ExposureMode exposure) {
  resin::PartColumns part(width, height, slices, exposure);
  for (int p = 0; p < width * height; ++p) {
    const auto column = column_of(values, slices, p);
    for (int k = 0; k < slices; ++k) part.fill(static_cast<std::size_t>(p), k, 1, column[k] != 0);
  }
  return part;
}

resin::CureLimits limits_for(ExposureMode exposure) {
  return resin::limits_of(resin::Process{.exposure = exposure, .absorbance_height_um = 700});
}

}  // namespace

TEST_CASE("runs of a column are found from any of their nodes") {
  for (const int slices : {1, 63, 64, 65, 200}) {
    for (const auto exposure : {ExposureMode::continuous, ExposureMode::layered}) {
      const auto values = random_part(slices, static_cast<unsigned>(slices));
      const resin::PartColumns part = part_of(values, slices, exposure);
      for (int p = 0; p < width * height; ++p) {
        const auto slice_bits = column_of(values, slices, p);
        const auto nodes = test::nodes_of(slice_bits, exposure);
        REQUIRE(static_cast<int>(nodes.size()) == part.nodes());
        for (int n = 0; n < part.nodes(); ++n) {
          const auto same = [&](int m) { return nodes[m] == nodes[n]; };
          int first = n;
          int last = n;
          while (first > 0 && same(first - 1)) --first;
          while (last + 1 < part.nodes() && same(last + 1)) ++last;
          const resin::NodeRun run = part.run(static_cast<std::size_t>(p), n);
          REQUIRE(run.first == first);
          REQUIRE(run.last == last);
          REQUIRE(run.inside == (nodes[n] != 0));
        }
      }
    }
  }
}

TEST_CASE("columns filled piece by piece, in any order, are those of dense slices") {
  for (const int slices : {1, 63, 64, 65, 200}) {
    CAPTURE(slices);
    const auto values = random_part(slices, static_cast<unsigned>(slices));
    resin::PartColumns part(width, height, slices, ExposureMode::layered);
    std::mt19937 random(3);
    for (int p = 0; p < width * height; ++p) {
      const auto column = column_of(values, slices, p);
      part.fill(static_cast<std::size_t>(p), 0, slices, true);  // to be overwritten
      std::vector<int> starts;
      for (int n = 0; n < slices; n += 37) starts.push_back(n);
      std::shuffle(starts.begin(), starts.end(), random);
      for (const int first : starts) {
        const int count = std::min(37, slices - first);
        std::uint64_t bits = ~std::uint64_t{0} << count;  // those beyond `count` do not matter
        for (int b = 0; b < count; ++b) {
          bits |= static_cast<std::uint64_t>(column[first + b]) << b;
        }
        part.put(static_cast<std::size_t>(p), first, count, bits);
      }
      for (int n = 0; n < slices; ++n) {
        REQUIRE(part.next_slice(static_cast<std::size_t>(p), n, column[n] != 0) == n);
      }
    }
    const std::size_t size = width * height;
    for (const int first : {0, slices / 3}) {
      std::vector<float> dense(size * static_cast<std::size_t>(slices - first), -1.0F);
      part.unpack(first, slices - first, dense.data());
      for (std::size_t i = 0; i < dense.size(); ++i) {
        REQUIRE(dense[i] == (values[static_cast<std::size_t>(first) * size + i] > 0.5F ? 1.0F : 0.0F));
      }
    }
  }
}

TEST_CASE("a survey counts columns and features") {
  const int slices = 150;
  const auto values = random_part(slices, 9);
  const resin::PartSurvey survey = resin::survey(part_of(values, slices, ExposureMode::continuous));
  resin::PartSurvey expected;
  for (int p = 0; p < width * height; ++p) {
    const auto bits = column_of(values, slices, p);
    bool any = false;
    for (int k = 0; k < slices; ++k) {
      if (bits[k] == 0) continue;
      any = true;
      expected.features += k == 0 || bits[k - 1] == 0;
      expected.last_slice = std::max(expected.last_slice, k);
    }
    expected.columns += any;
  }
  CHECK(survey.columns == expected.columns);
  CHECK(survey.features == expected.features);
  CHECK(survey.last_slice == expected.last_slice);
}

TEST_CASE("slices in printing order are the columns' exact solutions, on any number of threads") {
  for (const auto exposure : {ExposureMode::continuous, ExposureMode::layered}) {
    const int slices = 130;
    const resin::CureLimits limits = limits_for(exposure);
    const auto values = random_part(slices, 77);
    const resin::PartColumns part = part_of(values, slices, exposure);
    const int extra = resin::extra_slices(resin::survey(part).last_slice, slices, limits);
    CHECK(extra == resin::burst_slices(limits) - (exposure == ExposureMode::layered ? 1 : 0));
    for (const double omega_max : {1.0, 2.5, std::numeric_limits<double>::infinity()}) {
      std::vector<std::vector<float>> runs;
      for (const int threads : {1, 3}) {
        set_threads(threads);
        resin::SliceCorrection correction(part, limits, {omega_max}, slices + extra);
        std::vector<float>& all = runs.emplace_back();
        Image slice;
        for (int k = 0; k < slices + extra; ++k) {
          correction.next(slice);
          all.insert(all.end(), slice.values.begin(), slice.values.end());
        }
      }
      set_threads(0);
      CHECK(runs[0] == runs[1]);
      for (int p = 0; p < width * height; ++p) {
        const test::CorrectedColumn column =
            test::correct_column(column_of(values, slices, p), limits, {omega_max}, extra);
        for (int k = 0; k < slices + extra; ++k) {
          const double phi = runs[0][k * width * height + p] * limits.phi_max;
          // float storage of a value up to phi_max: half a unit in the last place
          CHECK(std::fabs(phi - column.phi[k]) <= 1e-7 * limits.phi_max);
        }
      }
    }
  }
}

TEST_CASE("grey levels: rounding never undercures and does not add up") {
  for (const auto exposure : {ExposureMode::continuous, ExposureMode::layered}) {
    const int slices = 130;
    const resin::CureLimits limits = limits_for(exposure);
    const auto values = random_part(slices, 3);
    const resin::PartColumns part = part_of(values, slices, exposure);
    const int extra = resin::extra_slices(resin::survey(part).last_slice, slices, limits);
    std::vector<float> levels;
    const double dark = limits.phi_min / limits.phi_max;
    for (int v = 0; v < 256; ++v) levels.push_back(static_cast<float>(dark + (1 - dark) * std::pow(v / 255.0, 2.2)));
    double widest = 0;
    for (std::size_t v = 1; v < 256; ++v) widest = std::max(widest, static_cast<double>(levels[v] - levels[v - 1]));
    const double bound = limits.gain * widest * limits.phi_max;
    resin::LevelCorrection correction(part, limits, {1}, slices + extra, levels);
    std::vector<std::vector<std::uint16_t>> stack(static_cast<std::size_t>(slices + extra));
    for (int k = slices + extra; k-- > 0;) correction.previous(stack[k]);
    for (int p = 0; p < width * height; ++p) {
      const auto bits = column_of(values, slices, p);
      const test::CorrectedColumn column = test::correct_column(bits, limits, {1}, extra);
      std::vector<double> phi;
      for (const auto& slice : stack) phi.push_back(levels[slice[p]] * limits.phi_max);
      const std::vector<double> omega = resin::dose_at_nodes(phi, limits);
      const auto nodes = test::nodes_of(bits, exposure);
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n] != 0) CHECK(omega[n] >= 1 - resin::dose_tolerance);
        // Where the light above the least is already there the next levels are the darkest: the surplus decays from at
        // most one step of the levels.
        CHECK(omega[n] <= column.omega[n] + bound + resin::dose_tolerance);
      }
    }
  }
}

TEST_CASE("an intensity range that cannot print is refused with a remedy") {
  const resin::PartColumns part = part_of(random_part(40, 1), 40, ExposureMode::continuous);
  resin::CureLimits limits = limits_for(ExposureMode::continuous);
  limits.phi_max = 0.5;
  CHECK_THROWS_WITH_AS(resin::require_printable(limits),
                       "intensity range: the maximum settles at 0.5 full-cure doses, so nothing cures; increase "
                       "the intensity, or print at 0.5 times this speed or slower",
                       Error);
  limits.phi_max = 9;
  limits.phi_min = 1.5;
  CHECK_THROWS_AS(resin::require_printable(limits), Error);
  const std::vector<float> falling{0.1F, 0.5F, 0.4F, 1.0F};
  CHECK_THROWS_AS(resin::LevelCorrection(part, limits_for(ExposureMode::continuous), {1}, 50, falling), Error);
}
