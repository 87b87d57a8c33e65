#include "runtime/device/hid_pid/pid_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "runtime/device/hid_pid/pid_usages.hpp"

namespace wale::hid {
namespace {

constexpr double turn = 360;  // degrees

std::string in_words(Usage what) {
  char text[16];
  std::snprintf(text, sizeof text, "%02X:%02X", what >> 16, what & 0xffff);
  return text;
}

/// Whether the range of a number can be written with its bits, in two's complement if it has negative values.
bool fits(const Field& field) {
  if (field.bits > 32) return false;
  const std::int64_t one = 1;
  if (field.logical_minimum >= 0) return field.logical_maximum < one << field.bits;
  return field.logical_minimum >= -(one << (field.bits - 1)) && field.logical_maximum < one << (field.bits - 1);
}

/// An element of a field, and the collection in which it was searched.
struct Element {
  const Field* field = nullptr;
  std::uint32_t index = 0;
};

/// Finds the numbers of one report. Keeps only the first error, because later ones may follow from it.
class Search {
 public:
  /// Searches the first report with a field within a collection of usage `what`; errors call the report `name`.
  Search(const ReportDescriptor& descriptor, ReportKind kind, Usage what, const char* name, std::string& wrong)
      : descriptor_(&descriptor), what_(what), name_(name), wrong_(&wrong) {
    for (const Report& report : descriptor.reports) {
      if (report.kind != kind || report.fields.empty()) continue;
      const auto is_inside = [&](const Field& field) { return descriptor.is_within(field.collection, what); };
      if (std::any_of(report.fields.begin(), report.fields.end(), is_inside)) {
        report_ = &report;
        break;
      }
    }
    if (report_ != nullptr && report_->bytes() > most_packet_bytes) {
      refuse("its " + std::string(name_) + " report has " + std::to_string(report_->bytes()) +
             " bytes, more than a packet");
    }
  }

  bool found() const { return report_ != nullptr; }

  PacketShape needed() {
    if (!found()) refuse("it has no " + std::string(name_) + " report (usage " + in_words(what_) + ")");
    return shape();
  }

  PacketShape shape() const {
    if (!found()) return {};
    return {report_->id, static_cast<std::uint8_t>(std::min(report_->bytes(), most_packet_bytes))};
  }

  Number number(Usage wanted, const char* name) {
    const Element element = find(wanted, 0);
    return element.field == nullptr ? missing(wanted, name) : at(element, name);
  }

  Number number_if_any(Usage wanted, const char* name) {
    const Element element = find(wanted, 0);
    return element.field == nullptr ? Number{} : at(element, name);
  }

  /// The axes' numbers within a collection, where they may be named as axes or in their order (page 0A).
  std::array<Number, 2> pair(Usage collection, const char* name) {
    std::array<Number, 2> numbers;
    std::size_t count = 0;
    if (!found()) return numbers;
    for (const Field& field : report_->fields) {
      if (!field.variable || !descriptor_->is_within(field.collection, collection)) continue;
      for (std::uint32_t i = 0; i < field.count && count < numbers.size(); ++i)
        numbers[count++] = at({&field, i}, name);
    }
    return numbers;
  }

  Order order(Usage wanted, const char* name) {
    const Order order = order_if_any(wanted, name);
    if (!order) missing(wanted, name);
    return order;
  }

  Order order_if_any(Usage wanted, const char* name) {
    const Element element = find(wanted, 0);
    if (element.field == nullptr) return {};
    // A bit of its own, whatever its range: OpenFFBoard declares 1 .. 6 for one bit.
    if (element.field->variable) return {placed(element, 0, 1), 1};
    return {at({element.field, 0}, name), element.field->logical_minimum + element.index};
  }

  /// The field of a usage, for its units.
  const Field* field(Usage wanted, Usage collection = 0) const { return find(wanted, collection).field; }

  const Field* first_within(Usage collection) const {
    if (!found()) return nullptr;
    for (const Field& field : report_->fields) {
      if (field.variable && descriptor_->is_within(field.collection, collection)) return &field;
    }
    return nullptr;
  }

  Number number_within(Usage wanted, Usage collection, const char* name) {
    const Element element = find(wanted, collection);
    return element.field == nullptr ? Number{} : at(element, name);
  }

 private:
  Element find(Usage wanted, Usage collection) const {
    if (!found()) return {};
    for (const Field& field : report_->fields) {
      if (!descriptor_->is_within(field.collection, what_)) continue;
      if (collection != 0 && !descriptor_->is_within(field.collection, collection)) continue;
      if (const auto index = field.find(wanted)) return {&field, *index};
    }
    return {};
  }

  Number at(const Element& element, const char* name) {
    const Field& field = *element.field;
    if (!fits(field)) {
      refuse(std::string(name) + " of its " + name_ + " report, " + std::to_string(field.logical_minimum) + " .. " +
             std::to_string(field.logical_maximum) + ", does not fit in " + std::to_string(field.bits) + " bits");
    }
    return placed(element, field.logical_minimum, field.logical_maximum);
  }

  Number placed(const Element& element, std::int64_t minimum, std::int64_t maximum) const {
    const Field& field = *element.field;
    const std::uint32_t bit = field.bit_offset + element.index * field.bits + (report_->id != 0 ? 8 : 0);
    if (bit + field.bits > 8 * most_packet_bytes) return {};  // the report has been refused
    return {static_cast<std::uint16_t>(bit), static_cast<std::uint8_t>(std::min(field.bits, 32u)), minimum, maximum};
  }

  Number missing(Usage wanted, const char* name) {
    if (found()) {
      refuse("its " + std::string(name_) + " report has no " + name + " (usage " + in_words(wanted) + ")");
    }
    return {};
  }

  void refuse(const std::string& reason) {
    if (wrong_->empty()) *wrong_ = reason;
  }

  const ReportDescriptor* descriptor_;
  Usage what_;
  const char* name_;
  std::string* wrong_;
  const Report* report_ = nullptr;
};

/// What one count stands for in the field's unit.
double physical_step(const Field& field) {
  return static_cast<double>(field.physical_maximum - field.physical_minimum) /
         static_cast<double>(std::max<std::int64_t>(1, field.logical_maximum - field.logical_minimum)) *
         std::pow(10.0, field.unit_exponent);
}

/// Seconds a count. Milliseconds, as the standard's example has it, where no plausible time is declared.
double seconds_of(const Field& field) {
  const bool is_time = field.unit == 0x1001 || field.unit == 0x1003;  // SI or English linear, seconds
  const double step = physical_step(field);
  return is_time && step >= 1e-6 && step <= 1 ? step : 1e-3;
}

/// Degrees a count. Where the range declared is not about a turn, it is taken for one.
double degrees_of(const Field& field) {
  const double counts = static_cast<double>(std::max<std::int64_t>(1, field.logical_maximum - field.logical_minimum));
  const double step = physical_step(field) * (field.unit == 0x12 ? 180 / 3.14159265358979323846 : 1);
  const double range = step * counts;
  const bool is_angle = field.unit == 0x12 || field.unit == 0x14;  // SI radians, English degrees
  return is_angle && range > 0.96 * turn && range < 1.04 * turn ? step : turn / counts;
}

PidLayout::SetEffect find_set_effect(const ReportDescriptor& descriptor, std::string& wrong) {
  Search search(descriptor, ReportKind::output, usages::set_effect, "Set Effect", wrong);
  PidLayout::SetEffect report;
  static_cast<PacketShape&>(report) = search.needed();
  report.block_index = search.number(usages::block_index, "effect block index");
  report.constant_force = search.order(usages::constant_force, "constant force type");
  report.duration = search.number(usages::duration, "duration");
  if (const Field* field = search.field(usages::duration)) report.duration_step = seconds_of(*field);
  report.gain = search.number_if_any(usages::gain, "gain");
  report.enable_x = search.number_within(usages::x, usages::axes_enable, "axes enable");
  report.enable_y = search.number_within(usages::y, usages::axes_enable, "axes enable");
  if (!report.enable_x || !report.enable_y) report.enable_x = report.enable_y = {};
  report.direction_enable = search.number_if_any(usages::direction_enable, "direction enable");
  report.direction = search.pair(usages::direction, "direction");
  if (const Field* field = search.first_within(usages::direction)) report.direction_step = degrees_of(*field);
  if (wrong.empty() && !report.enable_x && !(report.direction_enable && report.direction[0])) {
    wrong = "its Set Effect report can choose neither a direction (usages 0F:56 and 0F:57) nor axes (usage 0F:55)";
  }
  return report;
}

PidLayout::Input find_input(const ReportDescriptor& descriptor, std::string& wrong) {
  const auto number_of = [](const Report& report, Usage wanted) -> Number {
    for (const Field& field : report.fields) {
      if (!field.variable || field.relative || !fits(field)) continue;
      if (const auto index = field.find(wanted)) {
        const std::uint32_t bit = field.bit_offset + *index * field.bits + (report.id != 0 ? 8 : 0);
        if (bit + field.bits > 8 * most_packet_bytes) return {};
        return {static_cast<std::uint16_t>(bit), static_cast<std::uint8_t>(field.bits), field.logical_minimum,
                field.logical_maximum};
      }
    }
    return {};
  };
  PidLayout::Input input;
  for (const Report& report : descriptor.reports) {
    if (report.kind != ReportKind::input || report.bytes() > most_packet_bytes) continue;
    input.x = number_of(report, usages::x);
    input.y = number_of(report, usages::y);
    if (!input.x || !input.y || input.x.minimum == input.x.maximum || input.y.minimum == input.y.maximum) continue;
    input.button = number_of(report, usages::first_button);
    input.id = report.id;
    input.bytes = static_cast<std::uint8_t>(report.bytes());
    return input;
  }
  if (wrong.empty()) wrong = "it has no input report with the axes X and Y (usages 01:30 and 01:31)";
  return input;
}

/// A report that nothing depends on: one that makes no sense is taken for none, and so is one that no number tells from
/// the positions.
PidLayout::State find_state(const ReportDescriptor& descriptor) {
  std::string wrong;
  Search search(descriptor, ReportKind::input, usages::state, "PID State", wrong);
  PidLayout::State state;
  state.block_index = search.number_if_any(usages::block_index, "effect block index");
  state.effect_plays = search.order_if_any(usages::effect_playing, "effect playing");
  state.actuators_enabled = search.order_if_any(usages::actuators_enabled, "actuators enabled");
  static_cast<PacketShape&>(state) = search.shape();
  if (!wrong.empty() || state.id == 0 || !(state.effect_plays || state.actuators_enabled)) return {};
  return state;
}

}  // namespace

Result<PidLayout> find_pid_layout(const ReportDescriptor& descriptor) {
  const auto is_pid = [](const Collection& collection) { return collection.usage >> 16 == usages::pid_page; };
  if (std::none_of(descriptor.collections.begin(), descriptor.collections.end(), is_pid)) {
    return Error{Code::no_force_device,
                 "it is not a force device: nothing in its report descriptor is of usage page 0F"};
  }

  std::string wrong;
  PidLayout layout;
  layout.set_effect = find_set_effect(descriptor, wrong);

  Search constant(descriptor, ReportKind::output, usages::set_constant_force, "Set Constant Force", wrong);
  static_cast<PacketShape&>(layout.set_constant_force) = constant.needed();
  layout.set_constant_force.block_index = constant.number(usages::block_index, "effect block index");
  layout.set_constant_force.magnitude = constant.number(usages::magnitude, "magnitude");
  if (wrong.empty() && layout.set_constant_force.full() < 1) {
    wrong = "the magnitude of its Set Constant Force report cannot push both ways";
  }

  Search operation(descriptor, ReportKind::output, usages::effect_operation, "Effect Operation", wrong);
  static_cast<PacketShape&>(layout.effect_operation) = operation.needed();
  layout.effect_operation.block_index = operation.number(usages::block_index, "effect block index");
  layout.effect_operation.start = operation.order(usages::start, "start");
  layout.effect_operation.stop = operation.order(usages::stop, "stop");
  layout.effect_operation.loop_count = operation.number_if_any(usages::loop_count, "loop count");

  Search create(descriptor, ReportKind::feature, usages::create_new_effect, "Create New Effect", wrong);
  static_cast<PacketShape&>(layout.create_new_effect) = create.needed();
  layout.create_new_effect.constant_force = create.order(usages::constant_force, "constant force type");

  Search load(descriptor, ReportKind::feature, usages::block_load, "Block Load", wrong);
  static_cast<PacketShape&>(layout.block_load) = load.needed();
  layout.block_load.block_index = load.number(usages::block_index, "effect block index");
  layout.block_load.success = load.order(usages::load_success, "load success");
  layout.block_load.full = load.order_if_any(usages::load_full, "load full");

  // Some devices give the report's collection the usage of the report, others that of the field.
  Search control(descriptor, ReportKind::output, usages::device_control, "Device Control", wrong);
  if (!control.found()) {
    control = Search(descriptor, ReportKind::output, usages::device_control_report, "Device Control", wrong);
  }
  static_cast<PacketShape&>(layout.device_control) = control.shape();
  layout.device_control.enable_actuators = control.order_if_any(usages::enable_actuators, "enable actuators");
  layout.device_control.disable_actuators = control.order_if_any(usages::disable_actuators, "disable actuators");
  layout.device_control.stop_all = control.order_if_any(usages::stop_all, "stop all effects");
  layout.device_control.reset = control.order_if_any(usages::reset, "reset");

  Search gain(descriptor, ReportKind::output, usages::device_gain_report, "Device Gain", wrong);
  layout.device_gain.gain = gain.number_if_any(usages::device_gain, "gain");
  if (layout.device_gain.gain) static_cast<PacketShape&>(layout.device_gain) = gain.shape();

  Search free(descriptor, ReportKind::output, usages::block_free, "Block Free", wrong);
  layout.block_free.block_index = free.number_if_any(usages::block_index, "effect block index");
  if (layout.block_free.block_index) static_cast<PacketShape&>(layout.block_free) = free.shape();

  Search pool(descriptor, ReportKind::feature, usages::pool, "Pool", wrong);
  layout.pool.simultaneous_effects = pool.number_if_any(usages::simultaneous_effects, "simultaneous effects");
  if (layout.pool.simultaneous_effects) static_cast<PacketShape&>(layout.pool) = pool.shape();

  layout.state = find_state(descriptor);
  layout.input = find_input(descriptor, wrong);
  if (!wrong.empty()) return Error{Code::unlike_device, std::move(wrong), {}, {.name = "report descriptor"}};
  return layout;
}

}  // namespace wale::hid
