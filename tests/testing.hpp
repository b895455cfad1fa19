// SPDX-License-Identifier: GPL-3.0-or-later
// What unit tests begin with: doctest, what most of them take of the standard, and what a call throws.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "indices.hpp"

// Settings are made by the names of those that a test sets; the others are as they are declared.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

/// The fault of the Error that the call throws; nothing when it throws none.
inline std::optional<vam::Fault> fault_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const vam::Error& error) {
    return error.fault;
  }
  return std::nullopt;
}

/// Its message; empty when it throws none.
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const vam::Error& error) {
    return error.what();
  }
  return "";
}

/// Its message, after a check of its fault; "no error" when it throws none.
inline std::string error_of(const std::function<void()>& call, vam::Fault expected) {
  try {
    call();
  } catch (const vam::Error& error) {
    CHECK(error.fault == expected);
    return error.what();
  }
  return "no error";
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
