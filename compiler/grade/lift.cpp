#include "compiler/grade/lift.hpp"

#include <map>

namespace wale {
namespace {

/// Tracks the value in each register while the code is read in order.
class TickReader {
 public:
  explicit TickReader(const Bank& bank) : bank_(bank), program_(bank.program().description()) {}

  LiftedTick read() {
    values_.assign(program_.register_count(), unread);
    for (const Instruction& instruction : program_.tick) read(instruction);
    for (const Output& output : program_.outputs) lifted_.force[output.axis] = value(output.value);
    for (const State& state : program_.states) lifted_.next.push_back(value(state.next));
    return std::move(lifted_);
  }

 private:
  static constexpr NodeId unread = ~NodeId{0};

  /// The node for a register. Registers that do not change from tick to tick are constants from the bank.
  NodeId value(RegisterNumber number) {
    if (values_[number] != unread) return values_[number];
    const bool moment = number < first_constant && input_table[number].changes;
    if (moment)
      values_[number] = lifted_.graph.input(static_cast<Input>(number));
    else if (number >= program_.first_state() && number < program_.first_temporary())
      values_[number] = lifted_.graph.state(number - program_.first_state());
    else
      values_[number] = lifted_.graph.constant(bank_.registers()[number]);
    return values_[number];
  }

  void read(const Instruction& instruction) {
    const auto operation = static_cast<Operation>(instruction.operation);
    const OperationFacts& known = facts(operation);
    const RegisterNumber from[] = {instruction.a, instruction.b, instruction.c};
    NodeId operands[3]{};
    for (int i = 0; i < known.operands; ++i) operands[i] = value(from[i]);
    const bool looks_up = known.fields[2] == 't' || known.fields[2] == 'g';
    const NodeId result =
        lifted_.graph.apply(operation, operands[0], operands[1], operands[2], looks_up ? instruction.c : 0);
    if (known.results == 1) {
      values_[instruction.destination] = result;
      return;
    }
    for (int i = 0; i < known.results; ++i)
      values_[instruction.destination + i] = lifted_.graph.component(result, static_cast<std::uint32_t>(i));
  }

  const Bank& bank_;
  const PatchProgram& program_;
  LiftedTick lifted_;
  std::vector<NodeId> values_;  ///< by register
};

}  // namespace

LiftedTick lift(const Bank& bank) { return TickReader(bank).read(); }

}  // namespace wale
