// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/file_type.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/stream/private/temporary.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

using namespace std::string_view_literals;

struct Signature {
  std::size_t at;
  std::string_view bytes;
  const char* name;
  const char* remedy = "";
};

constexpr const char* by_convert = "; vam-convert makes a volume or a stack of it";
constexpr const char* by_numpy = "; save it as a NumPy or HDF5 array, which vam-convert reads";
constexpr const char* in_folder = "; put the images into a folder of their own, and give that";
constexpr const char* as_pages =
    "; vam-convert makes a volume or a stack of its pages; put single images into a folder, and give that";
constexpr const char* as_png = "; save it as PNG, numbered with the others in a folder, and give that";
constexpr const char* by_ffmpeg = "; convert it without loss: ffmpeg -i FILE -c:v ffv1 FILE.mkv";
constexpr const char* by_export = "; export it as 3MF or STL";
constexpr const char* unpack = "; unpack it";

constexpr Signature signatures[] = {
    {0, " BDV"sv, "a volume (OpenVDB)"},
    {0, "\x76\x2f\x31\x01"sv, "a stack (OpenEXR)"},
    {0, "\x93NUMPY"sv, "a NumPy array (.npy)", by_convert},
    {0, "II*\0"sv, "a TIFF image", as_pages},
    {0, "MM\0*"sv, "a TIFF image", as_pages},
    {0, "II+\0"sv, "a TIFF image", as_pages},
    {0, "MM\0+"sv, "a TIFF image", as_pages},
    {0, "\x89PNG\r\n"sv, "a PNG image", in_folder},
    {0, "\xff\xd8\xff"sv, "a JPEG image", as_png},
    {0, "GIF8"sv, "a GIF image", by_ffmpeg},
    {0, "\x89HDF\r\n"sv, "an HDF5 file", by_convert},
    {0, "CDF\x01"sv, "a NetCDF file", by_numpy},
    {0, "NRRD000"sv, "an NRRD volume", by_convert},
    {208, "MAP "sv, "an MRC volume", by_numpy},
    {128, "DICM"sv, "a DICOM image", by_numpy},
    {344, "n+1\0"sv, "a NIfTI volume", by_numpy},
    {0, "ISO-10303-21"sv, "a STEP model, surfaces without triangles", by_export},
    {72, "S      1"sv, "an IGES model, surfaces without triangles", by_export},
    {0, "\xd0\xcf\x11\xe0"sv, "a document of a CAD program", by_export},
    {0, "3D Geometry File Format"sv, "a Rhino model", by_export},
    {0, "glTF"sv, "a glTF model", by_export},
    {0, "Kaydara FBX"sv, "an FBX model", by_export},
    {0, "PXR-USDC"sv, "a USD scene", by_export},
    {0, "#usda"sv, "a USD scene", by_export},
    {0, "MATLAB 5.0 MAT"sv, "a MATLAB file", by_numpy},
    {0, "version https://git-lfs"sv, "a pointer to a file in Git LFS", "; fetch the file by git lfs pull"},
    {0, "#VRML"sv, "a VRML model", by_export},
    {0, "BLENDER"sv, "a Blender file", by_export},
    {0, "# vtk DataFile"sv, "a VTK file", by_numpy},
    {0, "\x1f\x8b"sv, "compressed by gzip", unpack},
    {0, "BZh"sv, "compressed by bzip2", unpack},
    {0, "\3757zXZ"sv, "compressed by xz", unpack},
    {0, "\x28\xb5\x2f\xfd"sv, "compressed by zstd", unpack},
    {0, "7z\xbc\xaf"sv, "a 7z archive", unpack},
    {0, "Rar!"sv, "a RAR archive", unpack},
    {257, "ustar"sv, "a tar archive", unpack},
    {0, "PK\3\4"sv, "a zip archive", unpack},
    {0, "PK\5\6"sv, "an empty zip archive"},
    {0, "\x1a\x45\xdf\xa3"sv, "a Matroska video"},
    {8, "AVI LIST"sv, "an AVI video", by_ffmpeg},
    {0, "\0\0\1\xba"sv, "an MPEG video", by_ffmpeg},
    {0, "\0\0\1\xb3"sv, "an MPEG video", by_ffmpeg},
    {0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"sv, "a WMV video", by_ffmpeg},
    {0, "FLV\1"sv, "a Flash video", by_ffmpeg},
    {8, "WEBP"sv, "a WebP image", as_png},
    {4, "ftyp"sv, "an MP4 video"},
    {0, "%PDF"sv, "a PDF document"},
    {0, "\xff\xfe"sv, "text of 16 bits a character; save it as ASCII or UTF-8"},
    {0, "\xfe\xff"sv, "text of 16 bits a character; save it as ASCII or UTF-8"},
    {0, "\177ELF"sv, "a program"},
    {0, "<!DOCTYPE html"sv, "a web page"},
    {0, "<!doctype html"sv, "a web page"},
    {0, "#!/"sv, "a script"},
    {0, "{"sv, "JSON (vam-report shows reports)"},
};

// XML by its root element.
constexpr Signature roots[] = {
    {0, "amf"sv, "an AMF model", by_export},
    {0, "COLLADA"sv, "a COLLADA model", by_export},
    {0, "X3D"sv, "an X3D model", by_export},
    {0, "VTKFile"sv, "a VTK file", by_numpy},
    {0, "svg"sv, "an SVG drawing"},
    {0, "html"sv, "a web page"},
    {0, "HTML"sv, "a web page"},
};
constexpr Signature other_xml{0, "", "XML"};

// What follows the first end in text.
std::string_view behind(std::string_view text, std::string_view end) {
  const std::size_t at = text.find(end);
  return at == std::string_view::npos ? "" : text.substr(at + end.size());
}

// The name of the element that holds all others, behind declaration and comments.
std::string_view root_element(std::string_view xml) {
  while (true) {
    xml = behind(xml, "<");
    if (xml.starts_with("?")) {
      xml = behind(xml, "?>");
    } else if (xml.starts_with("!--")) {
      xml = behind(xml, "-->");
    } else if (xml.starts_with("!")) {
      xml = behind(xml, ">");
    } else {
      return xml.substr(0, xml.find_first_of(" \t\r\n/>"));
    }
  }
}

const Signature* xml_of(std::string_view head) {
  const std::string_view name = root_element(head);
  for (const Signature& root : roots) {
    if (name == root.bytes) return &root;
  }
  return head.starts_with("<?xml") ? &other_xml : nullptr;
}

// Null for bytes without a known signature.
const Signature* signature_of(std::string_view head) {
  for (const Signature& signature : signatures) {
    if (head.size() > signature.at && head.substr(signature.at).starts_with(signature.bytes)) return &signature;
  }
  return head.starts_with('<') ? xml_of(head) : nullptr;
}

}  // namespace

std::string foreign_format(std::string_view head) {
  const Signature* signature = signature_of(head);
  return signature == nullptr ? "" : signature->name;
}

std::string foreign_remedy(std::string_view head) {
  const Signature* signature = signature_of(head);
  return signature == nullptr ? "" : signature->remedy;
}

namespace {

constexpr std::size_t look = 1024;  // for the names of foreign files
constexpr std::size_t enough = 16;  // for those that are read

// tee(2) copies what waits in one pipe into another and leaves it where it is.
std::string pipe_head(int descriptor) {
  std::array<int, 2> copy{};
  if (pipe2(copy.data(), O_CLOEXEC) != 0) return "";
  std::string head;
  // A writer may deliver its first bytes one by one; they are examined again until they suffice or the input ends.
  for (int attempt = 0; attempt < 1000 && head.size() < enough; ++attempt) {
    const ssize_t copied = tee(descriptor, copy[1], look, 0);
    if (copied <= 0) break;
    head.resize(copied);
    if (read(copy[0], head.data(), head.size()) != copied) break;
    if (head.size() < enough) poll(nullptr, 0, 1);
  }
  close(copy[0]);
  close(copy[1]);
  return head;
}

std::string stdin_head() {
  struct stat about {};
  if (fstat(STDIN_FILENO, &about) != 0) return "";
  require_end(about, input_name("-"));
  if (S_ISFIFO(about.st_mode)) return pipe_head(STDIN_FILENO);
  std::string head(look, '\0');
  const off_t here = lseek(STDIN_FILENO, 0, SEEK_CUR);
  const ssize_t count = here < 0 ? 0 : pread(STDIN_FILENO, head.data(), look, here);
  head.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return head;
}

std::string file_head(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode)) {  // a look would take its bytes
    require_end(about, path);
    throw Error{Fault::no_input, path + ": is not a regular file; give it on standard input"};
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw system_error(Fault::no_input, path + ": cannot open", errno);
  std::string head(look, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(look));
  head.resize(stream.gcount());
  return head;
}

std::string head_of(const std::string& path) { return path == "-" ? stdin_head() : file_head(path); }

// A 64-bit number begins with these four bytes.
bool begins_a_volume(const std::string& head) { return head.starts_with(" BDV"); }

}  // namespace

bool is_volume(const std::string& path) { return begins_a_volume(head_of(path)); }

bool is_lone_array(const std::string& path) {
  const std::string head = head_of(path);
  return head.starts_with("\x93NUMPY") || head.starts_with("NRRD") || head.starts_with("II") || head.starts_with("MM");
}

std::optional<FileType> known_file_type(const std::string& path) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored)) return FileType::images;
  const std::string head = head_of(path);
  if (begins_a_volume(head)) return FileType::volume;
  if (head.starts_with("\x76\x2f\x31\x01")) return FileType::stack;
  if (head.starts_with("\x1a\x45\xdf\xa3") || (head.size() >= 8 && head.substr(4, 4) == "ftyp")) return FileType::video;
  return std::nullopt;
}

void require_content(const std::string& path) {
  std::error_code ignored;
  if ((path != "-" && std::filesystem::is_directory(path, ignored)) || !head_of(path).empty()) return;
  throw Error{Fault::data, input_name(path) + ": is empty; the program that should have written it failed"};
}

FileType file_type(const std::string& path) {
  if (const auto known = known_file_type(path)) return *known;
  require_content(path);
  const std::string name = input_name(path);
  const std::string foreign = foreign_format(head_of(path));
  if (!foreign.empty()) {
    throw Error{Fault::data, name + ": is " + foreign +
                                 "; a volume (VDB), a stack (EXR), a video (MKV, MP4) or a folder of images "
                                 "is needed" +
                                 foreign_remedy(head_of(path))};
  }
  throw Error{Fault::data, name + ": neither a volume (VDB), a stack (EXR), a video (MKV, MP4) nor a folder of images"};
}

}  // namespace vam::io
