// Movies and shuffles as `movie`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <map>

#include "compiler/format/format.hpp"
#include "library/thesis_files/in_wale.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"
#include "wale/thesis_files.hpp"

namespace wale {
namespace {

/// Gives each frame the name of a workspace, and declares those that are not there.
Result<ThesisInWale> shown(const std::vector<std::string>& frames, const std::string& documentation, const ThesisShowOptions& options) {
  if (frames.empty())
    return Error{.code = Code::malformed_value, .sentence = "expected a frame or more, found none", .place = {.name = "frames"}};
  ThesisInWale made{.name = options.name, .text = {}};
  std::set<std::string> taken = options.taken;
  taken.insert(options.workspaces.begin(), options.workspaces.end());
  std::map<std::string, std::string> names;
  std::vector<std::string> words;
  std::string text;
  for (const std::string& frame : frames) {
    const auto [found, is_new] = names.try_emplace(frame);
    if (is_new) {
      if (const std::string plain = wale_name(frame, {}); options.workspaces.contains(frame)) found->second = frame;
      else if (options.workspaces.contains(plain)) found->second = plain;
      else {
        found->second = wale_name(frame, taken);
        text += fmt::format("/// To lay out: the thesis's workspace `{}` is a binary file, which is not read.\nworkspace {} {{}}\n\n",
                            visible_text(frame), found->second);
      }
      taken.insert(found->second);
    }
    words.push_back(found->second);
  }
  text += fmt::format("{}movie {} {{ frames {} }}\n", documentation, options.name, fmt::join(words, ", "));
  made.text = standard_declarations(text);
  return made;
}

}  // namespace

std::string standard_declarations(const std::string& text) {
  const std::string version = "wale 1\n\n";
  SourceSet sources;
  Diagnostics diagnostics;
  const auto formatted = format(sources, sources.add("imported", version + text), diagnostics);
  return formatted && formatted->starts_with(version) ? formatted->substr(version.size()) : text;
}

std::string wale_name(std::string_view file_name, const std::set<std::string>& taken) {
  std::string_view stem = file_name.substr(file_name.rfind('/') == file_name.npos ? 0 : file_name.rfind('/') + 1);
  for (const std::string_view ending : {".depth", ".shade", ".wave", ".movie", ".wale"})
    if (has_ending(stem, ending)) stem.remove_suffix(ending.size());
  std::string name;
  for (const char letter : stem.substr(0, 60))
    if (std::isalnum(static_cast<unsigned char>(letter)) && static_cast<unsigned char>(letter) < 0x80) name += letter;
    else if (!name.empty() && name.back() != '_') name += '_';
  while (name.ends_with('_')) name.pop_back();
  static const std::set<std::string> reserved = {"if", "then", "else", "in", "on", "from", "and", "or", "not"};
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front()))) name = name.empty() ? "unnamed" : "n" + name;
  if (reserved.contains(name)) name += "_";
  std::string free = name;
  for (int i = 2; taken.contains(free); ++i) free = fmt::format("{}_{}", name, i);
  return free;
}

Result<ThesisInWale> movie_in_wale(const ThesisMovie& movie, const ThesisShowOptions& options) {
  return shown(movie.workspaces, fmt::format("/// The movie `{}` of the thesis's Sandpaper.\n", visible_text(options.file)), options);
}

Result<ThesisInWale> shuffle_in_wale(const ThesisShuffle& shuffle, const ThesisShowOptions& options) {
  std::vector<std::string> frames;
  for (const ThesisShuffle::Frame& frame : shuffle.frames) frames.push_back(frame.name);
  return shown(frames,
               fmt::format("/// The movie `{}` as it was shuffled by the thesis's Sandpaper: {}, {}.\n", visible_text(shuffle.movie),
                           visible_text(shuffle.date), visible_text(shuffle.time)),
               options);
}

}  // namespace wale
