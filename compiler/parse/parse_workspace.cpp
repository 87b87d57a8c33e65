// Workspaces: patches that are laid out side by side.
#include <fmt/format.h>

#include <utility>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

const std::vector<std::string> placed_words = {"patch", "patches"};

}  // namespace

/// Reads `workspace NAME { … }`.
void Parser::workspace() {
  const std::size_t begin = at_;
  WorkspaceDecl workspace;
  workspace.documentation = documentation_here();
  advance();
  workspace.name = declared_name("workspace");
  block(false, [&] { workspace.placed.push_back(placed_statement()); });
  workspace.span = since(begin);
  tree_.declarations.push_back(std::move(workspace));
}

PlacedStatement Parser::placed_statement() {
  const std::string_view word = here().kind == TokenKind::name ? spelling(here()) : "";
  if (word == "patch") return placed_patch();
  if (word == "patches") return placed_picture();
  const bool heads_patch = kind(at_ + 1) == TokenKind::name && kind(at_ + 2) == TokenKind::equals;
  const auto meant = heads_patch ? nearest_spelling(word, placed_words) : std::nullopt;
  const bool lacks_keyword = !word.empty() && followed_by(TokenKind::equals);
  complain_at(Code::unexpected_token, span_of(here()),
              fmt::format("nothing in a workspace begins with {}", shown(here())), "`patch` or `patches`",
              shown(here()),
              meant           ? fmt::format("did you mean `{}`?", *meant)
              : lacks_keyword ? fmt::format("write `patch {} = …`", word)
                              : "write, for example, `patch board = oak`",
              meant           ? respell_here(placed_words)
              : lacks_keyword ? std::vector{insert_before(span_of(here()), "patch ", "write `patch`", false)}
                              : std::vector<Fix>{},
              {}, meant ? std::vector<Fact>{{"meant", *meant}} : std::vector<Fact>{});
  if (meant && *meant == "patch") return placed_patch();
  throw Abandon{};
}

/// Reads `patch board = oak`, `patch cloth = denim(roughness: 0.3) { at 40 mm, 0 mm }`.
PatchPlacing Parser::placed_patch() {
  const std::size_t begin = at_;
  PatchPlacing patch;
  MaterialDecl& material = patch.material;
  material.documentation = documentation_here();
  advance();
  material.name = declared_name("patch");
  if (!take(TokenKind::equals))
    missing("`=`", fmt::format("write `patch {} = oak`, with the material that it is of", material.name.text),
            insert_equals());
  in_origin_ = true;
  if (at(TokenKind::left_brace))
    fail("expected a material" + after_previous(), "a material",
         fmt::format("write the material that it is of before the brace: `patch {} = oak {{ … }}`", material.name.text));
  material.derived_from = expression();
  material.span = since(begin);
  // The brace may be on the next line, since nothing else begins with one.
  const bool has_settings = here().kind == TokenKind::left_brace;
  if (has_settings) patch.settings = placed_settings();
  patch.span = since(begin);
  if (!has_settings) end_statement();
  return patch;
}

/// Reads `patches from picture("map.png", scale: 0.3 mm/px) { colour "#c04020" = brick }`.
PicturePlacing Parser::placed_picture() {
  const std::size_t begin = at_;
  advance();
  if (!take(TokenKind::word_from))
    missing("`from`", "write `patches from picture(\"map.png\", scale: 0.3 mm/px) { … }`");
  PicturePlacing picture{};
  picture.picture = expression();
  picture.settings = placed_settings();
  picture.span = since(begin);
  return picture;
}

/// Reads the settings of a patch in their braces.
std::vector<Setting> Parser::placed_settings() {
  std::vector<Setting> settings;
  in_placed_ = true;
  block(false, [&] {
    settings.push_back(setting());
    end_statement();
  });
  in_placed_ = false;
  return settings;
}

}  // namespace wale
