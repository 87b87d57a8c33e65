#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/expression/checked.hpp"
#include "compiler/expression/written_out.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// What surrounds the expressions of one material or declaration while they are checked.
struct Surroundings {
  const SourceSet& sources;
  const Declarations& declarations;  ///< of the file whose expressions are checked
  Diagnostics& diagnostics;
  Resolver* resolver = nullptr;                ///< for images; none where no file may be read
  WrittenOutFunctions* written_out = nullptr;  ///< what is known of functions from other materials, if anything is
};

/// Gives expressions their types and dimensions and turns them into terms, inlining functions on the way.
///
/// One checker serves one material: its terms, its tables and what its calls leave behind.
class ExpressionChecker {
 public:
  ExpressionChecker(Surroundings surroundings, Terms& terms, std::vector<HeightTable>& tables)
      : surroundings_(surroundings), terms_(terms), tables_(tables) {}

  /// An actual argument of a function of the language, already checked.
  struct Actual {
    Value value;
    Span span;
    bool given = false;
  };

  /// The expression's value; what is wrong is reported, and the value then is `failed`.
  Value check(const SyntaxTree& tree, ExprId expr, Scope& scope);

  /// The same, and of this type and dimension, or reported: "force expected, found energy".
  Value check_as(const SyntaxTree& tree, ExprId expr, Scope& scope, Value::Type type, const Dimension& dimension);

  /// The value of a name that the parser has left as a word.
  Value named(const Word& word, Scope& scope) { return name(word, scope); }

  /// The value in SI of an expression of that dimension that needs nothing but literals; otherwise reported.
  std::optional<double> constant(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& dimension);
  /// The same of a number that has been checked.
  std::optional<double> constant(const Value& number);

  /// A call of a declared function with arguments that are values already, in the order of its formals; those not
  /// given take their defaults.
  Value call_with(const Declared<FunctionDecl>& function, std::vector<Actual> actuals, const Scope& scope, Span span);

  /// Reads another file's expressions, with its names, from now on.
  void read(const Declarations& declarations) { declarations_ = &declarations; }
  const Declarations& declarations() const { return *declarations_; }

  const std::vector<Carrier>& carriers() const { return carriers_; }
  std::vector<Carrier>& carriers() { return carriers_; }
  const std::vector<Span>& open_spans() const { return open_spans_; }
  /// Accumulators that calls of `phase` ask for.
  std::vector<CheckedState>& states() { return states_; }
  const std::vector<CheckedPeriod>& periods() const { return periods_; }

  /// Keeps a field for as long as the checker is there: for the values that it is the worth of.
  const Field* keep(Field field) { return fields_.emplace_back(std::make_unique<const Field>(std::move(field))).get(); }
  /// The value of a field at an argument of the type and dimension that it takes.
  Value at(const Field& field, const Value& argument, Span span);
  /// Where a place lies in a memory: columns and rows from the centre of its first cell.
  std::array<TermId, 2> memory_place(std::uint32_t memory, const Value& place, Span span);

  /// Reports a name that an imported file has and keeps to itself; nothing when there is none.
  std::optional<Value> private_name(const Word& word);

 private:
  friend struct BuiltinFunctions;

  /// A definition that is being written out: a function, or a `let` outside the materials.
  struct Callee {
    std::string_view name;
    bool constant = false;

    friend bool operator==(const Callee&, const Callee&) = default;
  };

  /// What a function calls its arguments.
  class Formals {
   public:
    Formals(const std::vector<std::string_view>& names) : size_(names.size()), names_(names.data()) {}
    Formals(const std::vector<FormalParameter>& parameters)
        : size_(parameters.size()), parameters_(parameters.data()) {}

    std::size_t size() const { return size_; }
    std::string_view operator[](std::size_t i) const { return names_ ? names_[i] : parameters_[i].name.text; }
    /// The place of that name, or the size.
    std::size_t find(std::string_view name) const {
      std::size_t i = 0;
      while (i < size_ && (*this)[i] != name) ++i;
      return i;
    }
    [[gnu::cold]] std::vector<std::string> spellings() const;

   private:
    std::size_t size_;
    const std::string_view* names_ = nullptr;
    const FormalParameter* parameters_ = nullptr;
  };

  /// What a call works with: its arguments, and the names that the function's body sees when it is read.
  struct Frame {
    std::vector<Actual> actuals;
    Scope names;
  };
  /// A frame while a call is read. It is used again for later calls: nearly everything in an expression is a call.
  class OpenFrame {
   public:
    explicit OpenFrame(ExpressionChecker& of) : checker_(of) {
      if (checker_.open_frames_ == checker_.frames_.size()) checker_.frames_.push_back(std::make_unique<Frame>());
      frame_ = checker_.frames_[checker_.open_frames_++].get();
    }
    ~OpenFrame() { --checker_.open_frames_; }
    OpenFrame(const OpenFrame&) = delete;
    OpenFrame& operator=(const OpenFrame&) = delete;
    Frame& operator*() const { return *frame_; }

   private:
    ExpressionChecker& checker_;
    Frame* frame_;
  };

  Value number(const SyntaxTree& tree, ExprId expr, const NumberLiteral& literal, Scope& scope);
  Value bound(Scope::Binding& binding, Span span, Scope& scope);
  Value name(const Word& word, Scope& scope);
  Value free_name(const Word& word, Scope& scope);
  Value unary(const SyntaxTree& tree, ExprId expr, const Unary& unary, Scope& scope);
  Value binary(const SyntaxTree& tree, ExprId expr, const Binary& binary, Scope& scope);
  Value conditional(const SyntaxTree& tree, ExprId expr, const Conditional& conditional, Scope& scope);
  Value part(const SyntaxTree& tree, const Part& node, Scope& scope);
  Value call(const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope);
  Value call_function(const SyntaxTree& tree, ExprId expr, const Call& call, const Declared<FunctionDecl>& function,
                      Scope& scope);
  Value call_field(const SyntaxTree& tree, ExprId expr, const Call& call, const Value& field, Scope& scope);
  Value curve(const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope);
  [[gnu::cold]] Value unknown_function(const Call& call, Scope& scope);
  bool may_expand(std::string_view name, Span callee, Span span);
  std::optional<Dimension> dimension_of(const FormalParameter& formal, const Declarations& home) const;
  std::uint32_t add_table(HeightTable table);
  std::optional<Value> input(const Word& word, const Scope& scope);
  std::optional<Value> constant_named(const Word& word);
  std::optional<Value> part_of_vector(const Word& word, Scope& scope);
  bool has_meaning(std::string_view name, const Scope& scope) const;
  bool bind_arguments(const SyntaxTree& tree, const Call& call, const Formals& formals, Scope& scope,
                      std::vector<Actual>& actuals);
  Value expanded(const Declared<FunctionDecl>& function, Frame& frame, const Scope& scope, Span span);
  // written_out.cpp: bodies that are the same in all materials
  using Traces = std::array<std::size_t, 8>;
  Traces traces() const;  ///< how much reading expressions has left behind, besides terms
  Value body(const Declared<FunctionDecl>& function, Frame& frame, bool hand);
  bool list_parts(const std::vector<Actual>& actuals);
  bool answers(const std::vector<WrittenOut::Question>& questions);
  bool write_out(TermId first, std::size_t first_asked, const std::vector<TermId>& parts, const Value& result,
                 WrittenOut& body) const;
  Value written(const WrittenOut& body);
  /// What comes out does not only depend on what the term is made of, but on the answer.
  void ask(const WrittenOut::Question& question) {
    if (writing_out_ > 0) asked_.push_back(question);
  }
  void ask_of(TermId term) { ask({WrittenOut::Question::About::worth, term}); }

  void record_carrier(const FunctionDecl& function, const std::vector<Actual>& actuals, const Value& result, Span span);

  Value add_or_compare(const SyntaxTree& tree, const Binary& node, const Value& left, const Value& right, Scope& scope,
                       Span span);
  Value multiply(const Value& left, const Value& right, Span span);
  Value divide(const Value& left, const Value& right, Span span);
  Value raise(const Value& base, const Value& exponent, Span span);

  Value failed(Span span) const;
  [[gnu::cold]] Value report(Code code, Span span, std::string message, std::string label = {}, Advice advice = "");
  [[gnu::cold]] void say(Diagnostic diagnostic);
  [[gnu::cold]] void report_dimension(const SyntaxTree& tree, ExprId expr, Scope& scope, const Value& value,
                                      const Dimension& expected);
  [[gnu::cold]] Advice dimension_mend(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& expected,
                                      const Dimension& found);
  [[gnu::cold]] Advice factor_mend(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& expected,
                                   const Dimension& ratio);
  [[gnu::cold]] Advice spelling_mend(const Word& word, const Scope* scope, bool functions, Advice otherwise);
  [[gnu::cold]] Value ambiguous_unit(const Word& word, Span declared);
  [[gnu::cold]] void mismatched_sides(const SyntaxTree& tree, const Binary& node, const Value& left, const Value& right,
                                      Scope& scope, Span span);
  /// A definition is read because it is used at `span`: what it adds from another file comes from the outermost use,
  /// unless all that this checker reads is attributed to some place already.
  void enter_call(Span span) {
    if (call_sites_.empty()) outside_ = terms_.attributed();
    call_sites_.push_back(span);
    if (!outside_) terms_.attribute(call_sites_.front());
  }
  void leave_call() {
    call_sites_.pop_back();
    if (call_sites_.empty()) terms_.attribute(outside_);
  }
  /// Where to point: inside a function of another file, at the call that led there.
  Span blame(Span span) const { return call_sites_.empty() || at_home(span) ? span : call_sites_.front(); }
  bool at_home(Span span) const { return !call_sites_.empty() && span.source == call_sites_.front().source; }
  [[gnu::cold]] std::string inside(Span span) const;  ///< " (inside `grating`)", where the place does not say so
  [[gnu::cold]] std::string called_from(
      Span span) const;  ///< "called on line 12", for a place inside a function of the same file
  const DimensionNames& names() const { return declarations_->names(); }
  const Unit* unit(const NameKey& name) const { return declarations_->units.find(name); }

  Surroundings surroundings_;
  const Declarations* declarations_ = &surroundings_.declarations;  ///< changes inside functions of other files
  Terms& terms_;
  std::vector<HeightTable>& tables_;
  std::vector<Carrier> carriers_;
  std::vector<Span> open_spans_;
  std::vector<CheckedState> states_;
  std::map<TermId, TermId> phases_;  ///< by frequency
  std::vector<CheckedPeriod> periods_;
  std::map<const Constant*, Value> constants_;
  std::set<std::pair<SourceId, std::uint32_t>> misspelt_;  ///< words whose likely meaning was looked for, by place
  std::vector<Span> ambiguous_;                            ///< declarations of names that are units too, reported
  bool too_large_ = false;                                 ///< reported
  std::vector<Span> call_sites_;
  std::optional<Span> outside_;  ///< what terms were attributed to before the outermost call
  std::vector<Callee> callees_;
  std::vector<std::unique_ptr<const Field>> fields_;  ///< that values point to
  std::vector<std::unique_ptr<Frame>> frames_;
  std::size_t open_frames_ = 0;              ///< the first of `frames_`
  std::size_t writing_out_ = 0;              ///< bodies within one another
  std::vector<WrittenOut::Question> asked_;  ///< while they are
  std::vector<WrittenOut::Kind> kinds_;      ///< of the arguments of the call that is read
  std::vector<TermId> parts_;                ///< that they consist of
  std::size_t deepest_ = 0;                  ///< how many callees there have been at a time since one of them began
};

/// What makes a value change while the hand rests, in words.
std::string what_changes(const Dependence& dependence);

/// A material that needs more terms than this is far beyond what a patch program holds.
inline constexpr std::size_t most_terms = std::size_t{1} << 18;

/// Definitions lead to one another at most so deep.
inline constexpr std::size_t deepest_call = 64;

/// Whether the compiler itself defines a function of that name.
bool is_builtin_function(const NameKey& name);

/// Whether the language itself gives this name a meaning on a patch: the hand's place and motion, the patch's extents,
/// time.
bool names_hand_or_patch(const NameKey& name);

/// The value of a term that depends on nothing, in double precision, or nothing. With `parameters` it may depend on
/// those too.
std::optional<double> constant_value(const Terms& terms, TermId id, const std::vector<Parameter>* parameters = nullptr);

/// `hold(value, ceiling)` and `force = value limit ceiling`: a vector held by its length, then each part again, which
/// is exact whatever the rounding.
Value held(Terms& terms, const Value& value, TermId ceiling, Span span);

/// The unit that people would write a quantity of this dimension in: "mm" for a length, the coherent unit otherwise.
std::string customary_unit(const Declarations& declarations, const Dimension& dimension);

/// The fix that writes a unit behind a bare number, for who forgot it; none where the expression is something else.
std::vector<Fix> append_unit(const SyntaxTree& tree, ExprId expr, const std::string& unit, const SourceSet& sources);

/// What to write in the place of a word that is no unit: the symbol of one written out, or the nearest.
Advice unit_mend(const Word& word, const Declarations& declarations);

}  // namespace wale
