// Frames as numbered PNG files in a folder that appears whole.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/frame_sink.hpp"
#include "io/picture.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* index_name = "frames.csv";

bool is_ours(const fs::path& file) {
  const std::string stem = file.stem().string();
  const bool digits = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
  return file.filename() == index_name || (digits && file.extension() == ".png");
}

void check_replaceable(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw Error{Fault::no_output, folder.string() + ": exists and is not a folder"};
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!is_ours(entry.path())) {
      throw Error{Fault::no_output, folder.string() + ": holds " + entry.path().filename().string() +
                                        ", which is no frame; name another folder"};
    }
  }
}

std::string number_name(long number) {
  char name[32];
  std::snprintf(name, sizeof name, "%05ld.png", number);
  return name;
}

class FolderSink : public FrameSink {
 public:
  FolderSink(const std::string& path, const FrameSinkOptions& options)
      : target_(fs::path(path).has_filename() ? fs::path(path) : fs::path(path).parent_path()),
        temporary_(fs::absolute(target_).parent_path() / (".vam-" + std::to_string(getpid()) + "-frames")),
        comment_(join(options.info.history, "\n")) {
    check_replaceable(target_);
    std::error_code problem;
    if (!fs::create_directory(temporary_, problem)) {
      throw Error{Fault::no_output, target_.string() + ": cannot create the folder: " +
                                        (problem ? problem.message() : temporary_.string() + " is in the way")};
    }
    index_ = "file,time_s,angle_deg\n";
  }

  ~FolderSink() override {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  }

  void write(std::span<const ProjectorFrame> frames) override {
    parallel_for(static_cast<int>(frames.size()), [&](int i) {
      const auto& frame = frames[static_cast<std::size_t>(i)];
      write_file(number_name(written_ + i), encode_png(frame.levels, {{"Comment", comment_}}));
    });
    for (const auto& frame : frames) {
      index_ += number_name(written_++) + "," + format_number(frame.time_s, 9) + "," +
                format_number(frame.angle_deg, 9) + "\n";
    }
  }

  void commit() override {
    write_file(index_name, index_);
    synchronize();
    std::error_code problem;
    if (fs::exists(target_)) {  // the old frames step aside, and come back if the new ones cannot take their place
      const fs::path old = temporary_.string() + "-old";
      fs::rename(target_, old, problem);
      if (!problem) fs::rename(temporary_, target_, problem);
      if (problem) {
        std::error_code ignored;
        fs::rename(old, target_, ignored);
      } else {
        fs::remove_all(old, problem);
      }
    } else {
      fs::rename(temporary_, target_, problem);
    }
    if (problem)
      throw Error{Fault::no_output, target_.string() + ": cannot put the folder in place: " + problem.message()};
    temporary_.clear();
  }

 private:
  void write_file(const std::string& name, const std::string& bytes) const {
    std::ofstream file(temporary_ / name, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw Error{Fault::io, (target_ / name).string() + ": cannot write; is the disk full?"};
  }

  // One call for the whole folder, in place of an fsync for each of a thousand files.
  void synchronize() const {
    const int folder = ::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool done = folder >= 0 && syncfs(folder) == 0;
    if (folder >= 0) ::close(folder);
    if (!done) throw Error{Fault::io, target_.string() + ": the disk did not take all frames"};
  }

  fs::path target_;
  fs::path temporary_;
  std::string comment_;
  std::string index_;
  long written_ = 0;
};

}  // namespace

std::unique_ptr<FrameSink> open_frame_folder(const std::string& path, const FrameSinkOptions& options) {
  return std::make_unique<FolderSink>(path, options);
}

}  // namespace vam::io
