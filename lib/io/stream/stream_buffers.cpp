// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/stream_buffers.hpp"

#include <algorithm>

namespace vam::io {

void InputBuffer::give_back() {
  file_.skip(gptr() - eback());
  setg(nullptr, nullptr, nullptr);
}

InputBuffer::int_type InputBuffer::underflow() {
  give_back();
  const auto ready = file_.peek();
  if (ready.empty()) return traits_type::eof();
  char* begin = const_cast<char*>(ready.data());  // a streambuf wants it so; nothing is put back
  setg(begin, begin, begin + ready.size());
  return traits_type::to_int_type(*begin);
}

InputBuffer::pos_type InputBuffer::seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) {
  if (from != std::ios_base::cur || offset < 0) return pos_type(off_type(-1));
  while (offset > 0) {
    if (gptr() == egptr() && underflow() == traits_type::eof()) return pos_type(off_type(-1));
    const auto step = std::min<off_type>(offset, egptr() - gptr());
    setg(eback(), gptr() + step, egptr());
    offset -= step;
  }
  return pos_type(static_cast<off_type>(file_.position()) + (gptr() - eback()));
}

void OutputBuffer::put(const char* bytes, std::size_t count) {
  // What lies before the end is overwritten, the rest appended.
  const std::uint64_t behind = file_.position() - position_;
  const std::size_t over = std::min<std::uint64_t>(behind, count);
  if (over > 0) file_.write_at(position_, bytes, over);
  if (count > over) file_.write(bytes + over, count - over);
  position_ += count;
}

int OutputBuffer::sync() {
  const auto filled = static_cast<std::size_t>(pptr() - pbase());
  if (position_ <= replaced_at_ && replaced_at_ + replacement_.size() <= position_ + filled) {
    std::copy(replacement_.begin(), replacement_.end(), pbase() + (replaced_at_ - position_));
  }
  put(pbase(), filled);
  setp(bytes_.data(), bytes_.data() + bytes_.size());
  return 0;
}

OutputBuffer::int_type OutputBuffer::overflow(int_type byte) {
  sync();
  if (!traits_type::eq_int_type(byte, traits_type::eof())) sputc(traits_type::to_char_type(byte));
  return traits_type::not_eof(byte);
}

std::streamsize OutputBuffer::xsputn(const char* bytes, std::streamsize count) {
  if (count > epptr() - pptr()) sync();
  if (count > epptr() - pptr()) {
    put(bytes, count);
  } else {
    std::copy(bytes, bytes + count, pptr());
    pbump(static_cast<int>(count));
  }
  return count;
}

OutputBuffer::pos_type OutputBuffer::seekoff(off_type offset, std::ios_base::seekdir from,
                                             std::ios_base::openmode which) {
  const auto here = static_cast<off_type>(position_) + (pptr() - pbase());
  if (from == std::ios_base::cur && offset == 0) return pos_type(here);  // tellp
  const auto end = std::max(here, static_cast<off_type>(file_.position()));
  if (from == std::ios_base::cur) offset += here;
  if (from == std::ios_base::end) offset += end;
  return seekpos(pos_type(offset), which);
}

OutputBuffer::pos_type OutputBuffer::seekpos(pos_type to, std::ios_base::openmode) {
  sync();
  const auto offset = static_cast<off_type>(to);
  const bool reachable = offset >= 0 && static_cast<std::uint64_t>(offset) <= file_.position();
  if (!reachable || (file_.is_stream() && static_cast<std::uint64_t>(offset) != file_.position())) {
    return pos_type(off_type(-1));
  }
  position_ = static_cast<std::uint64_t>(offset);
  return to;
}

}  // namespace vam::io
