#include "tests/truth/waveform.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/truth/composition.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;
using Text = std::function<std::string(const std::string&)>;

double fraction(double t) { return t - std::floor(t); }

/// `pattern` with every # replaced by the name of the turns.
Text text(std::string pattern) {
  return [pattern = std::move(pattern)](const std::string& t) {
    std::string result;
    for (const char each : pattern) each == '#' ? result += t : result += each;
    return result;
  };
}

}  // namespace

Waveform sine() {
  return {"sine", text("sin(2 * pi * #)"), [](double t) { return std::sin(2 * pi * t); }, text("cos(2 * pi * #)"),
          [](double t) { return -2 * pi * std::sin(2 * pi * t); }};
}

Waveform square() {
  const auto push = [](double t) { return fraction(t) < 0.5 ? 1.0 : -1.0; };
  return {"square", text("(if # - floor(#) < 0.5 then 1 else -1)"), push, text("abs(# - floor(#) - 0.5)"),
          [push](double t) { return -push(t); }};
}

Waveform triangle() {
  return {"triangle", text("(4 * abs(# - floor(#) - 0.5) - 1)"),
          [](double t) { return 4 * std::abs(fraction(t) - 0.5) - 1; },
          text("(2 * (# - floor(#) - 0.5) * abs(# - floor(#) - 0.5) - (# - floor(#) - 0.5))"),
          [](double t) { return 4 * std::abs(fraction(t) - 0.5) - 1; }};
}

Waveform sawtooth() {
  return {"sawtooth", text("(2 * (# - floor(#)) - 1)"), [](double t) { return 2 * fraction(t) - 1; },
          text("(# - floor(#) - 0.5)^2"), [](double t) { return 2 * fraction(t) - 1; }};
}

Waveform ridge(double duty) {
  const auto push = [duty](double t) { return fraction(t) < duty ? std::sin(2 * pi * fraction(t) / duty) : 0.0; };
  const std::string d = number(duty);
  return {"ridge", text(fmt::format("(if # - floor(#) < {0} then sin(2 * pi * (# - floor(#)) / {0}) else 0)", d)), push,
          text(fmt::format("(if # - floor(#) < {0} then 1 - cos(2 * pi * (# - floor(#)) / {0}) else 0)", d)),
          [push, duty](double t) { return 2 * pi / duty * push(t); }};
}

Waveform smooth_ribs() {
  const auto push = [](double t) { return std::sin(2 * pi * t) + 0.25 * std::sin(6 * pi * t); };
  return {"ribs", text("(sin(2 * pi * #) + 0.25 * sin(6 * pi * #))"), push,
          text("(cos(2 * pi * #) + cos(6 * pi * #) / 12)"), [push](double t) { return -2 * pi * push(t); }};
}

Waveform missing_fundamental(double third) {
  const std::string b = number(third);
  return {"missing fundamental",
          text(fmt::format("(sin(4 * pi * #) + {} * sin(6 * pi * # + 1))", b)),
          [third](double t) { return std::sin(4 * pi * t) + third * std::sin(6 * pi * t + 1); },
          text(fmt::format("(cos(4 * pi * #) / 2 + {} * cos(6 * pi * # + 1) / 3)", b)),
          [third](double t) { return -2 * pi * (std::sin(4 * pi * t) + third * std::sin(6 * pi * t + 1)); },
          {{2, [](double t) { return std::sin(4 * pi * t); }, [](double t) { return -2 * pi * std::sin(4 * pi * t); }},
           {3, [third](double t) { return third * std::sin(6 * pi * t + 1); },
            [third](double t) { return -2 * pi * third * std::sin(6 * pi * t + 1); }}}};
}

Waveform smooth_bumps(double width) {
  const auto push = [width](double t) {
    const double s = (fraction(t) - 0.5) / width;
    return s * std::exp(0.5 - s * s / 2);
  };
  const std::string w = number(width);
  return {"smooth bumps",
          text(fmt::format("((# - floor(#) - 0.5) / {0} * exp(0.5 - ((# - floor(#) - 0.5) / {0})^2 / 2))", w)), push,
          text(fmt::format("exp(-((# - floor(#) - 0.5) / {0})^2 / 2)", w)),
          [push, width](double t) { return -push(t) / width * std::exp(-0.5); }};
}

Waveform any_waveform(Chance& chance) {
  switch (static_cast<int>(chance.between(0, 7))) {
    case 0: return square();
    case 1: return triangle();
    case 2: return sawtooth();
    case 3: return ridge(rounded(chance.between(0.05, 0.3), 3));
    case 4: return missing_fundamental(rounded(chance.between(0.5, 1.2), 3));
    case 5: return smooth_bumps(rounded(chance.between(0.05, 0.1), 3));
    default: return sine();
  }
}

double grating_slope(double t, double duty, double smooth) {
  const auto bell = [smooth](double offset) { return std::exp(-offset * offset / (2 * smooth * smooth)); };
  double slope = 0;
  for (int edge = -3; edge <= 3; ++edge) {
    const double from_ridge = t - std::round(t) - edge;
    slope += bell(from_ridge + duty / 2) - bell(from_ridge - duty / 2);
  }
  return slope;
}

}  // namespace wale::truth
