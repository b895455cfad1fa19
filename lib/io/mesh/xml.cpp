// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/private/xml.hpp"

#include <expat.h>

#include <exception>
#include <memory>
#include <type_traits>

#include "base/index.hpp"
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

}  // namespace vam::io
