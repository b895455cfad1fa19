// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/private/model_part.hpp"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <type_traits>

#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/mesh/private/formats.hpp"

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

void XMLCALL on_text(void* data, const char* text, int size) {
  guarded(data, [&](const Parsing& parsing) { parsing.events.text({text, static_cast<std::size_t>(size)}); });
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

void XmlElement::wrong(std::string_view wanted) const {
  const auto text = attribute(wanted);
  throw MeshProblem{"its <" + std::string(name) + "> has " +
                    (text ? std::string(wanted) + " " + excerpt(*text) : "no " + std::string(wanted)) +
                    "; it is damaged"};
}

void parse_xml(const ByteFeed& feed, const XmlEvents& events) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
      XML_ParserCreateNS(nullptr, separator), XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Parsing parsing{parser.get(), events, nullptr};
  XML_SetUserData(parser.get(), &parsing);
  XML_SetElementHandler(parser.get(), on_begin, on_end);
  if (events.text) XML_SetCharacterDataHandler(parser.get(), on_text);
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
constexpr std::string_view beam_extension = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";

// Extensions that are read, or without which the shape of an object is still what its triangles say.
constexpr std::array<std::string_view, 6> known_extensions{
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07",
    beam_extension,
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07",
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
    metadata_.clear();
    if (element.space != core) {
      begin_of_extension(element);
    } else if (element.name == "vertex" && object_ != nullptr) {
      object_->points.push_back(
          {unit_ * element.number("x"), unit_ * element.number("y"), unit_ * element.number("z")});
    } else if (element.name == "triangle" && object_ != nullptr) {
      add_triangle(element);
    } else if (element.name == "component" && object_ != nullptr) {
      object_->components.push_back(instance(element));
    } else if (element.name == "metadata" && object_ != nullptr) {
      metadata_ = element.attribute("name").value_or(""), text_.clear();
    } else if (element.name == "item") {
      const std::string_view printed = element.attribute("printable").value_or("1");
      if (printed != "0" && printed != "false") part_.build.push_back(instance(element));
    } else if (element.name == "object") {
      begin_object(element);
    } else if (element.name == "model") {
      unit_ = unit_mm(element);
      check_extensions(element);
      found_ = true;
    }
  }
  void text(std::string_view piece) {
    if (!metadata_.empty()) text_ += piece;
  }
  void end() {
    // Cura says "True" of what a mesh is.
    if (!metadata_.empty() && trimmed(text_) == "True" && role_of(metadata_) != Role::refused)
      object_->type = metadata_;
    metadata_.clear();
    if (depth_-- != object_depth_ || object_ == nullptr) return;
    const std::size_t before = object_->triangles.size();
    append_beams(beams_, *object_);
    count(object_->triangles.size() - before);
    beams_.clear();
    object_ = nullptr;
  }

  ModelPart result() {
    if (!found_) throw MeshProblem{"not a 3MF file: its model part has no model"};
    return std::move(part_);
  }

 private:
  void check_extensions(const XmlElement& model) const {
    const auto& known = known_extensions;
    for (const std::string& prefix : split(std::string(model.attribute("requiredextensions").value_or("")), ' ')) {
      const auto space = spaces_.find(prefix);
      if (prefix.empty() ||
          (space != spaces_.end() && std::find(known.begin(), known.end(), space->second) != known.end())) {
        continue;
      }
      throw MeshProblem{"needs the 3MF extension " + excerpt(space != spaces_.end() ? space->second : prefix) +
                        ", which is not read; export it as a plain mesh"};
    }
  }

  void begin_of_extension(const XmlElement& element) {
    if (object_ == nullptr) return;
    if (element.space == beam_extension && element.name == "beamlattice") {
      end_ = beam_end(element, "", {0, unit_ * element.number("radius")});
      least_mm_ = unit_ * element.number("minlength");
      for (const char* mode : {"clippingmode", "clipping", "ballmode"}) {  // the second before version 1.2
        if (element.attribute(mode).value_or("none") != "none")
          spoil("has a beam lattice with " + std::string(mode) + ", which is not read");
      }
    } else if (element.space == beam_extension && element.name == "beam") {
      add_beam(element);
    } else if (depth_ == object_depth_ + 1) {  // a shape of another kind stands beside the mesh
      spoil("has a " + excerpt(element.name) + ", which is not read");
    }
  }

  [[nodiscard]] BeamEnd beam_end(const XmlElement& element, const std::string& which, BeamEnd end) const {
    if (element.attribute("v" + which)) end.point = element.number<int>("v" + which);
    if (element.attribute("r" + which)) end.radius_mm = unit_ * element.number("r" + which);
    if (const auto cap = element.attribute("cap" + which); cap && !cap->empty()) end.cap = cap->front();
    if (end.radius_mm <= 0) element.wrong("r" + which);
    return end;
  }

  void add_beam(const XmlElement& element) {
    constexpr std::size_t most = std::size_t{1} << 16;
    const BeamEnd first = beam_end(element, "1", end_);
    const Beam beam{first, beam_end(element, "2", {0, first.radius_mm, end_.cap})};
    for (const auto& [end, name] : {std::pair{beam[0], "v1"}, {beam[1], "v2"}})
      if (end.point < 0 || end.point >= count_of(object_->points)) element.wrong(name);
    const double mm = length(object_->points[beam[1].point] - object_->points[beam[0].point]);
    if (mm == 0 || mm < least_mm_) return;
    if (beams_.size() == most) return spoil("has a lattice of more than " + std::to_string(most) + " beams");
    beams_.push_back(beam);
  }

  void begin_object(const XmlElement& element) {
    const unsigned id = element.number<unsigned>("id");
    const auto [place, fresh] = part_.objects.try_emplace(id);
    if (!fresh) throw MeshProblem{"has two objects " + std::to_string(id) + "; mend it, or save the mesh again"};
    object_ = &place->second;
    object_->type = element.attribute("type").value_or("model");
    // Its mesh is a stand-in, in the samples of the 3MF Consortium the box around it, whatever its meshresolution.
    if (element.attribute("slicestackid")) spoil("consists of slices, which are not read");
    object_depth_ = depth_;
  }

  void spoil(const std::string& problem) const {
    if (object_->problem.empty()) object_->problem = problem;
  }

  void count(std::size_t more) {
    if ((triangles_ += more) <= max_triangles) return;
    throw MeshProblem{"has more than " + std::to_string(max_triangles) + " triangles, the most that are read"};
  }

  void add_triangle(const XmlElement& element) {
    count(1);
    object_->triangles.push_back({element.number<int>("v1"), element.number<int>("v2"), element.number<int>("v3")});
  }

  [[nodiscard]] Instance instance(const XmlElement& element) {
    if (++instances_ > max_instances) {
      throw MeshProblem{"has more than " + std::to_string(max_instances) +
                        " items and components, the most that are read"};
    }
    Instance made;
    made.part = element.attribute("path").value_or("");
    made.object = element.number<unsigned>("objectid");
    const auto text = element.attribute("transform");
    if (!text) return made;
    std::string_view rest = *text;
    for (auto& row : made.placement.rows) {
      for (double& value : row) {
        const auto number = number_of<double>(take_word(rest));
        if (!number) element.wrong("transform");
        value = *number * (&row == &made.placement.rows.back() ? unit_ : 1);
      }
    }
    if (!without_blanks(rest).empty()) element.wrong("transform");
    return made;
  }

  ModelPart part_;
  std::map<std::string, std::string> spaces_;  // by prefix
  Object3mf* object_ = nullptr;                // that is open
  std::vector<Beam> beams_;                    // of it
  BeamEnd end_;                                // of its beams that say nothing else
  double least_mm_ = 0;                        // shorter beams are none
  std::string metadata_;                       // that is open, of an object
  std::string text_;                           // and what it says
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
                   [&](std::string_view prefix, std::string_view space) { reader.declare(prefix, space); },
                   [&](std::string_view piece) { reader.text(piece); }});
  return reader.result();
}

std::string model_target(const ByteFeed& feed) {
  std::string target;
  parse_xml(feed, {[&](const XmlElement& element) {
                     if (element.name != "Relationship") return;
                     if (!element.attribute("Type").value_or("").ends_with("/3dmodel")) return;
                     if (!target.empty()) throw MeshProblem{"names two 3D models to be printed; save it again"};
                     target = element.attribute("Target").value_or("");
                   },
                   {},
                   {}});
  return target;
}

}  // namespace vam::io
