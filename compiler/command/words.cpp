#include "compiler/command/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "compiler/command/manual.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {

namespace {

/// "there is no option `--devise`; did you mean `--device`?"
std::string unknown_option(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  const auto enter = [&](const CLI::App& of) {
    for (const CLI::Option* option : of.get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
      for (const std::string& name : option->get_snames()) known.push_back("-" + name);
    }
  };
  enter(app);
  for (const CLI::App* group : app.get_subcommands({}))
    if (group->get_name().empty()) enter(*group);
  const auto near = nearest_spelling(word.substr(0, word.find('=')), known);
  return fmt::format("there is no option `{}`{}", visible_text(word),
                     near ? fmt::format("; did you mean `{}`?", *near) : "");
}

/// "--device: expected once, found twice" or "--device: expected NAME, found nothing": an option with another number of
/// values than it takes. Only the last word can be an option without its value, since an option takes the next word.
std::string mismatch_text(const CLI::App& verb, const std::string& last_word) {
  for (const CLI::Option* option : verb.get_options()) {
    const std::size_t count = option->count();
    if (count > 1 && option->get_items_expected_max() == 1)
      return fmt::format("{}: expected once, found {}", option->get_name(),
                         count == 2 ? "twice" : fmt::format("{} times", count));
  }
  const CLI::Option* last = verb.get_option_no_throw(last_word);
  return last == nullptr ? "expected another number of values"
                         : fmt::format("{}: expected {}, found nothing", last_word, last->get_type_name());
}

/// The second words of the verbs that begin with this one: "check" of `library check`.
std::vector<std::string> second_words(const CLI::App& app, const std::string& first) {
  std::vector<std::string> words;
  for (const CLI::App* verb : listed_verbs(app))
    if (verb->get_name().starts_with(first + "-")) words.push_back(verb->get_name().substr(first.size() + 1));
  return words;
}

}  // namespace

std::string spelt_verb(std::string name) {
  std::ranges::replace(name, '-', ' ');
  return name;
}

std::string with_spelt_verbs(const CLI::App& app, std::string text) {
  for (const CLI::App* verb : listed_verbs(app)) {
    const std::string& name = verb->get_name();
    if (name.find('-') == std::string::npos) continue;
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + name.size()))
      text.replace(at, name.size(), spelt_verb(name));
  }
  return text;
}

std::optional<std::string> misspelt_verb(const CLI::App& app, const std::string& first, const std::string& second) {
  std::vector<std::string> verbs;
  for (const CLI::App* known : listed_verbs(app)) verbs.push_back(spelt_verb(known->get_name()));
  for (const CLI::App* known : app.get_subcommands({}))  // also one that no help lists
    if (known->get_name() == first || known->get_name() == first + "-" + second) return std::nullopt;
  if (const auto seconds = second_words(app, first); !seconds.empty()) {
    const auto near = second.empty() ? std::nullopt : nearest_spelling(second, seconds);
    return near ? fmt::format("there is no verb `{} {}`; did you mean `{} {}`?", first, visible_text(second), first, *near)
                : fmt::format("`{}` is the first word of verbs: {} {}", first, first,
                              fmt::join(seconds, fmt::format(", {} ", first)));
  }
  if (first == "-h" || first == "--help" || first == "--version") return std::nullopt;
  if (first.starts_with('-')) return unknown_option(app, first);
  if (first == "help") {
    const bool is_verb = !second.empty() && std::ranges::find(verbs, second) != verbs.end();
    return fmt::format("there is no verb `help`; `wale {}--help` is the help", is_verb ? second + " " : "");
  }
  const auto near = nearest_spelling(first, verbs);
  return fmt::format("there is no verb `{}`; {}", visible_text(first),
                     near ? fmt::format("did you mean `{}`?", *near)
                          : fmt::format("the verbs are {}; `wale --help` says what they do", fmt::join(verbs, ", ")));
}

std::vector<std::string> words_of(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const std::vector<const CLI::App*> verbs = app.get_subcommands({});
  if (words.size() > 1) {
    const std::string both = words[0] + "-" + words[1];
    if (std::ranges::any_of(verbs, [&](const CLI::App* each) { return each->get_name() == both; }))
      words.erase(words.begin()), words.front() = both;
  }
  const auto named = std::ranges::find(verbs, words.front(), [](const CLI::App* each) { return each->get_name(); });
  if (named == verbs.end()) return words;
  const CLI::App* verb = *named;
  const auto marks_the_end = std::ranges::find(words, "--");
  std::vector<std::string> split(words.begin(), marks_the_end);
  for (std::size_t i = 1; i < split.size(); ++i) {
    if (!split[i].starts_with("--") || split[i].find('=') + 1 != split[i].size()) continue;
    const std::string name = split[i].substr(0, split[i].size() - 1);
    const CLI::Option* option = verb->get_option_no_throw(name);
    if (option == nullptr || option->get_items_expected_max() == 0) continue;
    split[i] = name;
    split.insert(split.begin() + static_cast<std::ptrdiff_t>(++i), "");
  }
  split.insert(split.end(), marks_the_end, words.end());
  return split;
}

std::string misuse_text(const CLI::App* app, const CLI::Error& error, const std::string& last_word) {
  const auto verbs = app->get_subcommands();
  const std::string verb = verbs.empty() ? "wale" : "wale " + spelt_verb(verbs.front()->get_name());
  std::string what = error.what();
  const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  // An unknown option is told before what is missing: it may be the misspelt name of just that, or of --help.
  if ((is(CLI::ExitCodes::ExtrasError) || is(CLI::ExitCodes::RequiredError)) && !verbs.empty()) {
    const std::vector<std::string> unexpected = verbs.front()->remaining();
    const auto option = std::ranges::find_if(unexpected, [](const auto& word) { return word.starts_with('-'); });
    if (option != unexpected.end())
      what = unknown_option(*verbs.front(), *option);
    else if (is(CLI::ExitCodes::ExtrasError) && unexpected.empty())  // CLI11 hands them to nobody
      what = "`--` ends the options: write it before the first word that is none";
    else if (is(CLI::ExitCodes::ExtrasError))
      what = "unexpected: " + visible_text(fmt::format("{}", fmt::join(unexpected, " ")));
  }
  if (is(CLI::ExitCodes::ArgumentMismatch) && !verbs.empty()) what = mismatch_text(*verbs.front(), last_word);
  return fmt::format("wale: {}\n  = help: `{} --help` lists the options\n", what, verb);
}

}  // namespace wale::command
