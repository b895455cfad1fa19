// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes in and out: "-" is stdin or stdout, an output appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vam::io {

/// Binary is neither read from nor written to a terminal (Fault::usage).
enum class Content { binary, text };

/// A file or stdin ("-"), read front to back through a buffer of 1 MiB. Nothing is ever sought, so that a pipe does.
class InputFile {
 public:
  /// Throws Error: no_input (cannot open, is a directory, is a device that never ends), usage (binary from a terminal).
  explicit InputFile(const std::string& path, Content content = Content::binary);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// What messages call it: the path, or "stdin".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Bytes handed out so far.
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Reads `size` bytes, fewer only at the end of the file; returns how many. Throws Error: io.
  std::size_t read(void* to, std::size_t size);
  /// The next bytes without taking them: at least one unless the file has ended. Throws Error: io.
  std::span<const char> peek();
  /// Takes `size` bytes of what peek() showed.
  void skip(std::size_t size);
  /// Throws Error: io.
  bool at_end() { return peek().empty(); }
  /// Bytes that peek() shows without waiting for more.
  [[nodiscard]] std::size_t buffered() const { return end_ - begin_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Bytes of a regular file; 0 of a pipe or a device.
  [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
  std::size_t receive(char* to, std::size_t size);
  std::string name_;
  int descriptor_ = -1;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t position_ = 0;
  std::uint64_t size_ = 0;
};

/// A file, a special file (/dev/full, a FIFO) or stdout ("-"), written front to back. A regular file is written without
/// a name where the file system can (nothing is left even after SIGKILL), else under a temporary name in the same
/// directory that also SIGHUP, SIGINT and SIGTERM remove; commit() makes it appear, whole, in one step.
class OutputFile {
 public:
  /// Named: has a temporary path from the start, as where a file system knows none without.
  enum class Temporary { unnamed, named };

  /// Throws Error: no_output (cannot create, is a directory, is write-protected), usage (binary to a terminal).
  explicit OutputFile(const std::string& path, Content content = Content::binary,
                      Temporary temporary = Temporary::unnamed);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// What messages call it: the path, or "stdout".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// True for a pipe, a device and stdout: what is written is gone, write_at() must not be used.
  [[nodiscard]] bool is_stream() const { return target_.empty(); }
  /// Bytes written so far.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// For what is written in full whatever it holds. Throws Fault::io where a file of so many bytes does not fit.
  void require_space(double bytes) const;
  /// Throws Error: io (no space left, closed pipe where SIGPIPE is ignored, ...).
  void write(const void* bytes, std::size_t size);
  void write(std::string_view bytes) { write(bytes.data(), bytes.size()); }
  /// Replaces bytes that were written before; the position stays. Throws Error: io.
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  /// Flushes, waits for the disk and puts the file under its name. Throws Error: io, no_output.
  void commit();

 private:
  void open_special(const std::string& path);
  void flush();
  void send(const char* bytes, std::size_t size, std::optional<std::uint64_t> offset = std::nullopt);
  void publish();
  void give_name();
  void discard() noexcept;
  std::string name_;
  std::string target_;     // final path of a regular file, links followed; empty for a stream
  std::string temporary_;  // name of the unfinished file, if it has one
  int descriptor_ = -1;
  int slot_ = -1;  // of the temporary name in the list that signal handlers clean
  std::string buffer_;
  std::uint64_t position_ = 0;
};

/// The whole of a file or stdin. Throws Error: no_input, io, data (longer than `limit` bytes).
[[nodiscard]] std::string read_all(const std::string& path, Content content = Content::text,
                                   std::uint64_t limit = std::uint64_t{4} << 30);

/// The same of what is left of it.
[[nodiscard]] std::string read_all(InputFile& file, std::uint64_t limit);

/// The SHA-256 of a file's bytes, as sha256sum(1) prints it. Throws what InputFile throws.
[[nodiscard]] std::string sha256_of(const std::string& path);

/// Writes a whole text; throws as OutputFile does.
void write_text(const std::string& path, std::string_view text);

/// The path, or "stdin" for "-".
[[nodiscard]] inline std::string input_name(const std::string& path) { return path == "-" ? "stdin" : path; }

/// The files are written beside the target, in a hidden folder that the destructor and SIGHUP, SIGINT and SIGTERM
/// remove; commit() puts it in place. An older folder is replaced if it is empty or holds nothing but files like these.
class OutputFolder {
 public:
  /// `like_these` tells by its name whether a file of an older folder may go. Throws Error: no_output (the folder holds
  /// something else, cannot be created).
  OutputFolder(const std::string& path, bool (*like_these)(const std::filesystem::path& file));
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Writes a whole file; several threads may write different ones. Throws Error: io.
  void write(const std::string& name, std::string_view bytes) const;
  /// Waits for the disk and puts the folder under its name. Throws Error: io, no_output.
  void commit();

 private:
  void synchronize() const;
  void discard();
  void forget();
  std::filesystem::path target_;
  std::string temporary_;
  int slot_ = -1;
};

}  // namespace vam::io
