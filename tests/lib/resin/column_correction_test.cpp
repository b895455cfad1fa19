// SPDX-License-Identifier: GPL-3.0-or-later

#include <limits>

#include "lib/resin/corrected_column.hpp"
#include "oracle/simplex.hpp"
#include "resin/curethrough/sweep.hpp"
#include "testing.hpp"

using namespace vam;
using resin::ExposureMode;
using Part = test::ColumnBits;
using test::violation;

namespace {

// The rung column of [CURE19 fig 2]: slices 1..50 of the paper are 0..49 here, rungs 10..19 and 30..39.
Part ladder() {
  Part part(50, 0);
  for (std::size_t n = 0; n < 50; ++n) part[n] = (n / 10) % 2 == 1;
  return part;
}

// Features of random heights and gaps of at least two slices, sometimes standing on the platform.
Part random_part(std::mt19937& random, int slices, int tallest, int narrowest_gap) {
  Part part(static_cast<std::size_t>(slices), 0);
  std::uniform_int_distribution<int> height(1, tallest);
  std::uniform_int_distribution<int> gap(narrowest_gap, tallest);
  int n = std::uniform_int_distribution<int>(0, 2)(random) == 0 ? 0 : gap(random);
  while (n < slices) {
    const int end = std::min(slices, n + height(random));
    std::fill(part.begin() + n, part.begin() + end, std::uint8_t{1});
    n = end + gap(random);
  }
  return part;
}

resin::CureLimits limits_with(ExposureMode exposure, double eta, double phi_min, double phi_max) {
  const double q = std::pow(10.0, -eta);
  return {exposure, q, exposure == ExposureMode::continuous ? 1 - q : q, phi_min, phi_max};
}

bool has_single_slice_gap(const Part& part) {
  const Part gap{1, 0, 1};
  return std::search(part.begin(), part.end(), gap.begin(), gap.end()) != part.end();
}

double log_uniform(std::mt19937& random, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution<double>(0, 1)(random));
}

int needed_extra(const resin::CureLimits& limits) {
  return std::max(0, resin::burst_slices(limits) - (limits.exposure == ExposureMode::layered ? 1 : 0));
}

// The constraints as a linear program in y = phi - phi_min >= 0. Omega(n) = sum_{m >= n} gain q^(m-n) phi_m.
vam::oracle::LinearProgram program_of(const Part& part, const resin::CureLimits& limits, double omega_max, int slices) {
  const auto count = static_cast<std::size_t>(slices);
  vam::oracle::LinearProgram lp;
  lp.cost.assign(count, 0);
  const auto add = [&](const std::vector<double>& row, double bound) {
    lp.a.push_back(row);
    lp.b.push_back(bound);
  };
  const auto solid = [&](int n) { return n >= 0 && n < static_cast<int>(part.size()) && part[n] != 0; };
  for (std::size_t n = 0; n < count; ++n) {
    std::vector<double> row(count, 0);
    row[n] = 1;
    add(row, limits.phi_max - limits.phi_min);
  }
  const bool continuous = limits.exposure == ExposureMode::continuous;
  for (int n = 0; n <= slices; ++n) {
    std::vector<double> up(count, 0);
    double base = 0;
    for (int m = n; m < slices; ++m) {
      up[m] = limits.gain * std::pow(limits.q, m - n);
      base += up[m] * limits.phi_min;
    }
    std::vector<double> down = up;
    for (double& value : down) value = -value;
    const bool here = solid(n);
    const bool before = continuous && solid(n - 1);
    if (!here && !before) {
      add(up, 1 - base);
      continue;
    }
    add(down, base - 1);  // Omega >= 1
    const bool edge = (here && n > 0 && !solid(n - 1)) || (continuous ? !here : !solid(n + 1));
    const double high = edge ? 1 : omega_max;
    if (std::isfinite(high)) add(up, high - base);
  }
  return lp;
}

}  // namespace

TEST_CASE("the paper's ladder, uncorrected: one fused feature with an undercured bottom edge") {
  const resin::CureLimits limits = resin::limits_of({});
  const std::vector<double> omega = resin::dose_at_nodes(resin::plain_column(ladder(), limits), limits);
  for (std::size_t n = 20; n <= 30; ++n) CHECK(omega[n] > 1);  // the gap between the rungs is solid
  for (std::size_t n = 30; n <= 37; ++n) CHECK(omega[n] > 1);
  CHECK(omega[39] < 1);  // [CURE19]: "correctly cured from zeta = 31 to ~38 then undercured"
  CHECK(omega[40] < 1);
}

TEST_CASE("the paper's ladder, corrected with omega_max = 1") {
  const resin::CureLimits limits = resin::limits_of({});
  const test::CorrectedColumn column = test::correct_column(ladder(), limits, {1}, 3);
  CHECK(violation(ladder(), column.phi, limits, 1) == "");
  for (const std::size_t edge : {10, 20, 30, 40}) CHECK(std::fabs(column.omega[edge] - 1) < 1e-6);
  for (std::size_t n = 10; n < 20; ++n) CHECK(column.phi[n] == doctest::Approx(1).epsilon(1e-9));
  for (std::size_t n = 30; n < 40; ++n) CHECK(column.phi[n] == doctest::Approx(1).epsilon(1e-9));
  CHECK(column.phi[40] == doctest::Approx(limits.phi_max));  // the burst at the bottom edge
  CHECK(column.phi[41] == doctest::Approx(limits.phi_max));
  for (std::size_t n = 43; n < 50; ++n) CHECK(column.phi[n] == doctest::Approx(limits.phi_min));
}

TEST_CASE("a rail that reaches the last slice needs the paper's three extra slices") {
  const resin::CureLimits limits = resin::limits_of({});
  const Part rail(50, 1);
  const test::CorrectedColumn dark = test::correct_column(rail, limits, {1}, 2);
  CHECK(has(violation(rail, dark.phi, limits, 1), "undercured"));
  CHECK(1 - *std::min_element(dark.omega.begin(), dark.omega.begin() + 51) > 0.1);
  const test::CorrectedColumn column = test::correct_column(rail, limits, {1}, 3);
  CHECK(violation(rail, column.phi, limits, 1) == "");
}

TEST_CASE("omega_max: the dose inside follows the limit, the edges stay") {
  const resin::CureLimits limits = resin::limits_of({});
  Part part(200, 0);
  std::fill(part.begin() + 40, part.begin() + 160, std::uint8_t{1});
  for (const double omega_max : {1.0, 2.0, 3.0, std::numeric_limits<double>::infinity()}) {
    const test::CorrectedColumn column = test::correct_column(part, limits, {omega_max}, 0);
    CHECK(violation(part, column.phi, limits, omega_max) == "");
    const double peak = *std::max_element(column.omega.begin(), column.omega.end());
    if (std::isfinite(omega_max)) CHECK(peak == doctest::Approx(omega_max));
    if (!std::isfinite(omega_max)) CHECK(peak > 4);
  }
}

TEST_CASE("strong base: features on the platform receive full intensity, as the rails of the paper's figure 4") {
  const resin::CureLimits limits = resin::limits_of({});
  Part part(50, 1);
  std::fill(part.begin() + 30, part.begin() + 40, std::uint8_t{0});
  const test::CorrectedColumn column = test::correct_column(part, limits, {1, true}, 3);
  CHECK(violation(part, column.phi, limits, std::numeric_limits<double>::infinity()) == "");
  for (std::size_t n = 0; n < 30; ++n) CHECK(column.phi[n] == doctest::Approx(limits.phi_max));
  for (std::size_t n = 40; n < 50; ++n) CHECK(column.phi[n] == doctest::Approx(1));  // this one has resin behind it
  const test::CorrectedColumn plain = test::correct_column(part, limits, {1}, 3);
  for (std::size_t n = 30; n <= 53; ++n) CHECK(column.omega[n] == plain.omega[n]);
}

TEST_CASE("thousands of random columns: every constraint holds where gaps and light allow it") {
  std::mt19937 random(20190700);
  int feasible = 0;
  int infeasible = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    const auto exposure = trial % 3 == 2 ? ExposureMode::layered : ExposureMode::continuous;
    const double phi_min = log_uniform(random, 1e-4, 1.5);
    const resin::CureLimits limits =
        limits_with(exposure, log_uniform(random, 3e-3, 1.0), phi_min, phi_min * log_uniform(random, 1.01, 1e4));
    const Part part = random_part(random, 20 + trial % 180, 30, 1);
    const double omega_max = trial % 5 == 0 ? std::numeric_limits<double>::infinity() : log_uniform(random, 1, 8);
    const int extra = trial % 7 == 0 ? 0 : needed_extra(limits);
    const test::CorrectedColumn column = test::correct_column(part, limits, {omega_max}, extra);
    const bool fuses = exposure == ExposureMode::continuous && has_single_slice_gap(part);
    const int last = static_cast<int>(part.rend() - std::find(part.rbegin(), part.rend(), std::uint8_t{1})) - 1;
    const bool possible = !fuses && resin::burst_slices(limits) > 0 && limits.settled(phi_min) < 1 &&
                          resin::extra_slices(last, static_cast<int>(part.size()), limits) <= extra;
    const std::string problem = violation(part, column.phi, limits, omega_max);
    for (const double phi : column.phi) REQUIRE((phi >= limits.phi_min && phi <= limits.phi_max));
    INFO("trial " << trial);
    if (possible) CHECK(problem == "");
    if (fuses) CHECK(problem != "");
    ++(possible ? feasible : infeasible);
  }
  CHECK(feasible > 1000);  // both outcomes are exercised
  CHECK(infeasible > 1000);
}

TEST_CASE("no feasible column has less dose: a linear program finds the same optimum") {
  std::mt19937 random(5);
  int solved = 0;
  int impossible = 0;
  for (int trial = 0; trial < 240; ++trial) {
    const auto exposure = trial % 3 == 2 ? ExposureMode::layered : ExposureMode::continuous;
    const double phi_min = log_uniform(random, 1e-3, 1.2);
    const resin::CureLimits limits =
        limits_with(exposure, log_uniform(random, 0.02, 0.5), phi_min, phi_min * log_uniform(random, 1.5, 500));
    const Part part = random_part(random, 14, 5, 2);
    const int extra = trial % 4 == 0 ? 0 : std::min(6, needed_extra(limits));
    const int slices = static_cast<int>(part.size()) + extra;
    const double omega_max = trial % 2 == 0 ? 3.0 : std::numeric_limits<double>::infinity();
    vam::oracle::LinearProgram lp = program_of(part, limits, omega_max, slices);
    const test::CorrectedColumn least = test::correct_column(part, limits, {1}, extra);
    const bool is_feasible = violation(part, least.phi, limits, 1) == "";

    // Total light: sum of phi.
    std::fill(lp.cost.begin(), lp.cost.end(), 1.0);
    const auto best = vam::oracle::minimise(lp);
    INFO("trial " << trial);
    // omega_max = 1 asks for phi_min <= hold(); a looser limit may be feasible without it.
    if (limits.settled(limits.phi_min) < 1) CHECK(best.has_value() == is_feasible);
    if (!best || !is_feasible) {
      ++impossible;
      continue;
    }
    ++solved;
    double total = 0;
    for (const double phi : least.phi) total += phi;
    const double optimum = best->value + slices * limits.phi_min;
    CHECK(total == doctest::Approx(optimum).epsilon(1e-7));  // the simplex stops at reduced costs of 1e-12

    // Greatest dose inside for this omega_max, least outside: every node is at its own extreme at once.
    const test::CorrectedColumn full = test::correct_column(part, limits, {omega_max}, extra);
    REQUIRE(violation(part, full.phi, limits, omega_max) == "");
    const auto nodes = test::nodes_of(part, exposure);
    const int probe = trial % static_cast<int>(nodes.size());
    const bool inside = nodes[probe] != 0;
    double base = 0;
    std::fill(lp.cost.begin(), lp.cost.end(), 0.0);
    for (int m = probe; m < slices; ++m) {
      const double weight = limits.gain * std::pow(limits.q, m - probe);
      lp.cost[m] = inside ? -weight : weight;
      base += weight * limits.phi_min;
    }
    const auto extreme = vam::oracle::minimise(lp);
    REQUIRE(extreme.has_value());
    const double dose = base + (inside ? -extreme->value : extreme->value);
    CHECK(full.omega[probe] == doctest::Approx(dose).epsilon(1e-7));
  }
  CHECK(solved > 60);
  CHECK(impossible > 20);
}

TEST_CASE("a layer-by-layer print has sharp bottom edges and needs no extra layers when one exposure is enough") {
  resin::Process process{.exposure = ExposureMode::layered};
  const resin::CureLimits limits = resin::limits_of(process);
  CHECK(limits.gain * limits.phi_max < 1);  // not here: 110 mW/cm2 for 0.18 s
  process.speed_mm_h = 100;
  const resin::CureLimits slow = resin::limits_of(process);
  const test::CorrectedColumn column = test::correct_column(Part(20, 1), slow, {1}, 0);
  CHECK(violation(Part(20, 1), column.phi, slow, 1) == "");
  CHECK(column.omega[19] == doctest::Approx(1));
  CHECK(column.phi[0] == doctest::Approx(slow.hold()));
}

TEST_CASE("omega_max below 1 is a usage error") {
  CHECK_THROWS_WITH_AS((void)test::correct_column(Part(3, 1), resin::limits_of({}), {0.5}, 0),
                       "omega-max: 0.5 is below 1, the dose that cures; give 1, more than 1, or inf", Error);
}
