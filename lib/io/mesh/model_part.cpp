// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/private/model_part.hpp"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/text.hpp"

namespace vam::io {

namespace {

constexpr XML_Index longest_tag = XML_Index{1} << 20;
constexpr char separator = '\n';  // between namespace and name; no name holds one

struct Parsing {
  XML_Parser parser;
  const XmlEvents& events;
  std::exception_ptr problem;  // exceptions do not pass through C
};

template <class Work>
void guarded(void* data, const Work& work) {
  auto& parsing = *static_cast<Parsing*>(data);
  if (parsing.problem) return;
  try {
    work(parsing);
  } catch (...) {
    parsing.problem = std::current_exception();
    XML_StopParser(parsing.parser, XML_FALSE);
  }
}

void split_name(std::string_view whole, std::string_view& space, std::string_view& name) {
  const auto at = whole.rfind(separator);
  space = at == std::string_view::npos ? std::string_view() : whole.substr(0, at);
  name = at == std::string_view::npos ? whole : whole.substr(at + 1);
}

void XMLCALL on_begin(void* data, const char* name, const char** attributes) {
  guarded(data, [&](const Parsing& parsing) {
    XmlElement element{{}, {}, attributes};
    split_name(name, element.space, element.name);
    parsing.events.begin(element);
  });
}

void XMLCALL on_end(void* data, const char*) {
  guarded(data, [&](const Parsing& parsing) {
    if (parsing.events.end) parsing.events.end();
  });
}

void XMLCALL on_namespace(void* data, const char* prefix, const char* space) {
  guarded(data, [&](const Parsing& parsing) {
    if (parsing.events.declare && prefix != nullptr && space != nullptr) parsing.events.declare(prefix, space);
  });
}

void XMLCALL on_doctype(void* data, const char*, const char*, const char*, int) {
  guarded(data, [](const Parsing&) { throw MeshProblem{"its XML declares a document type, which 3MF forbids"}; });
}

}  // namespace

std::optional<std::string_view> XmlElement::attribute(std::string_view wanted) const {
  for (const char** pair = attributes; *pair != nullptr; pair += 2) {
    std::string_view of;
    std::string_view called;
    split_name(pair[0], of, called);
    if (called == wanted) return pair[1];
  }
  return std::nullopt;
}

void parse_xml(const ByteFeed& feed, const XmlEvents& events) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
      XML_ParserCreateNS(nullptr, separator), XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Parsing parsing{parser.get(), events, nullptr};
  XML_SetUserData(parser.get(), &parsing);
  XML_SetElementHandler(parser.get(), on_begin, on_end);
  XML_SetStartNamespaceDeclHandler(parser.get(), on_namespace);
  XML_SetStartDoctypeDeclHandler(parser.get(), on_doctype);
  const auto parse = [&](std::string_view bytes, bool last) {
    const auto status = XML_Parse(parser.get(), bytes.data(), count_of(bytes), last ? 1 : 0);
    if (parsing.problem) std::rethrow_exception(parsing.problem);
    if (status == XML_STATUS_OK) return;
    throw MeshProblem{"its XML is wrong in line " + std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": " +
                      XML_ErrorString(XML_GetErrorCode(parser.get())) + "; it is truncated or damaged"};
  };
  XML_Index fed = 0;
  feed([&](std::string_view bytes) {
    parse(bytes, false);
    fed += count_of(bytes);
    if (fed - XML_GetCurrentByteIndex(parser.get()) <= longest_tag) return;  // each piece has it read from its begin
    throw MeshProblem{"its XML has a tag of more than 1 MiB in line " +
                      std::to_string(XML_GetCurrentLineNumber(parser.get())) + "; it is damaged"};
  });
  parse("", true);
}

namespace {

constexpr std::string_view core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";

// Extensions without which the shape of an object is still what its triangles say. Beam lattices are refused object by
// object, as a file may declare the extension without using it.
constexpr std::array<std::string_view, 5> harmless{
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02",
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
};

// 3MF core specification, 3.4: millimetre when absent.
double unit_mm(const XmlElement& model) {
  const std::string_view unit = model.attribute("unit").value_or("millimeter");
  const std::pair<std::string_view, double> units[] = {{"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10},
                                                       {"inch", 25.4},   {"foot", 304.8},   {"meter", 1000}};
  for (const auto& [name, mm] : units) {
    if (unit == name) return mm;
  }
  throw MeshProblem{"unknown 3MF unit " + excerpt(unit) + "; save it in millimeter"};
}

class ModelReader {
 public:
  void declare(std::string_view prefix, std::string_view space) { spaces_[std::string(prefix)] = space; }

  void begin(const XmlElement& element) {
    ++depth_;
    if (element.space != core) {
      // A shape of another kind stands beside the mesh or, a beam lattice, in it.
      if (object_ != nullptr && (depth_ == object_depth_ + 1 || element.name == "beamlattice")) unread(element);
    } else if (element.name == "vertex" && object_ != nullptr) {
      object_->points.push_back(
          {unit_ * number(element, "x"), unit_ * number(element, "y"), unit_ * number(element, "z")});
    } else if (element.name == "triangle" && object_ != nullptr) {
      add_triangle(element);
    } else if (element.name == "component" && object_ != nullptr) {
      object_->components.push_back(instance(element));
    } else if (element.name == "item") {
      if (element.attribute("printable").value_or("1") != "0") part_.build.push_back(instance(element));
    } else if (element.name == "object") {
      begin_object(element);
    } else if (element.name == "model") {
      unit_ = unit_mm(element);
      check_extensions(element);
      found_ = true;
    }
  }
  void end() {
    if (depth_-- == object_depth_) object_ = nullptr;
  }

  ModelPart result() {
    if (!found_) throw MeshProblem{"not a 3MF file: its model part has no model"};
    return std::move(part_);
  }

 private:
  void check_extensions(const XmlElement& model) const {
    for (const std::string& prefix : split(std::string(model.attribute("requiredextensions").value_or("")), ' ')) {
      const auto space = spaces_.find(prefix);
      if (prefix.empty() ||
          (space != spaces_.end() && std::find(harmless.begin(), harmless.end(), space->second) != harmless.end())) {
        continue;
      }
      throw MeshProblem{"needs the 3MF extension " + excerpt(space != spaces_.end() ? space->second : prefix) +
                        ", which is not read; export it as a plain mesh"};
    }
  }

  void begin_object(const XmlElement& element) {
    const unsigned id = number<unsigned>(element, "id");
    const auto [place, fresh] = part_.objects.try_emplace(id);
    if (!fresh) throw MeshProblem{"has two objects " + std::to_string(id) + "; mend it, or save the mesh again"};
    object_ = &place->second;
    const std::string_view type = element.attribute("type").value_or("model");  // core specification, 4.1
    object_->support = type == "support" || type == "solidsupport";
    object_depth_ = depth_;
  }

  void unread(const XmlElement& element) const {
    if (object_->unread.empty()) object_->unread = element.name;
  }

  void add_triangle(const XmlElement& element) {
    if (++triangles_ > max_triangles) {
      throw MeshProblem{"has more than " + std::to_string(max_triangles) + " triangles, the most that are read"};
    }
    object_->triangles.push_back({number<int>(element, "v1"), number<int>(element, "v2"), number<int>(element, "v3")});
  }

  [[nodiscard]] Instance instance(const XmlElement& element) {
    if (++instances_ > max_instances) {
      throw MeshProblem{"has more than " + std::to_string(max_instances) +
                        " items and components, the most that are read"};
    }
    Instance made;
    made.part = element.attribute("path").value_or("");
    made.object = number<unsigned>(element, "objectid");
    const auto text = element.attribute("transform");
    if (!text) return made;
    std::string_view rest = *text;
    for (auto& row : made.placement.rows) {
      for (double& value : row) {
        const auto number = number_of<double>(take_word(rest));
        if (!number) wrong(element, "transform");
        value = *number * (&row == &made.placement.rows.back() ? unit_ : 1);
      }
    }
    if (!without_blanks(rest).empty()) wrong(element, "transform");
    return made;
  }

  [[noreturn]] static void wrong(const XmlElement& element, std::string_view attribute) {
    const auto text = element.attribute(attribute);
    throw MeshProblem{"its <" + std::string(element.name) + "> has " +
                      (text ? std::string(attribute) + " " + excerpt(*text) : "no " + std::string(attribute)) +
                      "; it is damaged"};
  }
  template <class Number = double>
  [[nodiscard]] static Number number(const XmlElement& element, std::string_view attribute) {
    const auto value = number_of<Number>(element.attribute(attribute).value_or(""));
    if (!value) wrong(element, attribute);
    return *value;
  }

  ModelPart part_;
  std::map<std::string, std::string> spaces_;  // by prefix
  Object3mf* object_ = nullptr;                // that is open
  int depth_ = 0;
  int object_depth_ = 0;
  std::size_t triangles_ = 0;
  std::uint64_t instances_ = 0;
  double unit_ = 1;
  bool found_ = false;
};

}  // namespace

ModelPart parse_model_part(const ByteFeed& feed) {
  ModelReader reader;
  parse_xml(feed, {[&](const XmlElement& element) { reader.begin(element); }, [&] { reader.end(); },
                   [&](std::string_view prefix, std::string_view space) { reader.declare(prefix, space); }});
  return reader.result();
}

std::string model_target(const ByteFeed& feed) {
  std::string target;
  parse_xml(feed, {[&](const XmlElement& element) {
                     if (element.name != "Relationship" || !target.empty()) return;
                     if (element.attribute("Type").value_or("").ends_with("/3dmodel")) {
                       target = element.attribute("Target").value_or("");
                     }
                   },
                   {},
                   {}});
  return target;
}

}  // namespace vam::io
