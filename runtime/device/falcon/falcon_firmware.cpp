#include "runtime/device/falcon/falcon_firmware.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace wale {
namespace {

constexpr std::size_t most_firmware_bytes = 65536;  // known ones have less than 10 000

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::filesystem::path falcon_firmware_path() {
  if (const auto named = variable("WALE_FALCON_FIRMWARE"); !named.empty()) return named;
  const auto data = variable("XDG_DATA_HOME");
  const auto folder =
      data.empty() ? std::filesystem::path(variable("HOME")) / ".local/share" : std::filesystem::path(data);
  return folder / "wale/falcon_firmware.bin";
}

Result<std::vector<std::uint8_t>> read_falcon_firmware(const std::filesystem::path& path) {
  const auto refused = [&](Code code, const std::string& sentence) {
    return Error{
        code,
        sentence,
        "the firmware is Novint's and not part of Wale: take the one of the driver that came with the device, "
        "or firmware/nvent_firmware.bin of libnifalcon (github.com/libnifalcon/libnifalcon), and put it there, "
        "or name it: WALE_FALCON_FIRMWARE=FILE",
        {.name = path.string()}};
  };
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    return refused(Code::unreadable_file, "there is no firmware at " + path.string());
  std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(file), {});
  if (bytes.empty() || bytes.size() > most_firmware_bytes)
    return refused(Code::damaged_file, "the file at " + path.string() + " is not firmware: it has " +
                                           std::to_string(bytes.size()) + " bytes, expected 1 .. " +
                                           std::to_string(most_firmware_bytes));
  return bytes;
}

}  // namespace wale
