#include "tests/usb_mock/hid_nodes.hpp"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace wale::test {
namespace {

// HID 1.11 section 7.2.
constexpr std::uint8_t class_in = 0xa1, class_out = 0x21, get_report = 1, set_report = 9;
constexpr std::uint8_t input_kind = 1, output_kind = 2, feature_kind = 3;
constexpr std::size_t most_inputs = 64;  // that hidraw and the input layer hold for a slow reader; then they drop some
constexpr int most_effects = 16;

std::uint8_t low(unsigned value) { return static_cast<std::uint8_t>(value & 0xff); }
std::uint8_t high(unsigned value) { return static_cast<std::uint8_t>(value >> 8 & 0xff); }

std::string packed_hex(const std::vector<std::uint8_t>& bytes) {
  std::string text = hex(bytes);
  std::erase(text, ' ');
  return text;
}

/// Set Effect as hid-pidff fills it: always by direction, the second of two directions 0.
std::vector<std::uint8_t> set_effect_report(const PidFamily& family, std::uint8_t block, const ff_effect& effect) {
  std::vector<std::uint8_t> report{
      family.set_effect, block, 1, low(effect.replay.length), high(effect.replay.length), 0, 0, 0, 0};
  const auto put = [&](int bits, unsigned value) {
    report.push_back(low(value));
    if (bits == 16) report.push_back(high(value));
  };
  if (family.delay == PidFamily::Delay::before_gain) put(16, effect.replay.delay);
  put(family.gain_bits, static_cast<unsigned>(family.gain_maximum));
  constexpr std::uint8_t no_trigger = 0, by_direction = 4;
  report.push_back(no_trigger);
  report.push_back(by_direction);
  put(family.direction_bits, static_cast<unsigned>(effect.direction * family.direction_maximum / 0xffff));
  put(family.direction_bits, 0);
  if (family.type_offsets) report.insert(report.end(), 4, 0);
  if (family.delay == PidFamily::Delay::last) put(16, effect.replay.delay);
  return report;
}

std::vector<std::uint8_t> constant_report(const PidFamily& family, std::uint8_t block, int level) {
  const int counts =
      level > 0 ? level * family.magnitude_maximum / 0x7fff : level * -family.magnitude_maximum / -0x8000;
  return {family.constant, block, low(static_cast<unsigned>(counts)), high(static_cast<unsigned>(counts))};
}

std::vector<std::uint8_t> operation_report(const PidFamily& family, std::uint8_t block, int count) {
  constexpr std::uint8_t start = 1, stop = 3;
  return {family.operation, block, count != 0 ? start : stop, static_cast<std::uint8_t>(std::clamp(count, 0, 255))};
}

/// Device Control with one of its usages.
std::vector<std::uint8_t> control_report(const PidFamily& family, std::uint8_t order) {
  const auto at = std::ranges::find(family.control_orders, order) - family.control_orders.begin();
  return {family.control, static_cast<std::uint8_t>(family.control_is_mask ? 1 << at : at + 1)};
}

}  // namespace

MockNode::MockNode(UMockdevTestbed* testbed, std::string path, Kernel& kernel)
    : testbed_(testbed), path_(std::move(path)), kernel_(kernel), handler_(umockdev_ioctl_base_new()) {
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(when_asked), this);
  g_signal_connect(handler_, "handle-read", G_CALLBACK(when_read), this);
  g_signal_connect(handler_, "handle-write", G_CALLBACK(when_written), this);
  GError* error = nullptr;
  if (!umockdev_testbed_attach_ioctl(testbed_, path_.c_str(), handler_, &error)) {
    throw std::runtime_error(error->message);
  }
  gchar* root = umockdev_testbed_get_root_dir(testbed_);
  const std::string file = root + path_;
  g_free(root);
  // poll finds a regular file always readable, and a pipe only while it holds a byte.
  unlink(file.c_str());
  if (mkfifo(file.c_str(), 0666) != 0) throw std::runtime_error("no fifo");
  fifo_ = open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
}

MockNode::~MockNode() {
  g_signal_handlers_disconnect_by_data(handler_, this);
  umockdev_testbed_detach_ioctl(testbed_, path_.c_str(), nullptr);
  g_object_unref(handler_);
  close(fifo_);
}

void MockNode::show_whether_readable(bool is_readable) {
  if (is_readable == std::exchange(is_readable_, is_readable)) return;
  char byte = 0;
  const ssize_t moved = is_readable ? write(fifo_, &byte, 1) : read(fifo_, &byte, 1);
  if (moved != 1) std::perror("hid_nodes: fifo");
}

gboolean MockNode::when_asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  auto& node = *static_cast<MockNode*>(self);
  node.kernel_.answer(node, client);
  return TRUE;
}

gboolean MockNode::when_written(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  auto& node = *static_cast<MockNode*>(self);
  node.kernel_.take(node, client);
  return TRUE;
}

gboolean MockNode::when_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  auto& node = *static_cast<MockNode*>(self);
  const auto given = node.kernel_.give(node);
  UMockdevIoctlData* buffer = umockdev_ioctl_client_get_arg(client);
  if (!given) {
    umockdev_ioctl_client_complete(client, -1, EAGAIN);
  } else if (given->empty()) {
    umockdev_ioctl_client_complete(client, -1, EIO);
  } else {
    const auto length = std::min(given->size(), static_cast<std::size_t>(buffer->data_len));
    std::copy_n(given->begin(), length, buffer->data);
    umockdev_ioctl_client_complete(client, static_cast<long>(length), 0);
  }
  return TRUE;
}

MockHidNodes::MockHidNodes(UMockdevTestbed* testbed, MockJoystick& joystick, int number)
    : testbed_(testbed), joystick_(joystick) {
  const PidFamily family = joystick_.with_model([](PidModel& model) { return model.family; });
  const auto descriptor = joystick_.with_model([](PidModel& model) { return model.descriptor; });
  const std::string n = std::to_string(number), port = joystick_.syspath().substr(joystick_.syspath().rfind('/') + 1);
  char numbers[32];
  std::snprintf(numbers, sizeof numbers, "0003:%04X:%04X.%04X", static_cast<unsigned>(family.vendor),
                static_cast<unsigned>(family.product), static_cast<unsigned>(number));
  const std::string interface = joystick_.syspath() + "/" + port + ":1.0", device = interface + "/" + numbers,
                    input = device + "/input/input" + n;
  // FF_CONSTANT (82) and FF_GAIN (96), in words of 64 bits, the lowest last.
  const std::string forces = "100040000 0";
  const std::pair<std::string, std::string> folders[] = {
      {interface, "E: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\n"},
      {device, "E: SUBSYSTEM=hid\nH: report_descriptor=" + packed_hex(descriptor) + "\n"},
      {device + "/hidraw/hidraw" + n,
       "N: hidraw" + n + "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/hidraw" + n + "\nE: MAJOR=240\nE: MINOR=" + n + "\n"},
      {input, "E: SUBSYSTEM=input\nA: capabilities/ff=" + forces + "\n"},
      {input + "/event" + n, "N: input/event" + n + "\nE: SUBSYSTEM=input\nE: DEVNAME=/dev/input/event" + n +
                                 "\nE: MAJOR=13\nE: MINOR=" + std::to_string(64 + number) + "\n"}};
  for (const auto& [folder, text] : folders) {
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(testbed_, ("P: " + folder.substr(4) + "\n" + text + "\n").c_str(), &error)) {
      throw std::runtime_error(error->message);
    }
    folders_.push_back(folder);
  }
  for (input_absinfo& axis : axes_) axis = {.minimum = -32767, .maximum = 32767, .fuzz = 255, .flat = 4095};
  hidraw_ = std::make_unique<MockNode>(testbed_, "/dev/hidraw" + n, *this);
  event_ = std::make_unique<MockNode>(testbed_, "/dev/input/event" + n, *this);
  // As Linux 6.1 does when it binds a device.
  joystick_.with_model([&](PidModel& model) {
    for (const std::uint8_t order : {0x9a, 0x97}) model.output(control_report(family, order));
    model.log.clear();
  });
  joystick_.attach(this);
}

MockHidNodes::~MockHidNodes() {
  joystick_.attach(nullptr);
  close_all();
  hidraw_.reset();
  event_.reset();
  remove_folders();
}

void MockHidNodes::remove_folders() {
  std::ranges::reverse(folders_);
  for (const std::string& folder : std::exchange(folders_, {})) {
    umockdev_testbed_remove_device(testbed_, folder.c_str());
  }
}

void MockHidNodes::close_all() {
  joystick_.with_model([&](PidModel& model) {
    for (const auto& [id, effect] : std::exchange(effects_, {})) {
      outputs_.push_back({operation_report(model.family, effect.block, 0)});
      outputs_.push_back({{model.family.free, effect.block}});
      g_object_unref(effect.owner);
    }
    for (Report& report : outputs_) {
      if (report.writer != nullptr) g_object_unref(std::exchange(report.writer, nullptr));
    }
  });
}

/// The device takes one report, and sends one.
void MockHidNodes::frame(UsbModel& model) {
  auto& stick = static_cast<PidModel&>(model);
  erase_of_the_closed(stick);
  if (!outputs_.empty() && stick.listens(pid_out_endpoint)) {
    const Report report = std::move(outputs_.front());
    outputs_.pop_front();
    const bool is_taken = stick.take(pid_out_endpoint, report.bytes);
    if (report.writer != nullptr) {
      umockdev_ioctl_client_complete(report.writer, is_taken ? static_cast<long>(report.bytes.size()) : -1,
                                     is_taken ? 0 : EPIPE);
      g_object_unref(report.writer);
    }
  }
  if (const auto input = stick.give(pid_in_endpoint)) {
    inputs_.push_back(*input);
    if (inputs_.size() > most_inputs) inputs_.pop_front();
    take_position(stick, *input);
  }
  hidraw_->show_whether_readable(!inputs_.empty());
  event_->show_whether_readable(!events_.empty());
}

void MockHidNodes::unplug() {
  is_gone_ = true;
  remove_folders();
  for (Report& report : outputs_) {
    if (report.writer == nullptr) continue;
    umockdev_ioctl_client_complete(report.writer, -1, ENODEV);
    g_object_unref(report.writer);
  }
  outputs_.clear();
  hidraw_->show_whether_readable(true);  // waiting programs read, and get the error
  event_->show_whether_readable(true);
}

/// The X and Y of an input report as events, where they have changed.
void MockHidNodes::take_position(const PidModel& model, const std::vector<std::uint8_t>& input) {
  if (input.empty() || input[0] != model.family.input) return;
  const std::size_t first = 1 + static_cast<std::size_t>(model.family.buttons + 7) / 8;
  const auto event = [](std::uint16_t type, std::uint16_t code, std::int32_t value) {
    input_event event{};
    event.type = type;
    event.code = code;
    event.value = value;
    return event;
  };
  bool is_changed = false;
  for (std::size_t i = 0; i < model.family.axes.size(); ++i) {
    const std::uint8_t usage = model.family.axes[i];
    if ((usage != 0x30 && usage != 0x31) || input.size() < first + 2 * i + 2) continue;
    const auto value = static_cast<std::int16_t>(input[first + 2 * i] | input[first + 2 * i + 1] << 8);
    input_absinfo& axis = axes_[usage - 0x30u];
    if (std::exchange(axis.value, value) == value) continue;
    events_.push_back(event(EV_ABS, usage == 0x30 ? ABS_X : ABS_Y, value));
    is_changed = true;
  }
  if (is_changed) events_.push_back(event(EV_SYN, SYN_REPORT, 0));
  if (events_.size() <= most_inputs) return;
  events_ = {event(EV_SYN, SYN_DROPPED, 0), event(EV_SYN, SYN_REPORT, 0)};
}

std::optional<std::vector<std::uint8_t>> MockHidNodes::give(MockNode& node) {
  return joystick_.with_model([&](PidModel&) -> std::optional<std::vector<std::uint8_t>> {
    if (is_gone_) return std::vector<std::uint8_t>{};
    if (&node == hidraw_.get()) {
      if (inputs_.empty()) return std::nullopt;
      auto input = std::move(inputs_.front());
      inputs_.pop_front();
      hidraw_->show_whether_readable(!inputs_.empty());
      return input;
    }
    if (events_.empty()) return std::nullopt;
    const auto* raw = reinterpret_cast<const std::uint8_t*>(&events_.front());
    std::vector<std::uint8_t> event(raw, raw + sizeof(input_event));
    events_.pop_front();
    event_->show_whether_readable(!events_.empty());
    return event;
  });
}

void MockHidNodes::take(MockNode& node, UMockdevIoctlClient* client) {
  joystick_.with_model([&](PidModel& model) {
    const UMockdevIoctlData* written = umockdev_ioctl_client_get_arg(client);
    const auto size = static_cast<std::size_t>(written->data_len);
    if (is_gone_) return umockdev_ioctl_client_complete(client, -1, ENODEV);
    if (&node == hidraw_.get()) {  // returns when the device has taken it
      outputs_.push_back({{written->data, written->data + size}, UMOCKDEV_IOCTL_CLIENT(g_object_ref(client))});
      return;
    }
    for (std::size_t at = 0; at + sizeof(input_event) <= size; at += sizeof(input_event)) {
      input_event event{};
      std::memcpy(&event, written->data + at, sizeof event);
      play(model, event);
    }
    umockdev_ioctl_client_complete(client, static_cast<long>(size), 0);
  });
}

void MockHidNodes::answer(MockNode& node, UMockdevIoctlClient* client) {
  joystick_.with_model([&](PidModel& model) {
    const unsigned long request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
    if (is_gone_) return umockdev_ioctl_client_complete(client, -1, ENODEV);
    const std::size_t size = _IOC_SIZE(request);
    if (request == EVIOCRMFF && &node == event_.get()) {  // its argument is no address
      gulong id = 0;
      std::memcpy(&id, argument->data, sizeof id);
      const long result = erase(model, client, static_cast<int>(id));
      return umockdev_ioctl_client_complete(client, result < 0 ? -1 : result,
                                            result < 0 ? static_cast<int>(-result) : 0);
    }
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, size, nullptr);
    long result = -EFAULT;
    if (data != nullptr) {
      result = &node == hidraw_.get() ? answer_hidraw(model, request, data->data, size)
                                      : answer_event(model, client, request, data->data, size);
    }
    umockdev_ioctl_client_complete(client, result < 0 ? -1 : result, result < 0 ? static_cast<int>(-result) : 0);
    if (data != nullptr) g_object_unref(data);
  });
}

long MockHidNodes::answer_hidraw(PidModel& model, unsigned long request, std::uint8_t* data, std::size_t size) {
  if (_IOC_TYPE(request) != 'H') return -ENOTTY;
  const auto bytes = static_cast<std::uint32_t>(model.descriptor.size());
  switch (_IOC_NR(request)) {
    case _IOC_NR(HIDIOCGRDESCSIZE): std::memcpy(data, &bytes, sizeof bytes); return 0;
    case _IOC_NR(HIDIOCGRDESC):
      std::ranges::copy(model.descriptor, data + offsetof(hidraw_report_descriptor, value));
      return 0;
    case _IOC_NR(HIDIOCSFEATURE(0)): return report(model, false, feature_kind, data, size);
    case _IOC_NR(HIDIOCGFEATURE(0)): return report(model, true, feature_kind, data, size);
    case _IOC_NR(HIDIOCSOUTPUT(0)): return report(model, false, output_kind, data, size);
    case _IOC_NR(HIDIOCGINPUT(0)): return report(model, true, input_kind, data, size);
    default: return -ENOTTY;
  }
}

/// A control transfer; the length that came or went, or a negative error.
long MockHidNodes::report(PidModel& model, bool is_in, std::uint8_t kind, std::uint8_t* data, std::size_t size) {
  const UsbModel::SetUp set_up{is_in ? class_in : class_out,     is_in ? get_report : set_report,  data[0], kind, 0, 0,
                               low(static_cast<unsigned>(size)), high(static_cast<unsigned>(size))};
  const auto answer = model.control(set_up, is_in ? UsbModel::Bytes{} : UsbModel::Bytes(data, data + size));
  if (!answer) return -EPIPE;
  if (!is_in) return static_cast<long>(size);
  const std::size_t length = std::min(size, answer->size());
  std::copy_n(answer->begin(), length, data);
  return static_cast<long>(length);
}

long MockHidNodes::answer_event(PidModel& model, UMockdevIoctlClient* client, unsigned long request, std::uint8_t* data,
                                std::size_t size) {
  constexpr unsigned bits_of = 0x20, position_of = 0x40, set_position_of = 0xc0;  // EVIOCGBIT, EVIOCGABS, EVIOCSABS
  if (_IOC_TYPE(request) != 'E') return -ENOTTY;
  const unsigned number = _IOC_NR(request);
  if (request == EVIOCGVERSION) return 0;
  if (request == EVIOCGEFFECTS) return std::memcpy(data, &most_effects, sizeof most_effects), 0;
  if (request == EVIOCSFF) return upload(model, client, *reinterpret_cast<ff_effect*>(data));
  if (number == position_of + ABS_X || number == position_of + ABS_Y) {
    std::memcpy(data, &axes_[number - position_of], sizeof(input_absinfo));
    return 0;
  }
  if (number == set_position_of + ABS_X || number == set_position_of + ABS_Y) {
    std::memcpy(&axes_[number - set_position_of], data, sizeof(input_absinfo));
    return 0;
  }
  if (number < bits_of || number >= position_of) return -ENOTTY;
  std::memset(data, 0, size);
  const auto set = [&](unsigned bit) {
    if (bit / 8 < size) data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] | 1u << bit % 8);
  };
  if (number - bits_of == EV_FF) set(FF_CONSTANT), set(FF_GAIN);
  if (number - bits_of == EV_ABS) set(ABS_X), set(ABS_Y);
  return static_cast<long>(size);
}

/// Sends all queued reports at once, as hid_hw_wait does before a request that has an answer.
void MockHidNodes::send_now(PidModel& model) {
  for (const Report& report : std::exchange(outputs_, {})) {
    const bool is_taken = model.take(pid_out_endpoint, report.bytes);
    if (report.writer == nullptr) continue;
    umockdev_ioctl_client_complete(report.writer, is_taken ? static_cast<long>(report.bytes.size()) : -1,
                                   is_taken ? 0 : EPIPE);
    g_object_unref(report.writer);
  }
}

long MockHidNodes::upload(PidModel& model, UMockdevIoctlClient* client, ff_effect& effect) {
  if (effect.type != FF_CONSTANT) return -EINVAL;
  const PidFamily& family = model.family;
  if (effect.id >= 0) {
    const auto found = effects_.find(effect.id);
    if (found == effects_.end()) return -EINVAL;
    if (found->second.owner != client) return -EACCES;
    const ff_effect before = std::exchange(found->second.said, effect);
    const std::uint8_t block = found->second.block;
    if (before.direction != effect.direction || before.replay.length != effect.replay.length) {
      outputs_.push_back({set_effect_report(family, block, effect)});
    }
    if (before.u.constant.level != effect.u.constant.level) {
      outputs_.push_back({constant_report(family, block, effect.u.constant.level)});
    }
    return 0;
  }
  int id = 0;
  while (effects_.contains(id)) ++id;
  if (id >= most_effects) return -ENOSPC;
  send_now(model);
  std::uint8_t create[] = {family.create, 1, 0, 0}, load[5] = {family.load};
  constexpr std::uint8_t loaded = 1;
  if (report(model, false, feature_kind, create, sizeof create) < 0) return -EIO;
  if (report(model, true, feature_kind, load, sizeof load) < 0 || load[2] != loaded) return -ENOSPC;
  effect.id = static_cast<std::int16_t>(id);
  effects_[id] = {effect, load[1], UMOCKDEV_IOCTL_CLIENT(g_object_ref(client))};
  outputs_.push_back({set_effect_report(family, load[1], effect)});
  outputs_.push_back({constant_report(family, load[1], effect.u.constant.level)});
  return 0;
}

long MockHidNodes::erase(PidModel& model, const UMockdevIoctlClient* client, int id) {
  const auto found = effects_.find(id);
  if (found == effects_.end()) return -EINVAL;
  if (found->second.owner != client) return -EACCES;
  send_now(model);
  outputs_.push_back({operation_report(model.family, found->second.block, 0)});
  outputs_.push_back({{model.family.free, found->second.block}});
  g_object_unref(found->second.owner);
  effects_.erase(found);
  return 0;
}

void MockHidNodes::erase_of_the_closed(PidModel& model) {
  std::vector<std::pair<int, UMockdevIoctlClient*>> closed;
  for (const auto& [id, effect] : effects_) {
    if (!umockdev_ioctl_client_get_connected(effect.owner)) closed.emplace_back(id, effect.owner);
  }
  for (const auto& [id, owner] : closed) erase(model, owner, id);
}

void MockHidNodes::play(const PidModel& model, const input_event& event) {
  if (event.type != EV_FF) return;
  if (event.code == FF_GAIN) {
    outputs_.push_back({{model.family.gain, static_cast<std::uint8_t>(event.value * 255 / 0xffff)}});
  } else if (const auto found = effects_.find(event.code); found != effects_.end()) {
    outputs_.push_back({operation_report(model.family, found->second.block, event.value)});
  }
}

}  // namespace wale::test
