// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log/progress.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include "base/log/log.hpp"
#include "base/log/status_line.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam {

namespace {

constexpr long first_ms = 500, line_every_ms = 100, json_every_ms = 500;
constexpr int least_bar = 8, largest_bar = 30;

bool shown_as(ProgressStyle style) {
  if (talk().quiet || talk().progress != style) return false;
  return style == ProgressStyle::json || status_line::possible();
}

/// None before the first step is done, or where their number is not known.
std::optional<double> left_s(long done, long total, double elapsed) {
  if (done <= 0 || total <= 0) return std::nullopt;
  return elapsed * static_cast<double>(std::max(total - done, 0L)) / static_cast<double>(done);
}

}  // namespace

std::string clock_text(double seconds) {
  const long all = std::lround(std::min(seconds, 1e9));
  char text[32];
  if (all < 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld", all / 60, all % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", all / 3600, all / 60 % 60, all % 60);
  }
  return text;
}

Progress::Progress(std::string what, long total) : what_(std::move(what)), total_(total) {}

Progress::~Progress() {
  if (drawn_ms_ > 0 && shown_as(ProgressStyle::line)) status_line::hide();
  if (std::uncaught_exceptions() > 0) return;  // the error says what became of the work
  const long done = done_;
  if (shown_as(ProgressStyle::json)) print_json(done, 0, true);
  if (talk().verbose) note(program_name() + ": " + what_ + ": " + format_number(elapsed_s(), 3) + " s");
}

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::tick(long steps) { refresh(done_ += steps); }

void Progress::set_progress(long done, long total, std::vector<Figure> figures) {
  {
    const std::scoped_lock one(drawing_);
    figures_ = std::move(figures);
  }
  total_ = total;
  done_ = done;
  refresh(done);
}

void Progress::refresh(long done) {
  const bool json = shown_as(ProgressStyle::json);
  if (!json && !shown_as(ProgressStyle::line)) return;
  const auto now_ms = static_cast<long>(1000 * elapsed_s());
  long last = drawn_ms_;
  if (now_ms < (last == 0 ? first_ms : last + (json ? json_every_ms : line_every_ms))) return;
  if (drawn_ms_.compare_exchange_strong(last, now_ms)) draw(done);
}

void Progress::draw(long done) {
  const std::scoped_lock one(drawing_);
  if (shown_as(ProgressStyle::json)) return print_json(done, left_s(done, total_, elapsed_s()), false);
  status_line::show(line(done, status_line::width()));
}

/// The bar takes the room that is left. Where there is too little, figures go first, then the tool's name.
std::string Progress::line(long done, int width) const {
  const long total = total_;
  std::vector<std::string> parts{std::to_string(done)};
  if (total > 0) {
    const std::string percent = std::to_string(std::min(100L, 100 * done / total));
    parts = {(percent.size() < 2 ? " " : "") + percent + " %"};
    if (const auto left = left_s(done, total, elapsed_s())) parts.push_back(clock_text(*left) + " left");
  }
  const std::size_t least = parts.size();
  for (const Figure& figure : figures_) parts.push_back(figure.name + (" " + format_number(figure.value, 3)));
  std::string begin = program_name() + ": " + what_ + " ";
  const auto room = [&] { return width - static_cast<int>(begin.size() + join(parts, ", ").size()); };
  while (room() < 0 && parts.size() > least) parts.pop_back();
  if (room() < 0) begin = what_ + " ";
  const int bar = std::min(largest_bar, room() - 3);  // its brackets and a blank
  if (total <= 0 || bar < least_bar) return begin + join(parts, ", ");
  const int filled = static_cast<int>(std::min(done, total) * bar / total);
  return begin + '[' + std::string(filled, '#') + std::string(bar - filled, ' ') + "] " + join(parts, ", ");
}

void Progress::print_json(long done, std::optional<double> left_s, bool finished) const {
  Json line{{"tool", program_name()}, {"task", what_}, {"done", done}};
  if (total_ > 0) line["total"] = total_.load();
  line["elapsed_s"] = std::round(1000 * elapsed_s()) / 1000;
  if (left_s) line["left_s"] = std::round(1000 * *left_s) / 1000;
  line["finished"] = finished;
  for (const Figure& figure : figures_) {
    std::string key = figure.name;
    std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return std::tolower(c); });
    line[key] = figure.value;
  }
  std::fprintf(stderr, "%s\n", line.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
}

}  // namespace vam
