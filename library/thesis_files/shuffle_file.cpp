// Shuffles: a header, and the frames of a movie in another order.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <deque>
#include <map>
#include <optional>

#include "library/thesis_files/text_lines.hpp"
#include "wale/thesis_files.hpp"

namespace wale {
namespace {

constexpr std::string_view movie_key = "Movie:", date_key = "Date:", time_key = "Time:";

Error damaged(const std::string& name, std::size_t line, std::string expected, std::string_view found, std::string mend) {
  const std::string seen = found.empty() ? "nothing" : fmt::format("\"{}\"", found.substr(0, 80));
  return {.code = Code::damaged_file,
          .sentence = fmt::format("expected {}, found {}", expected, seen),
          .mend = std::move(mend),
          .place = {.name = name, .number = line, .text = std::string(found)},
          .expected = std::move(expected),
          .found = seen};
}

/// Reads the header, in three lines or in one. Returns the number of the line behind it, from 0.
Result<std::size_t> read_header(const std::vector<std::string>& lines, const std::string& name, ThesisShuffle& shuffle) {
  const auto value = [](std::string_view text, std::string_view key) { return std::string(without_blanks(text.substr(key.size()))); };
  const std::string_view first = lines.front();
  const char* mend = "a shuffle begins with `Movie:`, `Date:` and `Time:`, and a blank line";
  if (!first.starts_with(movie_key)) return damaged(name, 1, "`Movie:` and the name of a movie", first, mend);
  const std::size_t time = first.rfind(" Time:"), date = time == first.npos ? first.npos : first.rfind(" Date:", time);
  if (date != first.npos) {  // the manual's form may stand in one line
    shuffle.movie = value(first.substr(0, date), movie_key);
    shuffle.date = value(first.substr(date + 1, time - date - 1), date_key);
    shuffle.time = value(first.substr(time + 1), time_key);
    return std::size_t{1};
  }
  shuffle.movie = value(first, movie_key);
  const std::pair<std::string_view, std::string*> others[] = {{date_key, &shuffle.date}, {time_key, &shuffle.time}};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string_view line = i + 1 < lines.size() ? std::string_view(lines[i + 1]) : std::string_view();
    if (!line.starts_with(others[i].first)) return damaged(name, i + 2, fmt::format("`{}`", others[i].first), line, mend);
    *others[i].second = value(line, others[i].first);
  }
  return std::size_t{3};
}

}  // namespace

Result<ThesisShuffle> read_thesis_shuffle(std::string_view text, const std::string& name) {
  const auto lines = lines_of_thesis_text(text, name);
  if (!lines) return lines.error();
  ThesisShuffle shuffle;
  const auto header = read_header(*lines, name, shuffle);
  if (!header) return header.error();
  if (shuffle.movie.empty()) return damaged(name, 1, "the name of a movie", "", "write it behind `Movie:`");
  std::size_t at = *header;
  if (at >= lines->size() || !without_blanks((*lines)[at]).empty())
    return damaged(name, at + 1, "a blank line behind the header", at < lines->size() ? (*lines)[at] : "", "put one in");
  struct Row {
    std::size_t number, line;
  };
  std::vector<Row> rows;
  for (++at; at < lines->size(); ++at) {
    const std::string_view line = without_blanks((*lines)[at]);
    if (line.empty()) continue;
    std::size_t number = 0;
    const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), number);
    const std::string_view rest = line.substr(static_cast<std::size_t>(end - line.data()));
    const std::string_view frame = without_blanks(rest);
    if (problem != std::errc() || frame.empty() || frame.data() == rest.data())
      return damaged(name, at + 1, "a number, a space and the name of a workspace", line, "as in `3 kitchen`");
    rows.push_back({number, at + 1});
    shuffle.frames.push_back({.name = std::string(frame)});
  }
  if (rows.empty()) return damaged(name, lines->size(), "a line for each frame of the movie", "", "as in `3 kitchen`");
  // The numbers are places, so one of them is the first: 0, or else 1.
  shuffle.first_number = std::ranges::any_of(rows, [](const Row& row) { return row.number == 0; }) ? 0 : 1;
  std::vector<bool> seen(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t place = rows[i].number - shuffle.first_number;
    if (place >= rows.size())
      return damaged(name, rows[i].line, fmt::format("a number from {} to {}, one for each of the {} frames", shuffle.first_number,
                     rows.size() - 1 + shuffle.first_number, rows.size()), std::to_string(rows[i].number), "a line is missing, or the number is wrong");
    if (seen[place])
      return damaged(name, rows[i].line, "each number once", fmt::format("{} again", rows[i].number), "each frame has a place of its own");
    seen[place] = true;
    shuffle.frames[i].original = place;
  }
  return shuffle;
}

Result<std::string> write_thesis_shuffle(const ThesisShuffle& shuffle) {
  const auto refuse = [](std::string what, std::string sentence) {
    return Error{.code = Code::malformed_value, .sentence = std::move(sentence), .place = {.name = std::move(what)}};
  };
  for (const auto& [what, value] : {std::pair("movie", &shuffle.movie), std::pair("date", &shuffle.date), std::pair("time", &shuffle.time)})
    if (!is_thesis_name(*value)) return refuse(what, "expected text in one line, without spaces at its ends");
  if (shuffle.first_number > 1) return refuse("first_number", fmt::format("expected 0 or 1, found {}", shuffle.first_number));
  if (shuffle.frames.empty()) return refuse("frames", "expected a frame or more, found none");
  std::string text = fmt::format("{}{}\n{} {}\n{} {}\n\n", movie_key, shuffle.movie, date_key, shuffle.date, time_key, shuffle.time);
  std::vector<bool> seen(shuffle.frames.size());
  for (const ThesisShuffle::Frame& frame : shuffle.frames) {
    if (!is_thesis_name(frame.name)) return refuse("frames", "expected a name in one line, without spaces at its ends");
    if (frame.original >= seen.size() || seen[frame.original])
      return refuse("frames", "expected each place before the shuffle once");
    seen[frame.original] = true;
    text += fmt::format("{} {}\n", frame.original + shuffle.first_number, frame.name);
  }
  // A movie's name may look like the rest of the header.
  const auto read = read_thesis_shuffle(text, "shuffle");
  if (!read || !(*read == shuffle)) return refuse("movie", "the movie's name looks like a part of the header");
  return text;
}

Result<ThesisShuffle> shuffle_of(const ThesisMovie& movie, const ThesisMovie& shuffled) {
  const auto refuse = [](std::string sentence) {
    return Error{.code = Code::malformed_value,
                 .sentence = std::move(sentence),
                 .mend = "a shuffle has each frame of its movie as often as the movie",
                 .place = {.name = "frames"}};
  };
  if (movie.workspaces.size() != shuffled.workspaces.size())
    return refuse(fmt::format("expected {} frames as in the movie, found {}", movie.workspaces.size(), shuffled.workspaces.size()));
  std::map<std::string, std::deque<std::size_t>> places;
  for (std::size_t i = 0; i < movie.workspaces.size(); ++i) places[movie.workspaces[i]].push_back(i);
  ThesisShuffle shuffle;
  for (const std::string& frame : shuffled.workspaces) {
    const auto found = places.find(frame);
    if (found == places.end() || found->second.empty())
      return refuse(fmt::format("`{}` is there more often than in the movie", frame));
    shuffle.frames.push_back({found->second.front(), frame});
    found->second.pop_front();
  }
  return shuffle;
}

}  // namespace wale
