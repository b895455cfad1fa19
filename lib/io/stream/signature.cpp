// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/signature.hpp"

#include <cstddef>

namespace vam::io {

namespace {

using namespace std::string_view_literals;

struct Signature {
  std::size_t at;
  std::string_view bytes;
  const char* name;
};

constexpr Signature signatures[] = {
    {0, " BDV"sv, "a volume (OpenVDB)"},
    {0, "\x76\x2f\x31\x01"sv, "a stack (OpenEXR)"},
    {0, "\x93NUMPY"sv, "a NumPy array (.npy)"},
    {0, "II*\0"sv, "a TIFF image"},
    {0, "MM\0*"sv, "a TIFF image"},
    {0, "II+\0"sv, "a TIFF image"},
    {0, "\x89PNG\r\n"sv, "a PNG image"},
    {0, "\xff\xd8\xff"sv, "a JPEG image"},
    {0, "GIF8"sv, "a GIF image"},
    {0, "\x89HDF\r\n"sv, "an HDF5 file"},
    {0, "CDF\x01"sv, "a NetCDF file"},
    {0, "NRRD000"sv, "an NRRD volume"},
    {208, "MAP "sv, "an MRC volume"},
    {128, "DICM"sv, "a DICOM image"},
    {344, "n+1\0"sv, "a NIfTI volume"},
    {0, "ISO-10303-21"sv, "a STEP model, surfaces without triangles"},
    {72, "S      1"sv, "an IGES model, surfaces without triangles"},
    {0, "\xd0\xcf\x11\xe0"sv, "a document of a CAD program"},
    {0, "3D Geometry File Format"sv, "a Rhino model"},
    {0, "glTF"sv, "a glTF model"},
    {0, "Kaydara FBX"sv, "an FBX model"},
    {0, "BLENDER"sv, "a Blender file"},
    {0, "# vtk DataFile"sv, "a VTK file"},
    {0, "\x1f\x8b"sv, "compressed by gzip"},
    {0, "BZh"sv, "compressed by bzip2"},
    {0, "\3757zXZ"sv, "compressed by xz"},
    {0, "\x28\xb5\x2f\xfd"sv, "compressed by zstd"},
    {0, "7z\xbc\xaf"sv, "a 7z archive"},
    {0, "Rar!"sv, "a RAR archive"},
    {257, "ustar"sv, "a tar archive"},
    {0, "PK\3\4"sv, "a zip archive"},
    {0, "\x1a\x45\xdf\xa3"sv, "a Matroska video"},
    {4, "ftyp"sv, "an MP4 video"},
    {0, "%PDF"sv, "a PDF document"},
    {0, "\xff\xfe"sv, "text of 16 bits a character; save it as ASCII or UTF-8"},
    {0, "\xfe\xff"sv, "text of 16 bits a character; save it as ASCII or UTF-8"},
    {0, "\177ELF"sv, "a program"},
    {0, "{"sv, "JSON (vam-report shows reports)"},
};

}  // namespace

std::string foreign_format(std::string_view head) {
  for (const Signature& signature : signatures) {
    if (head.size() > signature.at && head.substr(signature.at).starts_with(signature.bytes)) return signature.name;
  }
  return "";
}

}  // namespace vam::io
