#include "compiler/expression/written_out.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "compiler/expression/check_expression.hpp"

namespace wale {

namespace {

/// Whether two terms that stand alone come to the same.
bool is_same(const Term& one, const Term& other) {
  return one.kind == other.kind && one.operation == other.operation && one.a == other.a && one.b == other.b &&
         one.c == other.c && one.index == other.index &&
         std::bit_cast<std::uint64_t>(one.value) == std::bit_cast<std::uint64_t>(other.value);
}

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

/// What is called after more terms than this is read each time, as few materials have it: to write out a body costs a
/// copy of them.
constexpr std::size_t most_terms_before = 4096;

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

/// The value of a function's body with the frame's actual arguments, which are all there.
Value ExpressionChecker::body(const Declared<FunctionDecl>& function, Frame& frame, bool hand) {
  const FunctionDecl& declaration = *function.node;
  const auto read = [&] {
    frame.names.clear();
    frame.names.hand = hand;
    frame.names.reserve(frame.actuals.size());
    for (std::size_t i = 0; i < frame.actuals.size(); ++i)
      frame.names.declare(declaration.parameters[i].name.text, frame.actuals[i].value,
                          declaration.parameters[i].name.span);
    return check(*function.tree, declaration.body, frame.names);
  };
  WrittenOutFunctions* const known = surroundings_.written_out;
  // Terms of what every file knows come from where the author calls it, wherever in the body they are written.
  const auto place = terms_.attributed();
  const bool is_author = place && place->source < first_embedded_source;
  const bool is_small = terms_.size() <= most_terms_before;
  if (!known || !known->covers(function) || !is_author || !is_small || !list_parts(frame.actuals)) return read();

  if (const WrittenOut* found = known->find(declaration, kinds_, hand)) {
    const bool fits =
        terms_.size() + found->terms.size() <= most_terms && callees_.size() - 1 + found->depth <= deepest_call;
    return found->always_alike && fits && answers(found->questions) ? written(*found) : read();
  }
  // What is read now is written out; so may be a call that it stands in.
  WrittenOut body{.arguments = kinds_, .hand = hand};
  const std::vector<TermId> parts = parts_;
  const Terms terms_before = terms_;
  const Traces before = traces();
  const std::size_t first_asked = asked_.size(), depth = callees_.size();
  const std::size_t deepest_before = std::exchange(deepest_, depth);
  ++writing_out_;
  Value result = read();
  if (!result.failed()) {
    const auto first = static_cast<TermId>(terms_before.size());
    body.depth = deepest_ - depth + 1;
    body.always_alike = traces() == before && write_out(first, first_asked, parts, result, body);
    if (body.always_alike) {  // the terms are the same, whether this is the first call or not
      terms_ = terms_before;
      asked_.resize(first_asked);
      parts_ = parts;
      answers(body.questions);
      result = written(body);
    }
    known->keep(declaration, std::move(body));
  }
  deepest_ = std::max(deepest_, deepest_before);
  if (--writing_out_ == 0) asked_.clear();
  return result;
}

/// Leaves in `kinds_` what kinds of arguments they are, and in `parts_` the terms that they consist of; false where
/// that is not all there is to them.
bool ExpressionChecker::list_parts(const std::vector<Actual>& actuals) {
  constexpr std::size_t few = 8;  // as nearly always
  kinds_.clear();
  parts_.clear();
  kinds_.reserve(few);
  parts_.reserve(few);
  for (const auto& [value, span, given] : actuals) {
    const bool vector = value.type == Value::Type::vector;
    if (!vector && value.type != Value::Type::number && value.type != Value::Type::boolean) return false;
    kinds_.push_back({value.type, value.dimension});
    const auto is_new = [&](TermId part) { return std::ranges::find(parts_, part) == parts_.end(); };
    if (!is_new(value.x)) return false;
    parts_.push_back(value.x);
    if (!vector) continue;
    if (!is_new(value.y)) return false;
    parts_.push_back(value.y);
  }
  return true;
}

/// Whether the parts answer no to all of them. Whoever is being written out asks the same of its own arguments.
bool ExpressionChecker::answers(const std::vector<WrittenOut::Question>& questions) {
  for (WrittenOut::Question each : questions) {
    each.term = parts_[each.term];
    const Term& term = terms_[each.term];
    if (each.about == WrittenOut::Question::About::change ? term.dependence.changing()
                                                          : term.known() && !each.admits(term.value))
      return false;
    ask(each);
  }
  return true;
}

/// Takes down the terms from `first` on. False where they do not follow from the kinds of the arguments alone: where
/// something has asked what an argument is worth, or they use what is neither of the body nor an argument.
bool ExpressionChecker::write_out(TermId first, std::size_t first_asked, const std::vector<TermId>& parts,
                                  const Value& result, WrittenOut& body) const {
  using Origins = std::uint64_t;  // the parts of arguments that something depends on, a bit each
  const bool vector = result.type == Value::Type::vector;
  if (!vector && result.type != Value::Type::number && result.type != Value::Type::boolean) return false;
  if (parts.size() > std::numeric_limits<Origins>::digits) return false;
  body.parts = parts.size();
  std::vector<bool> used(terms_.size() - first);  // of the terms from `first` on, as are the next two
  std::vector<Origins> origins;
  std::vector<TermId> numbers;
  const auto use = [&](TermId id) {
    if (id >= first) used[id - first] = true;
  };
  use(result.x);
  if (vector) use(result.y);
  for (std::size_t i = used.size(); i-- > 0;)
    if (used[i])
      for (const TermId operand : operands(terms_[static_cast<TermId>(first + i)])) use(operand);
  const auto part_of = [&](TermId id) -> std::optional<TermId> {
    const auto found = std::ranges::find(parts, id);
    return found == parts.end() ? std::nullopt : std::optional(static_cast<TermId>(found - parts.begin()));
  };
  const auto number_of = [&](TermId id) { return id >= first ? std::optional(numbers[id - first]) : part_of(id); };
  const auto origins_of = [&](TermId id) -> std::optional<Origins> {
    if (id >= first) return origins[id - first];
    const auto part = part_of(id);
    return part ? std::optional(Origins{1} << *part) : std::nullopt;
  };

  for (TermId id = first; id < terms_.size(); ++id) {
    Term term = terms_[id];
    if (!stands_alone(term)) return false;
    Origins all = 0;
    TermId* const places[] = {&term.a, &term.b, &term.c};
    for (std::size_t i = 0; i < term.operands; ++i) {
      const auto number = number_of(*places[i]);
      const auto origin = origins_of(*places[i]);
      if (!number || !origin) return false;
      *places[i] = *number;
      all |= *origin;
    }
    origins.push_back(all);
    numbers.push_back(0);
    if (!used[id - first]) continue;  // an exponent that has become products
    term.span = {};
    if (term.kind != TermKind::literal) term.value = 0;
    const auto same = std::ranges::find_if(body.terms, [&](const Term& other) { return is_same(term, other); });
    numbers.back() = static_cast<TermId>(parts.size() + static_cast<std::size_t>(same - body.terms.begin()));
    if (same == body.terms.end()) body.terms.push_back(term);
  }

  for (std::size_t i = first_asked; i < asked_.size(); ++i) {
    WrittenOut::Question question = asked_[i];
    const auto origin = origins_of(question.term);
    if (!origin) return false;
    if (*origin == 0) continue;
    const bool of_part = question.term < first;
    if (question.about == WrittenOut::Question::About::worth) return false;
    if (question.about == WrittenOut::Question::About::range && !of_part) return false;
    // What changes does so because of something that it is made from.
    for (TermId part = 0; part < parts.size(); ++part) {
      if ((*origin >> part & 1) == 0) continue;
      question.term = part;
      if (std::ranges::find(body.questions, question) == body.questions.end()) body.questions.push_back(question);
    }
  }
  const auto x = number_of(result.x), y = vector ? number_of(result.y) : TermId{0};
  if (!x || !y) return false;
  body.result = {.type = result.type, .x = *x, .y = *y, .dimension = result.dimension};
  return true;
}

/// A body that is known, with the parts of arguments that have been listed.
Value ExpressionChecker::written(const WrittenOut& body) {
  const TermId first = terms_.add(body.terms, parts_);
  const auto here = [&](TermId number) {
    return number < body.parts ? parts_[number] : static_cast<TermId>(first + (number - body.parts));
  };
  deepest_ = std::max(deepest_, callees_.size() - 1 + body.depth);
  Value result = body.result;
  result.x = here(result.x);
  if (result.type == Value::Type::vector) result.y = here(result.y);
  return result;
}

}  // namespace wale
