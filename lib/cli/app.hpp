// SPDX-License-Identifier: GPL-3.0-or-later
// One declaration per tool gives the parser, --help, --version, the manual page (--man) and completions
// (--completion bash|zsh|fish). run() is the only place that catches.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vam::cli {

struct ExitStatus {
  int code;
  std::string meaning;
};

/// A block of a manual page that is printed from a table: paragraphs of plain text.
struct ManualList {
  std::string name;  // of its marks
  std::vector<std::string> paragraphs;
};

/// What a tool declares for its manual page beside its options.
struct Manual {
  std::string name;       // vam-slice
  std::string summary;    // one line, lower case, no full stop
  std::string page = {};  // man/vam-slice.1, whose blocks App prints [printed_manual]; empty: only these
  std::vector<ExitStatus> statuses = {};  // beside those of all tools; device_statuses
  bool locks = false;                     // looks up who reserves devices, if it drives none
  std::vector<ManualList> lists = {};
};

/// For the manuals of tools that drive devices.
inline const std::vector<ExitStatus> device_statuses{{69, "A device is absent."},
                                                     {75, "A device is busy or timed out; try again."},
                                                     {76, "Device protocol error."},
                                                     {129, "SIGHUP, after the safe state."},
                                                     {130, "SIGINT, after the safe state."},
                                                     {143, "SIGTERM, after the safe state."}};

struct Range {
  double low;
  double high;
  bool open_low = false;  // low itself is not allowed
  bool not_zero = false;
};
inline constexpr Range any{-1e300, 1e300};
inline constexpr Range not_zero{-1e300, 1e300, false, true};
inline constexpr Range positive{0, 1e300, true};
inline constexpr Range non_negative{0, 1e300};
inline constexpr Range rate{0.001, 1e6};  // of what must end in a lifetime: frames a second, degrees a second

/// A word of a command line in one line: quoted for a shell, but for harmless characters.
[[nodiscard]] std::string quoted(const std::string& word);

struct Option;  // cli/private/declaration.hpp
struct Rule;
struct Declaration;

/// Options are bound to variables whose values are the defaults shown to the user. Value names carry the unit (MM,
/// DEG).
class App {
 public:
  explicit App(Manual manual);
  ~App();

  static constexpr const char* plain_heading = "Options";  // that of options without one
  /// Heading of the options that follow, which all require one of these conditions (but for options that they name)
  /// and are not for these kinds: only_with(), not_for().
  App& group(const std::string& title, const std::vector<std::string>& only_with = {},
             const std::vector<std::string>& not_for = {});
  /// An empty target: required.
  App& positional(const std::string& value_name, std::string& target, const std::string& help);
  /// The last one: all operands that are left; target holds the one that stands for none.
  App& positional(const std::string& value_name, std::vector<std::string>& target, const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, std::string& target, const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, double& target, Range range,
              const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, int& target, Range range,
              const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, std::optional<double>& target, Range range,
              const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, std::optional<int>& target, Range range,
              const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, std::vector<double>& target, int count,
              const std::string& help);
  App& option(const std::string& flag, const std::string& value_name, std::vector<std::string>& target,
              const std::string& help);  // repeatable
  App& option(const std::string& flag, const std::string& value_name, Range range,
              const std::function<void(int)>& store, const std::string& help, const std::string& default_text);
  App& choice(const std::string& flag, std::string& target, const std::vector<std::string>& values,
              const std::string& help);
  App& flag(const std::string& name, bool& target, const std::string& help);
  /// The default of the option declared last in words, where the tool works it out: "projector.pixel_mm".
  App& default_is(const std::string& text);
  /// The number of the option declared last may be left out: then it is this one. What follows the option and is no
  /// number is an operand, or the next option.
  App& when_left_out(const std::string& number);
  /// Of the options declared so far, --help shows these and those that are required; --help=all shows all.
  App& usual(const std::vector<std::string>& flags);
  /// What --help says of the option declared last, instead of its first sentence, where --help=all says more.
  App& brief(const std::string& text);
  /// The option declared last must be given; or where that other one is not.
  App& required();
  App& required_without(const std::string& flag);
  /// The option declared last leaves the result as it is, or is left out of job() for another reason.
  App& not_in_job();
  /// The option declared last names a file that the tool writes: no two of them may name the same one. Of what kind it
  /// is: its name must end in one of `endings`, if any; "-" and devices may be called anything.
  App& writes(const std::vector<std::string>& endings = {});
  /// And writes it in these formats, whatever it is called: a name with the ending of another one is refused.
  App& writes_as(const std::vector<std::string>& endings);
  /// The operand or option declared last names a file that the tool reads; - is standard input. At most one input is
  /// standard input, and no output is an input. `unless`: options that stand for the operand, and exclude it.
  App& reads(const std::vector<std::string>& unless = {});
  /// The option declared last makes a form of the tool, which the synopsis shows beside the plain one: with the
  /// operands that it does not stand for (reads).
  App& form();
  /// The option declared last is refused where none of these conditions holds: "--like", which is given;
  /// "--geometry vial", whose value is in force; "--output .mp4", whose name ends so; "resin.psf_mm", a setting of the
  /// printer [require_settings]. Called again: nor where none of those holds. value: only with this one of the option.
  App& only_with(const std::vector<std::string>& any_of, const std::string& value = "");
  /// And where one of these holds.
  App& excludes(const std::vector<std::string>& conditions, const std::string& value = "");
  /// The option declared last has no effect on these kinds of input or output, in the plural [require_for]. Called
  /// again: nor on those.
  App& not_for(const std::vector<std::string>& kinds);
  /// A subcommand with options of its own (vam-curethrough model, vam-stage move), which runs `body`. Returns the
  /// nested declaration. A tool with operands or options of its own has a plain form, which runs without a command;
  /// else a command must be given. Options may stand before the command.
  App& subcommand(const std::string& name, const std::string& summary, const std::function<void()>& body);
  /// The same with options that are kept here: what declares them, and what runs with them, given this App.
  template <class Options>
  void subcommand(const std::string& name, const std::string& summary, void (*declared)(App&, Options&),
                  void (*body)(const App&, Options&)) {
    const auto options = std::make_shared<Options>();
    declared(subcommand(name, summary, [this, options, body] { body(*this, *options); }), *options);
  }

  /// Parses, calls the body of the command that is given, or that of the plain form, and maps every exception to one
  /// line on stderr and its exit status.
  int run(int argc, char** argv, const std::function<void()>& plain = nullptr);

  /// "vam-slice 0.1.0 part.stl --voxel 0.1": the line for vam:history; known once run() has parsed. No paths of other
  /// machines, time stamps or host names are added.
  [[nodiscard]] std::string history() const;
  /// history() without these long options and their values, which do not change the result.
  [[nodiscard]] std::string history_without(const std::vector<std::string>& flags) const;
  /// A line "--flag=value" for each option but those not_in_job(), with the values in force, and the hash of each file
  /// that such an option reads: which job a kept state is of. An option is part of it unless its declaration says
  /// otherwise.
  [[nodiscard]] std::string job() const;
  /// The files that are read, in the order of their declaration.
  [[nodiscard]] std::vector<std::string> inputs() const;
  /// Did the user give this option, of the command if one was given?
  [[nodiscard]] bool given(const std::string& flag) const;
  /// Which kind the file of this name is, as soon as the tool knows it. Throws Fault::usage for an option that is
  /// not_for() it.
  void require_for(const std::string& kind, const std::string& name) const;
  /// Which settings of the printer have an effect, as soon as the tool knows it. Throws Fault::usage for an option with
  /// a rule that names settings and is not kept.
  void require_settings(const std::function<bool(const std::string& setting)>& is_set) const;

 private:
  struct State;
  App& declare(Option option, const std::function<void(const std::string&)>& store,
               const std::function<std::string()>& value);
  void parse(int argc, char** argv);
  bool print_about(int argc, char** argv) const;
  void require_present() const;
  [[nodiscard]] bool holds(const std::string& condition) const;
  void require_rules() const;
  void require_rules(const std::function<bool(const std::string&)>& is_set) const;
  void require_rule(const Option& option, const Rule& rule,
                    const std::function<bool(const std::string&)>& is_true) const;
  void require_own_inputs() const;
  void require_own_outputs() const;
  [[noreturn]] void fail_on_count(const std::vector<std::string>& reversed_words) const;
  [[nodiscard]] Declaration whole() const;
  [[nodiscard]] const App& form_in_use() const;

  std::unique_ptr<State> state_;
};

}  // namespace vam::cli
