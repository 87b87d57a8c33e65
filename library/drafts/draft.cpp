#include "library/drafts/draft.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <span>

#include "compiler/image/image.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// A text within quotation marks of the language.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : visible_text(text)) out += c == '"' || c == '\\' ? '\'' : c;
  return out + "\"";
}

}  // namespace

std::string draft_names(const std::string& title, const std::string& source, const std::string& licence) {
  std::string text = fmt::format("  representative {{\n    title  {}\n    source {}\n", in_quotes(title), in_quotes(source));
  if (!licence.empty()) text += fmt::format("    licence {}\n", in_quotes(licence));
  return text + "  }\n";
}

Error error_in_row(const std::string& path, std::size_t row, std::string sentence, std::string mend) {
  return {.code = Code::unreadable_table,
          .sentence = fmt::format("row {}: {}", row, sentence),
          .mend = std::move(mend),
          .place = {.name = path}};
}

Error missing_option(const char* option, std::string sentence, std::string mend) {
  return {.code = Code::malformed_value, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = option}};
}

Result<Draft> picture_draft(const std::string& path, const std::string& bytes, const std::string& name,
                            const DraftOptions& options) {
  namespace fs = std::filesystem;
  if (!options.scale)
    return missing_option("--scale", fmt::format("expected the side of a pixel of `{}`", visible_text(path)),
                          "for example, `--scale \"0.1 mm\"`");
  const auto image = read_height_image(std::as_bytes(std::span(bytes)), path, 0, options.sandbox);
  if (!image) return image.error();
  const double scale = 1000 * *options.scale, height = 1000 * options.height.value_or(1e-3);
  const double width = image->table.width * image->pixels_per_column * scale;
  const double depth = image->table.height * image->pixels_per_row * scale;
  const double amplitude = options.amplitude.value_or(1);
  Draft draft{.name = name, .text = {}};
  const std::string beside = name + fs::path(path).extension().string();
  draft.files.push_back({beside, bytes});
  if (!options.height)
    draft.assumed.push_back(fmt::format("its height, {:.6g} mm from black to white (--height)", height));
  if (!options.amplitude)
    draft.assumed.push_back(fmt::format("how hard it pushes, {:.6g} N (--amplitude)", amplitude));
  draft.assumed.push_back("that light is high and dark is low, as on no photograph with a shadow");
  draft.text = fmt::format(
      "/// The picture `{}`, {} by {} pixels of {:.6g} mm.\nmaterial {} {{\n{}  physical {{\n    patch {:.6g} mm, {:.6g} mm\n"
      "    param amplitude = {:.6g} N in {:.6g} N .. {:.6g} N \"largest lateral force\"\n"
      "    height surface = image(\"{}\", scale: {:.6g} mm/px, height: {:.6g} mm)\n"
      "    force = lateral(surface, amplitude: amplitude)\n  }}\n}}\n",
      visible_text(fs::path(path).filename().string()), image->table.width, image->table.height, scale, name,
      draft_names(name, "a picture, " + fs::path(path).filename().string(), options.licence), width, depth, amplitude,
      amplitude / 10, 2 * amplitude, beside, scale, height);
  return draft;
}

Result<Draft> thesis_draft(const std::string& path, const std::string& bytes, const std::string& name,
                           const DraftOptions& options) {
  const bool is_wave = kind_of_thesis_file(path, bytes) == ThesisFileKind::wave;
  const auto array = read_thesis_array(std::as_bytes(std::span(bytes)), path);
  if (!array) return array.error();
  if (is_wave && !options.size)
    return missing_option("--size", fmt::format("expected the length of one wave of `{}`", visible_text(path)),
                          "for example, `--size \"2.5 mm\"`");
  Draft draft{.name = name, .text = {}};
  ThesisSurfaceOptions surface{.name = name, .file = std::filesystem::path(path).filename().string()};
  surface.amplitude = options.amplitude.value_or(1);
  if (!options.amplitude) draft.assumed.push_back("how hard it pushes, 1 N (--amplitude)");
  if (options.size) surface.cell = *options.size / array->width, surface.period = *options.size;
  if (!options.size) draft.assumed.push_back("its cells, of 0.37 mm as on the thesis's screen (--size)");
  auto made = is_wave ? wave_in_wale(*array, surface) : surface_in_wale(*array, surface);
  if (!made) {
    made.error().place.name = path;
    return made.error();
  }
  draft.text = std::move(made->text), draft.files = std::move(made->files);
  if (!made->note.empty()) draft.assumed.push_back(made->note);
  return draft;
}

}  // namespace wale
