#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/expression/call_stack.hpp"
#include "compiler/expression/checked.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// The module that exports a name, and the kind of its declaration there ("function").
struct Exporter {
  std::string module;
  std::string_view what;
};
using FindExporter = std::function<std::optional<Exporter>(std::string_view name)>;

/// The context in which the expressions of one material or declaration are read.
struct Surroundings {
  const SourceSet& sources;
  const Declarations& declarations;  ///< those of the file whose expressions are checked
  Diagnostics& diagnostics;
  Resolver* resolver = nullptr;                 ///< for images and tables; null if no file may be read
  const FindExporter* find_exporter = nullptr;  ///< to suggest imports; null if there are none to suggest
};

/// An argument of `sin` or `cos`, and the place to report for it.
struct CheckedAngle {
  TermId angle = 0;
  Span span;
};

/// A value with the range that `usual` states for it, SI.
struct CheckedUsual {
  std::string name;
  TermId value = 0;
  double low = 0, high = 0;
  Dimension dimension;
  Span span;
};

/// The results of reading expressions besides terms and tables.
struct CallRecord {
  std::vector<Carrier> carriers;
  std::vector<Span> open_spans;      ///< one for each open quantity: the call that leaves it open
  std::vector<CheckedState> states;  ///< states that calls of `phase` and `stretch` add
  std::map<TermId, TermId> phases;   ///< the state term of each `phase`, by its frequency
  std::vector<CheckedPeriod> periods;
  std::vector<CheckedRate> rates;
  std::vector<CheckedAngle> angles;
  std::vector<CheckedUsual> usual;
  std::vector<std::unique_ptr<const Field>> fields;  ///< fields to which values point

  /// Stores a field for the life of the record, since values point to it.
  const Field* keep(Field field) { return fields.emplace_back(std::make_unique<const Field>(std::move(field))).get(); }
};

/// Names that have been read, so that each is read once and each mistake is reported once.
struct KnownNames {
  std::map<const Constant*, Value> constants;
  std::set<std::pair<SourceId, std::uint32_t>> misspelt;  ///< by the place where a word begins
  std::vector<Span> ambiguous;                            ///< declarations of names that are units too
};

/// The operations that an expression takes, without those of the functions that it calls: one for each of its operators
/// and names, of which a text has about one in two bytes.
inline std::size_t operations_of_text(const Span& span) { return 1 + (span.end - span.begin) / 2; }

/// How deep expressions may be nested with those of the functions that they call. They are read recursively, each with
/// less than 2 kB of the stack.
inline constexpr std::size_t deepest_expression = 1000;

/// The state that the parts of the expression checker share while they read the expressions of one material.
struct ExpressionReading {
  ExpressionReading(const Surroundings& around, Terms& terms, std::vector<HeightTable>& tables)
      : surroundings(around),
        names(&surroundings.declarations),
        terms(terms),
        tables(tables),
        calls(around.sources, around.diagnostics, terms) {}

  Surroundings surroundings;
  const Declarations* names;  ///< of the file whose expression is being read; changes inside functions of other files
  Terms& terms;
  std::vector<HeightTable>& tables;
  CallStack calls;
  CallRecord record;
  KnownNames known;
  /// How many expressions are being read, one inside another; those of functions that are called count too.
  std::size_t depth = 0;
  /// The place where a name is declared further down in the block that is being read; nothing outside such a block.
  std::function<std::optional<Span>(std::string_view name)> declared_below{};
  /// The component of a blend whose statements are being read, and which therefore spends the budget.
  std::optional<Span> component;

  /// Takes operations from the budget before they are done. False if it is spent, which has been reported: at the
  /// component of a blend, else at the call that led to `span`, else there.
  bool charge(std::size_t operations, const Span& span) {
    if (surroundings.diagnostics.charge(operations)) [[likely]]
      return true;
    report_spent(span);
    return false;
  }
  [[gnu::cold]] void report_spent(const Span& span) {
    surroundings.diagnostics.report_spent(component       ? *component
                                          : calls.empty() ? span
                                                          : calls.outermost(),
                                          component ? Work::blend : Work::expansion);
  }

  const DimensionNames& dimension_names() const { return names->names(); }
};

}  // namespace wale
