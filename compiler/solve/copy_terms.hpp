#pragma once

#include <vector>

#include "compiler/graph/term.hpp"

namespace wale {

/// Copies an expression from one set of terms to another, and replaces some of its terms.
class TermCopier {
 public:
  TermCopier(const Terms& from, Terms& to) : from_(from), to_(to), copies_(from.size(), none) {}

  void replace(TermId from, TermId to) { copies_[from] = to; }

  TermId operator()(TermId root) {
    if (copies_[root] != none) return copies_[root];
    // Operands precede their users, so the needed terms are found from the root backwards, and then copied in order.
    needed_.clear();
    copies_[root] = awaited;
    std::size_t waiting = 1;  // terms still to be visited
    for (TermId id = root; waiting > 0; --id) {
      if (copies_[id] != awaited) continue;
      --waiting;
      needed_.push_back(id);
      for (const TermId operand : operands(from_[id])) {
        if (copies_[operand] != none) continue;
        copies_[operand] = awaited;
        ++waiting;
      }
    }
    for (auto id = needed_.rbegin(); id != needed_.rend(); ++id) {
      Term term = from_[*id];
      const std::size_t count = operands(term).size();
      if (count > 0) term.a = copies_[term.a];
      if (count > 1) term.b = copies_[term.b];
      if (count > 2) term.c = copies_[term.c];
      copies_[*id] = to_.add(term);
    }
    return copies_[root];
  }

 private:
  static constexpr TermId none = ~TermId{0}, awaited = none - 1;

  const Terms& from_;
  Terms& to_;
  std::vector<TermId> copies_;  ///< the copy of each term; `none` if it has not been copied
  std::vector<TermId> needed_;  ///< terms needed by the current root, the last first
};

}  // namespace wale
