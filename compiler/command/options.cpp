#include "compiler/command/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "compiler/modules/load_modules.hpp"
#include "compiler/quantity.hpp"
#include "schema/spelling.hpp"

namespace wale::command {
namespace {

/// Lets an option be repeated, with one value each time. Otherwise CLI11 would read the words after it as more values.
void may_be_repeated(CLI::Option* option) { option->expected(1)->allow_extra_args(false)->take_all(); }

/// Adds an option whose text `read` turns into a value.
template <class Value, class Read>
CLI::Option* offer_value(CLI::App& verb, const char* option, const char* type, std::optional<Value>& into,
                         const char* about, Read read) {
  const auto take = [option, &into, read](const std::string& text) {
    const Result<Value> value = read(option, text);
    if (!value) throw CLI::ValidationError(error_text(value.error()), misused);
    into = *value;
  };
  return verb.add_option_function<std::string>(option, take, about)->type_name(type);
}

/// Checks that each is a folder. Empty names pass, since `without_empty_words` refuses them. Error: W0501.
Result<> are_folders(const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) {
    std::error_code ignored;
    if (folder.empty() || std::filesystem::is_directory(folder, ignored)) continue;
    const bool exists = std::filesystem::exists(folder, ignored);
    return Error{.code = Code::unreadable_file,
                 .sentence = fmt::format("`{}` {}", folder, exists ? "is not a folder" : "does not exist"),
                 .mend = "name a folder that holds Wale files",
                 .place = {.name = "--library", .text = folder}};
  }
  return {};
}

}  // namespace

CLI::Option* must_say(CLI::Option* option, const std::string& expected, const std::string& mend) {
  // CLI11 puts the option's name before it.
  const std::string text =
      fmt::format("expected {}, found nothing{}", expected, mend.empty() ? "" : "\n  = help: " + mend);
  return option->check([text](const std::string& word) { return word.empty() ? text : std::string(); });
}

namespace {

// A validator that accepts everything and that no help shows: CLI11 has no other place for what belongs to an option.
constexpr std::string_view proposed_words = "words:", proposed_words_or_file = "words or a file:";

}  // namespace

CLI::Option* propose(CLI::Option* option, const std::vector<std::string>& words, bool or_file) {
  const auto accept = [](std::string&) { return std::string(); };
  const std::string name =
      fmt::format("{}{}", or_file ? proposed_words_or_file : proposed_words, fmt::join(words, " "));
  return option->check(CLI::Validator(accept, "", name));
}

Proposed proposed(const CLI::Option& option) {
  Proposed found;
  try {
    for (int i = 0;; ++i) {
      const std::string name = const_cast<CLI::Option&>(option).get_validator(i)->get_name();  // which changes nothing
      for (const std::string_view kind : {proposed_words, proposed_words_or_file}) {
        if (!name.starts_with(kind)) continue;
        found.or_file = kind == proposed_words_or_file;
        found.words = CLI::detail::split_up(name.substr(kind.size()));
      }
    }
  } catch (const CLI::OptionNotFound&) {  // after the last
  }
  return found;
}

Result<> without_empty_words(const CLI::App& verb) {
  for (const CLI::Option* option : verb.get_options()) {
    const auto& words = option->results();
    if (std::ranges::find(words, "") == words.end()) continue;
    const std::string name = option->get_name();
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected {}, found nothing",
                                         option->get_positional() ? "a word" : option->get_type_name()),
                 .mend = option->get_required() ? "" : fmt::format("leave out {} if nothing is meant", name),
                 .place = {.name = name}};
  }
  for (const CLI::App* group : verb.get_subcommands({}))
    if (const auto complete = without_empty_words(*group); !complete) return complete;
  return {};
}

void offer_library(CLI::App& verb, std::vector<std::string>& folders, const char* about) {
  const auto take = [&folders](const std::vector<std::string>& given) {
    if (const auto found = are_folders(given); !found) throw CLI::ValidationError(error_text(found.error()), misused);
    folders = given;
  };
  may_be_repeated(verb.add_option_function<std::vector<std::string>>("--library", take, about)->type_name("DIR"));
}

void offer_sandbox(CLI::App& verb, Sandbox& sandbox) {
  const auto take = [&sandbox](std::int64_t) { sandbox = Sandbox::if_possible; };
  verb.add_flag_function(
      "--unsandboxed-pictures", take,
      "decodes pictures also where the system has no sandbox for it; only for pictures that you trust");
}

void offer_device_files(CLI::App& verb, std::vector<ResolvedFile>& files) {
  const auto take = [&files](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (name.empty()) continue;  // `without_empty_words` refuses it
      auto file = read_file(name);
      if (!file)
        throw CLI::ValidationError(error_text({.code = file.error().code,
                                               .sentence = "cannot be read: " + file.error().sentence,
                                               .place = {.name = name}}),
                                   refused);
      files.push_back(*std::move(file));
    }
  };
  may_be_repeated(verb.add_option_function<std::vector<std::string>>(
                          "--devices", take,
                          "a Wale file with exported devices for --device, like ~/.config/wale/devices.wale, whose "
                          "devices are known without it; may be repeated")
                      ->type_name("FILE"));
}

void offer_device(CLI::App& verb, Choice& choice, const char* option, const char* about) {
  const auto take = [&choice, option](const std::string& name) {
    choice.device = name;
    choice.device_option = option;
  };
  verb.add_option_function<std::string>(option, take, about)->type_name("NAME");
  if (std::string_view(option) == "--device") offer_device_files(verb, choice.devices);
}

void offer_material(CLI::App& verb, Choice& choice, const MaterialOptions& options) {
  must_say(verb.add_option("FILE", choice.file,
                           "a Wale file, a patch program (.wpp), or a material of the library by name, as in corduroy"),
           "a file or the name of a material")
      ->required();
  const auto take_material = [&choice](const std::string& name) {
    choice.material = name;
    choice.material_option = "--material";
  };
  verb.add_option_function<std::string>("--material", take_material, options.about_material)->type_name("NAME");
  offer_device(verb, choice, options.device_option, options.about_device);
  offer_library(verb, choice.folders);
  offer_sandbox(verb, choice.sandbox);
}

void offer_settings(CLI::App& verb, std::vector<std::string>& settings) {
  may_be_repeated(verb.add_option("--set", settings, "a parameter's value, as in --set wale=5mm; may be repeated")
                      ->type_name("NAME=VALUE"));
}

CLI::Option* offer_json(CLI::App& verb, bool& json, const char* about) {
  return verb.add_flag("--json", json,
                       std::string(about) +
                           "; the errors of a failed command are text on standard error "
                           "(`wale check --json` lists those of a file as JSON)");
}

CLI::Option* offer_output(CLI::App& verb, std::string& out, const char* about) {
  return verb.add_option("-o,--output", out, about)->type_name("FILE");
}

CLI::Option* offer_name(CLI::App& verb, const char* option, std::string& into, const std::vector<std::string>& names,
                        const char* about) {
  const auto take = [option, &into, names](const std::string& text) {
    into = text;
    if (text.empty() || std::ranges::find(names, text) != names.end()) return;
    const auto near = nearest_spelling(text, names);
    throw CLI::ValidationError(
        error_text({.code = Code::malformed_value,
                    .sentence = fmt::format("expected {}, {}", fmt::join(names, ", "), found_typed(text)),
                    .mend = near ? fmt::format("did you mean `{}`?", *near) : "",
                    .place = {.name = option, .text = text}}),
        misused);
  };
  return propose(
      verb.add_option_function<std::string>(option, take, fmt::format("{}: {}", about, fmt::join(names, ", ")))
          ->type_name("NAME"),
      names);
}

CLI::Option* offer_count(CLI::App& verb, const char* option, std::optional<std::uint64_t>& into,
                         const CountRange& range, const char* about) {
  return offer_value(verb, option, "N", into, about,
                     [range](const char* name, const std::string& text) { return read_count(name, text, range); });
}

CLI::Option* offer_number(CLI::App& verb, const char* option, std::optional<double>& into, const NumberRange& range,
                          const char* about) {
  return offer_value(verb, option, "NUMBER", into, about,
                     [range](const char* name, const std::string& text) { return read_number(name, text, range); });
}

CLI::Option* offer_duration(CLI::App& verb, const char* option, std::optional<double>& into, const DurationRange& range,
                            const char* about) {
  return offer_value(verb, option, "DURATION", into, about,
                     [range](const char* name, const std::string& text) { return read_duration(name, text, range); });
}

CLI::Option* offer_hand(CLI::App& verb, const char* option, std::optional<Hand>& into, const char* about) {
  const auto read = [](const char* name, const std::string& text) {
    return read_hand(common_modules()->declarations, name, text);
  };
  return offer_value(verb, option, "HAND", into, about, read);
}

CLI::Option* offer_force(CLI::App& verb, const char* option, std::optional<double>& into, const char* about) {
  const auto read = [](const char* name, const std::string& text) {
    return read_force(common_modules()->declarations, name, text);
  };
  return offer_value(verb, option, "FORCE", into, about, read);
}

CLI::Option* offer_length(CLI::App& verb, const char* option, std::optional<double>& into, const char* about) {
  const auto read = [](const char* name, const std::string& text) {
    return read_length(common_modules()->declarations, name, text);
  };
  return offer_value(verb, option, "LENGTH", into, about, read);
}

CLI::Option* offer_heights_between(CLI::App& verb, const char* option, std::optional<HeightsBetween>& into,
                                   const char* about) {
  const auto read = [](const char* name, const std::string& text) {
    return read_heights_between(common_modules()->declarations, name, text);
  };
  return offer_value(verb, option, "LOW,HIGH", into, about, read);
}

}  // namespace wale::command
