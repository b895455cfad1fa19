// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/av_library.hpp"

#include "base/shared_library.hpp"

namespace vam::io::av {

namespace {

// Of the release whose headers were seen.
SharedLibrary release(const std::string& stem, int major) {
  const std::string number = std::to_string(major);
  return {"video", stem + ".so." + number, stem + number};
}

AvApi load() {
  const SharedLibrary util = release("libavutil", LIBAVUTIL_VERSION_MAJOR);
  const SharedLibrary codec = release("libavcodec", LIBAVCODEC_VERSION_MAJOR);
  const SharedLibrary format = release("libavformat", LIBAVFORMAT_VERSION_MAJOR);
  AvApi found{};
#define VAM_FIND(name) util.find(found.name, #name);
  VAM_AVUTIL_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
#define VAM_FIND(name) codec.find(found.name, #name);
  VAM_AVCODEC_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
#define VAM_FIND(name) format.find(found.name, #name);
  VAM_AVFORMAT_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
  return found;
}

}  // namespace

const AvApi& api() {
  static const AvApi loaded = load();
  return loaded;
}

}  // namespace vam::io::av
