// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/angle_source.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "base/text/text.hpp"
#include "device/stage/private/ripple_filter.hpp"

namespace vam::device {

namespace {

constexpr double stale_s = 0.5;
constexpr std::size_t longest_line = 4096;

class ElapsedAngle final : public AngleSource {
 public:
  ElapsedAngle(double speed_deg_s, Clock& clock) : speed_deg_s_(speed_deg_s), clock_(clock) {}
  void update() override {
    if (!start_s_) start_s_ = clock_.now_s();
  }
  std::optional<AngleSample> at(double t_s) const override {
    if (!start_s_) return std::nullopt;
    return AngleSample{t_s, speed_deg_s_ * (t_s - *start_s_), 0};
  }

 private:
  double speed_deg_s_;
  Clock& clock_;
  std::optional<double> start_s_;
};

class StandingAngle final : public AngleSource {
 public:
  explicit StandingAngle(double angle_deg) : angle_deg_(angle_deg) {}
  void update() override {}
  std::optional<AngleSample> at(double t_s) const override { return AngleSample{t_s, angle_deg_, 0}; }

 private:
  double angle_deg_;
};

class FollowedAngle final : public AngleSource {
 public:
  FollowedAngle(const std::string& path, Clock& clock, double last_deg) : clock_(clock), last_deg_(last_deg) {
    fd_ = path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd_ < 0) throw system_error(Fault::no_input, path + ": cannot open", errno);
  }
  ~FollowedAngle() override { close(fd_); }

  void update() override {
    while (!ended_ && readable()) {
      std::array<char, 4096> bytes{};
      const ssize_t count = read(fd_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0 && !complete()) {
        throw Error{Fault::busy, "stage angles: input ended" + so_far() + "; see the error of vam-stage"};
      }
      ended_ = count <= 0;
      if (ended_) break;
      buffer_.append(bytes.data(), count);
      take_lines();
    }
    if (lines_ > 0 && !complete() && clock_.now_s() - heard_s_ > stale_s) {
      throw Error{Fault::busy, "stage angles: none for " + format_number(stale_s) + " s" + so_far()};
    }
  }

  std::optional<AngleSample> at(double t_s) const override {
    if (!fit_.ready()) return std::nullopt;
    return fit_.at(t_s);
  }

 private:
  [[nodiscard]] bool complete() const { return lines_ > 0 && last_.angle_deg >= last_deg_; }

  bool readable() const {
    pollfd ready{fd_, POLLIN, 0};
    return poll(&ready, 1, 0) > 0;
  }

  void take_lines() {
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = buffer_.find('\n', begin)) != std::string::npos; begin = end + 1) {
      last_ = parse_angle_line(buffer_.substr(begin, end - begin), ++lines_);
      if (!last_.ramp) fit_.add(last_);  // what it learned there would be taken for ripple
      heard_s_ = clock_.now_s();
    }
    buffer_.erase(0, begin);
    if (buffer_.size() > longest_line) (void)parse_angle_line(buffer_, lines_ + 1);  // throws: no line is so long
  }

  std::string so_far() const {
    return lines_ == 0 ? " before the first sample"
                       : " after line " + std::to_string(lines_) + ", at " + format_number(last_.angle_deg, 7) + " deg";
  }

  Clock& clock_;
  double last_deg_;
  bool ended_ = false;
  int fd_ = -1;
  std::string buffer_;
  long lines_ = 0;
  double heard_s_ = 0;
  AngleSample last_;
  RippleFilter fit_;
};

}  // namespace

std::unique_ptr<AngleSource> elapsed_angle(double speed_deg_s, Clock& clock) {
  return std::make_unique<ElapsedAngle>(speed_deg_s, clock);
}

std::unique_ptr<AngleSource> standing_angle(double angle_deg) { return std::make_unique<StandingAngle>(angle_deg); }

std::unique_ptr<AngleSource> followed_angle(const std::string& path, Clock& clock, double last_deg) {
  return std::make_unique<FollowedAngle>(path, clock, last_deg);
}

}  // namespace vam::device
