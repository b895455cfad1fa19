// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-curethrough/catalogue.hpp"

#include <cstdio>

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/csv_table.hpp"
#include "io/stream/stream.hpp"
#include "resin/curethrough/gaps.hpp"

namespace vam::curethrough {

namespace {

std::string cells(const std::vector<std::string>& texts) {
  std::string line;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::size_t width = i == 0 ? 20 : 12;
    const std::string pad(texts[i].size() < width ? width - texts[i].size() : 1, ' ');
    line += i == 0 ? texts[i] + pad : pad + texts[i];
  }
  return line + "\n";
}

Json entry_of(const std::string& name, const resin::Process& process, double limit_mm_h, int gap,
              const resin::GapReport& judged) {
  Json entry{{"name", name},
             {"absorbance_height_um", process.absorbance_height_um},
             {"full_cure_dose_mj_cm3", process.full_cure_dose_mj_cm3},
             {"speed_limit_mm_h", limit_mm_h},
             {"speed_mm_h", process.speed_mm_h},
             {"phi_max", resin::limits_of(process).phi_max},
             {"prints", process.speed_mm_h < limit_mm_h},
             {"narrowest_gap_um", nullptr},
             {"tight_gaps", judged.tight_gaps},
             {"fused_gaps", judged.infeasible_gaps}};
  if (gap > 0) entry["narrowest_gap_um"] = gap * process.slice_um;
  return entry;
}

}  // namespace

Json compare(const std::string& path, const std::vector<double>& speeds_mm_h, double clear, const PrintSettings& print,
             const resin::PartColumns& part) {
  const io::CsvTable table = io::read_csv(path, {"name", "absorbance_height_um", "full_cure_dose_mj_cm3"});
  std::string text = cells(
      {"resin", "h_a um", "D_f mJ/cm3", "limit mm/h", "speed mm/h", "Phi_max", "gap um", "tight gaps", "fused gaps"});
  Json report = Json::array();
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    resin::Process process = print.process;
    process.absorbance_height_um = table.number(row, 1);
    process.full_cure_dose_mj_cm3 = table.number(row, 2);
    const double limit = resin::speed_limit_mm_h(process);
    std::vector<double> speeds = speeds_mm_h;
    if (speeds.empty()) speeds = {0.2 * limit, 0.4 * limit, 0.6 * limit, 0.8 * limit};
    for (const double speed : speeds) {
      process.speed_mm_h = speed;
      const resin::CureLimits limits = resin::limits_of(process);
      const int gap = resin::narrowest_gap(limits, clear);
      const resin::GapReport judged = resin::judge_gaps(part, limits, clear);
      const bool prints = speed < limit;
      text += cells({table.rows[row][0], format_number(process.absorbance_height_um),
                     format_number(process.full_cure_dose_mj_cm3), format_number(limit, 4), format_number(speed, 4),
                     format_number(limits.phi_max, 4), gap > 0 ? format_number(gap * process.slice_um) : "-",
                     prints ? std::to_string(judged.tight_gaps) : "-",
                     prints ? std::to_string(judged.infeasible_gaps) : "-"});
      report.push_back(entry_of(table.rows[row][0], process, limit, gap, judged));
    }
  }
  io::write_text("-", text);
  return report;
}

}  // namespace vam::curethrough
