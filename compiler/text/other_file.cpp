#include "compiler/text/other_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "schema/visible_text.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

struct Beginning {
  std::string_view bytes;
  OtherFile file;
};

constexpr OtherFile picture{"a picture", "a Wale file shows it by `image(\"FILE.png\", …)`"};
constexpr OtherFile archive{"an archive", "unpack it, and name a Wale file from it"};
constexpr OtherFile table{"a table", "a Wale file reads it by `table(\"FILE.csv\", …)`"};
constexpr OtherFile binary{"a binary file", "Wale files are plain text and begin with `wale 1`"};

constexpr OtherFile document{"a document of a word processor",
                             "in the word processor, save it as plain text (.txt, UTF-8), or copy its text into a new plain file"};

constexpr Beginning beginnings[] = {
    {"{\\rtf"sv, document},
    {"\xd0\xcf\x11\xe0"sv, document},
    {"\x89WPP"sv, {"a patch program", "name the Wale file that it was built from"}},
    {"\x89WWS"sv, {"a workspace file", "name the Wale file that it was built from; `wale feel` plays it"}},
    {"\x89WRC"sv, {"a recording", "`wale replay` reads it"}},
    {"\x89PNG"sv, picture},
    {"\xff\xd8\xff"sv, picture},
    {"II*\0"sv, picture},
    {"MM\0*"sv, picture},
    {"GIF8"sv, picture},
    {"PK\x03\x04"sv, archive},
    {"\x1f\x8b"sv, archive},
    {"%PDF"sv, {"a PDF document", binary.mend}},
    {"\x7f\x45LF"sv, {"a program", binary.mend}},
};

/// The archives of word processors say early what they are.
bool is_zipped_document(std::string_view bytes) {
  const std::string_view first = bytes.substr(0, 512);
  return bytes.starts_with("PK\x03\x04"sv) &&
         (first.find("application/vnd.oasis.opendocument.text") != first.npos || first.find("[Content_Types].xml") != first.npos);
}

/// A NUL byte shows so early that a file is no text.
constexpr std::size_t looked_at = 4096;

}  // namespace

std::optional<OtherFile> other_file(std::string_view name, std::string_view bytes) {
  for (const Beginning& each : beginnings)
    if (bytes.starts_with(each.bytes)) return is_zipped_document(bytes) ? document : each.file;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string_view text = bytes;
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (text.starts_with("wale")) return std::nullopt;
  if (name.ends_with(".csv")) return table;
  if (bytes.substr(0, looked_at).find('\0') != std::string_view::npos) return binary;
  return std::nullopt;
}

std::string mend_of_path(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return "name the path of a Wale file";
  std::string first;
  for (fs::directory_iterator each(path, error), end; !error && each != end; each.increment(error)) {
    const std::string file = (fs::path(path) / each->path().filename()).string();
    if (file.ends_with(".wale") && (first.empty() || file < first)) first = file;
  }
  return first.empty() ? "name a Wale file" : fmt::format("name a Wale file in it, as in `{}`", visible_text(first));
}

}  // namespace wale
