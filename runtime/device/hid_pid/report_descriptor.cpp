#include "runtime/device/hid_pid/report_descriptor.hpp"

#include <algorithm>
#include <array>

namespace wale::hid {

std::optional<Usage> Field::usage_at(std::uint32_t index) const {
  if (usages.empty() || (variable && index >= count)) return std::nullopt;
  for (const UsageRange& range : usages) {
    const std::uint32_t length = range.last - range.first + 1;
    if (index < length) return range.first + index;
    index -= length;
  }
  return variable ? std::optional(usages.back().last) : std::nullopt;
}

std::optional<std::uint32_t> Field::find(Usage wanted) const {
  std::uint64_t before = 0;
  for (const UsageRange& range : usages) {
    if (wanted >= range.first && wanted <= range.last) {
      const std::uint64_t index = before + (wanted - range.first);
      const std::uint64_t end =
          variable ? count
                   : static_cast<std::uint64_t>(std::max<std::int64_t>(0, logical_maximum - logical_minimum + 1));
      return index < end ? std::optional(static_cast<std::uint32_t>(index)) : std::nullopt;
    }
    before += static_cast<std::uint64_t>(range.last - range.first) + 1;
  }
  return std::nullopt;
}

bool ReportDescriptor::is_within(int collection, Usage wanted) const {
  for (; collection >= 0; collection = collections[static_cast<std::size_t>(collection)].parent) {
    if (collections[static_cast<std::size_t>(collection)].usage == wanted) return true;
  }
  return false;
}

const Report* ReportDescriptor::find(ReportKind kind, std::uint8_t id) const {
  for (const Report& report : reports) {
    if (report.kind == kind && report.id == id) return &report;
  }
  return nullptr;
}

namespace {

/// An item's data: up to four bytes. The kind of item decides whether they are signed.
struct Data {
  std::uint32_t value = 0;
  std::uint32_t size = 0;  // bytes

  std::int64_t as_signed() const {
    const std::uint32_t bits = 8 * size;
    if (bits == 0) return 0;
    const std::uint32_t sign = std::uint32_t{1} << (bits - 1);
    return static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign);
  }
};

/// The global items, which apply until they are set anew (HID 1.11 section 6.2.2.7).
struct Globals {
  std::uint32_t page = 0;
  Data logical_minimum, logical_maximum, physical_minimum, physical_maximum;
  int unit_exponent = 0;
  std::uint32_t unit = 0, bits = 0, count = 0;
  std::uint8_t id = 0;
};

/// A local usage whose page may not be known yet.
struct LocalUsage {
  UsageRange range;
  bool is_extended = false;  // it has a page of its own
};

/// The maximum of a range is signed if its minimum is negative; many devices write 255 in one byte.
std::int64_t maximum(const Data& minimum, const Data& maximum) {
  return minimum.as_signed() < 0 ? maximum.as_signed() : static_cast<std::int64_t>(maximum.value);
}

class Parser {
 public:
  explicit Parser(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  Result<ReportDescriptor> parse() {
    if (bytes_.size() > most_descriptor_bytes) return error("the descriptor has more than 4096 bytes");
    while (position_ < bytes_.size()) {
      item_ = position_;
      const std::uint8_t prefix = bytes_[position_++];
      const std::size_t left = bytes_.size() - position_;
      if (prefix == 0xfe) {  // a long item: its size, its tag, its data
        if (left < 2 || left - 2 < bytes_[position_]) return error("a long item ends beyond the descriptor");
        position_ += 2 + std::size_t{bytes_[position_]};
        continue;
      }
      Data data;
      data.size = (prefix & 3) == 3 ? 4 : prefix & 3;
      if (left < data.size) return error("an item ends beyond the descriptor");
      for (std::uint32_t i = 0; i < data.size; ++i) data.value |= std::uint32_t{bytes_[position_++]} << (8 * i);
      const int tag = prefix >> 4;
      switch (prefix >> 2 & 3) {
        case 0: read_main(tag, data); break;
        case 1: read_global(tag, data); break;
        case 2: read_local(tag, data); break;
        default: break;  // reserved
      }
      if (failed_ != nullptr) return error(failed_);
    }
    item_ = bytes_.size();
    if (open_ >= 0) return error("a collection is not ended");
    return std::move(result_);
  }

 private:
  Error error(const char* reason) const {
    return {Code::unlike_device,
            "its report descriptor is damaged at byte " + std::to_string(item_) + ": " + reason,
            {},
            {.name = "report descriptor", .number = item_}};
  }
  void fail(const char* reason) { failed_ = reason; }

  void read_main(int tag, const Data& data) {
    if (in_delimiter_) return fail("a delimiter is not closed");
    settle_pages();
    switch (tag) {
      case 8: add_field(ReportKind::input, data.value); break;
      case 9: add_field(ReportKind::output, data.value); break;
      case 11: add_field(ReportKind::feature, data.value); break;
      case 10: {
        if (depth_ == most_collection_depth) return fail("collections stand too deep in one another");
        const Usage what = usages_.empty() ? 0 : usages_.front().range.first;
        result_.collections.push_back({what, static_cast<std::uint8_t>(data.value), open_});
        open_ = static_cast<int>(result_.collections.size()) - 1;
        ++depth_;
        break;
      }
      case 12:
        if (open_ < 0) return fail("a collection ends that was not begun");
        open_ = result_.collections[static_cast<std::size_t>(open_)].parent;
        --depth_;
        break;
      default: break;  // reserved
    }
    usages_.clear();
    usage_minimum_.reset();
    usage_maximum_.reset();
    page_is_newer_ = false;
  }

  void read_global(int tag, const Data& data) {
    switch (tag) {
      case 0:
        if (data.value > 0xffff) return fail("a usage page has more than 16 bits");
        globals_.page = data.value;
        page_is_newer_ = true;
        break;
      case 1: globals_.logical_minimum = data; break;
      case 2: globals_.logical_maximum = data; break;
      case 3: globals_.physical_minimum = data; break;
      case 4: globals_.physical_maximum = data; break;
      case 5: {
        // A nibble by the standard, in a byte; some devices write the whole negative byte.
        const std::int64_t exponent =
            data.value <= 15 ? (data.value < 8 ? data.value : std::int64_t{data.value} - 16) : data.as_signed();
        if (exponent < -8 || exponent > 7) return fail("a unit exponent is not in -8 .. 7");
        globals_.unit_exponent = static_cast<int>(exponent);
        break;
      }
      case 6: globals_.unit = data.value; break;
      case 7:
        if (data.value > 256) return fail("a field has more than 256 bits");
        globals_.bits = data.value;
        break;
      case 8:
        if (data.value == 0 || data.value > 255) return fail("a report id is not in 1 .. 255");
        if (has_unnumbered_) return fail("a report id comes after fields that have none");
        globals_.id = static_cast<std::uint8_t>(data.value);
        break;
      case 9:
        if (data.value > most_report_bits) return fail("a field has too many elements");
        globals_.count = data.value;
        break;
      case 10:
        if (pushed_count_ == most_pushed) return fail("too much is pushed");
        pushed_[pushed_count_++] = globals_;
        break;
      case 11:
        if (pushed_count_ == 0) return fail("popped what was not pushed");
        globals_ = pushed_[--pushed_count_];
        break;
      default: break;  // reserved
    }
  }

  void read_local(int tag, const Data& data) {
    const bool is_extended = data.size == 4;
    const Usage what = is_extended ? data.value : globals_.page << 16 | data.value;
    if (tag == 10) {
      if (data.value == 1) {
        if (in_delimiter_) return fail("a delimiter opens within another");
        in_delimiter_ = true;
        alternatives_ = 0;
      } else {
        if (!in_delimiter_) return fail("a delimiter closes that was not opened");
        in_delimiter_ = false;
      }
      return;
    }
    if (tag > 2) return;  // designators, strings, reserved
    if (tag == 0) {
      add_usages({{what, what}, is_extended});
    } else {
      (tag == 1 ? usage_minimum_ : usage_maximum_) = LocalUsage{{what, what}, is_extended};
      if (usage_minimum_ && usage_maximum_) {
        const LocalUsage range{{usage_minimum_->range.first, usage_maximum_->range.first},
                               usage_minimum_->is_extended || usage_maximum_->is_extended};
        if (range.range.first > range.range.last) return fail("a usage minimum is above its maximum");
        if (range.range.first >> 16 != range.range.last >> 16) return fail("a range of usages has two pages");
        add_usages(range);
        usage_minimum_.reset();
        usage_maximum_.reset();
      }
    }
    page_is_newer_ = false;
  }

  void add_usages(const LocalUsage& local) {
    if (in_delimiter_ && ++alternatives_ > 1) return;
    usages_.push_back(local);
  }

  void settle_pages() {
    if (!page_is_newer_) return;
    for (LocalUsage& local : usages_) {
      if (local.is_extended) continue;
      local.range = {globals_.page << 16 | (local.range.first & 0xffff),
                     globals_.page << 16 | (local.range.last & 0xffff)};
    }
  }

  Report& report(ReportKind kind) {
    for (Report& report : result_.reports) {
      if (report.kind == kind && report.id == globals_.id) return report;
    }
    return result_.reports.emplace_back(Report{kind, globals_.id, 0, {}});
  }

  void add_field(ReportKind kind, std::uint32_t flags) {
    if (globals_.id == 0) has_unnumbered_ = true;
    const std::uint64_t bits = std::uint64_t{globals_.bits} * globals_.count;
    Report& whole = report(kind);
    if (bits > most_report_bits || whole.bits + bits > most_report_bits)
      return fail("a report has more than 4096 bytes");
    const std::uint32_t offset = whole.bits;
    whole.bits += static_cast<std::uint32_t>(bits);
    const bool is_constant = (flags & 1) != 0;
    if (is_constant || bits == 0 || usages_.empty()) return;  // padding

    Field field;
    field.bit_offset = offset;
    field.bits = globals_.bits;
    field.count = globals_.count;
    field.logical_minimum = globals_.logical_minimum.as_signed();
    field.logical_maximum = maximum(globals_.logical_minimum, globals_.logical_maximum);
    if (field.logical_minimum > field.logical_maximum) return fail("a logical minimum is above its maximum");
    field.physical_minimum = globals_.physical_minimum.as_signed();
    field.physical_maximum = maximum(globals_.physical_minimum, globals_.physical_maximum);
    // Without a valid physical range the physical values are the logical ones (HID 1.11 section 6.2.2.7).
    if (field.physical_minimum >= field.physical_maximum) {
      field.physical_minimum = field.logical_minimum;
      field.physical_maximum = field.logical_maximum;
    }
    field.unit_exponent = globals_.unit_exponent;
    field.unit = globals_.unit;
    field.variable = (flags & 2) != 0;
    field.relative = (flags & 4) != 0;
    field.collection = open_;
    field.usages.reserve(usages_.size());
    for (const LocalUsage& local : usages_) field.usages.push_back(local.range);
    whole.fields.push_back(std::move(field));
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0, item_ = 0;
  const char* failed_ = nullptr;
  ReportDescriptor result_;
  Globals globals_;
  std::array<Globals, most_pushed> pushed_;
  std::size_t pushed_count_ = 0, depth_ = 0;
  int open_ = -1;  // the innermost collection
  std::vector<LocalUsage> usages_;
  std::optional<LocalUsage> usage_minimum_, usage_maximum_;
  bool page_is_newer_ = false;  // the page was set after the last usage
  bool has_unnumbered_ = false, in_delimiter_ = false;
  int alternatives_ = 0;
};

}  // namespace

Result<ReportDescriptor> parse_report_descriptor(std::span<const std::uint8_t> bytes) { return Parser(bytes).parse(); }

}  // namespace wale::hid
