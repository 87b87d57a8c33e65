#include "library/by_name/told.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "compiler/diagnostics/told.hpp"
#include "schema/closest_names.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// A name as a sentence shows it: it may be as long as its author likes, and no text at all.
std::string quoted(const std::string& name) {
  constexpr std::size_t longest = 200;
  return "`" + visible_text(name.substr(0, longest)) + (name.size() > longest ? "…`" : "`");
}

/// "there are: `roughness`, `drag` and 11 more".
std::string listed(std::vector<std::string> known) {
  constexpr std::size_t most_told = 8;
  if (known.empty()) return "there is none to ask for";
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  std::string all;
  for (std::size_t i = 0; i < std::min(known.size(), most_told); ++i)
    all += (i == 0 ? "there are: `" : ", `") + known[i] + "`";
  if (known.size() > most_told) all += " and " + std::to_string(known.size() - most_told) + " more";
  return all;
}

}  // namespace

std::vector<Error> warnings_in(Diagnostics& diagnostics, const SourceSet& sources) {
  diagnostics.sort();
  std::vector<Error> warnings;
  for (const Diagnostic& each : diagnostics.all())
    if (severity_of(each.code) == Severity::warning) warnings.push_back(in_own_words(told(each, sources)));
  return warnings;
}

Error first_error(Diagnostics& diagnostics, const SourceSet& sources) {
  diagnostics.sort();
  const auto& all = diagnostics.all();
  const auto first =
      std::ranges::find(all, Severity::error, [](const Diagnostic& each) { return severity_of(each.code); });
  if (first == all.end()) return {Code::refused_program, "this cannot be compiled", "report it as a bug of Wale"};
  Error error = told(*first, sources);
  for (auto each = all.begin(); each != all.end(); ++each)
    if (each != first) error.others.push_back(told(*each, sources));
  return in_own_words(std::move(error));
}

Error in_own_words(Error error) {
  // What the compiler says of the command line's options, and what the options of the library are called.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> words{{
      {"name it with `--library DIR` or in", "name it among the library's `folders` or in"},
      {"decode it without by --unsandboxed-pictures", "decode it without by the library's option `unsandboxed_pictures`"},
      {"a file that `--devices FILE` names", "the library's option `devices`"},
      {"which `wale build --workspace` makes", "which `write_workspace` makes"},
      {"`wale find` alone lists them all", "a blank text lists them all"},
      {"`wale find` lists the materials of the library", "`nearest` has the names that are least far from it"},
      {"`wale find WORD` searches the library", "`search` finds materials by words"},
      {"name that device, `--device ", "name that device, `"},
  }};
  for (const auto& [option, own] : words)
    if (const std::size_t at = error.mend.find(option); at != std::string::npos)
      error.mend.replace(at, option.size(), own);
  // A clause that proposes to list the materials at the command line.
  for (const std::string_view begin : {"; `wale find`", "; `wale find "}) {
    const std::size_t at = error.mend.find(begin);
    if (at != std::string::npos) error.mend.erase(at, error.mend.find(';', at + 1) - at);
  }
  for (Error& each : error.others) each = in_own_words(std::move(each));
  return error;
}

Error about(Error error, const Place& argument) {
  error.place = argument;
  for (Error& each : error.others) each = about(std::move(each), argument);
  return error;
}

Error unknown(Code code, const std::string& argument, const std::string& name, const std::vector<std::string>& known) {
  auto nearest = nearest_spellings(name, known);
  std::string mend;
  for (const std::string& each : nearest) mend += (mend.empty() ? "the nearest: `" : ", `") + each + "`";
  if (nearest.empty()) mend = listed(known);
  return {.code = code,
          .sentence = "no " + argument + " is called " + quoted(name),
          .mend = std::move(mend),
          .place = {.name = argument, .text = name},
          .nearest = closest_names(name, known)};
}

Error with_owners_problem(Error error, const Error& problem) {
  error.mend += "; if your own devices.wale declares it, mend that first: " + in_words(problem);
  error.others.push_back(problem);
  return error;
}

}  // namespace wale
