#include "compiler/grade/sought_force.hpp"

#include <algorithm>
#include <vector>

#include "compiler/grade/steep_places.hpp"
#include "compiler/grade/steps.hpp"
#include "compiler/measure/hands.hpp"
#include "compiler/measure/measure.hpp"

namespace wale {
namespace {

constexpr std::size_t most_choices = 32;  // of parameters

double sought_at(const Bank& bank, double enough) {
  const double newton = measure(bank).less_rim;
  if (newton >= enough) return newton;
  ProgramSlopes slopes(bank, {});
  if (!slopes.fits()) return newton;
  const glm::vec2 inside = 0.5f * glm::vec2(bank.size().width, bank.size().height) - glm::vec2(bank.size().rim);
  const auto hands = hands_at_rest(lattice_hands, inside);
  const DeviceProfile& device = bank.program().description().device;
  double most = newton;
  for (const ForceStep& step :
       StepSearch(bank, slopes).largest(stepped_quantities(device, inside, device.speed_limit)[0], hands, {}))
    most = std::max(most, step.largest);
  return most;
}

}  // namespace

double sought_force(const Bank& bank, double enough) {
  const auto& parameters = bank.program().description().parameters;
  double most = sought_at(bank, enough);
  std::size_t left = most_choices;
  const auto seek = [&](const std::vector<float>& values) {
    if (most >= enough || left == 0) return;
    --left;
    most = std::max(most, sought_at(Bank(bank.program(), values, bank.size()), enough));
  };
  std::vector<float> usual, low, high;
  const auto registers = bank.registers().begin() + bank.program().description().first_parameter();
  usual.assign(registers, registers + static_cast<std::ptrdiff_t>(parameters.size()));
  for (const Parameter& parameter : parameters) low.push_back(parameter.low), high.push_back(parameter.high);
  if (parameters.empty()) return most;
  seek(high), seek(low);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (const float end : {parameters[i].high, parameters[i].low}) {
      std::vector<float> values = usual;
      values[i] = end;
      seek(values);
    }
  return most;
}

}  // namespace wale
