// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/printable.hpp"

#include <cstdio>

namespace vam {

namespace {

/// How many bytes the character of UTF-8 takes that the text begins with; 0 where it begins with none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  if (byte(0) < 0x80) return 1;
  if (byte(0) >= 0xc2 && byte(0) <= 0xdf) return continues(1) ? 2 : 0;
  if (byte(0) >= 0xe0 && byte(0) <= 0xef) {
    const bool overlong = byte(0) == 0xe0 && byte(1) < 0xa0;
    const bool surrogate = byte(0) == 0xed && byte(1) > 0x9f;
    return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (byte(0) < 0xf0 || byte(0) > 0xf4) return 0;
  const bool overlong = byte(0) == 0xf0 && byte(1) < 0x90;
  const bool beyond = byte(0) == 0xf4 && byte(1) > 0x8f;
  return continues(1) && continues(2) && continues(3) && !overlong && !beyond ? 4 : 0;
}

/// Marks that turn the direction of text, and ends of lines: U+061C, U+200E, U+200F, U+2028 to U+202E, U+2066 to
/// U+2069.
bool moves_text(std::string_view character) {
  if (character == "\xd8\x9c") return true;
  const auto last = static_cast<unsigned char>(character.back());
  if (character.starts_with("\xe2\x80")) return last == 0x8e || last == 0x8f || (last >= 0xa8 && last <= 0xae);
  return character.starts_with("\xe2\x81") && last >= 0xa6 && last <= 0xa9;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool c1 = byte == 0xc2 && next >= 0x80 && next <= 0x9f;  // U+0080 to U+009F
    const std::size_t bytes = character_bytes(text.substr(i));
    if (byte >= 0x20 && byte != 0x7f && !c1 && bytes > 0 && !moves_text(text.substr(i, bytes))) {
      shown += text.substr(i, bytes);
      i += bytes - 1;
    } else if (byte == '\n' || byte == '\t') {
      shown += byte == '\n' ? "\\n" : "\\t";
    } else {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(c1 ? next : byte));
      shown += code;
      if (c1) ++i;
    }
  }
  return shown;
}

namespace {

std::string shortened_in(std::string_view text, const char* quote) {
  constexpr std::size_t most = 64;
  if (text.size() <= most) return quote + printable(text) + quote;
  std::size_t end = most;
  for (; end > most - 4 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80; --end) continue;  // whole characters
  return quote + printable(text.substr(0, end)) + "..." + quote + " (" + std::to_string(text.size()) + " bytes)";
}

}  // namespace

std::string excerpt(std::string_view text) { return shortened_in(text, "'"); }

std::string briefly(std::string_view text) { return shortened_in(text, ""); }

std::string page_text(std::string_view text) {
  std::string shown;
  for (const char c : printable(text)) {
    switch (c) {
      case '<':
        shown += "&lt;";
        break;
      case '>':
        shown += "&gt;";
        break;
      case '&':
        shown += "&amp;";
        break;
      case '"':
        shown += "&quot;";
        break;
      case '\'':
        shown += "&#39;";
        break;
      default:
        shown += c;
    }
  }
  return shown;
}

std::string link_text(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                       c == '_' || c == '-' || c == '~';
    char code[8];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += plain ? std::string(1, c) : code;
  }
  return text;
}

}  // namespace vam
