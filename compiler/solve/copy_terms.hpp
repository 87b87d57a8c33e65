#pragma once

#include <utility>
#include <vector>

#include "compiler/graph/term.hpp"

namespace wale {

/// Copies an expression from one set of terms to another, some of its terms replaced.
class TermCopier {
 public:
  TermCopier(const Terms& from, Terms& to)
      : from_(from), to_(to), copies_(from.size(), none), needed_(from.size(), false) {}

  void replace(TermId from, TermId to) { copies_[from] = to; }

  TermId operator()(TermId root) {
    // Operands stand before their users, so one pass over what the root needs copies everything in order.
    if (copies_[root] != none) return copies_[root];
    TermId first = root;      // of what is needed and not there yet
    std::size_t waiting = 1;  // of them: not looked at yet
    needed_[root] = true;
    for (TermId id = root; waiting > 0; --id) {
      if (!needed_[id]) continue;
      first = id;
      --waiting;
      for (const TermId operand : operands(from_[id]))
        if (copies_[operand] == none && !std::exchange(needed_[operand], true)) ++waiting;
    }
    for (TermId id = first; id <= root; ++id) {
      if (!needed_[id]) continue;
      needed_[id] = false;
      Term term = from_[id];
      const auto count = operands(term).size();
      if (count > 0) term.a = copies_[term.a];
      if (count > 1) term.b = copies_[term.b];
      if (count > 2) term.c = copies_[term.c];
      copies_[id] = to_.add(term);
    }
    return copies_[root];
  }

 private:
  static constexpr TermId none = ~TermId{0};

  const Terms& from_;
  Terms& to_;
  std::vector<TermId> copies_;  ///< by the term copied; `none` where there is none yet
  std::vector<char> needed_;    ///< by term, as bool; all false between calls
};

}  // namespace wale
