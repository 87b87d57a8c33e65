#include "compiler/command/options.hpp"

#include <CLI/CLI.hpp>

#include "compiler/modules/load_modules.hpp"
#include "compiler/quantity.hpp"

namespace wale::command {
namespace {

/// One value each time, as often as it is given: without this CLI11 would take the words that follow for more values.
void may_be_repeated(CLI::Option* option) { option->expected(1)->allow_extra_args(false)->take_all(); }

/// An option whose words `read` turns into a value; `status` ends the command where they cannot be.
template <class Value, class Read>
CLI::Option* offer_value(CLI::App& verb, const char* option, const char* type, std::optional<Value>& into,
                         const char* about, Read read, int status = misused) {
  const auto take = [option, &into, read, status](const std::string& text) {
    const Result<Value> value = read(option, text);
    if (!value) throw CLI::ValidationError(error_text(value.error()), status);
    into = *value;
  };
  return verb.add_option_function<std::string>(option, take, about)->type_name(type);
}

}  // namespace

void offer_library(CLI::App& verb, std::vector<std::string>& folders) {
  may_be_repeated(
      verb.add_option("--library", folders, "a folder to look for imports in, after the file's own; may be repeated")
          ->type_name("DIR"));
}

void offer_device(CLI::App& verb, std::string& device, const char* option) {
  verb.add_option(option, device, "the device to build for (default: sandpaper; see `wale devices`)")
      ->type_name("NAME");
}

void offer_material(CLI::App& verb, Choice& choice, const char* device_option) {
  verb.add_option("FILE", choice.file,
                  "a Wale file, a patch program (.wpp), or a material of the library by name, as in corduroy")
      ->required();
  verb.add_option("--material", choice.material, "which material of the file (default: its first)")->type_name("NAME");
  offer_device(verb, choice.device, device_option);
  offer_library(verb, choice.folders);
}

void offer_settings(CLI::App& verb, std::vector<std::string>& settings) {
  may_be_repeated(verb.add_option("--set", settings, "a parameter's value, as in --set wale=5mm; may be repeated")
                      ->type_name("NAME=VALUE"));
}

void offer_json(CLI::App& verb, bool& json, const char* about) { verb.add_flag("--json", json, about); }

CLI::Option* offer_output(CLI::App& verb, std::string& out, const char* about) {
  return verb.add_option("-o,--output", out, about)->type_name("FILE");
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

CLI::Option* offer_force(CLI::App& verb, const char* option, std::optional<double>& into, const char* about) {
  const auto read = [](const char* name, const std::string& text) {
    return read_force(common_modules()->declarations, name, text);
  };
  return offer_value(verb, option, "FORCE", into, about, read, refused);
}

}  // namespace wale::command
