// SPDX-License-Identifier: GPL-3.0-or-later
// Parses what the user gave, checks it as a whole, and runs the tool.
#include <sys/resource.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <set>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/system_error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "cli/private/app_state.hpp"
#include "cli/private/command_line.hpp"
#include "cli/private/values.hpp"

namespace vam::cli {

std::string quoted(const std::string& word) {
  const char* harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+,./:@%";
  if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) return word;
  // A history has one line a command.
  if (printable(word) != word) {
    std::string text = "$'";
    for (const char c : word) text += c == '\'' || c == '\\' ? std::string("\\") + c : printable({&c, 1});
    return text + "'";
  }
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

namespace {

// The command that the words name, with the tool's name before its own, or the tool.
Declaration asked_about(Declaration tool, const std::vector<std::string>& words) {
  const int place = find_command(tool, words);
  for (Declaration nested : tool.subcommands) {
    if (place < 0 || nested.manual.name != words[place]) continue;
    nested.manual.name = tool.manual.name + " " + nested.manual.name;
    return nested;
  }
  return tool;
}

// A smaller stack ends the process by a signal in the midst of its work; threads have one of the same size.
void require_stack() {
  constexpr rlim_t least_bytes = rlim_t{256} * 1024;
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= least_bytes) return;
  throw Error{Fault::memory, "needs a stack of " + std::to_string(least_bytes / 1024) + " KiB, and the limit is " +
                                 std::to_string(limit.rlim_cur / 1024) + " KiB; raise it (ulimit -s)"};
}

/// "vam-slice: 0.52 s, 0.21 GiB of memory"
std::string use_of_machine(double seconds) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  constexpr double kib_per_gib = 1 << 20;
  return program_name() + ": " + format_number(seconds, 3) + " s, " +
         format_number(static_cast<double>(used.ru_maxrss) / kib_per_gib, 2) + " GiB of memory";
}

}  // namespace

// The command that was given, or the plain form.
const App& App::form_in_use() const {
  for (const auto& nested : state_->subcommands) {
    if (nested->state_->parser->parsed()) return *nested;
  }
  return *this;
}

bool App::given(const std::string& flag) const { return form_in_use().state_->parser->get_option(flag)->count() > 0; }

std::string App::history() const { return history_without({}); }

std::string App::history_without(const std::vector<std::string>& flags) const {
  std::string line = state_->tool.manual.name + " " + VAM_VERSION;
  for (const std::string& word : words_without(state_->tool, state_->words, flags)) line += " " + quoted(word);
  return line;
}

// The declaration with those of its subcommands, for printing.
Declaration App::whole() const {
  Declaration tool = state_->tool;
  for (const auto& nested : state_->subcommands) tool.subcommands.push_back(nested->whole());
  return tool;
}

// CLI11 reports only that a count is wrong: find the option that comes twice, or the one whose value is missing.
void App::fail_on_count(const std::vector<std::string>& reversed_words) const {
  const auto repeatable = [](const Declaration& tool, const std::string& flag) {
    for (const auto& group : tool.groups) {
      for (const auto& option : group.options) {
        if (option.repeatable && long_flag(option) == flag) return true;
      }
    }
    return false;
  };
  const Declaration tool = whole();
  const auto may_repeat = [&](const std::string& flag) {
    return repeatable(tool, flag) || std::any_of(tool.subcommands.begin(), tool.subcommands.end(),
                                                 [&](const Declaration& nested) { return repeatable(nested, flag); });
  };
  std::set<std::string> seen;
  std::string last;
  for (auto word = reversed_words.rbegin(); word != reversed_words.rend(); ++word) {
    if (!is_option(*word)) continue;
    last = flag_of(*word);
    if (!seen.insert(last).second && !may_repeat(last)) throw Error{Fault::usage, last + ": given twice"};
  }
  throw Error{Fault::usage, last + ": needs a value"};
}

// Operands and options that a form, the plain one or a command, cannot do without.
void App::require_present() const {
  const auto require = [&](const std::string& name, const std::string& unless = "") {
    if (state_->parser->get_option(name)->count() > 0 || (!unless.empty() && given(unless))) return;
    throw Error{Fault::usage, name + ": missing" + (unless.empty() ? "" : ", as is " + unless) + "; see --help"};
  };
  for (const auto& positional : state_->tool.positionals) {
    const std::string name = split(positional.value_name, ' ').front();
    if (positional.default_text.empty()) require(name);
    const auto values = positional.values();
    if (!given(name) || std::find(values.begin(), values.end(), "") == values.end()) continue;
    throw Error{Fault::usage, name + ": is empty; give its name"};
  }
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      if (option.required) require(long_flag(option), option.unless);
    }
  }
}

namespace {

// By the text of --memory.
void bound(const std::optional<std::string>& gib) {
  constexpr double bytes_per_gib = 1 << 30;
  const double chosen = !gib ? 0 : checked_number(memory_flag, *gib, {0, 1e6, true});
  bound_memory(static_cast<std::uint64_t>(std::ceil(chosen * bytes_per_gib)), memory_flag);
}

}  // namespace

void App::parse(int argc, char** argv) {
  const Declaration tool = whole();
  std::vector<std::string> words(argv + 1, argv + argc);
  const CommonOptions given = take_common_options(words);
  set_talk(given.log);
  bound(given.memory_gib);
  add_implicit_values(tool, words);
  state_->words = words;
  require_command(tool, words);
  put_command_first(tool, words);
  if (find_command(tool, words) < 0) {  // an operand may have the name of a command
    for (const auto& nested : state_->subcommands) nested->state_->parser->disabled();
  }
  const std::vector<std::string> reversed(words.rbegin(), words.rend());  // CLI11 takes them last first
  try {
    state_->parser->parse(std::vector<std::string>(reversed));  // it consumes its copy
  } catch (const CLI::ExtrasError&) {
    const auto unknown = state_->parser->remaining(true);
    const auto first = std::find_if(unknown.begin(), unknown.end(), [](const auto& word) { return word != "--"; });
    throw Error{Fault::usage, unknown_word(tool, words, first == unknown.end() ? "" : *first)};
  } catch (const CLI::ArgumentMismatch&) {
    fail_on_count(reversed);
  } catch (const CLI::ParseError& error) {
    throw Error{Fault::usage, std::string(error.what()) + " (" + tool.manual.name + " --help lists all)"};
  }
  const App& form = form_in_use();
  form.require_present();
  form.require_rules();
  form.require_own_inputs();
  form.require_own_outputs();
}

// --help, --version, --man and --completion print and end; they win over every other option. True when one was given.
bool App::print_about(int argc, char** argv) const {
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") return false;
    if (flag_of(word) == "--help" || word == "-h") {
      if (flag_of(word) != word && word != "--help=all") throw not_one_of("--help", word.substr(7), {"all"});
      std::fputs(help_text(asked_about(whole(), words), word == "--help=all").c_str(), stdout);
    } else if (word == "--version") {
      std::printf("%s %s\n", state_->tool.manual.name.c_str(), VAM_VERSION);
    } else if (word == "--man") {
      std::fputs(printed_manual(whole()).c_str(), stdout);
    } else if (word == "--completion") {
      std::fputs(completion(whole(), i + 1 < argc ? argv[i + 1] : "").c_str(), stdout);
    } else {
      continue;
    }
    return true;
  }
  return false;
}

int App::run(int argc, char** argv, const std::function<void()>& plain) {
  set_program_name(state_->tool.manual.name);
  (void)std::signal(SIGXFSZ, SIG_IGN);  // beyond a limit of file sizes a write fails, and is reported
  const auto start = std::chrono::steady_clock::now();
  std::string line;
  Fault fault = Fault::bug;
  try {
    if (!print_about(argc, argv)) {
      require_stack();
      parse(argc, argv);
      const App& form = form_in_use();
      &form == this ? plain() : form.state_->body();
      if (talk().verbose)
        note(use_of_machine(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
    }
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {  // errno is that of an earlier write, or lost
      throw Error{Fault::io, "standard output: write failed" +
                                 (errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : std::string())};
    }
    return 0;
  } catch (const Error& error) {
    line = error.what();
    fault = error.fault;
  } catch (const std::filesystem::filesystem_error& problem) {  // of a name that cannot be looked up
    const Error refused = system_error(Fault::no_input, problem.path1().string(), problem.code().value());
    line = refused.what();
    fault = refused.fault;
  } catch (const OutOfMemory& refused) {
    line = refused.what();
    fault = Fault::memory;
  } catch (const std::bad_alloc&) {
    line = OutOfMemory(0).what();
    fault = Fault::memory;
  } catch (const std::exception& error) {
    line = std::string("internal error: ") + error.what() + "; please report this";
  }
  say(line);
  return static_cast<int>(fault);
}

}  // namespace vam::cli
