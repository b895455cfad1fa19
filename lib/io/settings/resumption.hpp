// SPDX-License-Identifier: GPL-3.0-or-later
// Which print goes on with which: what remains of one that was aborted is given once.
#pragma once

#include <string>
#include <vector>

namespace vam::io {

/// What is wrong with the resumed.json of a run folder, as a line; empty: nothing, or the run was not resumed. It says
/// when and by which other print, and is there where events.jsonl states it ("resumed", unless "released" follows).
/// Throws what is no fault of the folder, as a lack of open files.
[[nodiscard]] std::string resumption_problem(const std::string& run);

/// Throws Fault::data where there is one.
void require_resumption(const std::string& run);

/// The print that resumed this one, by its resumed.json; empty: none.
[[nodiscard]] std::string resumed_by(const std::string& run);

/// The folder that a run resumes, as vam-print was given it; empty: none.
[[nodiscard]] std::string resumes_of(const std::string& run);

/// Does a run resume this one? By when that was armed and by the sinogram, so that both may have been moved.
[[nodiscard]] bool resumes(const std::string& run, const std::string& earlier);

/// Of these run folders a line for each without resumed.json of which another one showed the rest.
[[nodiscard]] std::vector<std::string> unmarked_resumptions(const std::vector<std::string>& runs);

}  // namespace vam::io
