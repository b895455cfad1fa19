#include "vam-curethrough/folder.hpp"

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "base/error.hpp"
#include "base/log.hpp"

namespace vam::curethrough {

namespace fs = std::filesystem;

namespace {

std::string name_of(int number) {
  char name[32];
  std::snprintf(name, sizeof name, "%05d.png", number);
  return name;
}

}  // namespace

FolderWriter::FolderWriter(const std::string& path)
    : target_(fs::path(path).has_filename() ? fs::path(path) : fs::path(path).parent_path()),
      temporary_(fs::absolute(target_).parent_path() / (".vam-" + std::to_string(getpid()) + "-slices")) {
  if (fs::exists(target_) && !(fs::is_directory(target_) && fs::is_empty(target_))) {
    throw Error{Fault::no_output, target_.string() + ": exists and is not an empty folder; name a new one"};
  }
  std::error_code problem;
  if (!fs::create_directory(temporary_, problem)) {
    const std::string why = problem ? problem.message() : temporary_.string() + " is in the way";
    temporary_.clear();
    throw Error{Fault::no_output, target_.string() + ": cannot create the folder: " + why};
  }
}

FolderWriter::~FolderWriter() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void FolderWriter::write(int number, const GreyImage& picture, const io::PictureText& text) const {
  const std::string bytes = io::encode_png(picture, text);
  std::ofstream file(temporary_ / name_of(number), std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw Error{Fault::io, (target_ / name_of(number)).string() + ": cannot write; is the disk full?"};
}

void FolderWriter::commit(const std::vector<model::ImageInfo>& about) {
  std::ofstream index(temporary_ / "frames.csv");
  index << "file,time_s,angle_deg\n";
  for (std::size_t n = 0; n < about.size(); ++n) {
    index << name_of(static_cast<int>(n)) << ',' << format_number(about[n].time_s, 9) << ",0\n";
  }
  index.close();
  if (!index) throw Error{Fault::io, (target_ / "frames.csv").string() + ": cannot write; is the disk full?"};
  std::error_code problem;
  fs::rename(temporary_, target_, problem);  // takes the place of an empty folder too
  if (problem)
    throw Error{Fault::no_output, target_.string() + ": cannot put the folder in place: " + problem.message()};
  temporary_.clear();
}

}  // namespace vam::curethrough
