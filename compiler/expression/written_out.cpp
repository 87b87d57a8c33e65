#include "compiler/expression/written_out.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "compiler/expression/check_expression.hpp"

namespace wale {

namespace {

/// Whether a term is the same in every material, but for its operands.
bool stands_alone(const Term& term) {
  switch (term.kind) {
    case TermKind::literal:
    case TermKind::input:
    case TermKind::gradient:
    case TermKind::peak: return true;
    case TermKind::operation:
      return term.operation != Operation::sample && term.operation != Operation::recall &&
             term.operation != Operation::cell;
    default: return false;
  }
}

}  // namespace

const WrittenOut* WrittenOutFunctions::find(const FunctionDecl& function,
                                            const std::vector<WrittenOut::Kind>& arguments, bool hand) const {
  const std::shared_lock reading(mutex_);
  const auto bodies = bodies_.find(&function);
  if (bodies == bodies_.end()) return nullptr;
  const auto body = std::ranges::find_if(
      bodies->second, [&](const WrittenOut& each) { return each.hand == hand && each.arguments == arguments; });
  return body == bodies->second.end() ? nullptr : &*body;
}

void WrittenOutFunctions::keep(const FunctionDecl& function, WrittenOut body) {
  const std::unique_lock writing(mutex_);
  auto& bodies = bodies_[&function];  // whose elements stay where they are
  const bool known = std::ranges::any_of(
      bodies, [&](const WrittenOut& each) { return each.hand == body.hand && each.arguments == body.arguments; });
  if (!known && bodies.size() < most_kinds) bodies.push_back(std::move(body));
}

ExpressionChecker::Traces ExpressionChecker::traces() const {
  return {surroundings_.diagnostics.all().size(),
          open_spans_.size(),
          carriers_.size(),
          states_.size(),
          periods_.size(),
          constants_.size(),
          fields_.size(),
          tables_.size()};
}

/// The value of a function's body, of which the frame's names are the arguments.
Value ExpressionChecker::body(const Declared<FunctionDecl>& function, Frame& frame) {
  const auto read = [&] { return check(*function.tree, function.node->body, frame.names); };
  WrittenOutFunctions* const known = surroundings_.written_out;
  // Terms of what every file knows come from where the author calls it, wherever in the body they are written.
  const auto place = terms_.attributed();
  const bool is_author = place && place->source < first_embedded_source;
  if (!known || !known->covers(function) || !is_author || !list_parts(frame)) return read();

  if (const WrittenOut* found = known->find(*function.node, frame.kinds, frame.names.hand)) {
    const bool fits =
        terms_.size() + found->steps.size() <= most_terms && callees_.size() - 1 + found->depth <= deepest_call;
    return found->always_alike && fits ? written(*found, frame.parts) : read();
  }
  // What is read now is written out; so may be a call that it stands in.
  const Traces before = traces();
  const auto first = static_cast<TermId>(terms_.size());
  const std::size_t first_asked = asked_.size(), depth = callees_.size();
  const std::size_t deepest_before = std::exchange(deepest_, depth);
  ++writing_out_;
  const Value result = read();
  if (!result.failed()) {
    WrittenOut body{.arguments = frame.kinds, .hand = frame.names.hand, .depth = deepest_ - depth + 1};
    body.always_alike = traces() == before && write_out(first, first_asked, frame.parts, result, body);
    known->keep(*function.node, std::move(body));
  }
  deepest_ = std::max(deepest_, deepest_before);
  if (--writing_out_ == 0) asked_.clear();
  return result;
}

/// What kinds of arguments they are, and the terms that they consist of; false where that is not all there is to them.
bool ExpressionChecker::list_parts(Frame& frame) {
  frame.kinds.clear();
  frame.parts.clear();
  for (const auto& binding : frame.names.bindings()) {
    const Value& value = binding.value;
    const bool vector = value.type == Value::Type::vector;
    if (!vector && value.type != Value::Type::number && value.type != Value::Type::boolean) return false;
    frame.kinds.push_back({value.type, value.dimension});
    frame.parts.push_back(value.x);
    if (vector) frame.parts.push_back(value.y);
  }
  return true;
}

/// Takes down the terms from `first` on. False where they do not follow from the kinds of the arguments alone: where
/// something has asked what an argument is worth, or they use what is neither of the body nor an argument.
bool ExpressionChecker::write_out(TermId first, std::size_t first_asked, const std::vector<TermId>& parts,
                                  const Value& result, WrittenOut& body) const {
  body.parts = parts.size();
  const auto number_of = [&](TermId id) -> std::optional<TermId> {
    if (id >= first) return static_cast<TermId>(id - first + parts.size());
    if (std::ranges::count(parts, id) != 1) return std::nullopt;  // of two arguments that are the same, either
    return static_cast<TermId>(std::ranges::find(parts, id) - parts.begin());
  };
  std::vector<bool> of_arguments;  // whether the term of the body depends on any
  for (TermId id = first; id < terms_.size(); ++id) {
    if (!stands_alone(terms_[id])) return false;
    const TermOperands used = operands(terms_[id]);
    WrittenOut::Step step{terms_[id], used.size()};
    step.term.span = {};
    if (step.term.kind != TermKind::literal) step.term.value = 0;
    bool depends = false;
    for (std::size_t i = 0; i < used.size(); ++i) {
      const auto number = number_of(used[i]);
      if (!number) return false;
      (i == 0 ? step.term.a : i == 1 ? step.term.b : step.term.c) = *number;
      depends = depends || *number < parts.size() || of_arguments[*number - parts.size()];
    }
    of_arguments.push_back(depends);
    body.steps.push_back(step);
  }
  for (std::size_t i = first_asked; i < asked_.size(); ++i)
    if (asked_[i] < first || of_arguments[asked_[i] - first]) return false;
  const bool vector = result.type == Value::Type::vector;
  if (!vector && result.type != Value::Type::number && result.type != Value::Type::boolean) return false;
  const auto x = number_of(result.x), y = vector ? number_of(result.y) : TermId{0};
  if (!x || !y) return false;
  body.result = {.type = result.type, .x = *x, .y = *y, .dimension = result.dimension};
  return true;
}

/// A body that is known, with these parts of arguments.
Value ExpressionChecker::written(const WrittenOut& body, const std::vector<TermId>& parts) {
  const auto first = static_cast<TermId>(terms_.size());
  const auto here = [&](TermId number) {
    return number < body.parts ? parts[number] : static_cast<TermId>(first + (number - body.parts));
  };
  for (const auto& [term, operands] : body.steps) {
    Term own = term;
    if (operands > 0) own.a = here(term.a);
    if (operands > 1) own.b = here(term.b);
    if (operands > 2) own.c = here(term.c);
    terms_.add(own);
  }
  deepest_ = std::max(deepest_, callees_.size() - 1 + body.depth);
  Value result = body.result;
  result.x = here(result.x);
  if (result.type == Value::Type::vector) result.y = here(result.y);
  return result;
}

}  // namespace wale
