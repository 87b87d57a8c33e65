#pragma once

#include <deque>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/expression/value.hpp"

namespace wale {

/// The body of a function as terms, for arguments of certain types and dimensions, whatever they are worth.
struct WrittenOut {
  /// What is known of an argument before it is known what it is worth.
  struct Kind {
    Value::Type type = Value::Type::failed;
    Dimension dimension;

    friend bool operator==(const Kind&, const Kind&) = default;
  };
  /// What reading a body asks of a term besides what it is made of.
  struct Question {
    enum class About {
      worth,   ///< anything
      change,  ///< whether it changes while the hand rests, which would be an error
      range,   ///< whether it is known and not in low .. high, which would be one
    };
    About about = About::worth;
    TermId term = 0;
    double low = 0, high = 0;

    bool admits(double value) const { return value >= low && value <= high; }
    friend bool operator==(const Question&, const Question&) = default;
  };

  std::vector<Kind> arguments;
  bool hand = false;  ///< the hand may be used
  /// Whether there is anything to go by: a body whose terms depend on what the arguments are worth, or that leaves more
  /// behind than terms, is read anew at each call.
  bool always_alike = false;
  /// To be answered by no, or else it is read anew; of parts of arguments, numbered from 0 on (a vector has two).
  std::vector<Question> questions;
  std::size_t parts = 0;    ///< of all arguments
  std::vector<Term> terms;  ///< each once, their operands numbered as `Terms::add` takes them
  Value result;             ///< of terms that are numbered likewise
  std::size_t depth = 0;    ///< how deep the functions are that it calls, 1 where there are none
};

/// The bodies of the functions that every file knows, written out once for each kind of arguments that they are called
/// with. Of the process; may be used by several compilations at once.
class WrittenOutFunctions {
 public:
  explicit WrittenOutFunctions(const Declarations& declarations) : declarations_(declarations) {}

  /// Whether the function is one of those.
  bool covers(const Declared<FunctionDecl>& function) const { return function.home == &declarations_; }
  /// Null where it has not been written out for these. Valid from then on.
  const WrittenOut* find(const FunctionDecl& function, const std::vector<WrittenOut::Kind>& arguments, bool hand) const;
  void keep(const FunctionDecl& function, WrittenOut body);

 private:
  /// An author who makes up dimensions could otherwise fill the memory.
  static constexpr std::size_t most_kinds = 64;

  const Declarations& declarations_;
  mutable std::shared_mutex mutex_;
  std::unordered_map<const FunctionDecl*, std::deque<WrittenOut>> bodies_;
};

}  // namespace wale
