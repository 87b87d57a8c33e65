#pragma once

#include <cstdint>
#include <forward_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/text/source.hpp"

namespace wale {

/// A word of the text and its place. Dotted names ("fabric.woven") are one word. Words and texts are views into the
/// file that was read, which the tree keeps.
struct Word {
  std::string_view text;
  Span span;
};

using ExprId = std::uint32_t;

/// One name in the suffix of a number: `N s/m^2` is N, s, /m^2. `check` decides whether a name is a unit, since
/// `0.3 denim` is a product.
struct SuffixFactor {
  Word name;
  bool divides = false;
  int exponent = 1;
};

/// Consecutive entries of one of the tree's lists; `SyntaxTree::suffix` and `SyntaxTree::arguments` return them.
struct Row {
  std::uint32_t first = 0, count = 0;
};

struct NumberLiteral {
  double value = 0;
  Row suffix;
};
struct TextLiteral {
  std::string_view text;
};
struct NameUse {
  std::string_view name;
};

enum class UnaryOperator { negate, plus, complement };  // complement: `not`
enum class BinaryOperator {
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_equal,
  greater,
  greater_equal,
  conjunction,  // `and`
  disjunction,  // `or`
};

struct Unary {
  UnaryOperator op;
  ExprId operand;
};
struct Binary {
  BinaryOperator op;
  ExprId left, right;
};
struct Argument {
  std::optional<Word> name;
  ExprId value;
};
struct Call {
  Word callee;  ///< of a material by a title, `"wet glass"(roughness: 0.3)`, without the quotes; its span has them
  Row arguments;
  bool quoted = false;  ///< `callee` is written in quotes
};
struct Conditional {
  ExprId condition, yes, no;
};
/// `grad(h).x`: one part of a vector without a name. `hand.x` is a dotted name instead.
struct Part {
  ExprId whole;
  char part;  ///< 'x' or 'y'
};
/// An expression that could not be read, which has been reported.
struct Erroneous {};

using Expr = std::variant<NumberLiteral, TextLiteral, NameUse, Unary, Binary, Call, Conditional, Part, Erroneous>;

/// `a .. b`.
struct Range {
  ExprId low, high;
};

/// One item of a setting: leading words, then optionally a value, a range or an equation, as in
/// `slope measured` | `10 N` | `amplitude 9 pu .. 194 pu` | `log10(magnitude) = 0.76 * ...` | `roughness =
/// lateral(...)`.
struct SettingItem {
  std::vector<Word> words;
  std::optional<ExprId> value;
  std::optional<ExprId> range_end;  ///< value .. range_end
  std::optional<ExprId> equals;     ///< value = equals, or words = equals
  std::vector<Word> trailing;       ///< words after the value: `0.3 kg assumed`
  Span span;
};

/// One statement of a declarative block: a key, items separated by commas, optionally `on DEVICE`.
struct Setting {
  Word key;
  std::vector<SettingItem> items;
  std::optional<Word> on;
  Span span;
};

/// `percept`, `map`, `device`, `levels`, `hand` and the like: a keyword, a name, a block of settings.
struct RecordDecl {
  Word keyword;
  Word name;
  std::optional<Word> from;  ///< `map roughness from amplitude`
  std::vector<Setting> settings;
  std::string_view documentation;
  Span span;
  bool exported = false;
};

struct Import {
  Word module;
};
/// Declarations other than materials and imports are private to their file unless `export` precedes them.
struct DimensionDecl {
  Word name;
  std::optional<ExprId> definition;  ///< none for a base dimension
  std::optional<Range> range;        ///< default bounds of states of this dimension
  bool exported = false;
};
/// `unit m : length` (a base unit) or `unit N = 1 kg m/s^2`.
struct UnitDecl {
  Word name;
  std::optional<Word> dimension;
  std::optional<ExprId> definition;
  std::string_view documentation;
  bool exported = false;
};
struct Constant {
  Word name;
  ExprId value;
  std::string_view documentation;
  bool exported = false;
};  ///< `let` outside a material
struct FormalParameter {
  Word name;
  std::optional<Word> dimension;
  std::optional<ExprId> default_value;
};
struct FunctionDecl {
  Word name;
  std::vector<FormalParameter> parameters;
  ExprId body;
  std::string_view documentation;
  bool exported = false;
};

/// `roughness 0.6`, `essential softness 0.8 ± 0.1`, `roughness coarse`.
struct PerceptStatement {
  Word name;
  bool essential = false;
  std::optional<ExprId> value;
  std::optional<Word> level_name;  ///< without text: a level is missing there, which has been reported
  std::optional<ExprId> tolerance;
  std::optional<Word> evidence;  ///< how well the level is known, `estimated`
  std::optional<Word> by;        ///< the chosen map, `, by minsky1995.figure19`
  Span span;
};

struct ParamStatement {
  Word name;
  ExprId value;
  std::optional<Range> range;
  std::optional<Range> soft_range;
  std::string_view description;
  std::string_view documentation;
};
struct LetStatement {
  Word name;
  ExprId value;
};
struct HeightStatement {
  Word name;
  ExprId value;
};
/// `force = …`, or a layer of it, `force texture = …`, optionally with `limit 3 N`.
struct ForceStatement {
  std::optional<Word> name;
  ExprId value;
  std::optional<ExprId> limit;
};
/// `patch 95 mm, 95 mm`: the patch's width and height.
struct PatchStatement {
  std::vector<ExprId> sizes;
};
/// `active 0.3 W`: the power that the material may give to the hand by itself.
struct ActiveStatement {
  ExprId power;
};
struct StateStatement {
  Word name;
  std::optional<Word> dimension;
  ExprId value;
  std::optional<Range> range;
};
/// `memory track : length = 0 mm in 0 mm .. 5 mm, cell 1 mm`.
struct MemoryStatement {
  Word name;
  std::optional<Word> dimension;
  ExprId value;
  std::optional<Range> range;
  ExprId cell;
};
struct UpdateStatement {
  Word name;
  bool derivative;
  ExprId value;
};  ///< `x' = …` or `next x = …`
struct ShowStatement {
  ExprId value;
};

struct PhysicalStatement {
  std::variant<ParamStatement, LetStatement, HeightStatement, ForceStatement, PatchStatement, ActiveStatement,
               StateStatement, MemoryStatement, UpdateStatement, ShowStatement>
      what;
  Span span;
};

/// `material NAME { … }`, `material NAME = EXPRESSION` or `material NAME = EXPRESSION { … }`.
struct MaterialDecl {
  Word name;
  std::optional<ExprId> derived_from;
  std::vector<Setting> representative;
  std::vector<PerceptStatement> perceptual;
  std::vector<PhysicalStatement> physical;
  std::optional<Span> perceptual_span, physical_span;  ///< the blocks with their braces, if they are there
  std::string_view documentation;
  Span span;
};

/// `patch cloth = denim(roughness: 0.3) { at 40 mm, 0 mm; size 60 mm, 90 mm }` in a workspace. It is a material with
/// the patch's name, made from the expression, and a block that says where it lies.
struct PatchPlacing {
  MaterialDecl material;
  std::vector<Setting> settings;
  Span span;
};

/// `patches from picture("map.png", scale: 0.3 mm/px) { colour "#c04020" = brick }` in a workspace.
struct PicturePlacing {
  ExprId picture;
  std::vector<Setting> settings;
  Span span;
};

using PlacedStatement = std::variant<PatchPlacing, PicturePlacing>;

/// `workspace NAME { … }`: patches that lie side by side or on one another, the last in front.
struct WorkspaceDecl {
  Word name;
  std::vector<PlacedStatement> placed;
  std::string_view documentation;
  Span span;
};

using Declaration =
    std::variant<Import, DimensionDecl, UnitDecl, Constant, FunctionDecl, RecordDecl, MaterialDecl, WorkspaceDecl>;

/// One parsed file. Expressions are in `exprs` and named by index; `expr_spans` has their spans.
struct SyntaxTree {
  SourceId source = 0;
  std::vector<Expr> exprs;
  std::vector<Span> expr_spans;
  std::vector<SuffixFactor> suffix_factors;  ///< of all numbers, one after the other
  std::vector<Argument> call_arguments;      ///< of all calls, one after the other
  std::vector<Declaration> declarations;
  std::shared_ptr<const Source> text;                               ///< the file into which words and texts point ...
  std::shared_ptr<const std::forward_list<std::string>> rewritten;  ///< ... or these rewritten texts: see `Tokens`

  std::span<const SuffixFactor> suffix(const NumberLiteral& number) const {
    return std::span(suffix_factors).subspan(number.suffix.first, number.suffix.count);
  }
  std::span<const Argument> arguments(const Call& call) const {
    return std::span(call_arguments).subspan(call.arguments.first, call.arguments.count);
  }

  const Expr& expr(ExprId id) const { return exprs[id]; }
  Span span(ExprId id) const { return expr_spans[id]; }
};

}  // namespace wale
