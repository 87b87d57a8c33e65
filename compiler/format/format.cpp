#include "compiler/format/format.hpp"

#include "compiler/format/align.hpp"
#include "compiler/format/lines.hpp"
#include "compiler/format/pieces.hpp"
#include "compiler/format/rows.hpp"
#include "compiler/format/spacing.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/parse/print_tree.hpp"

namespace wale {
namespace {

/// The content that formatting must preserve: the tree, and every token and comment except `;`.
struct Content {
  std::string tree;
  std::vector<std::string> pieces;

  friend bool operator==(const Content&, const Content&) = default;
};

Content content_of(const SyntaxTree& tree, const std::vector<formatting::Piece>& pieces) {
  Content content{print_tree(tree), {}};
  for (const auto& piece : pieces) content.pieces.push_back(piece.text);
  return content;
}

Content content_of(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("formatted", text);
  const SyntaxTree tree = parse(sources, source, diagnostics);
  if (diagnostics.has_errors()) return {};
  return content_of(tree, formatting::pieces_of(text, lex(sources, source, diagnostics)));
}

}  // namespace

std::optional<std::string> format(const SourceSet& sources, SourceId source, Diagnostics& diagnostics) {
  Diagnostics found;
  const SyntaxTree tree = parse(sources, source, found);
  for (const Diagnostic& each : found.all()) diagnostics.report(each);
  if (found.has_errors()) return std::nullopt;

  Diagnostics already_reported;
  const auto pieces = formatting::pieces_of(sources[source].text, lex(sources, source, already_reported));
  std::string text = formatting::aligned(formatting::lines_of(formatting::rows_of(pieces), formatting::roles_of(tree)));
  // A file is never overwritten with a different one, even if the formatter has a fault.
  if (!(content_of(text) == content_of(tree, pieces))) {
    diagnostics.report({.code = Code::unexpected_token,
                        .span = {source, 0, 0},
                        .message = "the file was not formatted, because formatting would change its meaning",
                        .help = "this is a fault of the formatter; the file is unchanged"});
    return std::nullopt;
  }
  return text;
}

}  // namespace wale
