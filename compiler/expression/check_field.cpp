// Curves, measured tables, reliefs and memories: what is called like a function.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/expression/builtin_functions.hpp"
#include "compiler/expression/measured_table.hpp"
#include "compiler/image/image.hpp"
#include "compiler/text/embedded_files.hpp"

namespace wale {
namespace {

/// What a module of the binary brings with it: `slate.png` beside library/stone/slate.wale.
const EmbeddedFile* embedded_asset(std::string_view module, std::string_view written) {
  const std::string_view folder = module.substr(0, module.rfind('/') + 1);
  for (const EmbeddedFile& asset : embedded_assets())
    if (asset.name.starts_with(folder) && asset.name.substr(folder.size()) == written) return &asset;
  return nullptr;
}

}  // namespace

Value ExpressionChecker::at(const Field& field, const Value& argument, Span span) {
  const auto literal = [&](double value) { return terms_.literal(value, span); };
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms_.apply(operation, a, b, span); };
  const auto between = [&](TermId value, TermId low, TermId high) {
    return apply(Operation::maximum, apply(Operation::minimum, value, high), low);
  };
  Value result{.type = Value::Type::number, .dimension = field.to, .span = span};
  const auto sampled = [&](TermId u, TermId v) {
    const TermId sample = terms_.add({.kind = TermKind::operation,
                                      .operation = Operation::sample,
                                      .a = u,
                                      .b = v,
                                      .index = field.index,
                                      .span = span});
    const TermId code = terms_.add({.kind = TermKind::component, .a = sample, .index = 0, .span = span});
    const TermId height = apply(Operation::multiply, code, literal(field.span));
    return field.low == 0 ? height : apply(Operation::add, height, literal(field.low));
  };
  switch (field.kind) {
    case Field::Kind::curve: {
      // Each stretch adds its own rise, so that the curve is continuous whatever the rounding, and needs no search.
      result.x = field.knots.front()[1];
      for (std::size_t i = 0; i + 1 < field.knots.size(); ++i) {
        const auto [from, start] = field.knots[i];
        const auto [to, end] = field.knots[i + 1];
        const TermId width = apply(Operation::subtract, to, from), rise = apply(Operation::subtract, end, start);
        const TermId along = between(apply(Operation::subtract, argument.x, from), literal(0), width);
        result.x =
            apply(Operation::add, result.x, apply(Operation::multiply, along, apply(Operation::divide, rise, width)));
      }
      return result;
    }
    case Field::Kind::table: {
      const TermId place = apply(Operation::multiply, apply(Operation::subtract, argument.x, literal(field.first)),
                                 literal(1 / field.step));
      result.x = sampled(between(place, literal(0), literal(field.samples - 1.0)), literal(0));
      return result;
    }
    case Field::Kind::relief: {
      const TermId u = apply(Operation::add, apply(Operation::multiply, argument.x, literal(1 / field.column)),
                             literal((field.columns - 1) / 2));
      const TermId v = apply(Operation::subtract, literal((field.rows - 1) / 2),
                             apply(Operation::multiply, argument.y, literal(1 / field.row)));
      result.x = sampled(u, v);
      return result;
    }
    case Field::Kind::memory: break;
  }
  const auto [u, v] = memory_place(field.index, argument, span);
  const TermId recalled = terms_.add({.kind = TermKind::operation,
                                      .operation = Operation::recall,
                                      .a = u,
                                      .b = v,
                                      .index = field.index,
                                      .span = span});
  result.x = terms_.add({.kind = TermKind::component, .a = recalled, .index = 0, .span = span});
  return result;
}

std::array<TermId, 2> ExpressionChecker::memory_place(std::uint32_t memory, const Value& place, Span span) {
  const auto along = [&](TermId position, Input half, std::uint32_t axis) {
    const TermId half_cells = terms_.apply(
        Operation::multiply, terms_.add({.kind = TermKind::cells, .index = 2 * memory + axis, .span = span}),
        terms_.literal(0.5, span), span);
    const TermId from_centre =
        terms_.apply(Operation::multiply, terms_.apply(Operation::divide, position, terms_.input(half, span), span),
                     half_cells, span);
    return terms_.apply(Operation::add, from_centre,
                        terms_.apply(Operation::subtract, half_cells, terms_.literal(0.5, span), span), span);
  };
  return {along(place.x, Input::patch_half_width, 0), along(place.y, Input::patch_half_height, 1)};
}

Value ExpressionChecker::call_field(const SyntaxTree& tree, ExprId expr, const Call& call, const Value& field,
                                    Scope& scope) {
  const Span span = tree.span(expr);
  std::vector<Value> arguments;
  for (const auto& argument : tree.arguments(call)) arguments.push_back(check(tree, argument.value, scope));
  for (const auto& argument : arguments)
    if (argument.failed()) return failed(span);
  const bool of_place = field.field->kind == Field::Kind::relief || field.field->kind == Field::Kind::memory;
  const auto due = of_place ? Value::Type::vector : Value::Type::number;
  if (arguments.size() != 1 || tree.arguments(call)[0].name)
    return report(
        Code::missing_argument, span,
        fmt::format("`{}` is asked at one place, and {} {} given", call.callee.text, arguments.size(),
                    arguments.size() == 1 ? "name is" : "are"),
        "",
        of_place ? fmt::format("write `{}(hand)`", call.callee.text) : fmt::format("write `{}(x)`", call.callee.text));
  if (arguments[0].type != due)
    return report(Code::wrong_type, arguments[0].span,
                  fmt::format("{} is due here, not {}", type_words(due), type_words(arguments[0].type)), "",
                  of_place ? "give a place, such as `hand` or `vector(x, 0 mm)`" : "give a number, such as `x`");
  if (arguments[0].dimension != field.field->from) {
    report_dimension(tree, tree.arguments(call)[0].value, scope, arguments[0], field.field->from);
    return failed(span);
  }
  return at(*field.field, arguments[0], span);
}

/// `curve(0 mm, 0 N, 2 mm, 1.5 N, …)`: places and values by turns, the places rising.
Value ExpressionChecker::curve(const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope) {
  const Span span = tree.span(expr);
  std::vector<Value> values;
  bool good = true;
  for (const auto& argument : tree.arguments(call)) {
    if (argument.name) {
      report(Code::unknown_argument, argument.name->span, "the arguments of `curve` have no names", "",
             "give places and values by turns, as in `curve(0 mm, 0 N, 2 mm, 1 N)`");
      good = false;
    }
    values.push_back(check(tree, argument.value, scope));
    good = good && !values.back().failed();
  }
  if (!good) return failed(span);
  if (values.size() < 4 || values.size() % 2 != 0)
    return report(
        Code::missing_argument, span,
        fmt::format("a curve has two points or more, each a place and a value; {} numbers are given", values.size()),
        "", "write, for example, `curve(0 mm, 0 N, 2 mm, 1 N)`");
  Field field{.kind = Field::Kind::curve, .from = values[0].dimension, .to = values[1].dimension};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].type != Value::Type::number)
      return report(Code::wrong_type, values[i].span,
                    fmt::format("a number is due here, not {}", type_words(values[i].type)), "",
                    "make a curve for each part of a vector");
    const Dimension& due = i % 2 == 0 ? field.from : field.to;
    if (values[i].dimension != due) {
      report_dimension(tree, tree.arguments(call)[i].value, scope, values[i], due);
      return failed(span);
    }
    if (terms_.dependence(values[i].x).in_tick())
      return report(Code::wrong_rate, values[i].span, "the points of a curve stay where they are, and this changes", "",
                    "give constants and parameters; call the curve with what changes");
    if (i % 2 == 0) continue;
    field.knots.push_back({values[i - 1].x, values[i].x});
    if (i < 2) continue;
    const auto before = constant_value(terms_, values[i - 3].x), here = constant_value(terms_, values[i - 1].x);
    if (before && here && !(*here > *before))
      return report(Code::value_out_of_range, values[i - 1].span, "the places of a curve rise from point to point", "",
                    "put the points in order; for a jump, set two places close to each other");
  }
  return {.type = Value::Type::field, .dimension = field.to, .field = keep(std::move(field)), .span = span};
}

bool BuiltinFunctions::text(std::size_t i, const char* example) const {
  if (value(i).type == Value::Type::text) return true;
  checker.report(Code::wrong_type, actuals[i].span,
                 fmt::format("a text is due here, not {}", type_words(value(i).type)), "",
                 fmt::format("write it in quotes, as in `{}`", example));
  return false;
}

/// The bytes of the file that the first argument names, from the folder of the Wale file; `name` becomes the file's
/// own.
std::optional<std::string> BuiltinFunctions::file_argument(std::string& name) const {
  if (!checker.surroundings_.resolver) {
    checker.report(Code::not_constant, span, "no file can be read here", "",
                   "use files in a material's physical block or in a `let` that it uses");
    return std::nullopt;
  }
  const Source& source = checker.surroundings_.sources[span.source];
  if (span.source >= first_embedded_source)
    if (const auto* asset = embedded_asset(source.name, value(0).text)) {
      name = asset->name;
      return std::string(asset->text);
    }
  auto resolved = checker.surroundings_.resolver->file(std::string(value(0).text), source.name);
  if (!resolved) {
    checker.report(Code::unreadable_file, actuals[0].span,
                   fmt::format("`{}` cannot be read: {}", value(0).text, resolved.error().sentence), "",
                   "give the path from the folder of this file");
    return std::nullopt;
  }
  name = resolved->name;
  return std::move(resolved->bytes);
}

/// A sampled height map, centred on the patch, mirrored at its edges; its top row lies at the largest y.
Value BuiltinFunctions::relief() const {
  const auto& declarations = checker.declarations();
  if (!text(0, "relief(\"slate.tif\", …)")) return failed();
  const auto scale = constant_argument(1, declarations.dimension("scale"), "0.1 mm/px");
  const auto height = constant_argument(2, declarations.dimension("length"), "0.8 mm");
  const auto smooth =
      actuals[3].given ? constant_argument(3, declarations.dimension("length"), "0.2 mm") : std::optional<double>(0.0);
  if (!scale || !height || !smooth) return failed();
  if (!(*scale > 0))
    return checker.report(Code::value_out_of_range, actuals[1].span, "the scale must be more than nothing", "",
                          "write something like `0.1 mm/px`");
  if (!(*smooth >= 0))
    return checker.report(Code::value_out_of_range, actuals[3].span, "smoothing cannot be negative", "",
                          "write something like `0.2 mm`");
  std::string name;
  const auto bytes = file_argument(name);
  if (!bytes) return failed();
  auto read = read_height_image(std::as_bytes(std::span(*bytes)), name, *smooth / *scale);
  if (!read)
    return checker.report(read.error().code, actuals[0].span,
                          fmt::format("`{}`: {}", value(0).text, read.error().sentence), "", read.error().mend);
  HeightImage& picture = *read;
  Field field{.kind = Field::Kind::relief,
              .from = declarations.dimension("length"),
              .to = declarations.dimension("length"),
              .span = *height,
              .columns = static_cast<double>(picture.table.width),
              .rows = static_cast<double>(picture.table.height),
              .column = *scale * picture.pixels_per_column,
              .row = *scale * picture.pixels_per_row};
  field.index = checker.add_table(std::move(picture.table));
  return {.type = Value::Type::field, .dimension = field.to, .field = checker.keep(field), .span = span};
}

/// A measured relation from a file of comma-separated values.
Value BuiltinFunctions::table() const {
  if (!text(0, "table(\"detent.csv\")")) return failed();
  for (const std::size_t column : {1, 2})
    if (actuals[column].given && !text(column, "table(\"detent.csv\", place: \"x\", value: \"force\")"))
      return failed();
  std::string name;
  const auto bytes = file_argument(name);
  if (!bytes) return failed();
  const auto read =
      read_measured_table(*bytes, std::string(value(1).text), std::string(value(2).text), checker.declarations());
  if (const auto* problem = std::get_if<TableProblem>(&read))
    return checker.report(Code::unreadable_table, actuals[0].span,
                          problem->line == 0
                              ? fmt::format("`{}` {}", value(0).text, problem->reason)
                              : fmt::format("`{}`, line {}: {}", value(0).text, problem->line, problem->reason),
                          "", problem->mend);
  const auto& measured = std::get<MeasuredTable>(read);
  Field field{.kind = Field::Kind::table,
              .from = measured.from,
              .to = measured.to,
              .samples = measured.table.width,
              .first = measured.first,
              .step = measured.step,
              .low = measured.low,
              .span = measured.high - measured.low};
  field.index = checker.add_table(measured.table);
  return {.type = Value::Type::field, .dimension = field.to, .field = checker.keep(field), .span = span};
}

std::uint32_t ExpressionChecker::add_table(HeightTable table) {
  const auto existing = std::ranges::find(tables_, table);
  const auto index = static_cast<std::uint32_t>(existing - tables_.begin());
  if (existing == tables_.end()) tables_.push_back(std::move(table));
  return index;
}

}  // namespace wale
