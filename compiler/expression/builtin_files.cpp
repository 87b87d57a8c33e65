#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "compiler/expression/builtin_functions.hpp"
#include "compiler/expression/fields.hpp"
#include "compiler/expression/measured_table.hpp"
#include "compiler/image/image.hpp"
#include "compiler/text/embedded_files.hpp"

namespace wale {

namespace {

/// An embedded file beside an embedded module: `slate.png` beside library/stone/slate.wale. Null if there is none.
const EmbeddedFile* embedded_asset(std::string_view module, std::string_view written) {
  const std::string_view folder = module.substr(0, module.rfind('/') + 1);
  for (const EmbeddedFile& asset : embedded_assets())
    if (asset.name.starts_with(folder) && asset.name.substr(folder.size()) == written) return &asset;
  return nullptr;
}

/// A file, and how it is decoded if it is a picture: those of the binary are trusted.
struct FileArgument {
  ResolvedFile file;
  Sandbox sandbox = Sandbox::required;
};

void report_too_many_samples(const BuiltinCall& call) {
  constexpr std::size_t most = Budget::most_samples / (1 << 20);
  call.reading.calls.report(
      Code::too_much_read, call.actuals[0].span,
      fmt::format("expected at most {} million samples of pictures and tables in one compilation, found more with `{}`",
                  most, call.value(0).text),
      "", Advice("use fewer or smaller ones").fact("limit", static_cast<double>(Budget::most_samples)));
}

/// The file that the first argument names, relative to the folder of the Wale file. Empty if it cannot be read, which
/// is reported.
std::optional<FileArgument> file_argument(const BuiltinCall& call) {
  const Surroundings& surroundings = call.reading.surroundings;
  if (!surroundings.resolver) {
    call.reading.calls.report(Code::not_constant, call.span, "no file can be read here", "",
                              "read files in a material's physical block or in a `let` that it uses");
    return std::nullopt;
  }
  const std::string& from = surroundings.sources[call.span.source].name;
  if (call.span.source >= first_embedded_source)
    if (const auto* asset = embedded_asset(from, call.value(0).text))
      return FileArgument{{std::string(asset->name), std::string(asset->text)}, Sandbox::if_possible};
  if (!surroundings.diagnostics.has_samples()) return report_too_many_samples(call), std::nullopt;
  auto resolved = surroundings.resolver->file(std::string(call.value(0).text), from);
  if (resolved) return FileArgument{*std::move(resolved), surroundings.resolver->sandbox()};
  if (resolved.error().code == Code::too_much_read) {
    call.reading.calls.report(Code::too_much_read, call.actuals[0].span, resolved.error().sentence, "",
                              resolved.error().mend);
    return std::nullopt;
  }
  call.reading.calls.report(Code::unreadable_file, call.actuals[0].span,
                            fmt::format("`{}` cannot be read: {}", call.value(0).text, resolved.error().sentence), "",
                            "give the path relative to the folder of this file");
  return std::nullopt;
}

/// The index of a table among those of the material. Equal tables are stored once. Empty if the compilation would have
/// too many samples, which is reported.
std::optional<std::uint32_t> add_table(const BuiltinCall& call, HeightTable table) {
  std::vector<HeightTable>& tables = call.reading.tables;
  const auto existing = std::ranges::find(tables, table);
  const bool is_new = existing == tables.end();
  if (!call.reading.surroundings.diagnostics.take_samples(table.heights.size(), is_new)) {
    report_too_many_samples(call);
    return std::nullopt;
  }
  const auto index = static_cast<std::uint32_t>(existing - tables.begin());
  if (is_new) tables.push_back(std::move(table));
  return index;
}

}  // namespace

/// `relief(…)`: a sampled height map, centred on the patch and mirrored at its edges, with its top row at the largest
/// y.
Value relief(const BuiltinCall& call) {
  const auto& declarations = *call.reading.names;
  if (!call.text(0, "relief(\"slate.tif\", …)")) return call.failed();
  const auto scale = call.constant_argument(1, declarations.dimension("scale"), "0.1 mm/px");
  const auto height = call.constant_argument(2, declarations.dimension("length"), "0.8 mm");
  const auto smooth = call.actuals[3].given ? call.constant_argument(3, declarations.dimension("length"), "0.2 mm")
                                            : std::optional<double>(0.0);
  if (!scale || !height || !smooth) return call.failed();
  if (!(*scale > 0))
    return call.reading.calls.report(Code::value_out_of_range, call.actuals[1].span,
                                     "the scale must be greater than zero", "", "write something like `0.1 mm/px`");
  if (!(*smooth >= 0))
    return call.reading.calls.report(Code::value_out_of_range, call.actuals[3].span, "smoothing cannot be negative", "",
                                     "write something like `0.2 mm`");
  const auto argument = file_argument(call);
  if (!argument) return call.failed();
  const auto& [file, sandbox] = *argument;
  auto read = read_height_image(std::as_bytes(std::span(file.bytes)), file.name, *smooth / *scale, sandbox);
  if (!read)
    return call.reading.calls.report(read.error().code, call.actuals[0].span,
                                     fmt::format("`{}`: {}", call.value(0).text, read.error().sentence), "",
                                     read.error().mend);
  HeightImage& picture = *read;
  Field field{.kind = Field::Kind::relief,
              .from = declarations.dimension("length"),
              .to = declarations.dimension("length"),
              .span = *height,
              .columns = static_cast<double>(picture.table.width),
              .rows = static_cast<double>(picture.table.height),
              .column = *scale * picture.pixels_per_column,
              .row = *scale * picture.pixels_per_row};
  const auto index = add_table(call, std::move(picture.table));
  if (!index) return call.failed();
  field.index = *index;
  return {
      .type = Value::Type::field, .dimension = field.to, .field = call.reading.record.keep(field), .span = call.span};
}

/// `table(…)`: a measured relation from a file of comma-separated values.
Value table(const BuiltinCall& call) {
  if (!call.text(0, "table(\"detent.csv\")")) return call.failed();
  for (const std::size_t column : {1, 2})
    if (call.actuals[column].given && !call.text(column, "table(\"detent.csv\", place: \"x\", value: \"force\")"))
      return call.failed();
  const auto argument = file_argument(call);
  if (!argument) return call.failed();
  const auto measured = read_measured_table(argument->file.bytes, std::string(call.value(1).text),
                                            std::string(call.value(2).text), *call.reading.names);
  if (!measured) {
    const Error& error = measured.error();
    const std::string line = error.place.number ? fmt::format(", line {}", *error.place.number) : "";
    return call.reading.calls.report(Code::unreadable_table, call.actuals[0].span,
                                     fmt::format("`{}`{}: {}", call.value(0).text, line, error.sentence), "",
                                     error.mend);
  }
  Field field{.kind = Field::Kind::table,
              .from = measured->from,
              .to = measured->to,
              .samples = measured->table.width,
              .first = measured->first,
              .step = measured->step,
              .low = measured->low,
              .span = measured->high - measured->low};
  const auto index = add_table(call, measured->table);
  if (!index) return call.failed();
  field.index = *index;
  return {
      .type = Value::Type::field, .dimension = field.to, .field = call.reading.record.keep(field), .span = call.span};
}

/// `image(…)`: the value of a relief under the hand.
Value image(const BuiltinCall& call) {
  const Value field = relief(call);
  if (field.failed()) return field;
  const Value hand{.type = Value::Type::vector,
                   .x = call.terms().input(Input::x, call.span),
                   .y = call.terms().input(Input::y, call.span),
                   .dimension = call.reading.names->dimension("length"),
                   .span = call.span};
  return value_at(call.terms(), *field.field, hand, call.span);
}

}  // namespace wale
