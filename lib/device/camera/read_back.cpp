// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/read_back.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::device {

void require_read_back(const std::string& subject, double wanted, double got, double grain) {
  constexpr double tolerance = 0.01;
  if (std::abs(wanted - got) <= tolerance * std::abs(wanted) + grain) return;
  throw Error{Fault::protocol, subject + " reads back as " + format_number(got) + " instead of " +
                                   format_number(wanted) + "; choose a supported value"};
}

}  // namespace vam::device
