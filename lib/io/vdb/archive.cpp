// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/private/archive.hpp"

#include <openvdb/openvdb.h>

#include <iostream>
#include <stdexcept>
#include <string>

#include "io/stream/stream_buffers.hpp"
#include "io/vdb/private/head.hpp"

namespace vam::io {

namespace {

// OpenVDB comments on std::cerr on what it meets in a damaged file; one line is enough, and it will be ours.
struct SilencedCerr {
  SilencedCerr() : saved(std::cerr.rdbuf(nullptr)) {}
  ~SilencedCerr() {
    std::cerr.rdbuf(saved);
    std::cerr.clear();
  }
  SilencedCerr(const SilencedCerr&) = delete;
  SilencedCerr& operator=(const SilencedCerr&) = delete;
  std::streambuf* saved;
};

}  // namespace

void for_archives(InputFile& file, const std::function<void(std::istream&)>& archive) {
  openvdb::initialize();  // grid and metadata types must be registered before anything is read
  try {
    if (file.at_end()) throw std::runtime_error("is empty; the program that should have written it failed");
    for (const std::uint64_t begin = file.position(); !file.at_end();) {
      if (file.position() > begin && !is_archive(file.peek())) {
        throw std::runtime_error("trailing data after the last grid, from byte " + std::to_string(file.position()) +
                                 " on, is not a volume; write the file again, or truncate it there");
      }
      check_head(file.peek());
      const SilencedCerr quiet;
      InputBuffer buffer(file);
      std::istream stream(&buffer);
      stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
      archive(stream);
    }
  } catch (const std::ios_base::failure&) {
    throw std::runtime_error("is cut off after " + std::to_string(file.position()) +
                             " bytes; the program that wrote it did not finish");
  } catch (const openvdb::ArithmeticError&) {
    throw std::runtime_error(
        "a grid has a transform with a number that is not finite, or without an inverse; mend it in the program that "
        "wrote it");
  }
}

}  // namespace vam::io
