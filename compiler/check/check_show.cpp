#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "compiler/check/check_statements.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

constexpr std::uint32_t ink = 0x202020;

}  // namespace

/// One argument of a shape: its name, its dimension, and its default.
struct ShapeArgument {
  std::string_view name;
  const char* dimension;
  bool place;                         ///< a vector rather than a number
  std::optional<double> otherwise{};  ///< default, SI; none if the argument is required
};

struct ShowChecker::Shape {
  std::string_view name;
  MarkKind kind;
  std::vector<ShapeArgument> arguments;
};

namespace {

const auto& shapes() {
  using Kind = MarkKind;
  struct Entry {
    std::string_view name;
    Kind kind;
    std::vector<ShapeArgument> arguments;
  };
  static const std::vector<Entry> table{
      {"point", Kind::point, {{"place", "length", true}, {"size", "length", false, 4e-3}}},
      {"circle", Kind::circle, {{"place", "length", true}, {"radius", "length", false}}},
      {"box",
       Kind::box,
       {{"place", "length", true},
        {"width", "length", false},
        {"height", "length", false},
        {"angle", "number", false, 0.0}}},
      {"line", Kind::line, {{"start", "length", true}, {"end", "length", true}}},
      {"spring", Kind::spring, {{"start", "length", true}, {"end", "length", true}, {"width", "length", false, 6e-3}}},
      {"trajectory", Kind::trajectory, {{"place", "length", true}, {"seconds", "time", false, 1.0}}},
  };
  return table;
}

}  // namespace

void ShowChecker::check(const SyntaxTree& tree, ExprId expr) {
  if (std::holds_alternative<Erroneous>(tree.expr(expr))) return;
  const auto* call = std::get_if<Call>(&tree.expr(expr));
  std::vector<std::string> known{"relief", "colour"};
  for (const auto& shape : shapes()) known.emplace_back(shape.name);
  if (!call)
    return report(Code::wrong_type, tree.span(expr), "this cannot be shown",
                  "write, for example, `show box(p, 20 mm, 10 mm)` or `show relief(height)`");
  if (call->callee.text == "relief") return relief(tree, *call);
  if (call->callee.text == "colour") return colour(tree, *call);
  const auto found = std::ranges::find(shapes(), call->callee.text, [](const auto& each) { return each.name; });
  if (found != shapes().end()) return mark(tree, expr, *call, {found->name, found->kind, found->arguments});
  report(
      Code::unknown_name, call->callee.span, fmt::format("no shape is called `{}`", call->callee.text),
      did_you_mean(call->callee.span, call->callee.text, known, fmt::format("there are: {}", fmt::join(known, ", "))));
}

void ShowChecker::mark(const SyntaxTree& tree, ExprId expr, const Call& call, const Shape& shape) {
  const auto& declarations = checker_.declarations();
  std::vector<std::optional<ExprId>> given(shape.arguments.size());
  CheckedMark mark{.kind = shape.kind, .operands = {}, .colour = ink};
  std::size_t position = 0;
  bool good = true;
  std::vector<std::string> names;
  for (const auto& argument : shape.arguments) names.emplace_back(argument.name);
  names.emplace_back("colour");
  const std::string taken = fmt::format("it takes: {}", fmt::join(names, ", "));
  for (const auto& argument : tree.arguments(call)) {
    std::size_t index = argument.name
                            ? static_cast<std::size_t>(std::ranges::find(names, argument.name->text) - names.begin())
                            : position++;
    if (index >= names.size() || (index == shape.arguments.size() && !argument.name)) {
      report(Code::unknown_argument, argument.name ? argument.name->span : tree.span(argument.value),
             argument.name
                 ? fmt::format("a {} has no `{}`", shape.name, argument.name->text)
                 : fmt::format("a {} takes {} arguments, and this is one too many", shape.name, shape.arguments.size()),
             argument.name ? did_you_mean(argument.name->span, argument.name->text, names, taken) : Advice(taken));
      good = false;
    } else if (index == shape.arguments.size()) {
      const auto code = colour_code(tree, argument.value);
      good = good && code;
      mark.colour = code.value_or(ink);
    } else {
      given[index] = argument.value;
    }
  }
  for (std::size_t i = 0; i < shape.arguments.size() && good; ++i) {
    const auto& argument = shape.arguments[i];
    if (!given[i] && !argument.otherwise) {
      report(Code::missing_argument, tree.span(expr), fmt::format("a {} needs its `{}`", shape.name, argument.name),
             taken);
      return;
    }
    if (!given[i]) {
      mark.operands.push_back(material_.terms.literal(*argument.otherwise, tree.span(expr)));
      continue;
    }
    const bool plain = std::string_view(argument.dimension) == "number";
    const Value value =
        checker_.check_as(tree, *given[i], scope_, argument.place ? Value::Type::vector : Value::Type::number,
                          plain ? Dimension{} : declarations.dimension(argument.dimension));
    good = good && !value.failed();
    mark.operands.push_back(value.x);
    if (argument.place) mark.operands.push_back(value.y);
  }
  if (good) material_.marks.push_back(std::move(mark));
}

/// `show relief(height)`: the look of the surface, independent of the force.
void ShowChecker::relief(const SyntaxTree& tree, const Call& call) {
  if (tree.arguments(call).size() != 1)
    return report(Code::missing_argument, call.callee.span, "`relief` takes one height",
                  "write, for example, `show relief(ribs)`");
  const ExprId expr = tree.arguments(call)[0].value;
  const Value value = checker_.check(tree, expr, scope_);
  if (value.failed()) return;
  const bool length = value.dimension == checker_.declarations().dimension("length");
  if (value.type != Value::Type::number || (!length && !value.dimension.plain()))
    return report(Code::wrong_type, value.span, "a height must be a length or a plain number at each place",
                  "write it in terms of `x` and `y`, as in `grating(x, period: 2.5 mm)`");
  if (!is_of_place(value)) return;
  material_.relief = value.x;
  material_.relief_is_length = length;
}

/// `show colour(0.8, 0.5, 0.2)`: red, green and blue, which may change from place to place.
void ShowChecker::colour(const SyntaxTree& tree, const Call& call) {
  const auto arguments = tree.arguments(call);
  if (arguments.size() != 3)
    return report(Code::missing_argument, call.callee.span, "a colour needs red, green and blue, each from 0 to 1",
                  "write, for example, `show colour(0.8, 0.5, 0.2)`");
  std::array<TermId, 3> parts{};
  bool doubted = false;  // one part in 255ths is as all three
  for (std::size_t i = 0; i < 3; ++i) {
    const Value value = checker_.check_as(tree, arguments[i].value, scope_, Value::Type::number, Dimension{});
    if (value.failed() || !is_of_place(value)) return;
    parts[i] = value.x;
    const auto known = constant_value(material_.terms, value.x);
    if (known && !(*known >= 0 && *known <= 1) && !std::exchange(doubted, true))
      report(Code::beyond_soft_range, value.span,
             readable("`{}` is {:.4g}, and the parts of a colour go from 0 to 1",
                      i == 0   ? "red"
                      : i == 1 ? "green"
                               : "blue",
                      *known),
             *known > 1 && *known <= 255 ? typeable("if it goes to 255, write `{:.3g}`", *known / 255)
                                         : "give a number from 0 to 1");
  }
  material_.colour = parts;
}

/// A surface is drawn as a whole, wherever the hand is, so it may not depend on time or motion.
bool ShowChecker::is_of_place(const Value& value) {
  const auto dependence = material_.terms.dependence(value.x);
  if (!dependence.on(Dependence::velocity | Dependence::moment)) return true;
  report(Code::wrong_rate, value.span,
         fmt::format("the surface is drawn at every place at once, but this depends on {}", what_changes(dependence)),
         "use only `x`, `y`, parameters and states; show motion with a mark");
  return false;
}

/// The colour of a text such as "#c04020".
std::optional<std::uint32_t> ShowChecker::colour_code(const SyntaxTree& tree, ExprId expr) {
  const auto* literal = std::get_if<TextLiteral>(&tree.expr(expr));
  const auto digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); };
  if (literal && literal->text.size() == 7 && literal->text[0] == '#' &&
      std::ranges::all_of(literal->text.substr(1), digit))
    return static_cast<std::uint32_t>(std::stoul(std::string(literal->text.substr(1)), nullptr, 16));
  report(Code::wrong_type, tree.span(expr), "a shape's colour must be a text of a # and six hexadecimal digits",
         "write, for example, `colour: \"#c04020\"`");
  return std::nullopt;
}

void ShowChecker::report(Code code, Span span, std::string message, Advice advice) {
  surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
}

}  // namespace wale
