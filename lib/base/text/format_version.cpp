// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/format_version.hpp"

#include <charconv>
#include <system_error>

#include "base/text/printable.hpp"

namespace vam {

std::string FormatKind::objection(std::string_view stated) const {
  int number = 0;
  const char* last = stated.data() + stated.size();
  const auto [end, problem] = std::from_chars(stated.data(), last, number);
  if (problem != std::errc{} || end != last || number < 1) {
    return "states " + excerpt(stated) + " as the version of its format (" + std::string(kind()) +
           "), which is no whole number from 1 on; write it again";
  }
  if (number <= entry_->version) return "";
  return "is of version " + std::to_string(number) + " of its format (" + std::string(kind()) +
         "), and this tool reads up to version " + version() + "; install newer VAM tools";
}

std::string schema_objection(std::string_view schema) {
  const std::size_t slash = schema.find('/');
  const FormatVersion* found = find_format(schema.substr(0, slash));
  if (found == nullptr || slash == std::string_view::npos) return "";
  return FormatKind(*found).objection(schema.substr(slash + 1));
}

}  // namespace vam
