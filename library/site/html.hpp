#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace wale {

/// A text that stands in a page as it is, tags and all. Only `html` makes it, so no text of somebody else gets into a
/// page without being escaped.
class Markup {
 public:
  Markup() = default;
  const std::string& text() const { return text_; }
  bool empty() const { return text_.empty(); }
  Markup& operator+=(const Markup& more) {
    text_ += more.text_;
    return *this;
  }

 private:
  friend Markup trusted_markup(std::string text);
  std::string text_;
};

/// A text of our own that has been made safe by other means; for the few places that build tags by themselves.
Markup trusted_markup(std::string text);

/// A text of anybody's as the content of an element or of a quoted attribute: one line, whose characters show and do
/// nothing (schema/visible_text.hpp). With `lines`, its line breaks stay.
std::string escaped(std::string_view text, bool lines = false);

/// A literal with places `{}` for parts, as fmt has them. A text that was put together at run time is none.
struct Template {
  template <std::size_t size>
  consteval Template(const char (&text)[size]) : text(text, size - 1) {}
  std::string_view text;
};

namespace parts_of_markup {
inline std::string safe(const Markup& part) { return part.text(); }
inline std::string safe(std::string_view part) { return escaped(part); }
inline std::string safe(const std::string& part) { return escaped(part); }
inline std::string safe(const char* part) { return escaped(part); }
template <class Number>
requires std::integral<Number> || std::floating_point<Number> Number safe(Number part) { return part; }
}  // namespace parts_of_markup

/// The template with its parts: a `Markup` as it is, a number as fmt writes it, and any other text escaped.
template <class... Parts>
Markup html(Template form, const Parts&... parts) {
  const auto kept = std::make_tuple(parts_of_markup::safe(parts)...);
  return trusted_markup(
      std::apply([&](const auto&... each) { return fmt::vformat(form.text, fmt::make_format_args(each...)); }, kept));
}

/// All of them, with `between` between each two.
Markup joined(const std::vector<Markup>& parts, Template between);

/// JSON as a script of data, which is read and never run. `json` is ASCII, so that nothing in it turns the page's text.
Markup data_block(std::string json);

/// JSON that stands in a script: no `<` in it, and no separator that older scripts take for the end of a line.
std::string script_json(std::string json);

}  // namespace wale
