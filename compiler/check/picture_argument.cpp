#include "compiler/check/picture_argument.hpp"

#include <fmt/format.h>

#include <utility>

namespace wale {

std::optional<PictureArgument> picture_argument(const Call& call, Span span, const char* what, const char* example,
                                                const SyntaxTree& tree, const Surroundings& surroundings,
                                                ExpressionChecker& checker) {
  const auto refuse = [&](Code code, Span at, std::string message, std::string mend) {
    surroundings.diagnostics.report(Advice(std::move(mend)).about(code, at, std::move(message)));
    return std::nullopt;
  };
  const std::span<const Argument> arguments = tree.arguments(call);
  const auto* name = arguments.empty() ? nullptr : std::get_if<TextLiteral>(&tree.expr(arguments[0].value));
  if (!name || arguments[0].name || arguments.size() > 2)
    return refuse(Code::wrong_type, span, fmt::format("a {} is a file and its scale", what), example);
  if (arguments.size() < 2)
    return refuse(Code::missing_argument, span, fmt::format("a {} needs its scale: the size of a pixel", what),
                  example);
  if (arguments[1].name && arguments[1].name->text != "scale")
    return refuse(Code::unknown_argument, arguments[1].name->span,
                  fmt::format("`{}` has no argument `{}`", what, arguments[1].name->text), example);
  PictureArgument picture{.written = std::string(name->text), .file = {}, .span = tree.span(arguments[0].value)};
  Scope scope;
  const auto scale = checker.constant(tree, arguments[1].value, scope, surroundings.declarations.dimension("scale"));
  if (!scale) return std::nullopt;
  if (!(*scale > 0))
    return refuse(Code::value_out_of_range, tree.span(arguments[1].value), "the scale must be greater than zero",
                  "write something like `0.5 mm/px`");
  picture.scale = *scale;
  Resolver* resolver = surroundings.resolver;
  if (!resolver)
    return refuse(Code::unreadable_file, picture.span, "no picture can be read here",
                  fmt::format("leave the {} out", what));
  auto file = resolver->file(picture.written, surroundings.sources[tree.source].name);
  if (!file)
    return refuse(file.error().code, picture.span,
                  fmt::format("`{}` cannot be read: {}", picture.written, file.error().sentence),
                  "give the path relative to the folder of this file");
  picture.file = *std::move(file);
  return picture;
}

}  // namespace wale
