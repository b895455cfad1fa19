// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/private/gcs_link.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::device {

namespace {

constexpr std::size_t longest_answer = 65536;
constexpr int not_referenced = 5;  // or the servo is off, which the backend sees to

// ASCII, and the upper half of Latin-1 for the signs of copyright and micro.
bool printable(const std::string& line) {
  return std::all_of(line.begin(), line.end(), [](char c) {
    const auto value = static_cast<unsigned char>(c);
    return (value >= 32 && value < 127) || value >= 0xA0 || c == '\t' || c == '\r';
  });
}

// By the maker's picontrollererrors.h.
std::string gcs_meaning(int code) {
  static const std::map<int, std::string> meanings{
      {1, "parameter syntax"},
      {2, "unknown command"},
      {3, "command too long"},
      {5, "not referenced: give --home, or run `vam-stage home` if the controller keeps the reference"},
      {7, "beyond the limits of travel"},
      {8, "faster than the stage's maximum"},
      {10, "stopped by command"},
      {15, "no such axis"},
      {17, "parameter out of range"},
      {23, "illegal axis"},
      {24, "wrong number of parameters"},
      {25, "not a number"},
      {26, "parameter missing"},
      {27, "soft limits out of range"},
      {45, "the reference move failed"},
      {50, "referencing is disabled"},
      {54, "unknown parameter"},
      {63, "initialisation in progress"},
      {84, "the motor is off"},
      {88, "not allowed in reference mode"},
      {93, "not allowed while the axis moves"},
      {-1024, "motion error: position error too large, servo switched off"}};
  const auto found = meanings.find(code);
  return found == meanings.end() ? "" : found->second;
}

}  // namespace

std::string gcs_error_text(int code) {
  const std::string meaning = gcs_meaning(code);
  return std::to_string(code) + (meaning.empty() ? "" : " (" + meaning + ")");
}

GcsLink::GcsLink(std::unique_ptr<Port> port, Clock& clock, GcsSettings settings)
    : port_(std::move(port)), clock_(clock), settings_(settings) {}

Error GcsLink::malformed(const std::string& question, const std::string& answer, const std::string& what) const {
  return {Fault::protocol, port_->name() + ": " + excerpt(question) + " was answered " + excerpt(answer) + ", " + what};
}

double GcsLink::send(const std::string& text) {
  // Unsolicited bytes would be taken for the answer. 1 ns: only what has already arrived.
  while (!port_->read(1e-9).empty()) continue;
  // Before the bytes leave: a process that must wait for its processor right after has its answer before it knows.
  const double t0_s = clock_.now_s();
  port_->write(addressed(text.size() == 1 ? text : text + "\n", settings_));
  return t0_s;
}

std::string GcsLink::read_more(const std::string& question, const std::string& so_far) {
  std::string bytes = port_->read(settings_.timeout_s);
  if (bytes.empty()) {
    throw Error{Fault::busy, port_->name() + ": no " + (so_far.empty() ? "answer" : "end of the answer") + " to " +
                                 excerpt(question) + " within " + format_number(settings_.timeout_s) +
                                 " s; check power, cable" +
                                 (settings_.address ? ", baud rate and address" : " and baud rate")};
  }
  if (so_far.size() + bytes.size() > longest_answer)
    throw malformed(question, so_far, "more than 64 KiB without a terminator");
  return bytes;
}

std::string GcsLink::without_sender(const std::string& question, const std::string& line) const {
  // "0 <sender> text": 0 is the computer's address.
  const std::size_t first = line.find(' ');
  if (line.rfind("0 ", 0) != 0) return line;
  const std::size_t second = line.find(' ', first + 1);
  if (second == std::string::npos) return line;
  int sender = 0;
  const char* end = line.data() + second;
  const auto [stopped, error] = std::from_chars(line.data() + first + 1, end, sender);
  if (error != std::errc{} || stopped != end) return line;
  const int wanted = settings_.address.value_or(1);
  if (sender != wanted) {
    throw malformed(question, line,
                    "by controller " + std::to_string(sender) + " instead of " + std::to_string(wanted));
  }
  return line.substr(second + 1);
}

GcsAnswer GcsLink::ask(const std::string& text) {
  GcsAnswer answer;
  answer.t0_s = send(text);
  std::string received;
  for (;;) {
    const std::size_t end = received.find('\n');
    if (end == std::string::npos) {
      received += read_more(text, received);
      answer.t1_s = clock_.now_s();
      continue;
    }
    std::string line = received.substr(0, end);
    received.erase(0, end + 1);
    if (line.empty()) continue;  // the LF that may follow the byte of #7
    if (!printable(line)) throw malformed(text, line, "which is not printable text; check the baud rate");
    const bool last = line.back() != ' ';
    if (!last) line.pop_back();
    answer.lines.push_back(without_sender(text, line));
    if (last) break;
  }
  return answer;
}

double GcsLink::ask_number(const std::string& text, double* t0_s, double* t1_s) {
  const GcsAnswer answer = ask(text);
  const std::string& line = answer.lines.front();
  const std::size_t equals = line.find('=');
  const std::size_t blank = text.find(' ');
  // "SPA? 1 0xA" may be answered "1 10=50": only the axis must come back as it was sent.
  const std::string axis = blank == std::string::npos ? "" : split(text.substr(blank + 1), ' ').front();
  const bool echoes = equals != std::string::npos && split(line.substr(0, equals), ' ').front() == axis;
  const auto value = echoes ? parse_number(line.substr(equals + 1)) : std::nullopt;
  if (!value || !std::isfinite(*value) || answer.lines.size() != 1) {
    throw malformed(text, line, "not '" + axis + "=<number>'");
  }
  if (t0_s != nullptr) *t0_s = answer.t0_s;
  if (t1_s != nullptr) *t1_s = answer.t1_s;
  return *value;
}

int GcsLink::take_error() {
  const std::string line = ask("ERR?").lines.front();
  const auto value = parse_number(line);
  if (!value || *value != std::floor(*value) || std::abs(*value) > 1e6) throw malformed("ERR?", line, "not a number");
  return static_cast<int>(*value);
}

void GcsLink::order(const std::string& text, int harmless) {
  send(text);
  const int code = take_error();
  if (code != 0 && code != harmless) {
    if (code == not_referenced) throw Error{Fault::data, port_->name() + ": " + gcs_meaning(code)};
    throw Error{Fault::protocol, port_->name() + ": '" + text + "' was refused with error " + gcs_error_text(code)};
  }
}

unsigned GcsLink::motion_bits() {
  const std::string line = ask("\x05").lines.front();
  unsigned bits = 0;
  const std::string digits = line.rfind("0x", 0) == 0 ? line.substr(2) : line;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
  if (error != std::errc{} || end != digits.data() + digits.size()) throw malformed("#5", line, "not hexadecimal");
  return bits;
}

bool GcsLink::ready() {
  send("\x07");
  std::string received;
  for (;;) {
    received += read_more("#7", received);
    // A chain puts its sender before the byte, so look at the first byte that is not text.
    const auto byte = std::find_if(received.begin(), received.end(), [](char c) { return (c & 0x80) != 0; });
    if (byte != received.end()) {
      const auto code = static_cast<unsigned char>(*byte);
      if (code == 0xB1 || code == 0xB0) return code == 0xB1;
      throw malformed("#7", received, "neither B1 (ready) nor B0 (busy)");
    }
    if (received.find('\n') != std::string::npos) throw malformed("#7", received, "neither B1 (ready) nor B0 (busy)");
  }
}

void GcsLink::halt_now() { port_->write(addressed("\x18", settings_)); }

std::string addressed(const std::string& bytes, const GcsSettings& settings) {
  return settings.address ? std::to_string(*settings.address) + " " + bytes : bytes;
}

}  // namespace vam::device
