// SPDX-License-Identifier: GPL-3.0-or-later
// Stacks of images as one standard multi-part scanline OpenEXR file, in a file or through a pipe (FILES in the
// manuals).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "model/metadata.hpp"
#include "model/stack.hpp"

namespace vam::io {

struct StackOptions {
  bool half = false;                // store 16-bit floats
  std::string compression = "rle";  // none, rle, zip, zips, piz, pxr24; a pipe is always uncompressed
  bool late = false;                // facts of the stack come after its images: state()
};

/// Reads a stack front to back. "-" is stdin; file or pipe, seekable or not, in constant memory.
/// Throws Error: no_input, data (not an EXR, truncated, no channel Y, no vam:kind, sizes beyond the limits), io.
class StackReader {
 public:
  /// several: stacks may follow each other on the stream; else what follows the last image is refused with it.
  /// to_end: the place of the last image shows whether a file is cut, before any image is read.
  explicit StackReader(const std::string& path, bool several = false, bool to_end = false);
  ~StackReader();
  [[nodiscard]] const model::StackInfo& info() const;
  /// The facts of every image, known before the first is read.
  [[nodiscard]] const std::vector<model::ImageInfo>& about() const;
  /// The next image in ascending order; false after the last. Throws Fault::data where the stream is cut, and where a
  /// pixel is not a finite number.
  bool next(Image& image, model::ImageInfo& about);
  /// The seal of this stack, 16 digits; empty where it has none, on a pipe until its last image. A stack with a seal is
  /// held to it: what differs ends in Fault::data, at the header, the image or, on a pipe, after the last one.
  [[nodiscard]] std::string seal() const;
  [[nodiscard]] bool is_sealed() const;
  /// After the last image, of several: moves on to the stack that follows (a live capture sends one per turn).
  /// False at the end of the stream.
  bool next_stack();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a stack front to back; info.count images must follow. "-" is stdout. A file appears under its final name only
/// at commit(), complete; without commit() nothing is left. Throws Error: no_output, io, usage (unknown compression,
/// binary to a terminal), data (a value too large for half).
class StackWriter {
 public:
  StackWriter(const std::string& path, const model::StackInfo& info, const StackOptions& options = {});
  /// The same for images whose own facts (measured angles and times) are known before the first: info.count of them.
  StackWriter(const std::string& path, const model::StackInfo& info, std::vector<model::ImageInfo> about,
              const StackOptions& options = {});
  ~StackWriter();
  void write(const Image& image);
  /// Facts that come only with the image. Images of one stack all have a measured angle (time), or none has. As they
  /// stand before the pixels, a pipe then receives the stack at commit(), out of a ScratchFile.
  void write(const Image& image, const model::ImageInfo& about);
  /// Facts in place of others of the same names and lengths; on a pipe with StackOptions::late only, as above;
  /// without it throws Fault::bug once the header was sent.
  void state(const model::Metadata& facts);
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether an attribute is what StackInfo and ImageInfo have beside `extra`.
[[nodiscard]] bool is_own_fact(const std::string& name);

/// Throws Fault::data unless the stack is of this kind and space: "frames.exr holds frames (projector), but
/// vam-resample needs a sinogram (virtual)".
void require(const std::string& path, const model::StackInfo& info, model::Kind kind, model::Space space);
void require(const std::string& path, const model::StackInfo& info, model::Kind kind);

/// Row 0 at the top; values as they are. Parsed in a child. Throws Error: no_input, io, data (no EXR, damaged, several
/// channels without Y, a pixel that is not a finite number).
[[nodiscard]] Image read_exr_image(const std::string& path);

}  // namespace vam::io
