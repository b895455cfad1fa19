// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/tally.hpp"

#include "base/index.hpp"
#include "optimize/methods/metrics.hpp"

namespace vam::optimize {

namespace {

/// Identical slices share a job, but some may be level with the part and others above or below it.
void add_outside(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs,
                 Ledger& ledger) {
  const OutsideSlices found = outside_part(dose, problem, jobs.part);
  for (int k = jobs.asked.from; k < jobs.asked.to; ++k) {
    const int job = jobs.of_slice[k];
    if (job < pass.first || job >= pass.last) continue;
    const bool beside = k >= jobs.part.low[2] && k <= jobs.part.high[2];
    ledger.add_outside((beside ? found.beside : found.whole)[job - pass.low]);
  }
}

}  // namespace

void tally(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs, Ledger& ledger) {
  const auto whole = whole_statistics(dose, problem);
  const auto cut = cut_statistics(dose, problem);
  const auto grey = problem.demands.grey ? metrics(dose, problem) : std::vector<model::DoseMetrics>{};
  for (int job = pass.first; job < pass.last; ++job) {
    const int i = job - pass.low;
    ledger.add(whole[i], grey.empty() ? whole[i].metrics() : grey[i], jobs.slices_each[job]);
    if (jobs.slices_each[job] > 0) ledger.add_cut(cut[i], jobs.slices_each[job]);
  }
  if (!problem.demands.grey) add_outside(dose, problem, pass, jobs, ledger);
}

}  // namespace vam::optimize
