#include "compiler/diagnostics/fix.hpp"

#include <fmt/format.h>

#include <utility>

#include "schema/spelling.hpp"

namespace wale {

Fix replace(Span span, std::string text, std::string title, bool safe) {
  if (title.empty()) title = text.empty() ? "remove it" : fmt::format("write `{}`", text);
  return {std::move(title), {{span, std::move(text)}}, safe};
}

Fix insert_before(Span span, std::string text, std::string title, bool safe) {
  return replace({span.source, span.begin, span.begin}, std::move(text), std::move(title), safe);
}

Fix insert_after(Span span, std::string text, std::string title, bool safe) {
  return replace({span.source, span.end, span.end}, std::move(text), std::move(title), safe);
}

std::vector<Fix> respell(Span span, std::string_view word, const std::vector<std::string>& candidates,
                         bool may_be_safe) {
  auto near = near_spelling(word, candidates);
  if (!near) return {};
  return {replace(span, std::move(near->text), {}, near->certain && may_be_safe)};
}

}  // namespace wale
