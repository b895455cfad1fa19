// SPDX-License-Identifier: GPL-3.0-or-later
// vam-print: one print, synchronised and safe: stage, projector, and on request camera and live metrology.
// Every tool is a child of this one that ends, dark and stopped, when this one ends for any reason.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "cli/app.hpp"
#include "cli/companion.hpp"
#include "device/os/interrupt.hpp"
#include "manual_page.hpp"
#include "session/printer.hpp"
#include "vam-print/arm.hpp"
#include "vam-print/drive.hpp"

namespace {

using namespace vam;
using print_tool::Run;

constexpr std::array ending{SIGINT, SIGTERM, SIGHUP};

// Below these something fails in words of its own, wherever it is.
void require_limits() {
  constexpr rlim_t least = 64;
  const auto require = [](auto what, const char* name, const char* flag) {
    rlimit limit{};
    if (getrlimit(what, &limit) != 0 || limit.rlim_cur >= least) return;
    throw Error{Fault::memory, "needs " + std::to_string(least) + " " + name + ", and the limit is " +
                                   std::to_string(limit.rlim_cur) + "; raise it (ulimit " + flag + ")"};
  };
  require(RLIMIT_NOFILE, "open files", "-n");
  require(RLIMIT_NPROC, "processes", "-u");
}

/// One print, from the folder of its run to its records.
class Print {
 public:
  explicit Print(const print_tool::Options& options) : run_(options) {}

  /// Returns the exit status; throws Interrupted when all is safe and recorded.
  int go() {
    int status = 0;
    int signal = 0;
    try {
      if (!run_.options.resume.empty()) take_over(run_);
      if (run_.options.plan) return print_plan(run_);
      make_folder(run_);
      made_ = true;
      arm(run_);
      drive_.emplace(run_);
      claim_.take(run_);
      drive_->start();
      status = drive_->watch();
    } catch (const Error& error) {
      say(error.what());
      status = static_cast<int>(error.fault);
    } catch (const print_tool::Ended& ended) {
      status = ended.status;
    } catch (const device::Interrupted& interrupted) {
      signal = interrupted.signal;
      status = 128 + signal;
    } catch (const std::exception& error) {  // of the standard library: no memory, a folder that cannot be used
      say(error.what());
      status = static_cast<int>(Fault::io);
    }
    for (const int one : ending) (void)std::signal(one, SIG_IGN);
    if (made_) status = leave(status);
    if (signal != 0) throw device::Interrupted{signal};
    return status;
  }

 private:
  // Every way out: dark, then still, then the summary.
  int leave(int status) {
    if (!drive_) drive_.emplace(run_);
    drive_->end_all();
    run_.look();
    claim_.release(run_, run_.may_be_lit());
    if (!is_used(run_)) {  // refused before any device was in use: nothing to tell
      drive_->end_watching();
      std::error_code ignored;
      std::filesystem::remove_all(run_.folder, ignored);
      return status;
    }
    log_dark(run_);
    drive_->keep_logs();
    run_.note("end", {{"outcome", run_.outcome}, {"status", status}});
    drive_->end_watching();
    try {
      write_summary(run_, status);
    } catch (const std::exception&) {
      say(run_.file("summary.json") + ": cannot be written completely; free space on the disk");
      if (status == 0) status = static_cast<int>(Fault::io);
    }
    drive_->finish();
    return status;
  }

  Run run_;
  bool made_ = false;
  print_tool::Claim claim_;
  std::optional<print_tool::Drive> drive_;
};

int run(const print_tool::Options& options) {
  require_limits();
  if (session::print_printer(options.printer)) return 0;
  require_sound(options);
  cli::find_tools_beside();
  device::supervise();
  std::array<bool, ending.size()> ignored{};
  for (std::size_t i = 0; i < ending.size(); ++i) {
    struct sigaction before = {};
    ignored.at(i) = sigaction(ending.at(i), nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
  }
  int status = 0;
  device::interruptible([&] {
    for (std::size_t i = 0; i < ending.size(); ++i) {  // as whoever starts this in the background wants it
      if (ignored.at(i)) (void)std::signal(ending.at(i), SIG_IGN);
    }
    status = Print(options).go();
  });
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  print_tool::Options options;
  std::vector<cli::ExitStatus> statuses = cli::device_statuses;
  statuses.push_back({1, "Complete, but --until was not met, or it ended in open loop."});
  statuses.push_back({137, "A tool was killed."});
  cli::App app({"vam-print",
                "run one print: stage, projector, and optionally camera and live metrology",
                manual_page,
                statuses,
                false,
                {cli::ManualList{"states", print_tool::state_texts()}}});
  declare(app, options);
  int status = 0;
  const int refused = app.run(argc, argv, [&] { status = run(options); });
  return refused != 0 ? refused : status;
}
