#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <set>

#include "compiler/command/manual.hpp"
#include "compiler/command/words.hpp"

namespace wale::command {
namespace {

/// Text as roff shows it: no line of it is a request, and minus signs stay minus signs.
std::string roff(std::string_view text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '~')
      out += "\\(ti";
    else if (c == '^')
      out += "\\(ha";
    else if (c == '`')
      out += "\\(ga";
    else
      out += c;
    begins = c == '\n';
  }
  return out;
}

/// Lines as they stand.
std::string as_they_stand(std::string_view lines) { return fmt::format(".nf\n{}\n.fi\n", roff(lines)); }

/// "FILE ..." or "[CODE]", as the synopsis shows it.
std::string in_synopsis(const CLI::Option& option) {
  const std::string many = option.get_items_expected_max() > 1 ? " ..." : "";
  const std::string name = fmt::format("\\fI{}\\fR{}", roff(option.get_name(true)), many);
  return option.get_required() ? name : "[" + name + "]";
}

/// "-o, --output FILE"
std::string names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("\\fB\\-" + roff(name) + "\\fR");
  for (const std::string& name : option.get_lnames()) names.push_back("\\fB\\-\\-" + roff(name) + "\\fR");
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (option.get_items_expected_max() > 0) text += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
  return text;
}

std::string relatives(const char* how, const std::set<CLI::Option*>& others) {
  std::vector<std::string> names;
  for (const CLI::Option* each : others) names.push_back("\\fB" + roff(each->get_name()) + "\\fR");
  std::ranges::sort(names);
  return names.empty() ? "" : fmt::format("{} {}.\n", how, fmt::join(names, ", "));
}

std::string sentence(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  if (!text.empty() && text.back() != '.') text += '.';
  return roff(text) + "\n";
}

std::string arguments_of(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional())
      text += fmt::format(".TP\n{}\n{}", in_synopsis(*option), sentence(option->get_description()));
  return text.empty() ? text : ".SH ARGUMENTS\n" + text;
}

std::string options_of(const CLI::App& app) {
  std::string text = ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options())
    if (!option->get_positional())
      text += fmt::format(".TP\n{}\n{}{}{}", names_of(*option), sentence(option->get_description()),
                          relatives("Needs", option->get_needs()), relatives("Not with", option->get_excludes()));
  return text;
}

std::string heading(const std::string& name, const CLI::App& all, std::string_view about) {
  std::string title = name, version = all.version();
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  version = version.substr(0, version.find(','));
  return fmt::format(".TH {} 1 \"\" \"{}\" \"Wale\"\n.SH NAME\n{} \\- {}\n", roff(title), roff(version), roff(name),
                     roff(about));
}

}  // namespace

std::vector<const CLI::App*> listed_verbs(const CLI::App& all) {
  std::vector<const CLI::App*> verbs;
  for (const CLI::App* each : all.get_subcommands({}))
    if (!each->get_name().empty() && !each->get_group().empty()) verbs.push_back(each);
  return verbs;
}

std::string manual_page(const CLI::App& all, const CLI::App* verb) {
  if (verb == nullptr) {
    std::string text = heading("wale", all, "a language for how things feel, and its runtime");
    text += ".SH SYNOPSIS\n\\fBwale\\fR \\fIVERB\\fR [\\fIOPTIONS\\fR] ...\n.SH DESCRIPTION\n" +
            as_they_stand(all.get_description()) + ".SH VERBS\n";
    for (const CLI::App* each : listed_verbs(all))
      text += fmt::format(".TP\n\\fBwale\\-{}\\fR(1)\n{}", roff(each->get_name()), sentence(each->get_description()));
    return text + options_of(all) + ".SH EXIT STATUS\n" + as_they_stand(all.get_footer());
  }
  std::string text = heading("wale-" + verb->get_name(), all, verb->get_description());
  text += fmt::format(".SH SYNOPSIS\n\\fBwale {}\\fR [\\fIOPTIONS\\fR]", roff(spelt_verb(verb->get_name())));
  for (const CLI::Option* option : verb->get_options())
    if (option->get_positional()) text += " " + in_synopsis(*option);
  text += "\n.SH DESCRIPTION\n\\fBwale " + roff(spelt_verb(verb->get_name())) + "\\fR " + roff(verb->get_description()) + ".\n";
  text += arguments_of(*verb) + options_of(*verb);
  if (!verb->get_footer().empty()) text += ".SH EXAMPLES\n" + as_they_stand(verb->get_footer());
  return text + ".SH SEE ALSO\n\\fBwale\\fR(1)\n";
}

}  // namespace wale::command
