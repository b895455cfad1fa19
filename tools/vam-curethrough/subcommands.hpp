// SPDX-License-Identifier: GPL-3.0-or-later
// vam-curethrough's subcommands: each declares its options and runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/exr/stack.hpp"
#include "resin/curethrough/target_dose.hpp"
#include "vam-curethrough/part.hpp"
#include "vam-curethrough/print.hpp"

namespace vam::curethrough {

struct CorrectOptions {
  PartOptions part;
  PrintOptions print;
  std::string output = "-";
  std::string png;
  std::string mask;
  std::string values = "intensity";
  resin::DoseLimit limit;
  double clear = 0.5;
  bool quantise = false;
  bool full_frame = false;
  std::string catalogue;
  std::vector<double> speeds_mm_h;
  std::string report;
  // Rows are runs of few values, on which ZIP is small and fast; RLE does not see the period of a float's four bytes.
  io::StackOptions stack{false, "zip"};
};
void declare(cli::App& app, CorrectOptions& options);
void run(const cli::App& root, const cli::App& app, const CorrectOptions& options);

struct ModelOptions {
  std::string input = "-";
  PartOptions part;
  PrintOptions print;
  std::string output;
  std::string section;
  std::optional<int> row;
  std::optional<int> column;
  std::optional<double> slice_um;
  std::string report;
};
void declare(cli::App& app, ModelOptions& options);
void run(const cli::App& root, const cli::App& app, const ModelOptions& options);

struct SweepOptions {
  PrintOptions print;
  std::string ranges = "df_over_dc=1..8,omega_max=1..5";
  std::vector<double> heights{4, 6, 8, 10, 14, 20, 40};
  double slice_um = 50;
  std::optional<double> gel_dose_mj_cm3;
  std::string plot;
  std::string report;
};
void declare(cli::App& app, SweepOptions& options);
void run(const cli::App& root, const cli::App& app, const SweepOptions& options);

}  // namespace vam::curethrough
