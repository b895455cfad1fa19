// Grey slices as numbered pictures in a folder that appears whole, in the form of vam-project's.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "io/picture.hpp"
#include "model/stack.hpp"

namespace vam::curethrough {

/// 00000.png, 00001.png, ... and frames.csv (file,time_s,angle_deg), written in any order. The folder must not exist,
/// or be empty. Without commit() nothing is left. Throws Error: no_output, io.
class FolderWriter {
 public:
  explicit FolderWriter(const std::string& path);
  ~FolderWriter();
  FolderWriter(const FolderWriter&) = delete;
  FolderWriter& operator=(const FolderWriter&) = delete;
  void write(int number, const GreyImage& picture, const io::PictureText& text) const;
  void commit(const std::vector<model::ImageInfo>& about);

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

}  // namespace vam::curethrough
