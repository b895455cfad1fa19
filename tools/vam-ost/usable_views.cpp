// SPDX-License-Identifier: GPL-3.0-or-later
// The views of a turn that can be measured.
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "vam-ost/session.hpp"

namespace vam::ost_tool {

std::vector<metrology::CameraView> Session::usable_views(io::ViewSource& source, const std::string& subject) {
  std::vector<metrology::CameraView> views;
  std::vector<std::string> names;
  std::vector<std::string> left_out;
  io::CameraFrame frame;
  while (source.next(frame)) {
    const metrology::Exposure exposure = metrology::exposure_of(frame.image);
    const std::string problem = exposure.problem();
    if (!problem.empty()) {
      left_out.push_back(frame.name + ": " + problem);
      continue;
    }
    names.push_back(frame.name);
    views.push_back(take(std::move(frame), exposure));
  }
  const std::vector<std::string> unlike = metrology::contrast_problems(views);
  std::vector<metrology::CameraView> usable;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (unlike[i].empty()) {
      usable.push_back(std::move(views[i]));
    } else {
      left_out.push_back(names[i] + ": " + unlike[i]);
    }
  }
  constexpr std::size_t one_of = 10;
  const std::size_t all = usable.size() + left_out.size();
  if (one_of * left_out.size() > all) {
    throw Error{Fault::data, subject + ": " + std::to_string(left_out.size()) + " of " + std::to_string(all) +
                                 " views cannot be used; " + left_out.front()};
  }
  for (const std::string& reason : left_out) warn(reason + "; the view is left out");
  return usable;
}

}  // namespace vam::ost_tool
