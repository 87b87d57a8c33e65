#include "schema/device_table.hpp"

#include <array>

#include "schema/byte_reader.hpp"
#include "schema/byte_writer.hpp"
#include "schema/read_device.hpp"
#include "schema/write_device.hpp"

namespace wale {
namespace {

using namespace patch_program_format;

/// As in PNG: a byte that no text has, the name, then line ends and an end-of-file mark, which text transfers change.
constexpr std::array<std::uint8_t, 8> table_magic = {0x89, 'W', 'D', 'T', '\r', '\n', 0x1a, '\n'};
constexpr std::uint16_t table_version = 1;

std::uint8_t code_of_axis(const SignedAxis& axis) {
  return static_cast<std::uint8_t>(2 * axis.axis + (axis.sign < 0 ? 1 : 0));
}

void write_texts(ByteWriter& out, std::span<const std::string> texts) {
  out.u32(texts.size());
  for (const std::string& text : texts) out.text(text);
}

void write_wiring(ByteWriter& out, const DeviceWiring& wiring) {
  out.u32(wiring.usb.size());
  for (const UsbNumbers& numbers : wiring.usb) {
    out.u16(numbers.vendor);
    out.u16(numbers.product);
  }
  out.u8(wiring.is_generic);
  for (const auto& axes : {wiring.axes, wiring.motors})
    for (const SignedAxis& axis : axes) out.u8(code_of_axis(axis));
  for (const double gain : wiring.gain) out.f64(gain);
}

std::vector<std::string> read_texts(ByteReader& in, std::string_view what) {
  std::vector<std::string> texts(in.count(4, what));
  for (std::string& text : texts) text = in.text(what);
  return texts;
}

std::array<SignedAxis, 2> read_axes(ByteReader& in) {
  std::array<SignedAxis, 2> axes;
  for (SignedAxis& axis : axes) {
    const std::uint8_t code = in.u8();
    if (code > 3) in.damaged(" has axis ", int{code}, "; expected 0 .. 3");
    axis = {code / 2, code % 2 == 0 ? 1 : -1};
  }
  if (axes[0].axis == axes[1].axis) in.damaged(" names one axis twice");
  return axes;
}

DeviceWiring read_wiring(ByteReader& in) {
  DeviceWiring wiring;
  wiring.usb.resize(in.count(4, "USB devices"));
  for (UsbNumbers& numbers : wiring.usb) {
    numbers.vendor = in.u16();
    numbers.product = in.u16();
  }
  wiring.is_generic = in.boolean("whether it is generic");
  wiring.axes = read_axes(in);
  wiring.motors = read_axes(in);
  for (double& gain : wiring.gain) {
    gain = in.finite_f64("a gain");
    if (!(gain >= DeviceWiring::least_gain && gain <= DeviceWiring::most_gain))
      in.damaged(" has a gain of ", gain, "; expected ", DeviceWiring::least_gain, " .. ", DeviceWiring::most_gain);
  }
  return wiring;
}

/// Refuses figures that drivers and the loop could not divide by or count with.
void require_usable(const DeviceProfile& profile) {
  const auto require = [&](bool holds, const char* what) {
    if (!holds) damaged("the device `", profile.name, "` has ", what);
  };
  require(!profile.name.empty(), "no name");
  require(profile.rate >= DeviceProfile::least_rate && profile.rate <= DeviceProfile::most_rate,
          "a rate that no loop can keep");
  if (profile.has_position()) {
    require(profile.workspace_diameter > 0, "no workspace");
    require(profile.position_counts > 0, "no position counts");
  }
  if (!profile.shaker) {
    require(profile.force_newton > 0, "no force");
    require(profile.force_counts > 0, "no force counts");
    return;
  }
  require(!profile.shaker->response.empty(), "no response");
  double frequency = 0;
  for (const Shaker::Response& response : profile.shaker->response) {
    require(response.frequency > frequency, "a response whose frequencies do not rise");
    frequency = response.frequency;
    Shaker::Response::Point before;
    for (const auto& point : response.points) {
      require(point.command > before.command && point.acceleration > before.acceleration,
              "a response that does not rise");
      before = point;
    }
  }
}

DeclaredDevice read_declared_device(ByteReader& in) {
  DeclaredDevice device;
  device.profile = read_device(in);
  if (in.boolean("whether a shaker follows")) device.profile.shaker = read_shaker(in);
  require_usable(device.profile);
  device.wiring = read_wiring(in);
  device.of_class = in.text("the device's class");
  device.source = in.text("the device's source");
  device.assumed = read_texts(in, "assumed settings");
  device.unknown = read_texts(in, "unknown settings");
  return device;
}

}  // namespace

std::vector<std::byte> write_device_table(std::span<const DeclaredDevice> devices) {
  ByteWriter out;
  out.bytes(std::as_bytes(std::span(table_magic)));
  out.u16(table_version);
  out.u32(devices.size());
  for (const DeclaredDevice& device : devices) {
    write_device(out, device.profile);
    out.u8(device.profile.shaker.has_value());
    if (device.profile.shaker) write_shaker(out, *device.profile.shaker);
    write_wiring(out, device.wiring);
    out.text(device.of_class);
    out.text(device.source);
    write_texts(out, device.assumed);
    write_texts(out, device.unknown);
  }
  return std::move(out.result());
}

Result<std::vector<DeclaredDevice>> read_device_table(std::span<const std::byte> bytes) {
  constexpr std::size_t least_device_bytes = 200;  // an empty name, 22 figures and a wiring are more
  const auto damaged = [](std::string sentence) {
    return Error{Code::damaged_file,
                 std::move(sentence),
                 "build Wale anew, or hand in another table",
                 {.name = "table of devices"}};
  };
  try {
    ByteReader in("the table of devices", bytes);
    for (const std::uint8_t expected : table_magic)
      if (in.u8() != expected) return damaged("expected a table of devices, found other bytes");
    if (const std::uint16_t version = in.u16(); version != table_version)
      return damaged(sentence("expected version ", table_version, " of the table of devices, found ", version));
    std::vector<DeclaredDevice> devices;
    for (std::uint32_t left = in.count(least_device_bytes, "devices"); left > 0; --left)
      devices.push_back(read_declared_device(in));
    in.finish();
    return devices;
  } catch (const Error& error) {
    return damaged(error.sentence);
  }
}

}  // namespace wale
