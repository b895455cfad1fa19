// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/file_type.hpp"
#include "testing.hpp"

using namespace vam;
using io::foreign_format;
using io::foreign_remedy;

namespace {

bool names(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string declared = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";

}  // namespace

TEST_CASE("XML is named by its root element, and models have a remedy") {
  CHECK(foreign_format(declared + "<amf unit=\"millimeter\">") == "an AMF model");
  CHECK(foreign_format(declared + "<!-- <X3D> by hand -->\r\n<COLLADA\nversion=\"1.4.1\">") == "a COLLADA model");
  CHECK(foreign_format(declared + "<!DOCTYPE X3D PUBLIC \"ISO//Web3D//DTD X3D 3.0//EN\" \"x3d-3.0.dtd\"><X3D>") ==
        "an X3D model");
  for (const std::string root : {"<amf>", "<COLLADA>", "<X3D>"}) {
    CHECK(foreign_format(root) != "");
    CHECK(foreign_remedy(root) == "; export it as 3MF or STL");
  }
  CHECK(names(foreign_remedy(declared + "<VTKFile type=\"ImageData\">"), "vam-convert"));
  CHECK(foreign_format(declared + "<other/>") == "XML");
  CHECK(foreign_format(declared + "<!-- cut") == "XML");
  CHECK(foreign_format(declared) == "XML");
  CHECK(foreign_format("<other/>") == "");
  CHECK(foreign_format("<amfibian>") == "");
}

TEST_CASE("vam-convert is the remedy for what it reads") {
  const std::string zeros(400, '\0');
  for (const std::string& head : {"\x93NUMPY" + zeros, "\x89HDF\r\n" + zeros, std::string("II*\0", 4),
                                  std::string("MM\0*", 4), std::string("MM\0+", 4), std::string("NRRD0004")}) {
    CAPTURE(foreign_format(head));
    CHECK(names(foreign_remedy(head), "vam-convert makes a volume"));
  }
  for (const std::string& head : {std::string(128, '\0') + "DICM", std::string(344, '\0') + std::string("n+1\0", 4),
                                  std::string(208, '\0') + "MAP " + zeros}) {
    CAPTURE(foreign_format(head));
    CHECK(names(foreign_remedy(head), "array, which vam-convert reads"));
  }
}
