// What a file holds, as far as its name and its bytes tell.
#include "schema/spelling.hpp"
#include "wale/thesis_files.hpp"

namespace wale {

ThesisFileKind kind_of_thesis_file(std::string_view name, std::string_view bytes) {
  if (has_ending(name, ".depth")) return ThesisFileKind::surface;
  if (has_ending(name, ".shade")) return ThesisFileKind::shading;
  if (has_ending(name, ".wave")) return ThesisFileKind::wave;
  if (bytes.starts_with("Movie:")) return ThesisFileKind::shuffle;
  if (read_thesis_array(std::as_bytes(std::span(bytes)), {})) return ThesisFileKind::array;
  for (const char each : bytes.substr(0, 4096))
    if (static_cast<unsigned char>(each) < 0x20 && each != '\r' && each != '\n' && each != '\t') return ThesisFileKind::workspace;
  return ThesisFileKind::movie;
}

Error unread_thesis_workspace(const std::string& name) {
  return {.code = Code::damaged_file,
          .sentence = "expected an array, a wave, a movie or a shuffle, found other binary data, perhaps a workspace of the "
                      "thesis's Sandpaper (type TXPS); those are not read, since the sizes of their fields are not printed",
          .mend = "lay its patches out anew; Sandpaper's `Save Text` shows what they are. If it is an array, its size is wrong",
          .place = {.name = name}};
}

}  // namespace wale
