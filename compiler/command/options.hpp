#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/command/command.hpp"
#include "compiler/command/verb.hpp"
#include "compiler/quantity.hpp"
#include "compiler/typed_number.hpp"
#include "wale/program.hpp"

/// Options that several verbs share, and options with values. Values are written to `into` and the like when the
/// command line is parsed, so these must live as long as the verb.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace wale::command {

/// Checks that no option or argument is an empty text: "" is neither a name nor a file, nor the same as leaving the
/// option out. Called before a verb runs. Error: W0801.
Result<> without_empty_words(const CLI::App& verb);

/// Refuses an empty text for one option or argument, in words of its own: "expected a file, found nothing". `mend` is
/// the help; it may be empty.
CLI::Option* must_say(CLI::Option* option, const std::string& expected, const std::string& mend = {});

/// The words that the completion of a shell proposes for an option's value, besides what its type says. An option with
/// words of its own may also take a file, if `or_file`.
CLI::Option* propose(CLI::Option* option, const std::vector<std::string>& words, bool or_file = false);

/// What `propose` has said.
struct Proposed {
  std::vector<std::string> words;
  bool or_file = false;
};
Proposed proposed(const CLI::Option& option);

/// The help texts of options that mean slightly different things in some verbs.
namespace help_text {
inline constexpr const char* library = "a folder to search for imports, after the file's own; may be repeated";
inline constexpr const char* material = "which material of the file (default: its first)";
inline constexpr const char* device =
    "the device to build for: one of `wale devices`, of --devices or of the file itself (default: sandpaper)";
/// For a verb that takes no file.
inline constexpr const char* device_alone = "the device: one of `wale devices` or of --devices (default: sandpaper)";
}  // namespace help_text

/// --library DIR, which may be repeated. If DIR is not a folder, the command ends.
void offer_library(CLI::App& verb, std::vector<std::string>& folders, const char* about = help_text::library);

/// --unsandboxed-pictures, for a verb that compiles materials.
void offer_sandbox(CLI::App& verb, Sandbox& sandbox);

/// --devices FILE, which may be repeated, as `offer_device` offers it. A file that cannot be read ends the command.
void offer_device_files(CLI::App& verb, std::vector<ResolvedFile>& files);

/// --device NAME and --devices FILE. `option` may give the first another name; then there is no second.
void offer_device(CLI::App& verb, Choice& choice, const char* option = "--device",
                  const char* about = help_text::device);

/// The name and the help texts of the options that name one material.
struct MaterialOptions {
  const char* device_option = "--device";
  const char* about_material = help_text::material;
  const char* about_device = help_text::device;
};

/// FILE, --material NAME, --device NAME and --library DIR, which together name one material, and
/// --unsandboxed-pictures.
void offer_material(CLI::App& verb, Choice& choice, const MaterialOptions& options = {});

/// --set NAME=VALUE, which may be repeated.
void offer_settings(CLI::App& verb, std::vector<std::string>& settings);

/// --json; `about` describes the JSON output.
CLI::Option* offer_json(CLI::App& verb, bool& json, const char* about);

/// -o, --output FILE.
CLI::Option* offer_output(CLI::App& verb, std::string& out, const char* about);

// Values of options are read here and never by CLI11, which reads "" as 0. Malformed values end the command with
// `misused` before the verb runs. `into` stays empty if the option is not given.

/// One of a few names, which the help text lists after `about`. Other names are refused; the message has the nearest
/// name or all of them.
CLI::Option* offer_name(CLI::App& verb, const char* option, std::string& into, const std::vector<std::string>& names,
                        const char* about);

/// A whole number: "12".
CLI::Option* offer_count(CLI::App& verb, const char* option, std::optional<std::uint64_t>& into,
                         const CountRange& range, const char* about);
/// A plain number: "0.5".
CLI::Option* offer_number(CLI::App& verb, const char* option, std::optional<double>& into, const NumberRange& range,
                          const char* about);
/// A duration, in s: "5", "5 s", "2 min".
CLI::Option* offer_duration(CLI::App& verb, const char* option, std::optional<double>& into, const DurationRange& range,
                            const char* about);
/// A hand: "10 mm, 5 mm".
CLI::Option* offer_hand(CLI::App& verb, const char* option, std::optional<Hand>& into, const char* about);
/// A force above 0, in N: "3 N".
CLI::Option* offer_force(CLI::App& verb, const char* option, std::optional<double>& into, const char* about);
/// A length above 0, in m: "40 mm".
CLI::Option* offer_length(CLI::App& verb, const char* option, std::optional<double>& into, const char* about);
/// Two heights, the first below the second: "0 mm, 1 mm" or "0, 1".
CLI::Option* offer_heights_between(CLI::App& verb, const char* option, std::optional<HeightsBetween>& into,
                                   const char* about);

}  // namespace wale::command
