#include "runtime/device/falcon/falcon_firmware.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "schema/regular_file.hpp"

namespace wale {
namespace {

constexpr std::size_t largest_firmware = 65536;  // bytes; known ones have less than 10 000

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
  const auto text = read_regular_file(path.string(), largest_firmware);
  std::error_code ignored;
  if (!text && !std::filesystem::exists(path, ignored))
    return refused(Code::unreadable_file, "there is no firmware at " + path.string());
  if (!text)
    return refused(Code::unreadable_file,
                   "the firmware at " + path.string() + " cannot be read: " + text.error().sentence);
  if (text->empty()) return refused(Code::damaged_file, "the file at " + path.string() + " is empty, and no firmware");
  return std::vector<std::uint8_t>(text->begin(), text->end());
}

}  // namespace wale
