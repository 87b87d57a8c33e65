#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "compiler/command/manual.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/words.hpp"

namespace wale::command {
namespace {

/// What a word of the command line may be, and so what is proposed for it.
enum class Sought { nothing, file, material, folder, percept, device, place, code, kind };

Sought sought_by(const CLI::App& verb, const CLI::Option& option) {
  constexpr std::array<std::string_view, 11> of_files_alone = {
      "check",           "format",          "replay",         "import",         "library-check",    "library-sheet",
      "library-coverage", "library-import", "experiment-run", "experiment-plan", "experiment-export"};
  if (option.get_positional()) {
    const std::string name = option.get_name(true);
    if (name == "PERCEPT") return Sought::percept;
    if (name == "CODE") return Sought::code;
    if (name == "OLD" || name == "NEW" || name == "PATH" || name == "TRIALS") return Sought::file;
    if (verb.get_name() == "show" || verb.get_name() == "between") return Sought::material;
    if (name != "FILE") return Sought::nothing;
    return std::ranges::find(of_files_alone, verb.get_name()) == of_files_alone.end() ? Sought::material : Sought::file;
  }
  const std::string type = option.get_type_name();
  if (option.check_lname("against") || option.check_lname("near")) return Sought::material;
  const bool is_where = option.check_lname("device") && verb.get_name() == "feel";  // a device in the hand
  if (is_where || option.check_lname("identify")) return Sought::place;
  if (option.check_lname("device") || option.check_lname("built-for")) return Sought::device;
  if (option.check_lname("kind")) return Sought::kind;
  return type == "FILE" ? Sought::file : type == "DIR" ? Sought::folder : Sought::nothing;
}

std::vector<std::string> options_of_verb(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

Sought sought_by_arguments(const CLI::App& verb) {
  for (const CLI::Option* option : verb.get_options())
    if (option->get_positional()) return sought_by(verb, *option);
  return Sought::nothing;
}

/// Verbs of two words by their first: ("library", {"check"}).
std::map<std::string, std::vector<std::string>> pairs_of_words(const CLI::App& all) {
  std::map<std::string, std::vector<std::string>> pairs;
  for (const CLI::App* verb : listed_verbs(all))
    if (const std::size_t at = verb->get_name().find('-'); at != std::string::npos)
      pairs[verb->get_name().substr(0, at)].push_back(verb->get_name().substr(at + 1));
  return pairs;
}

/// The first words of all verbs, each once.
std::vector<std::string> first_words(const CLI::App& all) {
  std::vector<std::string> words;
  for (const CLI::App* verb : listed_verbs(all)) {
    const std::string first = verb->get_name().substr(0, verb->get_name().find('-'));
    if (std::ranges::find(words, first) == words.end()) words.push_back(first);
  }
  return words;
}

const char* in_bash(Sought sought) {
  switch (sought) {
    case Sought::file: return "_wale_files";
    case Sought::material: return "_wale_files; _wale_words \"$(_wale_materials)\"";
    case Sought::folder: return "compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -d -- \"$cur\"))";
    case Sought::percept: return "_wale_words \"$percepts\"";
    case Sought::device: return "_wale_words \"$devices\"";
    case Sought::place: return "_wale_words \"$places\"";
    case Sought::kind: return "_wale_words \"$kinds\"";
    case Sought::code: return "_wale_words \"$codes\"";
    case Sought::nothing: return ":";
  }
  return ":";
}

const char* in_zsh(Sought sought) {
  switch (sought) {
    case Sought::file: return "_files";
    case Sought::material: return "_wale_material";
    case Sought::folder: return "_files -/";
    case Sought::percept: return "($wale_percepts)";
    case Sought::device: return "($wale_devices)";
    case Sought::place: return "($wale_places)";
    case Sought::kind: return "($wale_kinds)";
    case Sought::code: return "($wale_codes)";
    case Sought::nothing: return " ";
  }
  return " ";
}

/// What is proposed for the value of an option.
std::string value_in_bash(const CLI::App& verb, const CLI::Option& option) {
  const auto [words, or_file] = proposed(option);
  if (words.empty()) return in_bash(sought_by(verb, option));
  return fmt::format("_wale_words \"{}\"{}", fmt::join(words, " "), or_file ? "; _wale_files" : "");
}

std::string value_in_zsh(const CLI::App& verb, const CLI::Option& option) {
  const auto [words, or_file] = proposed(option);
  if (words.empty()) return in_zsh(sought_by(verb, option));
  if (!or_file) return fmt::format("({})", fmt::join(words, " "));
  return fmt::format(" _wale_word_or_file {}", fmt::join(words, " "));
}

/// A description within '…' and […] of a zsh specification.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, text.find(" ("))) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      out += '\\', out += c;
    else
      out += c;
  }
  return out;
}

/// `'(-o --output)'{-o,--output}'[text]:FILE:_files'`
std::string zsh_option(const CLI::App& verb, const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  const bool again = option.get_items_expected_max() > 1;
  const std::string value = option.get_items_expected_max() > 0
                                ? fmt::format("{}{}:{}", option.get_items_expected_min() == 0 ? "::" : ":",
                                              zsh_text(option.get_type_name()), value_in_zsh(verb, option))
                                : "";
  const std::string spelt = names.size() == 1 ? names.front() : fmt::format("'{{{}}}'", fmt::join(names, ","));
  const std::string excluded = again ? "*" : fmt::format("({})", fmt::join(names, " "));
  return fmt::format("        '{}{}[{}]{}' \\\n", excluded, spelt, zsh_text(option.get_description()), value);
}

/// The lists of words by their names in a script.
std::vector<std::pair<std::string, std::vector<std::string>>> lists_of(const CompletedNames& names) {
  std::vector<std::string> places = {"auto", "usb", "pointer", "simulated"};
  places.insert(places.end(), names.devices.begin(), names.devices.end());
  return {{"percepts", names.percepts},
          {"devices", names.devices},
          {"places", places},
          {"codes", names.codes},
          {"kinds", names.kinds}};
}

}  // namespace

std::string bash_completion(const CLI::App& all, const CompletedNames& names) {
  const std::vector<std::string> verbs = first_words(all);
  std::string cases, pairs;
  for (const auto& [first, seconds] : pairs_of_words(all))
    pairs += fmt::format(
        "  if [[ $verb == {0} ]]; then\n    if ((COMP_CWORD == 2)); then _wale_words \"{1}\"; return; fi\n"
        "    verb={0}-${{COMP_WORDS[2]}}\n  fi\n",
        first, fmt::join(seconds, " "));
  for (const CLI::App* verb : listed_verbs(all)) {
    std::string values;
    for (const CLI::Option* option : verb->get_options()) {
      if (option->get_positional() || option->get_items_expected_max() == 0) continue;
      std::vector<std::string> spelt;
      for (const std::string& name : option->get_snames()) spelt.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) spelt.push_back("--" + name);
      values += fmt::format("        {}) {}; return ;;\n", fmt::join(spelt, "|"), value_in_bash(*verb, *option));
    }
    cases += fmt::format(
        "    {})\n      options=\"{}\"\n      case $prev in\n{}      esac\n      [[ $cur == -* ]] || {{ {}; return; }} "
        ";;\n",
        verb->get_name(), fmt::join(options_of_verb(*verb), " "), values, in_bash(sought_by_arguments(*verb)));
  }
  std::string text = R"(# bash completion of wale. Generated by the program itself.
_wale_words() { COMPREPLY+=($(compgen -W "$1" -- "$cur")); }
_wale_files() { compopt -o filenames 2>/dev/null; COMPREPLY+=($(compgen -f -- "$cur")); }
_wale_materials() { "${COMP_WORDS[0]}" find 2>/dev/null | cut -d ' ' -f 1; }
_wale() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} options=
  local IFS=$' \t\n'
)";
  for (const auto& [name, words] : lists_of(names))
    text += fmt::format("  local {}=\"{}\"\n", name, fmt::join(words, " "));
  text += fmt::format(
      "  COMPREPLY=()\n  if ((COMP_CWORD == 1)); then\n    _wale_words \"{} --help --version\"\n    return\n  fi\n",
      fmt::join(verbs, " "));
  return text + "  local verb=${COMP_WORDS[1]}\n" + pairs + "  case $verb in\n" + cases +
         "  esac\n  _wale_words \"$options\"\n}\ncomplete -F _wale wale\n";
}

std::string zsh_completion(const CLI::App& all, const CompletedNames& names) {
  std::string verbs, cases, pairs;
  for (const auto& [first, seconds] : pairs_of_words(all)) {
    verbs += fmt::format("    '{}:{} {}'\n", first, first, fmt::join(seconds, fmt::format(", {} ", first)));
    pairs += fmt::format(
        "  if [[ $verb == {0} ]]; then\n    if (( CURRENT == 2 )); then\n      compadd {1}\n      return\n    fi\n"
        "    verb={0}-$words[2]\n    shift words\n    (( CURRENT-- ))\n  fi\n",
        first, fmt::join(seconds, " "));
  }
  for (const CLI::App* verb : listed_verbs(all)) {
    if (verb->get_name().find('-') == std::string::npos)
      verbs += fmt::format("    '{}:{}'\n", verb->get_name(), zsh_text(verb->get_description()));
    cases += fmt::format("    {})\n      _arguments -s \\\n", verb->get_name());
    for (const CLI::Option* option : verb->get_options())
      if (!option->get_positional()) cases += zsh_option(*verb, *option);
    const Sought sought = sought_by_arguments(*verb);
    cases += sought == Sought::nothing ? "        ;;\n" : fmt::format("        '*:name:{}' ;;\n", in_zsh(sought));
  }
  std::string text = "#compdef wale\n# zsh completion of wale. Generated by the program itself.\n";
  // zsh reads this file at the first completion and afterwards calls only the functions, so lists are within them.
  std::string lists;
  for (const auto& [name, words] : lists_of(names))
    lists += fmt::format("  local -a wale_{}=({})\n", name, fmt::join(words, " "));
  return text + R"zsh(
(( $+functions[_wale_word_or_file] )) || _wale_word_or_file() {
  local -a words_here=($@)
  _alternative 'words:word:compadd -a words_here' 'files:file:_files'
}
(( $+functions[_wale_material] )) || _wale_material() {
  local -a materials
  materials=(${(f)"$(wale find 2>/dev/null | cut -d ' ' -f 1)"})
  _alternative 'materials:material:compadd -a materials' 'files:file:_files'
}
_wale() {
)zsh" + lists +
         R"zsh(  local -a verbs
  verbs=(
)zsh" + verbs +
         R"zsh(  )
  if (( CURRENT == 2 )); then
    _describe verb verbs
    return
  fi
  local verb=$words[2]
  shift words
  (( CURRENT-- ))
)zsh" + pairs + "  case $verb in\n" +
         cases +
         "  esac\n}\n_wale \"$@\"\n";
}

}  // namespace wale::command
