// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/viewer/view.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/exr_encoder.hpp>
#include <glidar/link/control/tcp_service.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/foxglove/server.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <new>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

using Commands = std::vector<std::pair<std::string, Command>>;

/// The subcommand of the command line, or its tool.
const CLI::App& chosen(const CLI::App& program) {
  const std::vector<const CLI::App*> subcommands =
      program.get_subcommands([](const CLI::App* command) { return command->parsed(); });
  return subcommands.empty() ? program : chosen(*subcommands.front());
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// The error for a word that is neither an option nor a subcommand, with a suggestion.
std::string explain_extra(const CLI::App& program, std::string word) {
  const CLI::App& command = chosen(program);
  word = word.substr(0, word.find('='));
  if (word.starts_with('-')) {
    const std::string nearest = closest_match(word, option_names(command));
    return nearest.empty() ? fmt::format("unknown option {}; see --help", word)
                           : fmt::format("unknown option {}; did you mean {}?", word, nearest);
  }
  std::vector<std::string> names = subcommand_names(command);
  if (names.empty()) return fmt::format("unexpected word '{}'; see --help", word);
  for (const std::string& name : names) {
    const std::vector<std::string> tools = subcommand_names(*command.get_subcommand(name));
    if (std::ranges::find(tools, word) == tools.end()) continue;
    return fmt::format("'{1}' is a tool of '{0}': glidar {0} {1}", name, word);
  }
  if (&command == &program) names.insert(names.end(), {"--help", "--version"});
  const std::string nearest = closest_match(word, names);
  const std::string kind = &command == &program ? "subcommand" : "tool";
  if (!nearest.empty()) {
    return fmt::format("'{}' is no {}; did you mean {}?", word, kind, nearest);
  }
  if (&command != &program) {
    return fmt::format("'{}' is no tool; allowed: {}", word, fmt::join(names, ", "));
  }
  return fmt::format("'{0}' is no subcommand; to measure a model: glidar render {0} -o cloud.pcd",
                     word);
}

/// The options that a message of CLI11 names, in their order there. Its other words depend on its
/// version.
std::vector<const CLI::Option*> options_in(const CLI::App& command, const std::string& message) {
  std::map<std::size_t, const CLI::Option*> found;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name().empty()) continue;  // hidden
    const std::regex name(option->get_name() + "(?![-A-Za-z0-9])");
    std::smatch match;
    if (std::regex_search(message, match, name)) found.emplace(match.position(), option);
  }
  std::vector<const CLI::Option*> options;
  for (const auto& [place, option] : found) options.push_back(option);
  return options;
}

/// The error for an option with too few or too many values.
std::string explain_mismatch(const CLI::App& command, const std::string& message) {
  const std::vector<const CLI::Option*> options = options_in(command, message);
  if (options.empty()) return message + "; see --help";
  const CLI::Option& option = *options.front();
  if (option.count() > 1) {
    return fmt::format("{}: given more than once; allowed: once", option.get_name());
  }
  return fmt::format("{}: there is no value after it; see --help for what it takes",
                     option.get_name());
}

/// The error for two options that exclude each other, or of which the first needs the second.
std::string explain_conflict(const CLI::App& command, const std::string& message) {
  const std::vector<const CLI::Option*> options = options_in(command, message);
  if (options.size() < 2) return message + "; see --help";
  const std::string first = options[0]->get_name();
  const std::string second = options[1]->get_name();
  if (options[1]->count() > 0) {
    return fmt::format("{} and {}: both are given; give one of them", first, second);
  }
  return fmt::format("{0}: there is no {1}; give {1} too", first, second);
}

/// The error for a missing option or subcommand.
std::string explain_missing(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_required() && option->count() == 0) return option->get_name() + " is required";
  }
  return command.get_parent() == nullptr ? "a subcommand is required" : "a tool is required";
}

/// The most helpful word that CLI11 did not parse: within a subcommand an option, else the word in
/// the place of a subcommand.
std::string first_extra(const CLI::App& program) {
  const std::vector<std::string> extras = program.remaining(true);
  const bool options_first = &chosen(program) != &program;
  const auto best = std::find_if(extras.begin(), extras.end(), [&](const std::string& word) {
    return (word.size() > 1 && word.starts_with('-')) == options_first;
  });
  if (best != extras.end()) return *best;
  return extras.empty() ? "" : extras.front();
}

/// Prints the message as an error; returns the exit code of invalid input.
int report_error(const std::string& message) {
  print_message("glidar: error", message);
  return kBadInput;
}

int parse_and_run(CLI::App& program, const Commands& commands,
                  const std::vector<std::string>& arguments, const std::string& section) {
  try {
    program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& help_or_version) {
    if (section.empty()) return program.exit(help_or_version);
    const std::string text = section_help(chosen(program), section);
    if (text.empty()) return program.exit(help_or_version);
    print_lines(stdout, text);
    return kDone;
  } catch (const CLI::ArgumentMismatch& error) {
    return report_error(explain_mismatch(chosen(program), error.what()));
  } catch (const CLI::ExcludesError& error) {
    return report_error(explain_conflict(chosen(program), error.what()));
  } catch (const CLI::RequiresError& error) {
    return report_error(explain_conflict(chosen(program), error.what()));
  } catch (const CLI::ConversionError& error) {
    return report_error(std::string(error.what()) + "; see --help for what it takes");
  } catch (const CLI::ParseError& error) {
    const std::string extra = first_extra(program);
    if (!extra.empty()) return report_error(explain_extra(program, extra));
    const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    return report_error(fmt::format("{}; see {} --help",
                                    is_missing ? explain_missing(chosen(program)) : error.what(),
                                    full_name(chosen(program))));
  }
  for (const auto& [name, run] : commands) {
    if (program.got_subcommand(name)) return run();
  }
  return kBadInput;  // unreachable: parse() requires a subcommand
}

/// The version, and the optional parts of this build.
std::string version_text() {
  std::vector<std::string> parts;
  if (has_viewer()) parts.emplace_back("window");
  if (foxglove::has_foxglove_server()) parts.emplace_back("Foxglove server");
  if (control::has_tcp_services()) parts.emplace_back("sensor control (HTTP, PTC)");
  if (dds::has_dds()) parts.emplace_back("ROS 2 (DDS)");
  if (has_openexr()) parts.emplace_back("OpenEXR");
  if (parts.empty()) parts.emplace_back("none");
  return fmt::format("glidar {}\noptional parts: {}", version(), fmt::join(parts, ", "));
}

/// A subcommand and what adds it to the program.
struct Subcommand {
  std::string name;
  /// Gets the program and the arguments of the whole command line.
  std::function<Command(CLI::App& program, const std::vector<std::string>& arguments)> add;
};

/// A subcommand that needs no arguments of the whole command line.
Subcommand subcommand(const char* name, Command (*add)(CLI::App&)) {
  return {name, [add](CLI::App& program, const std::vector<std::string>&) { return add(program); }};
}

std::vector<Subcommand> all_subcommands() {
  return {{"render", add_render},
          subcommand("view", add_view),
          {"stream", add_stream},
          subcommand("replay", add_replay),
          subcommand("decode", add_decode),
          subcommand("explain", add_explain),
          subcommand("info", add_info),
          subcommand("campaign", add_campaign),
          subcommand("sensors", add_sensors),
          subcommand("schema", add_schema),
          subcommand("depth", add_depth),
          subcommand("verify", add_verify),
          subcommand("completion", add_completion)};
}

bool is_subcommand(const std::string& word) {
  const std::vector<Subcommand> all = all_subcommands();
  return std::any_of(all.begin(), all.end(),
                     [&](const Subcommand& one) { return one.name == word; });
}

/// Appends a word as the options have it: `-qj4` as `-q -j 4`, American spellings as ours.
void append_option(const std::string& word, std::vector<std::string>& words) {
  const bool is_short = word.size() > 2 && word[0] == '-' && word[1] != '-';
  const std::size_t at = is_short ? word.find_first_not_of('q', 1) : 1;
  for (std::size_t i = 1; i < std::min(at, word.size()); ++i) words.emplace_back("-q");
  if (at == std::string::npos) return;
  const std::string rest = at == 1 ? word : "-" + word.substr(at);
  if (is_short && rest.size() > 2 &&
      std::string_view("jow").find(rest[1]) != std::string_view::npos) {
    words.push_back(rest.substr(0, 2));
    words.push_back(rest.substr(2));
    return;
  }
  const std::string name = rest.substr(0, rest.find('='));
  const std::string value = rest.substr(name.size());
  words.push_back(name == "--color-by" ? "--colour-by" + value
                  : name == "--center" ? "--centre" + value
                                       : rest);
}

/// The words of the command line as the options have them. `help render` becomes `render --help`; a
/// word after the help goes to `section`. Throws Error for `-h 480`.
std::vector<std::string> tidied(std::vector<std::string> given, std::string& section) {
  const bool asks_help = !given.empty() && given.front() == "help";
  if (asks_help) given.erase(given.begin());
  if (asks_help && (given.empty() || is_subcommand(given.front()))) {
    const bool has_tool = given.size() > 1 && given.front() == "depth" && given[1][0] != '-';
    given.insert(given.begin() + (given.empty() ? 0 : has_tool ? 2 : 1), "--help");
  }
  const std::string command = given.empty() ? "" : given.front();
  if (command == "campaign") return given;  // it has its own command line
  const bool has_height = command == "render" || command == "view" || command == "stream";
  std::vector<std::string> words;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string next = i + 1 < given.size() ? given[i + 1] : "";
    if (given[i] == "--") {
      words.insert(words.end(), given.begin() + static_cast<std::ptrdiff_t>(i), given.end());
      break;
    }
    if (has_height && given[i] == "-h" && !next.empty() &&
        next.find_first_not_of("0123456789") == std::string::npos) {
      throw Error(
          {"-h " + next, "-h prints the help", "", "the height of an image is --height " + next});
    }
    if (i > 0 && (given[i] == "-h" || given[i] == "--help") && !next.starts_with('-'))
      section = next;
    append_option(given[i], words);
  }
  return words;
}

constexpr const char* kExamples = R"(Examples:
  glidar render builtin:asteroid -o asteroid.pcd -o asteroid.png
  glidar view builtin:asteroid
  glidar stream builtin:asteroid --object-rate 0,0.5,0 --port 5555
  glidar explain asteroid.pcd --index 30000
  glidar info builtin:torus
  glidar sensors
  glidar verify
More: glidar help render; also for view, stream, replay, decode, explain, info, campaign,
sensors, schema, depth, verify and completion)";

/// Parses the command line and runs the chosen subcommand; returns the exit code.
int run_program(int argc, char** argv) {
  CLI::App program("Simulator of 3D sensors: point clouds with ground truth from any 3D model",
                   "glidar");
  use_help_layout(program);
  program.set_version_flag("--version", version_text(), "Print the version and the optional parts");
  program.require_subcommand(1);
  program.footer(kExamples);
  std::string section;
  const std::vector<std::string> arguments =
      tidied({argv + std::min(argc, 1), argv + argc}, section);
  Commands commands;
  for (const Subcommand& one : all_subcommands()) {
    commands.emplace_back(one.name, one.add(program, arguments));
  }
  return parse_and_run(program, commands, arguments, section);
}

}  // namespace
}  // namespace glidar::app

int main(int argc, char** argv) {
  try {
    glidar::app::end_cleanly_on_interrupt();
    const int status = glidar::app::run_program(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      return glidar::app::report_error("standard output could not be written; is the disk full?");
    }
    return status;
  } catch (const glidar::ClosedPipe&) {
    return glidar::app::kClosedPipe;  // no message: readers such as `| head` close the pipe on
                                      // purpose
  } catch (const std::bad_alloc&) {
    return glidar::app::report_error("out of memory; use a smaller image or a smaller model");
  } catch (const std::exception& error) {
    return glidar::app::report_error(error.what());
  }
}
