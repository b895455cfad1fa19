// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/tiff_memory.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace vam::io {

namespace {

TiffMemory& memory(thandle_t handle) { return *static_cast<TiffMemory*>(handle); }

tmsize_t read(thandle_t handle, void* to, tmsize_t size) {
  TiffMemory& file = memory(handle);
  const std::size_t left = file.bytes.size() - std::min(file.at, file.bytes.size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), left);
  if (count > 0) std::memcpy(to, file.bytes.data() + file.at, count);
  file.at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write(thandle_t /*handle*/, void* /*from*/, tmsize_t /*size*/) { return 0; }

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  TiffMemory& file = memory(handle);
  const toff_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : file.bytes.size();
  file.at = from + offset;
  return file.at;
}

int close(thandle_t /*handle*/) { return 0; }

toff_t size(thandle_t handle) { return memory(handle).bytes.size(); }

}  // namespace

Tiff open_tiff(TiffMemory& file) {
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  return {TIFFClientOpen("", "rm", &file, read, write, seek, close, size, nullptr, nullptr), TIFFClose};
}

}  // namespace vam::io
