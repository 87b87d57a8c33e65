#include "compiler/drawing/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/text/readable.hpp"

namespace wale {
namespace {

std::string with_minus(std::string number) {
  if (!number.empty() && number.front() == '-') number.replace(0, 1, "\u2212");
  return number;
}

}  // namespace

Notation length_notation(double largest) {
  if (largest < 0.1e-3) return {"µm", 1e6};
  return {"mm", 1e3};
}

Notation force_notation(double largest) {
  if (largest < 0.1) return {"mN", 1e3};
  return {"N", 1};
}

Notation speed_notation(double largest) {
  if (largest < 0.1) return {"mm/s", 1e3};
  return {"m/s", 1};
}

double round_number(double most) {
  if (!(most > 0)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  // The slack makes up for rounding: 5 may be 4.9999999 after a change of unit.
  for (double digit : {5.0, 2.0}) {
    if (digit * power <= most * (1 + 1e-9)) return digit * power;
  }
  return power * 10 <= most * (1 + 1e-9) ? power * 10 : power;
}

std::vector<Tick> round_ticks(double low, double high, int count) {
  std::vector<Tick> ticks;
  if (!(high > low)) return ticks;
  const double rough = (high - low) / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (double digit : {5.0, 2.0, 1.0}) {
    if (digit * power >= rough * (1 - 1e-9)) step = digit * power;
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const auto first = static_cast<long>(std::ceil(low / step - 1e-6)),
             last = static_cast<long>(std::floor(high / step + 1e-6));
  for (long i = first; i <= last; ++i) {
    const double at = static_cast<double>(i) * step;
    ticks.push_back({at, with_minus(fmt::format("{:.{}f}", at, decimals))});
  }
  return ticks;
}

std::string shown_number(double value) {
  if (!std::isfinite(value)) return "—";
  const double size = std::abs(value);
  if (size >= 999.5) return with_minus(readable("{:.0f}", value));
  if (size != 0 && size < 1e-4) return with_minus(typeable("{:.2e}", value));
  return with_minus(fmt::format("{:.3g}", value));
}

std::string shown_quantity(double value, const Notation& notation) {
  const std::string number = shown_number(value * notation.per_si);
  return notation.unit.empty() ? number : number + " " + notation.unit;
}

}  // namespace wale
