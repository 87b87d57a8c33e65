#include "compiler/listing/cpp_arithmetic.hpp"

#include <algorithm>

#include "compiler/text/embedded_files.hpp"

namespace wale {
namespace {

constexpr std::string_view helpers = R"(
/// A constant that the C++ compiler cannot see, so that it does not fold expressions with it: it does not know that
/// subnormal numbers count as zero.
inline float hidden(float constant) {
  auto bits = std::bit_cast<std::uint32_t>(constant);
  asm("" : "+r"(bits));
  return std::bit_cast<float>(bits);
}
)";

constexpr std::string_view peak_helpers = R"(
/// Coordinate i of a Kronecker lattice in -1 .. 1.
inline float lattice_coordinate(std::uint32_t i, std::uint32_t step) {
  return static_cast<float>(static_cast<std::int32_t>((i * step) ^ 0x80000000u)) * 0x1p-31f;
}

/// The value number ceil(fraction n) of n sorted values.
inline float percentile_of(std::vector<float>& values, float fraction) {
  const auto count = static_cast<std::uint32_t>(values.size());
  const auto rank = static_cast<std::uint32_t>(std::ceil(fraction * static_cast<float>(count)));
  const auto nth = values.begin() + (std::clamp(rank, 1u, count) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}
)";

constexpr std::string_view height_table = R"(
struct HeightTable {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint16_t> heights;
};

)";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

std::string cpp_arithmetic(std::string_view file, const std::string& name_space) {
  std::string text;
  for (const EmbeddedFile& each : embedded_arithmetic()) {
    if (!each.name.ends_with("/" + std::string(file))) continue;
    for (std::size_t at = 0; at < each.text.size();) {
      const std::size_t end = std::min(each.text.find('\n', at), each.text.size());
      const std::string_view line = each.text.substr(at, end - at);
      const bool own_files =
          line.starts_with("#pragma") || (line.starts_with("#include") && !line.ends_with("intrin.h>"));
      if (!own_files) text.append(line) += '\n';  // includes of the standard library are at the head
      at = end + 1;
    }
  }
  replace_all(text, "namespace wale {", "namespace " + name_space + " {");
  replace_all(text, "}  // namespace wale\n", "}  // namespace " + name_space + "\n");
  replace_all(text, "\nSpline::Spline(", "\ninline Spline::Spline(");
  text.erase(0, text.find_first_not_of('\n'));
  return text;
}

std::string cpp_height_table(const std::string& name_space) {
  return "namespace " + name_space + " {\n" + std::string(height_table) + "}  // namespace " + name_space + "\n";
}

std::string cpp_helpers(bool with_peaks) {
  return std::string(helpers) + (with_peaks ? std::string(peak_helpers) : "");
}

}  // namespace wale
