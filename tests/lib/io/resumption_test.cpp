// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "io/settings/run_folder.hpp"
#include "testing.hpp"

namespace {

namespace fs = std::filesystem;

const std::string hash(64, 'a');

// Prints in folders of their own below one that is removed at the end.
struct Prints {
  fs::path path = fs::temp_directory_path() / ("vam-resumption-" + std::to_string(getpid()));
  Prints() = default;
  Prints(const Prints&) = delete;
  Prints& operator=(const Prints&) = delete;
  ~Prints() { fs::remove_all(path); }
  [[nodiscard]] std::string add(const char* name, const std::string& utc, const std::string& more = "") const {
    fs::create_directories(path / name);
    std::ofstream(path / name / "events.jsonl")
        << R"({"utc":")" << utc << R"(","event":"armed","turns":3,"from_deg":0,"sinogram_sha256":")" << hash << '"'
        << more << "}\n";
    return (path / name).string();
  }
};

}  // namespace

TEST_CASE("a print is resumed by the one that states when it was armed, wherever both are now") {
  const Prints prints;
  const std::string first = prints.add("w", "2026-11-27T10:00:00.123Z");
  const std::string moved = prints.add("archive/other", "2026-11-27T10:00:00.123Z");
  const std::string namesake = prints.add("archive/w", "2026-11-26T09:00:00.456Z");
  const std::string rest =
      prints.add("rest", "2026-11-27T10:05:00.789Z", R"(,"resumes":"w","resumes_utc":"2026-11-27T10:00:00.123Z")");
  CHECK(vam::io::resumes(rest, first));
  CHECK(vam::io::resumes(rest, moved));
  CHECK_FALSE(vam::io::resumes(rest, namesake));
  CHECK_FALSE(vam::io::resumes(rest, rest));
  CHECK_FALSE(vam::io::resumes(first, rest));
}
