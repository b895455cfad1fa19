// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log/chain.hpp"

#include <xxhash.h>

#include <array>
#include <cstdio>

namespace vam {

namespace {

constexpr std::string_view chain_begin = ",\"chain\":\"";
constexpr std::string_view chain_end = "\"}";
constexpr std::size_t digits = 16;
constexpr std::size_t length = chain_begin.size() + digits + chain_end.size();

std::string link(std::string_view before, std::string_view object) {
  const std::string text = std::string(before).append(object);
  std::array<char, digits + 1> hash{};
  std::snprintf(hash.data(), hash.size(), "%016llx",
                static_cast<unsigned long long>(XXH3_64bits(text.data(), text.size())));
  return hash.data();
}

}  // namespace

std::string chained(std::string_view object, std::string& chain) {
  object.remove_suffix(1);  // the brace
  chain = link(chain, object);
  return std::string(object).append(chain_begin).append(chain).append(chain_end);
}

std::string chain_of(std::string_view line) {
  if (line.size() < length) return "";
  const std::string_view last = line.substr(line.size() - length);
  if (!last.starts_with(chain_begin) || !last.ends_with(chain_end)) return "";
  const std::string_view hash = last.substr(chain_begin.size(), digits);
  return hash.find_first_not_of("0123456789abcdef") == std::string_view::npos ? std::string(hash) : "";
}

bool follows(std::string_view line, std::string_view before) {
  return chain_of(line) == link(before, line.substr(0, line.size() - length));
}

}  // namespace vam
