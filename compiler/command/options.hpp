#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/command/command.hpp"
#include "compiler/command/verb.hpp"
#include "compiler/typed_number.hpp"
#include "wale/program.hpp"

/// Options that several verbs take, and options for values. What is read is written to `into` and its like once the
/// command line is read, so that must live as long as the verb.
namespace CLI {
class App;
class Option;
}

namespace wale::command {

/// Whether nothing was given as an empty text: "" is no name, no file and no word to look for, and is not "not given".
/// Called before a verb runs, of all its options. Error: W0801.
Result<> without_empty_words(const CLI::App& verb);

/// --library DIR, which may be repeated. A DIR that is no folder ends the command.
void offer_library(CLI::App& verb, std::vector<std::string>& folders);

/// --unsandboxed-pictures, for a verb that compiles materials.
void offer_sandbox(CLI::App& verb, Sandbox& sandbox);

/// --device NAME, or the same under another name, for a verb without a material.
void offer_device(CLI::App& verb, std::string& device);
/// The same for a material.
void offer_device(CLI::App& verb, Choice& choice, const char* option = "--device");

/// FILE, --material NAME, --device NAME, --library DIR and --unsandboxed-pictures: what names one material.
void offer_material(CLI::App& verb, Choice& choice, const char* device_option = "--device");

/// --set NAME=VALUE, which may be repeated.
void offer_settings(CLI::App& verb, std::vector<std::string>& settings);

/// --json; `about` says what the output is then.
void offer_json(CLI::App& verb, bool& json, const char* about);

/// -o, --output FILE.
CLI::Option* offer_output(CLI::App& verb, std::string& out, const char* about);

// Values of options are read here and never by CLI11, which takes "" for 0. Words that make no sense end the command
// before the verb runs, with `misused`. `into` stays empty where the option is not given.

/// One of a few names. Another is refused, with the nearest or with all of them.
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

}  // namespace wale::command
