// A libFuzzer target for the files of the thesis. Any bytes are refused with a reason and a mend, or make a value that is
// written and read as the same value again. What it becomes in Wale is a text in the standard style, of a movie without errors;
// the picture of a material is no file here.
#include <algorithm>
#include <cstdlib>
#include <span>
#include <string>

#include "wale/language_service.hpp"
#include "wale/library.hpp"
#include "wale/thesis_files.hpp"

namespace {

using namespace wale;

void demand(bool condition) {
  if (!condition) std::abort();
}

void demand_material(const Result<ThesisInWale>& made) {
  static const LanguageService language;
  if (!made) return demand(!made.error().sentence.empty());
  const std::string text = "wale 1\n\n" + made->text;
  const auto formatted = language.format(text);
  demand(formatted && *formatted == text);
}

void demand_movie(const Result<ThesisInWale>& made) {
  static const Library library;
  demand(made && library.presentation("wale 1\n\n" + made->text));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  (void)kind_of_thesis_file("file", text);
  const std::string name = wale_name(text, {"a", "a_2"});
  if (const auto array = read_thesis_array(std::as_bytes(std::span(text)), "file")) {
    const auto written = write_thesis_array(*array);
    demand(written && std::ranges::equal(*written, std::as_bytes(std::span(text))));
    const ThesisSurfaceOptions options{.name = name, .file = text, .amplitude = 1, .period = 1e-3};
    demand_material(surface_in_wale(*array, options, &*array));
    demand_material(wave_in_wale(*array, options));
  } else {
    demand(!array.error().sentence.empty() && !array.error().mend.empty());
  }
  if (const auto movie = read_thesis_movie(text, "file")) {
    if (const auto written = write_thesis_movie(*movie)) demand(*read_thesis_movie(*written, "file") == *movie);
    else demand(movie->workspaces.size() > ThesisMovie::most_frames || !written.error().sentence.empty());
    if (size < 4096) demand_movie(movie_in_wale(*movie, {.name = name, .file = text, .taken = {"b"}}));
  } else {
    demand(!movie.error().sentence.empty());
  }
  if (const auto shuffle = read_thesis_shuffle(text, "file")) {
    if (const auto written = write_thesis_shuffle(*shuffle)) demand(*read_thesis_shuffle(*written, "file") == *shuffle);
    demand_movie(shuffle_in_wale(*shuffle, {.name = name, .file = text}));
  } else {
    demand(!shuffle.error().sentence.empty());
  }
  return 0;
}
