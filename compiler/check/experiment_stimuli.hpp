#pragma once

#include <string>
#include <vector>

#include "compiler/check/check_experiment.hpp"
#include "compiler/modules/declare_records.hpp"

namespace wale {

/// A level of a factor, and what it puts into an expression.
struct WrittenLevel {
  ExprId value = 0;
  Word material;  ///< if it is one; its text is empty otherwise
  std::string text;
};

/// Reads the factors of an experiment and crosses its stimuli with them. Expressions are added to a copy of the tree.
class ExperimentStimuli {
 public:
  ExperimentStimuli(RecordReader& reader, const Surroundings& surroundings, CheckedExperiment& experiment)
      : reader_(reader), surroundings_(surroundings), experiment_(experiment), tree_(reader.tree) {}

  /// Reads `factor`, `stimulus` and `standard`. Errors are reported.
  void read();

 private:
  struct Written {
    ExprId made_of = 0;
    std::string name;  ///< empty if none is given
    Span span;
    std::vector<std::size_t> factors;  ///< those that it names
  };

  void read_factor(const Setting& setting);
  bool add_steps(const Setting& setting, ExperimentFactor& factor, std::vector<WrittenLevel>& levels);
  bool add_level(const Setting& setting, std::size_t index, ExperimentFactor& factor,
                 std::vector<WrittenLevel>& levels);
  std::optional<Written> written(const SettingItem& item, bool may_be_named);
  void names_in(ExprId expr, std::vector<std::size_t>& factors) const;
  ExprId bound(ExprId expr, const std::vector<std::size_t>& levels, std::vector<std::pair<Span, std::string>>& edits);
  std::optional<std::size_t> factor_named(std::string_view name) const;
  bool cross(const Written& stimulus, const std::optional<Written>& standard);
  std::shared_ptr<const CheckedMaterial> material(const Written& of, const std::vector<std::size_t>& levels,
                                                  std::string& made_of);
  ExprId add(Expr expr, Span span);
  std::string free_name(const std::string& made_of, const std::string& given);

  RecordReader& reader_;
  const Surroundings& surroundings_;
  CheckedExperiment& experiment_;
  SyntaxTree tree_;
  std::vector<std::vector<WrittenLevel>> levels_;  ///< of each factor
  std::vector<bool> used_;                         ///< which factors a stimulus names
  std::map<std::string, std::size_t> standards_;   ///< by what they are made of
  std::set<std::string> names_;
};

}  // namespace wale
