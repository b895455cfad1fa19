// SPDX-License-Identifier: GPL-3.0-or-later
// For libraries that insist on std::istream and std::ostream. Their streams hide a full disk and a read error unless
// asked; here every Error passes through, once the stream has exceptions(badbit | failbit).
#pragma once

#include <array>
#include <ios>
#include <streambuf>
#include <string>
#include <utility>

#include "io/stream/stream.hpp"

namespace vam::io {

/// Shows an InputFile; can skip forward and tell where it is, nothing else. What is taken from here is taken from
/// there.
class InputBuffer : public std::streambuf {
 public:
  explicit InputBuffer(InputFile& file) : file_(file) {}
  ~InputBuffer() override { give_back(); }
  InputBuffer(const InputBuffer&) = delete;
  InputBuffer& operator=(const InputBuffer&) = delete;

 protected:
  int_type underflow() override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;

 private:
  void give_back();
  InputFile& file_;
};

/// Feeds an OutputFile; can go back and overwrite where that is no stream. Call pubsync() before commit().
class OutputBuffer : public std::streambuf {
 public:
  explicit OutputBuffer(OutputFile& file) : file_(file) { setp(bytes_.data(), bytes_.data() + bytes_.size()); }
  /// What a library will write at `offset` becomes `bytes`. For a few bytes near the start of the file.
  void replace(std::uint64_t offset, std::string bytes) {
    replaced_at_ = offset;
    replacement_ = std::move(bytes);
  }

 protected:
  int_type overflow(int_type byte) override;
  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int sync() override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type to, std::ios_base::openmode which) override;

 private:
  void put(const char* bytes, std::size_t count);
  OutputFile& file_;
  std::array<char, 1 << 16> bytes_{};
  std::string replacement_;
  std::uint64_t replaced_at_ = 0;
  std::uint64_t position_ = 0;  // in the file, of the first byte in the buffer
};

}  // namespace vam::io
