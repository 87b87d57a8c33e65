#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "compiler/modules/declare_records.hpp"

namespace wale {

namespace {

/// Reads `x` or `-y`; a word of evidence may come before it.
std::optional<SignedAxis> signed_axis(const SyntaxTree& tree, const SettingItem& item) {
  SignedAxis axis;
  std::string_view name = item.words.empty() ? "" : item.words.back().text;
  if (item.range_end || item.equals) return std::nullopt;
  if (item.value) {
    const auto* turned = std::get_if<Unary>(&tree.expr(*item.value));
    if (!turned || turned->op == UnaryOperator::complement) return std::nullopt;
    const auto* of = std::get_if<NameUse>(&tree.expr(turned->operand));
    if (!of) return std::nullopt;
    axis.sign = turned->op == UnaryOperator::negate ? -1 : 1;
    name = of->name;
  }
  if (name != "x" && name != "y") return std::nullopt;
  axis.axis = name == "x" ? 0 : 1;
  return axis;
}

/// Reads `axes y, -x`: two different axes of the device.
void read_axes(RecordReader& reader, const char* key, std::array<SignedAxis, 2>& axes) {
  const auto* found = reader.setting(key);
  if (!found) return;
  std::array<std::optional<SignedAxis>, 2> read;
  if (found->items.size() == 2)
    for (std::size_t i = 0; i < 2; ++i) read[i] = signed_axis(reader.tree, found->items[i]);
  if (read[0] && read[1] && read[0]->axis != read[1]->axis)
    axes = {*read[0], *read[1]};
  else
    reader.report(
        Code::wrong_type, found->span,
        fmt::format("`{}` needs the device's two axes, the one to the right first, each with an optional `-`", key),
        fmt::format("write, for example, `{} x, y` or `{} -y, x`", key, key));
}

/// `usb "1209:ffb0", "1209:ffb1"`, or `usb any`.
void read_usb(RecordReader& reader, DeviceWiring& wiring) {
  const auto* found = reader.setting("usb");
  if (!found) return;
  if (found->items.size() == 1 && !found->items[0].value && words_of(found->items[0]) == "any") {
    wiring.is_generic = true;
    return;
  }
  for (const std::string& text : reader.texts(*found)) {
    const auto numbers = read_usb_numbers(text);
    if (!numbers)
      reader.report(Code::wrong_type, found->span,
                    fmt::format("\"{}\" is not a USB vendor and product, with four hexadecimal digits each", text),
                    "copy it from `wale devices`, as in `usb \"1209:ffb0\"`, or write `usb any`");
    else if (std::ranges::find(wiring.usb, *numbers) != wiring.usb.end())
      reader.report(Code::declared_twice, found->span, fmt::format("\"{}\" is given twice", text), "keep one of them");
    else
      wiring.usb.push_back(*numbers);
  }
}

}  // namespace

void read_wiring(RecordReader& reader, const DeviceProfile& profile, DeviceWiring& wiring,
                 std::vector<FigureInterval>& intervals) {
  read_usb(reader, wiring);
  if (profile.has_position()) read_axes(reader, "axes", wiring.axes);
  if (profile.shaker) return;
  read_axes(reader, "motors", wiring.motors);
  read_response(reader, profile, wiring, intervals);
}

}  // namespace wale
