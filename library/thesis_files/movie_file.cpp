// Movies: a list of the names of workspaces.
#include <fmt/format.h>

#include "library/thesis_files/text_lines.hpp"
#include "wale/thesis_files.hpp"

namespace wale {

Result<ThesisMovie> read_thesis_movie(std::string_view text, const std::string& name) {
  const auto lines = lines_of_thesis_text(text, name);
  if (!lines) return lines.error();
  ThesisMovie movie;
  for (const std::string& line : *lines)
    if (const auto frame = without_blanks(line); !frame.empty()) movie.workspaces.emplace_back(frame);
  if (movie.workspaces.empty())
    return Error{.code = Code::damaged_file,
                 .sentence = "expected the names of workspaces, found none",
                 .mend = "write the name of one workspace on each line",
                 .place = {.name = name, .number = 1},
                 .expected = "a name",
                 .found = "nothing"};
  return movie;
}

Result<std::string> write_thesis_movie(const ThesisMovie& movie) {
  const auto refuse = [](std::string sentence, std::string mend, std::size_t frame) {
    return Error{.code = Code::malformed_value, .sentence = std::move(sentence), .mend = std::move(mend),
                 .place = {.name = "frames", .number = frame}};
  };
  if (movie.workspaces.empty() || movie.workspaces.size() > ThesisMovie::most_frames)
    return refuse(fmt::format("expected 1 to {} frames, found {}", ThesisMovie::most_frames, movie.workspaces.size()),
                  "the thesis's Sandpaper holds no more: make two movies", movie.workspaces.size());
  std::string text;
  for (std::size_t i = 0; i < movie.workspaces.size(); ++i) {
    if (!is_thesis_name(movie.workspaces[i]))
      return refuse("expected a name in one line, without spaces at its ends", "give the workspace another name", i + 1);
    text += movie.workspaces[i] + "\n";
  }
  return text;
}

}  // namespace wale
