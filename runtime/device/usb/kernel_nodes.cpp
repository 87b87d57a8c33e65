#include "runtime/device/usb/kernel_nodes.hpp"

#include <linux/input.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "schema/visible_text.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The sorted paths in a folder whose names begin with a prefix; none if there is no such folder.
std::vector<fs::path> entries(const fs::path& folder, std::string_view beginning) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().starts_with(beginning)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return file ? std::string(std::istreambuf_iterator<char>(file), {}) : std::string();
}

/// The name that a device or a program gives itself, in one line: its maker may have written anything.
std::string line_of(const fs::path& path) {
  std::string line = content_of(path);
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return visible_text(line);
}

/// Whether an input device makes a constant force, by its bits of force feedback: words of hexadecimal digits, the
/// lowest last.
bool makes_constant_force(const fs::path& input) {
  const std::string bits = content_of(input / "capabilities" / "ff");
  constexpr unsigned word_bits = 8 * sizeof(long);
  std::vector<std::string> words;
  std::string word;
  for (const char letter : bits + " ") {
    if (std::isxdigit(static_cast<unsigned char>(letter)) != 0) {
      word += letter;
    } else if (!word.empty()) {
      words.push_back(std::exchange(word, {}));
    }
  }
  constexpr std::size_t from_last = FF_CONSTANT / word_bits;
  if (words.size() <= from_last) return false;
  const std::string& digits = words[words.size() - 1 - from_last];
  unsigned long value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return (value >> FF_CONSTANT % word_bits & 1) != 0;
}

void add_input(HidNodes& nodes, const fs::path& input) {
  const bool pushes = makes_constant_force(input);
  for (const fs::path& event : entries(input, "event")) {
    nodes.events.push_back("/dev/input/" + event.filename().string());
    if (pushes) nodes.pushing.push_back(nodes.events.back());
  }
  for (const fs::path& other : entries(input, "js")) nodes.others.push_back("/dev/input/" + other.filename().string());
}

HidNodes hid_nodes(std::uint8_t number, const fs::path& interface) {
  HidNodes nodes{.interface = number};
  for (const fs::path& device : entries(interface, "")) {
    const std::string descriptor = content_of(device / "report_descriptor");
    if (descriptor.empty()) continue;
    nodes.report_descriptor.assign(descriptor.begin(), descriptor.end());
    for (const fs::path& raw : entries(device / "hidraw", "hidraw")) {
      nodes.hidraw = "/dev/" + raw.filename().string();
    }
    for (const fs::path& input : entries(device / "input", "input")) add_input(nodes, input);
  }
  return nodes;
}

}  // namespace

std::string usbfs_node(int bus, int address) {
  char path[40];
  std::snprintf(path, sizeof path, "/dev/bus/usb/%03d/%03d", bus, address);
  return path;
}

KernelNodes kernel_nodes(const UsbDeviceInfo& info) {
  KernelNodes nodes;
  nodes.usbfs = usbfs_node(info.bus, info.address);
  const fs::path folder = fs::path("/sys/bus/usb/devices") / info.port;
  nodes.product = line_of(folder / "product");
  for (const UsbHidInterface& interface : info.hid) {
    // PORT:CONFIGURATION.INTERFACE
    for (const fs::path& path : entries(folder, info.port + ":")) {
      if (!path.filename().string().ends_with("." + std::to_string(interface.number))) continue;
      nodes.hid.push_back(hid_nodes(interface.number, path));
    }
  }
  return nodes;
}

const HidNodes* KernelNodes::of(std::uint8_t interface) const {
  const auto found = std::ranges::find(hid, interface, &HidNodes::interface);
  return found != hid.end() ? &*found : nullptr;
}

std::vector<std::string> KernelNodes::all() const {
  std::vector<std::string> nodes{usbfs};
  for (const HidNodes& each : hid) {
    if (!each.hidraw.empty()) nodes.push_back(each.hidraw);
    nodes.insert(nodes.end(), each.events.begin(), each.events.end());
    nodes.insert(nodes.end(), each.others.begin(), each.others.end());
  }
  return nodes;
}

NodeHolders who_holds(const std::vector<std::string>& nodes, const std::string& proc) {
  NodeHolders holders;
  std::error_code error;
  for (const auto& process : fs::directory_iterator(proc, error)) {
    const std::string name = process.path().filename();
    int number = 0;
    const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (wrong != std::errc() || end != name.data() + name.size() || number == getpid()) continue;
    std::error_code unreadable;
    fs::directory_iterator files(process.path() / "fd", unreadable);
    if (unreadable == std::errc::permission_denied) ++holders.hidden;
    for (; !unreadable && files != fs::directory_iterator(); files.increment(unreadable)) {
      std::error_code gone;
      const std::string node = fs::read_symlink(files->path(), gone);
      if (gone || std::ranges::find(nodes, node) == nodes.end()) continue;
      NodeHolder holder{number, line_of(process.path() / "comm"), node};
      if (std::ranges::find(holders.seen, holder) == holders.seen.end()) holders.seen.push_back(std::move(holder));
    }
  }
  std::ranges::sort(holders.seen, {}, &NodeHolder::process);
  return holders;
}

std::string in_words(const NodeHolders& holders) {
  std::string text;
  for (const NodeHolder& holder : holders.seen) {
    if (!text.empty()) text += ", ";
    text += holder.program + " (process " + std::to_string(holder.process) + ") has " + holder.node + " open";
  }
  return text;
}

std::string udev_rule(std::uint16_t vendor, std::uint16_t product) {
  const std::string numbers = in_words(vendor, product), from = numbers.substr(0, 4), what = numbers.substr(5);
  return "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"" + from + "\", ATTR{idProduct}==\"" + what +
         "\", TAG+=\"uaccess\"\n"
         "SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==\"" +
         from + "\", ATTRS{idProduct}==\"" + what + "\", TAG+=\"uaccess\"\n";
}

std::string how_to_permit(std::uint16_t vendor, std::uint16_t product) {
  const std::string rule = udev_rule(vendor, product);
  const std::size_t first = rule.find('\n') + 1;
  return "as root, write the lines\n  " + rule.substr(0, first) + "  " + rule.substr(first) +
         "to /etc/udev/rules.d/70-wale.rules, then plug it in again";
}

}  // namespace wale
