#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compiler/check/assemble.hpp"

namespace wale {

/// Checks the statements of one assembled material in order, each with the names of its own file.
///
/// Several checkers may fill one `CheckedMaterial`: each component of a blend has one, with names of its own.
class StatementChecker {
 public:
  /// `prefix` goes before parameters whose names are taken.
  StatementChecker(CheckedMaterial& material, ExpressionChecker& checker, const Surroundings& surroundings,
                   std::string prefix);

  /// One force, or one layer of it, with its place in the source.
  struct Layer {
    Value force;
    Span span;
  };

  void check(const std::vector<AssembledStatement>& statements);
  const std::vector<Layer>& layers() const { return layers_; }
  std::optional<Value> last_height() const { return last_height_; }
  /// Warns of names declared within the span `own` that are never used.
  void warn_of_unused_names(Span own) const;

  void operator()(const ParamStatement& node);
  void operator()(const LetStatement& node);
  void operator()(const HeightStatement& node);
  void operator()(const ForceStatement& node);
  void operator()(const PatchStatement& node);
  void operator()(const ActiveStatement& node);
  void operator()(const StateStatement& node);
  void operator()(const MemoryStatement& node);
  void operator()(const UpdateStatement& node);
  void operator()(const ShowStatement& node);

 private:
  struct KnownMemory {
    std::uint32_t index = 0;
    std::optional<Span> next;  ///< the place of its update, once seen
  };

  const Declarations& declarations() const { return *statement_->home; }
  const SyntaxTree& tree() const { return *statement_->tree; }

  std::optional<TermId> force_limit(ExprId expr);
  std::string two_sizes(const PatchStatement& node) const;
  Advice with_units(const std::vector<ExprId>& numbers, const std::string& unit, const char* write) const;
  std::optional<double> parameter_value(const ParamStatement& node, const Value& own_value);
  std::optional<double> mixed(const Mixture& mixture, const Dimension& dimension);
  Span place_of_default(const ParamStatement& node) const;
  void warn_of_percent(const ParamStatement& node);
  bool lacks_its_unit(const ParamStatement& node, const Value& value);
  bool disagrees_with_its_range(const ParamStatement& node, const Value& value);
  bool range_lacks_its_unit(const ParamStatement& node, const Range& range, const Dimension& dimension);
  std::pair<std::string, double> written_unit(const ParamStatement& node, const Dimension& dimension) const;
  void check_soft_range(const ParamStatement& node, const Dimension& dimension, double value, Parameter& parameter);

  std::optional<Dimension> declared_dimension(const std::optional<Word>& dimension);
  std::optional<StateBounds> bounds(const Word& name, const std::optional<Word>& declared,
                                    const std::optional<Range>& range, const Dimension& dimension);
  bool fits(const Value& value, ExprId expr, const Dimension& dimension);
  Value check_update(const UpdateStatement& node, Value::Type type, const Dimension& dimension);
  std::vector<std::string> remembered() const;
  void update_state(const UpdateStatement& node);
  void update_memory(const UpdateStatement& node, KnownMemory& known);

  std::string free_name(const std::string& name, const std::function<bool(const std::string&)>& taken) const;
  void declare(const Word& name, const Value& value);
  [[gnu::cold]] void declare_failed(const Word& name);
  [[gnu::cold]] void report(Code code, Span span, std::string message, Advice advice);

  CheckedMaterial& material_;
  ExpressionChecker& checker_;
  const Surroundings& surroundings_;
  std::string prefix_;
  Scope scope_;
  const AssembledStatement* statement_ = nullptr;
  std::vector<Layer> layers_;
  std::optional<Value> last_height_;
  std::optional<Span> whole_force_;  ///< place of `force = …`, once seen
  bool patch_seen_ = false, active_seen_ = false;
  struct KnownState {
    std::uint32_t first = 0;   ///< index of the state, or of a vector's x
    Value updated;             ///< new value, for later updates; `failed` before the first update
    std::optional<Span> next;  ///< place of its update
  };
  std::map<std::string_view, KnownState> states_;
  std::map<std::string_view, KnownMemory> memories_;
};

/// Checks `show` statements (shapes and the look of the surface) and fills in the material's picture.
class ShowChecker {
 public:
  ShowChecker(CheckedMaterial& material, ExpressionChecker& checker, const Surroundings& surroundings, Scope& scope)
      : material_(material), checker_(checker), surroundings_(surroundings), scope_(scope) {}

  void check(const SyntaxTree& tree, ExprId expr);

 private:
  struct Shape;
  void mark(const SyntaxTree& tree, ExprId expr, const Call& call, const Shape& shape);
  void relief(const SyntaxTree& tree, const Call& call);
  void colour(const SyntaxTree& tree, const Call& call);
  bool is_of_place(const Value& value);
  std::optional<std::uint32_t> colour_code(const SyntaxTree& tree, ExprId expr);
  [[gnu::cold]] void report(Code code, Span span, std::string message, Advice advice);

  CheckedMaterial& material_;
  ExpressionChecker& checker_;
  const Surroundings& surroundings_;
  Scope& scope_;
};

}  // namespace wale
