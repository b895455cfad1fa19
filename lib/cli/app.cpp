#include "cli/app.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <set>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/text.hpp"
#include "cli/declaration.hpp"
#include "cli/private/values.hpp"
#include "cli/private/words.hpp"

namespace vam::cli {

struct App::State {
  Declaration tool;
  CLI::App* parser = nullptr;
  std::unique_ptr<CLI::App> owned;                // the root's parser
  std::vector<std::unique_ptr<App>> subcommands;  // declared under this one
  std::string history;
  std::string heading = App::plain_heading;  // of the options that follow

  Group& current_group() {
    const auto found = std::find_if(tool.groups.begin(), tool.groups.end(),
                                    [this](const Group& group) { return group.title == heading; });
    if (found != tool.groups.end()) return *found;
    tool.groups.push_back({heading, {}});
    return tool.groups.back();
  }
};

namespace {

// Shell quoting for the history line: words of harmless characters stay as they are.
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

std::string exact(double value) { return format_number(value, 17); }

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

}  // namespace

App::App(Manual manual) : state_(std::make_unique<State>()) {
  state_->owned = std::make_unique<CLI::App>();
  state_->parser = state_->owned.get();
  state_->parser->set_help_flag();
  state_->parser->require_subcommand(0, 1);  // an operand of the first may have the name of another
  state_->parser->option_defaults()->always_capture_default(false);
  state_->tool.manual = std::move(manual);
}

App::~App() = default;

App& App::group(const std::string& title) {
  state_->heading = title;
  return *this;
}

// Every option takes its text through one function that converts, checks and stores it.
App& App::declare(Option option, const std::function<void(const std::string&)>& store,
                  const std::function<std::string()>& value) {
  option.value = value;
  const std::string flag = long_flag(option);
  auto* parsed = state_->parser->add_option_function<std::vector<std::string>>(
      option.flag, [store](const std::vector<std::string>& texts) {
        for (const auto& text : texts) store(text);
      });
  parsed->expected(option.repeatable ? -1 : 1)->type_size(1)->allow_extra_args(false);
  parsed->multi_option_policy(option.repeatable ? CLI::MultiOptionPolicy::TakeAll : CLI::MultiOptionPolicy::Throw);
  state_->current_group().options.push_back(std::move(option));
  return *this;
}

// An operand is required when nothing stands for it, or when a required one follows.
App& App::positional(const std::string& value_name, std::string& target, const std::string& help,
                     const std::string& former) {
  state_->parser->add_option(value_name, target)->type_size(1)->expected(1);
  state_->tool.positionals.push_back({value_name, help, target, former});
  if (!target.empty()) return *this;
  for (auto& positional : state_->tool.positionals) positional.default_text.clear();
  return *this;
}

App& App::option(const std::string& flag, const std::string& value_name, std::string& target, const std::string& help) {
  return declare(
      {flag, value_name, help, target, "", {}}, [&target](const std::string& text) { target = text; },
      [&target] { return target; });
}

App& App::option(const std::string& flag, const std::string& value_name, double& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, format_number(target), describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_number(flag, text, range); },
      [&target] { return exact(target); });
}

App& App::option(const std::string& flag, const std::string& value_name, int& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, std::to_string(target), describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_integer(flag, text, range); },
      [&target] { return std::to_string(target); });
}

App& App::option(const std::string& flag, const std::string& value_name, std::optional<double>& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, target ? format_number(*target) : "", describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_number(flag, text, range); },
      [&target] { return target ? exact(*target) : ""; });
}

App& App::option(const std::string& flag, const std::string& value_name, std::optional<int>& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, target ? std::to_string(*target) : "", describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_integer(flag, text, range); },
      [&target] { return target ? std::to_string(*target) : ""; });
}

App& App::option(const std::string& flag, const std::string& value_name, std::vector<double>& target, int count,
                 const std::string& help) {
  std::vector<std::string> defaults;
  for (const double value : target) defaults.push_back(format_number(value));
  return declare(
      {flag, value_name, help, join(defaults, ","), "", {}},
      [&target, flag, count](const std::string& text) {
        const auto parts = split(text, ',');
        if (count > 0 && static_cast<int>(parts.size()) != count) {
          throw Error{Fault::usage, flag + ": '" + text + "' has " + std::to_string(parts.size()) + " numbers; give " +
                                        std::to_string(count) + ", separated by commas"};
        }
        target.clear();
        for (const auto& part : parts) target.push_back(checked_number(flag, part, any));
      },
      [&target] {
        std::vector<std::string> values;
        for (const double value : target) values.push_back(exact(value));
        return join(values, ",");
      });
}

App& App::option(const std::string& flag, const std::string& value_name, std::vector<std::string>& target,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, "", "", {}, true}, [&target](const std::string& text) { target.push_back(text); },
      [&target] { return join(target, ","); });
}

App& App::option(const std::string& flag, const std::string& value_name, Range range,
                 const std::function<void(int)>& store, const std::string& help, const std::string& default_text) {
  const auto given = std::make_shared<std::string>(default_text);
  return declare(
      {flag, value_name, help, default_text, describe(range), {}},
      [store, flag, range, given](const std::string& text) {
        store(checked_integer(flag, text, range));
        *given = text;
      },
      [given] { return *given; });
}

App& App::choice(const std::string& flag, std::string& target, const std::vector<std::string>& values,
                 const std::string& help) {
  return declare(
      {flag, "WORD", help, target, "", values},
      [&target, flag, values](const std::string& text) {
        if (std::find(values.begin(), values.end(), text) == values.end()) {
          throw Error{Fault::usage,
                      flag + ": '" + text + "' is not one of " + join(values, ", ") + did_you_mean(text, values)};
        }
        target = text;
      },
      [&target] { return target; });
}

App& App::flag(const std::string& name, bool& target, const std::string& help) {
  state_->parser->add_flag(name, target);
  state_->current_group().options.push_back({name, "", help, "", "", {}});
  state_->current_group().options.back().value = [&target] { return std::string(target ? "1" : "0"); };
  return *this;
}

App& App::default_is(const std::string& text) {
  state_->current_group().options.back().default_text = text;
  return *this;
}

App& App::not_in_job() {
  state_->current_group().options.back().in_job = false;
  return *this;
}

App& App::needs(const std::vector<std::string>& any_of) {
  state_->current_group().options.back().needs = any_of;
  return *this;
}

App& App::was(const std::string& old_flag, const std::string& value) {
  state_->current_group().options.back().former.push_back({old_flag, value});
  return *this;
}

App& App::subcommand(const std::string& name, const std::string& summary, std::string& chosen) {
  auto nested = std::unique_ptr<App>(new App(Manual{name, summary, {}, {}, {}, {}}));
  nested->state_->owned.reset();
  nested->state_->parser = state_->parser->add_subcommand(name, summary);
  nested->state_->parser->set_help_flag();
  nested->state_->parser->callback([&chosen, name] { chosen = name; });
  state_->subcommands.push_back(std::move(nested));
  return *state_->subcommands.back();
}

bool App::given(const std::string& flag) const { return state_->parser->get_option(flag)->count() > 0; }

std::string App::history() const { return state_->history; }

std::string App::job() const {
  std::string text;
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      if (option.in_job) text += long_flag(option) + "=" + option.value() + "\n";
    }
  }
  return text;
}

// The declaration with those of its subcommands, for printing.
Declaration App::whole() const {
  Declaration tool = state_->tool;
  for (const auto& nested : state_->subcommands) tool.subcommands.push_back(nested->whole());
  return tool;
}

// CLI11 reports only that a count is wrong: find the option that comes twice, or the one whose value is missing.
void App::fail_on_count(const std::vector<std::string>& reversed_words) const {
  std::set<std::string> seen;
  std::string last;
  for (auto word = reversed_words.rbegin(); word != reversed_words.rend(); ++word) {
    if (word->rfind("--", 0) != 0) continue;
    last = split(*word, '=').front();
    if (!seen.insert(last).second) throw Error{Fault::usage, last + ": given twice"};
  }
  throw Error{Fault::usage, last + ": needs a value"};
}

// Of the tool and of its commands, whose options are given only if the command is.
void App::require_needed() const {
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      if (option.needs.empty() || !given(long_flag(option))) continue;
      const auto is_given = [&](const std::string& flag) { return given(flag); };
      if (std::any_of(option.needs.begin(), option.needs.end(), is_given)) continue;
      throw Error{Fault::usage, long_flag(option) + ": requires " + join(option.needs, " or ")};
    }
  }
  for (const auto& nested : state_->subcommands) nested->require_needed();
}

void App::parse(int argc, char** argv) {
  const Declaration tool = whole();
  std::vector<std::string> words(argv + 1, argv + argc);
  rename_former(tool, words);
  state_->history = tool.manual.name + " " + VAM_VERSION;
  for (const auto& word : words) state_->history += " " + quoted(word);
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
  require_needed();
}

// --help, --version, --man and --completion print and end; they win over every other option. True when one was given.
bool App::print_about(int argc, char** argv) const {
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") return false;
    if (word == "--help" || word == "-h") {
      std::fputs(help_text(asked_about(whole(), words)).c_str(), stdout);
    } else if (word == "--version") {
      std::printf("%s %s\n", state_->tool.manual.name.c_str(), VAM_VERSION);
    } else if (word == "--man") {
      std::fputs(manual_page(whole()).c_str(), stdout);
    } else if (word == "--completion") {
      std::fputs(completion(whole(), i + 1 < argc ? argv[i + 1] : "").c_str(), stdout);
    } else {
      continue;
    }
    return true;
  }
  return false;
}

int App::run(int argc, char** argv, const std::function<void()>& body) {
  const std::string& name = state_->tool.manual.name;
  set_program_name(name);
  std::string line;
  Fault fault = Fault::bug;
  try {
    if (!print_about(argc, argv)) {
      parse(argc, argv);
      body();
    }
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw Error{Fault::io, std::string("standard output: write failed (") + std::strerror(errno) + ")"};
    }
    return 0;
  } catch (const Error& error) {
    line = error.what();
    fault = error.fault;
  } catch (const std::bad_alloc&) {
    line = "out of memory";
    fault = Fault::memory;
  } catch (const std::exception& error) {
    line = std::string("internal error: ") + error.what() + "; please report this";
  }
  std::fprintf(stderr, "%s: %s\n", name.c_str(), printable(line).c_str());
  return static_cast<int>(fault);
}

}  // namespace vam::cli
