#include "tests/usb/pid_descriptor.hpp"

#include <cstdio>

namespace wale::test {

Items& Items::raw(std::initializer_list<std::uint8_t> more) {
  bytes.insert(bytes.end(), more);
  return *this;
}

Items& Items::put(std::uint8_t prefix, std::uint32_t value, int size) {
  bytes.push_back(static_cast<std::uint8_t>(prefix | (size == 4 ? 3 : size)));
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  return *this;
}

Items& Items::range(std::uint8_t prefix, std::int32_t value) {
  const int size = value >= -128 && value < 128 ? 1 : value >= -32768 && value < 32768 ? 2 : 4;
  return put(prefix, static_cast<std::uint32_t>(value), size);
}

namespace {

/// A number of a report of page 0F.
void number(Items& items, std::uint8_t what, int bits, int maximum, int minimum = 0) {
  items.use(what).logical(minimum, maximum).physical(minimum, maximum).size(static_cast<std::uint8_t>(bits), 1);
  items.output(variable);
}

void begin_output(Items& items, std::uint8_t what, std::uint8_t id) {
  items.begin(what).id(id);
  number(items, 0x22, 8, 40, 1);
}

void effect_types(Items& items) {
  items.begin(0x25).use(0x26).use(0x27).use(0x30).use(0x31).use(0x40).use(0x41);
  items.logical(1, 6).physical(1, 6).size(8, 1);
}

void write_set_effect(Items& items, const PidFamily& family) {
  begin_output(items, 0x21, family.set_effect);
  effect_types(items);
  items.output(array).end();
  items.use(0x50).use(0x54).use(0x51);
  if (family.delay == PidFamily::Delay::before_gain) items.use(0xa7);
  items.logical(0, 32767).physical(0, 32767).unit(0x1003, -3);
  items.size(16, family.delay == PidFamily::Delay::before_gain ? 4 : 3).output(variable).unit(0, 0);
  number(items, 0x52, family.gain_bits, family.gain_maximum);
  number(items, 0x53, 8, 8, 1);
  items.begin(0x55).page(1).use(0x30).use(0x31).logical(0, 1).physical(0, 1).size(1, 2).output(variable).end().page(
      0x0f);
  items.use(0x56).size(1, 1).output(variable).size(5, 1).output(constant);
  if (family.has_direction) {
    items.begin(0x57).use(0x000a0001).use(0x000a0002).logical(0, family.direction_maximum).physical(0, 36000);
    items.unit(0x14, -2).size(static_cast<std::uint8_t>(family.direction_bits), 2).output(variable).unit(0, 0).end();
  }
  if (family.type_offsets) {
    items.begin(0x58).use(0x000a0001).use(0x000a0002).logical(0, 32765).physical(0, 32765).size(16, 2);
    items.output(variable).end();
  }
  if (family.delay == PidFamily::Delay::last) {
    items.use(0xa7).logical(0, 32767).physical(0, 32767).unit(0x1003, -3).size(16, 1).output(variable).unit(0, 0);
  }
  items.end();
}

void write_control(Items& items, const PidFamily& family) {
  // Devices use both forms: the field's usage on the report's collection, or inside its own collection.
  if (family.control_is_mask)
    items.begin(0x95).id(family.control).begin(0x96);
  else
    items.begin(0x96).id(family.control);
  for (const std::uint8_t order : family.control_orders) items.use(order);
  const auto count = static_cast<int>(family.control_orders.size());
  if (family.control_is_mask) {
    // OpenFFBoard declares the range of one bit here, which has no meaning.
    items.logical(1, count).physical(1, count).size(1, static_cast<std::uint16_t>(count)).output(variable);
    if (count < 8) items.size(static_cast<std::uint8_t>(8 - count), 1).output(constant);
    items.end();
  } else {
    items.logical(1, count).physical(1, count).size(8, 1).output(array);
  }
  items.end();
}

void write_features(Items& items, const PidFamily& family) {
  items.begin(0xab).id(family.create);
  effect_types(items);
  items.feature(array).end();
  items.page(1).use(0x3b).logical(0, 511).physical(0, 511).size(10, 1).feature(variable).size(6, 1).feature(constant);
  items.page(0x0f).end();

  items.begin(0x89).id(family.load);
  items.use(0x22).logical(1, 40).physical(1, 40).size(8, 1).feature(variable);
  items.begin(0x8b).use(0x8c).use(0x8d).use(0x8e).logical(1, 3).physical(1, 3).size(8, 1).feature(array).end();
  items.use(0xac).logical(0, 65535).physical(0, 65535).size(16, 1).feature(variable).end();

  if (!family.has_pool) return;
  items.begin(0x7f).id(family.pool);
  items.use(0x80).logical(0, 65535).physical(0, 65535).size(16, 1).feature(variable);
  items.use(0x83).logical(0, 255).physical(0, 255).size(8, 1).feature(variable);
  items.use(0xa9)
      .use(0xaa)
      .logical(0, 1)
      .physical(0, 1)
      .size(1, 2)
      .feature(variable)
      .size(6, 1)
      .feature(constant)
      .end();
}

/// The vendor's report as in OpenFFBoard's usb_hid_ffb_desc.h: usages 1 .. 6 of page FF00, with 8 to 64 bits and a
/// range without meaning.
void write_vendor_reports(Items& items) {
  items.page(0xff00).begin(0x00, 1);
  for (const bool is_out : {true, false}) {
    items.id(0xa1);
    std::uint8_t which = 0;
    for (const int bits : {8, 16, 8, 32, 64, 64}) {
      items.use(++which).logical(0, 4).size(static_cast<std::uint8_t>(bits), 1);
      if (is_out)
        items.output(variable);
      else
        items.input(variable);
    }
  }
  items.end();
}

}  // namespace

std::vector<std::uint8_t> report_descriptor(const PidFamily& family) {
  Items items;
  items.page(1).begin(0x04, 1).id(family.input);
  items.page(9).raw({0x19, 1, 0x29, static_cast<std::uint8_t>(family.buttons)}).logical(0, 1).physical(0, 1);
  items.size(1, static_cast<std::uint16_t>(family.buttons)).input(variable);
  if (family.buttons % 8 != 0) items.size(static_cast<std::uint8_t>(8 - family.buttons % 8), 1).input(constant);
  items.page(1);
  for (const std::uint8_t axis : family.axes) items.use(axis);
  items.logical(-32767, 32767).physical(0, 0).size(16, static_cast<std::uint16_t>(family.axes.size())).input(variable);

  items.page(0x0f);
  items.begin(0x92).id(static_cast<std::uint8_t>(family.input + 1));  // PID state
  items.use(0x9f).use(0xa0).use(0xa4).use(0xa5).use(0xa6).logical(0, 1).physical(0, 1).size(1, 5).input(variable);
  items.size(3, 1).input(constant).use(0x94).size(1, 1).input(variable);
  items.use(0x22).logical(1, 40).physical(1, 40).size(7, 1).input(variable).end();

  write_set_effect(items, family);
  begin_output(items, 0x5a, family.envelope);  // Linux's driver plays a constant force only with an envelope
  for (const std::uint8_t level : {0x5b, 0x5d}) number(items, level, 16, family.magnitude_maximum);
  for (const std::uint8_t time : {0x5c, 0x5e}) number(items, time, 16, 32767);
  items.end();
  begin_output(items, 0x73, family.constant);
  number(items, 0x70, 16, family.magnitude_maximum, -family.magnitude_maximum);
  items.end();
  begin_output(items, 0x77, family.operation);
  items.begin(0x78).use(0x79).use(0x7a).use(0x7b).logical(1, 3).physical(1, 3).size(8, 1).output(array).end();
  number(items, 0x7c, 8, 255);
  items.end();
  begin_output(items, 0x90, family.free);
  items.end();
  write_control(items, family);
  items.begin(0x7d).id(family.gain);
  number(items, 0x7e, 8, 255);
  items.end();
  write_features(items, family);
  items.end();
  if (family.has_vendor_report) write_vendor_reports(items);
  return items.bytes;
}

PidFamily openffboard() {
  PidFamily family;
  family.name = "OpenFFBoard";
  family.vendor = 0x1209;
  family.product = 0xffb0;
  family.axes = {0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x37, 0x36};
  family.buttons = 64;
  family.create = 0x11;
  family.load = 0x12;
  family.pool = 0x13;
  family.direction_bits = 16;
  family.direction_maximum = 36000;
  family.delay = PidFamily::Delay::before_gain;
  family.magnitude_maximum = 32767;
  family.control_is_mask = true;
  family.control_orders = {0x97, 0x98, 0x99, 0x9a, 0x9b, 0x9c};
  family.has_vendor_report = true;
  return family;
}

PidFamily rhino() {
  PidFamily family;
  family.name = "VPforce Rhino";
  family.vendor = 0xffff;
  family.product = 0x2055;
  family.axes = {0x30, 0x31};
  family.buttons = 32;
  family.set_effect = 101;
  family.envelope = 102;
  family.constant = 105;
  family.operation = 110;
  family.free = 111;
  family.control = 112;
  family.gain = 113;
  family.gain_bits = 16;
  family.gain_maximum = 4096;
  family.delay = PidFamily::Delay::last;
  family.magnitude_maximum = 4096;
  family.control_orders = {0x98, 0x97, 0x99, 0x9a};
  return family;
}

PidFamily adapt_ffb_joy() {
  PidFamily family;
  family.name = "adapt-ffb-joy";
  family.vendor = 0x03eb;
  family.product = 0x2056;
  family.axes = {0x30, 0x31, 0x36};
  family.buttons = 9;
  family.create = 1;
  family.load = 2;
  family.pool = 3;
  family.type_offsets = true;
  family.magnitude_maximum = 255;
  family.control_orders = {0x97, 0x98, 0x99, 0x9a, 0x9b, 0x9c};
  return family;
}

PidFamily arduino() {
  PidFamily family;
  family.name = "Arduino";
  family.vendor = 0x2341;
  family.product = 0x8036;
  family.axes = {0x30, 0x31};
  family.buttons = 4;
  family.type_offsets = true;
  family.magnitude_maximum = 10000;
  family.control_orders = {0x97, 0x98, 0x99, 0x9a, 0x9b, 0x9c};
  return family;
}

std::vector<PidFamily> all_families() { return {openffboard(), rhino(), adapt_ffb_joy(), arduino()}; }

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char byte[4];
  for (const std::uint8_t b : bytes) {
    std::snprintf(byte, sizeof byte, text.empty() ? "%02X" : " %02X", b);
    text += byte;
  }
  return text;
}

std::vector<std::uint8_t> from_hex(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 3) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

}  // namespace wale::test
