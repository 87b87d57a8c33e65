#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wale::test {

/// The layout of reports of one family of force-feedback joysticks. The tests write descriptors from it. The model of
/// the device reads and writes packets by it, and so does not depend on the driver's reading of the descriptor.
struct PidFamily {
  enum class Delay { before_gain, last, absent };

  const char* name = "";
  std::uint16_t vendor = 0, product = 0;
  std::uint8_t input = 1;
  std::vector<std::uint8_t> axes;  ///< usages of page 01, i16 each, after `buttons` bits of buttons
  int buttons = 0;
  std::uint8_t set_effect = 1, envelope = 2, constant = 5, operation = 10, free = 11, control = 12, gain = 13;
  std::uint8_t create = 5, load = 6, pool = 7;
  int gain_bits = 8, gain_maximum = 255;
  int direction_bits = 8, direction_maximum = 255;
  Delay delay = Delay::absent;
  bool type_offsets = false;  ///< two u16 after the directions
  int magnitude_maximum = 0;
  bool control_is_mask = false;
  std::vector<std::uint8_t> control_orders;  ///< usages of page 0F, in the order of bits or of numbers from 1
  bool has_pool = true;
  bool has_direction = true;
  int simultaneous = 40;
  bool has_vendor_report = false;  ///< OpenFFBoard's A1
};

/// The families of PID devices: ids, widths, ranges, missing fields and kinds of Device Control. An id that the table
/// lacks is the next free one.
PidFamily openffboard();
PidFamily rhino();
PidFamily adapt_ffb_joy();
PidFamily arduino();
std::vector<PidFamily> all_families();

/// A report descriptor, item by item.
class Items {
 public:
  Items& raw(std::initializer_list<std::uint8_t> bytes);
  Items& page(std::uint16_t page) { return put(0x04, page, page > 0xff ? 2 : 1); }
  Items& use(std::uint32_t what) { return put(0x08, what, what > 0xffff ? 4 : what > 0xff ? 2 : 1); }
  Items& begin(std::uint8_t what, std::uint8_t type = 2) { return use(what).put(0xa0, type, 1); }
  Items& end() { return raw({0xc0}); }
  Items& id(std::uint8_t id) { return put(0x84, id, 1); }
  Items& logical(std::int32_t minimum, std::int32_t maximum) { return range(0x14, minimum).range(0x24, maximum); }
  Items& physical(std::int32_t minimum, std::int32_t maximum) { return range(0x34, minimum).range(0x44, maximum); }
  Items& unit(std::uint16_t unit, int exponent) { return put(0x64, unit, 2).put(0x54, exponent & 15, 1); }
  Items& size(std::uint8_t bits, std::uint16_t count) {
    return put(0x74, bits, 1).put(0x94, count, count > 255 ? 2 : 1);
  }
  Items& input(std::uint8_t flags) { return put(0x80, flags, 1); }
  Items& output(std::uint8_t flags) { return put(0x90, flags, 1); }
  Items& feature(std::uint8_t flags) { return put(0xb0, flags, 1); }

  std::vector<std::uint8_t> bytes;

 private:
  Items& put(std::uint8_t prefix, std::uint32_t value, int size);
  Items& range(std::uint8_t prefix, std::int32_t value);
};

constexpr std::uint8_t array = 0, variable = 2, constant = 3;

std::vector<std::uint8_t> report_descriptor(const PidFamily& family);

/// "01 02 FF"
std::string hex(const std::vector<std::uint8_t>& bytes);
std::vector<std::uint8_t> from_hex(const std::string& text);

}  // namespace wale::test
