// What a call throws, for tests of errors.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/error.hpp"

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
