#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "wale/result.hpp"

namespace wale::hid {

// A parser of HID report descriptors: USB "Device Class Definition for HID" 1.11, section 6.2.2.

/// The meaning of a field or a collection: the usage page in the upper 16 bits, the usage in the lower ones.
using Usage = std::uint32_t;

constexpr Usage usage(std::uint16_t page, std::uint16_t id) { return static_cast<Usage>(page) << 16 | id; }

/// Consecutive usages, both ends included.
struct UsageRange {
  Usage first = 0, last = 0;

  friend bool operator==(const UsageRange&, const UsageRange&) = default;
};

enum class ReportKind : std::uint8_t { input, output, feature };

struct Collection {
  Usage usage = 0;
  std::uint8_t type = 0;  ///< 0 physical, 1 application, 2 logical, …
  int parent = -1;        ///< index of the collection around it; -1: none

  friend bool operator==(const Collection&, const Collection&) = default;
};

/// A row of `count` equal elements of one report. Padding is not a field.
struct Field {
  std::uint32_t bit_offset = 0;  ///< of the first element, from the first bit of the report without its id byte
  std::uint32_t bits = 0;        ///< of one element, 1 .. 256
  std::uint32_t count = 0;       ///< elements, at least 1
  std::int64_t logical_minimum = 0, logical_maximum = 0;
  /// The physical range of the logical one, in units of 10^unit_exponent; if none is declared, equal to the logical
  /// one.
  std::int64_t physical_minimum = 0, physical_maximum = 0;
  int unit_exponent = 0;   ///< -8 .. 7
  std::uint32_t unit = 0;  ///< nibbles of powers, as in HID 1.11 section 6.2.2.7
  bool variable = false;   ///< each element is a value; otherwise each is the number of one of the usages (an array)
  bool relative = false;   ///< elements are changes
  int collection = -1;     ///< index of the innermost collection; -1: none
  std::vector<UsageRange> usages;

  /// The usage of element `index` of a variable field, or of the value `logical_minimum + index` of an array. The last
  /// usage of a variable field also counts for all elements after it. Empty if there is no such usage.
  std::optional<Usage> usage_at(std::uint32_t index) const;
  /// The first `index` at which `usage_at` is `wanted`, among the elements of a variable field or the values of an
  /// array.
  std::optional<std::uint32_t> find(Usage wanted) const;

  friend bool operator==(const Field&, const Field&) = default;
};

struct Report {
  ReportKind kind = ReportKind::input;
  std::uint8_t id = 0;     ///< 0: reports have no ids
  std::uint32_t bits = 0;  ///< without the id byte, padding included
  std::vector<Field> fields;

  /// With the id byte, if there is one.
  std::size_t bytes() const { return (bits + 7) / 8 + (id != 0 ? 1 : 0); }

  friend bool operator==(const Report&, const Report&) = default;
};

struct ReportDescriptor {
  std::vector<Collection> collections;  ///< outer ones before inner ones
  std::vector<Report> reports;          ///< in the order of their first field

  /// Whether `collection`, or a collection around it, has that usage.
  bool is_within(int collection, Usage wanted) const;
  const Report* find(ReportKind kind, std::uint8_t id) const;

  friend bool operator==(const ReportDescriptor&, const ReportDescriptor&) = default;
};

/// Larger descriptors are refused, as Linux does (HID_MAX_DESCRIPTOR_SIZE).
constexpr std::size_t most_descriptor_bytes = 4096;
/// Reports of more bits are refused.
constexpr std::uint32_t most_report_bits = 8 * 4096;
constexpr std::size_t most_collection_depth = 64, most_pushed = 16;

/// Reads a report descriptor. Takes any bytes, in time proportional to their number, with memory bounded by the limits
/// above. Of alternative usages between delimiters the first one counts, which is the preferred one; designators,
/// strings and long items are skipped. A Usage Page after the usages of an item applies to all of them, as in Linux;
/// otherwise each short usage has the page that was set before it. The number of an error's place is the item's offset
/// from the first byte.
Result<ReportDescriptor> parse_report_descriptor(std::span<const std::uint8_t> bytes);

}  // namespace wale::hid
