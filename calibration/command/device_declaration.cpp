#include "calibration/command/device_declaration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "compiler/text/readable.hpp"

namespace wale::command {
namespace {

/// Writes the settings of a declaration, in the usual order and units.
class DeclarationWriter {
 public:
  explicit DeclarationWriter(const DeclaredDevice& device) : device_(device) {}

  void add(const std::string& key, const std::string& value) { text_ += fmt::format("  {} {}\n", key, value); }
  /// Adds a figure, or `unknown`.
  void figure(const std::string& key, const std::string& value) {
    const auto among = [&](const std::vector<std::string>& keys) { return std::ranges::find(keys, key) != keys.end(); };
    add(key, among(device_.unknown) ? "unknown" : (among(device_.assumed) ? "assumed " : "") + value);
  }
  const std::string& text() const { return text_; }

 private:
  const DeclaredDevice& device_;
  std::string text_;
};

/// The shortest digits that agree to twelve places.
std::string number(double value) { return fmt::format("{:.12g}", value); }

std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string identified_text(const Identified& found) {
  std::string text;
  for (std::size_t motor = 0; motor < 2; ++motor) {
    const MotorAnswer& answer = found.motors[motor];
    const char* name = motor == 0 ? "x" : "y";
    if (answer.moves)
      text +=
          readable("the {} motor moves the axis {}, from {:.2g} N on\n", name, in_words(*answer.moves), answer.newton);
    else
      text += fmt::format("the {} motor: {}\n", name, answer.problem);
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (found.shown[i])
      text += fmt::format("{} is the device's axis {}\n", i == 0 ? "to the right" : "away from you",
                          in_words(*found.shown[i]));
  if (!found.problem.empty()) text += "the axes and motors are not known: " + found.problem + "\n";
  return text;
}

std::string device_declaration(const DeclaredDevice& device, const std::vector<std::string>& comments,
                               const std::vector<std::string>& more) {
  const DeviceProfile& profile = device.profile;
  const DeviceWiring& wiring = device.wiring;
  DeclarationWriter writer(device);
  const bool is_calibrated = wiring.is_corrected() || !device.intervals.empty();
  const std::vector<std::string> settings = is_calibrated ? calibrated_settings(device) : std::vector<std::string>{};
  const auto is_given = [&](std::string_view key) {
    return std::ranges::any_of(settings,
                               [&](const std::string& each) { return each.starts_with(std::string(key) + " "); });
  };
  std::string numbers;
  for (const UsbNumbers& each : wiring.usb) numbers += (numbers.empty() ? "" : ", ") + in_quotes(in_words(each));
  if (!numbers.empty()) writer.add("usb", numbers);
  if (!device.of_class.empty()) writer.add("class", device.of_class);
  const auto axes = [](const std::array<SignedAxis, 2>& both) { return in_words(both[0]) + ", " + in_words(both[1]); };
  writer.add("axes", axes(wiring.axes));
  writer.add("motors", axes(wiring.motors));
  if (std::ranges::find(device.unknown, "gain") != device.unknown.end() ||
      (!is_calibrated && wiring.gain != std::array<double, 2>{1, 1}))
    writer.figure("gain", number(wiring.gain[0]) + ", " + number(wiring.gain[1]));
  const auto millimetres = [](double metres) { return number(1e3 * metres) + " mm"; };
  writer.figure("workspace", "disc(" + millimetres(profile.workspace_diameter) + ")");
  writer.figure("position", number(profile.position_counts) + " counts");
  writer.figure("force", number(profile.force_newton) + " N, " + number(profile.force_counts) + " counts");
  writer.figure("rate", number(profile.rate) + " Hz");
  writer.figure("speed", number(profile.speed_limit) + " m/s");
  writer.figure("slew", number(profile.slew) + " N/s");
  writer.figure("sustained", profile.continuous_newton > 0
                                 ? number(profile.continuous_newton) + " N, " + number(profile.heating_seconds) + " s"
                                 : "unknown");
  writer.figure("active", profile.active_watt > 0 ? number(profile.active_watt) + " W" : "unknown");
  writer.figure("velocity_filter",
                number(profile.velocity_window) + ", " + number(profile.velocity_noise_counts) + " counts");
  writer.figure("patch", millimetres(profile.patch_width) + ", " + millimetres(profile.patch_height) + ", " +
                             millimetres(profile.patch_rim));
  if (!is_given("mass")) writer.figure("mass", number(profile.mass) + " kg");
  if (!is_given("damping")) writer.figure("damping", number(profile.damping) + " N s/m");
  if (!is_given("friction")) writer.figure("friction", number(profile.friction) + " N");
  if (!is_given("delay"))
    writer.figure("delay", number(1e3 * profile.delay_x) + " ms, " + number(1e3 * profile.delay_y) + " ms");
  writer.figure("bandwidth", number(profile.bandwidth_x) + " Hz, " + number(profile.bandwidth_y) + " Hz");
  for (const auto* lines : {&settings, &more})
    for (const std::string& each : *lines) writer.add(each.substr(0, each.find(' ')), each.substr(each.find(' ') + 1));
  if (!device.source.empty()) writer.add("source", in_quotes(device.source));
  std::string text = "wale 1\n\n";
  for (const std::string& comment : comments) text += "// " + comment + "\n";
  return text + "export device " + profile.name + " {\n" + writer.text() + "}\n";
}

std::vector<std::string> calibrated_settings(const DeclaredDevice& device) {
  std::vector<std::string> settings;
  const auto interval = [&](const std::string& figure) {
    const auto found = std::ranges::find(device.intervals, figure, &FigureInterval::figure);
    return found == device.intervals.end() ? nullptr : &*found;
  };
  // `scale`: from SI to the unit that is written.
  const auto value_text = [&](double value, const std::string& figure, const char* unit, double scale = 1) {
    std::string text = typeable("{:.6g}{}", scale * value, unit);
    if (const auto* within = interval(figure))
      text += typeable(", within {:.6g}{} .. {:.6g}{}", scale * within->low, unit, scale * within->high, unit);
    return text;
  };
  const auto add = [&](const char* key, Way way, const char* part, double value, double usual, const char* unit) {
    const std::string figure = fmt::format("{} {}{}{}", key, in_words(way), *part != '\0' ? " " : "", part);
    if (value == usual && interval(figure) == nullptr) return;
    settings.push_back(figure + " " + value_text(value, figure, unit));
  };
  const DeviceWiring& wiring = device.wiring;
  for (const Way way : all_ways) {
    const auto i = static_cast<std::size_t>(way);
    add("gain", way, "", wiring.gain[i / 2] * wiring.response[i].gain, 1, "");
  }
  for (const Way way : all_ways)
    add("dead_band", way, "", wiring.response[static_cast<std::size_t>(way)].dead_band, 0, " N");
  for (const Way way : all_ways) {
    const ForceResponse& response = wiring.response[static_cast<std::size_t>(way)];
    add("nonlinearity", way, "quadratic", response.quadratic, 0, "");
    add("nonlinearity", way, "cubic", response.cubic, 0, "");
  }
  for (const Way way : all_ways)
    add("saturation", way, "", wiring.response[static_cast<std::size_t>(way)].most, 0, " N");
  for (const Way way : {Way::right, Way::away})
    add("offset", way, "", wiring.offset[static_cast<std::size_t>(axis_of(way))], 0, " N");
  const DeviceProfile& profile = device.profile;
  if (interval("mass")) settings.push_back("mass " + value_text(profile.mass, "mass", " kg"));
  if (interval("damping")) settings.push_back("damping " + value_text(profile.damping, "damping", " N s/m"));
  if (interval("friction")) settings.push_back("friction " + value_text(profile.friction, "friction", " N"));
  if (interval("delay x") || interval("delay y"))
    settings.push_back("delay " + value_text(profile.delay_x, "delay x", " ms", 1e3) + ", " +
                       value_text(profile.delay_y, "delay y", " ms", 1e3));
  return settings;
}

}  // namespace wale::command
