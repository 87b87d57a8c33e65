#include "tests/usb_mock/usb_mock.hpp"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <pthread.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "runtime/stage/scheduling.hpp"

namespace wale::test {
namespace {

constexpr unsigned long disconnect_claim = 0x8108551b;  // USBDEVFS_DISCONNECT_CLAIM with its argument's size
constexpr std::uint8_t in_bit = 0x80;
constexpr std::chrono::milliseconds frame_time(1);  // the least duration of frames that pass by themselves

std::atomic<std::int64_t> microseconds_passed{0};

/// Gives this thread a real-time priority above the drivers' threads, because it stands for the kernel. Returns false
/// if that is not permitted; drivers may then have to wait.
bool go_before_all_others() {
  sched_param parameters{};
  parameters.sched_priority = usual_priority + 1;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

std::string in_hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char two[3];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(two, sizeof two, "%02X", byte);
    text += two;
  }
  return text;
}

std::string digits(int value, int count) {
  char text[16];
  std::snprintf(text, sizeof text, "%0*d", count, value);
  return text;
}

std::string hexadecimal(int value, int count) {
  char text[16];
  std::snprintf(text, sizeof text, "%0*x", count, static_cast<unsigned>(value));
  return text;
}

usbdevfs_urb& urb_of(UMockdevIoctlData* data) { return *reinterpret_cast<usbdevfs_urb*>(data->data); }

}  // namespace

MockUsbDevice::MockUsbDevice(UMockdevTestbed* testbed, std::unique_ptr<UsbModel> model, int port, int address)
    : model_(std::move(model)), testbed_(testbed) {
  syspath_ = "/sys/devices/pci0000:00/0000:00:14.0/usb1/1-" + std::to_string(port);
  node_ = "/dev/bus/usb/001/" + digits(address, 3);
  const auto device = model_->device_descriptor(), configuration = model_->configuration_descriptor();
  const int vendor = device[8] | device[9] << 8, product = device[10] | device[11] << 8;
  const std::string text = "P: " + syspath_.substr(4) + "\nN: " + node_.substr(5) +
                           "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DEVNAME=" + node_ +
                           "\nE: BUSNUM=001\nE: DEVNUM=" + digits(address, 3) +
                           "\nE: MAJOR=189\nE: MINOR=" + std::to_string(address - 1) +
                           "\nE: PRODUCT=" + hexadecimal(vendor, 1) + "/" + hexadecimal(product, 1) +
                           "/100\nE: TYPE=0/0/0\nA: busnum=1\nA: devnum=" + std::to_string(address) +
                           "\nA: bConfigurationValue=1\nA: speed=12\nA: idVendor=" + hexadecimal(vendor, 4) +
                           "\nA: idProduct=" + hexadecimal(product, 4) +
                           "\nA: bNumConfigurations=1\nA: maxchild=0\nA: product=" + model_->name() +
                           "\nH: descriptors=" + in_hex(device) + in_hex(configuration) + "\n\n";
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(testbed, text.c_str(), &error)) throw std::runtime_error(error->message);
  handler_ = umockdev_ioctl_base_new();
  connection_ = g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(when_asked), this);
  if (!umockdev_testbed_attach_ioctl(testbed, node_.c_str(), handler_, &error)) {
    throw std::runtime_error(error->message);
  }
  // A regular file is always ready, and libusb would spin; a pipe of one page is not while it holds a byte.
  gchar* root = umockdev_testbed_get_root_dir(testbed);
  const std::string file = root + node_;
  g_free(root);
  unlink(file.c_str());
  if (mkfifo(file.c_str(), 0666) != 0) throw std::runtime_error("no fifo");
  fifo_ = open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  fcntl(fifo_, F_SETPIPE_SZ, 4096);
  show_whether_ready();
}

MockUsbDevice::~MockUsbDevice() {
  g_signal_handler_disconnect(handler_, connection_);
  umockdev_testbed_detach_ioctl(testbed_, node_.c_str(), nullptr);
  g_object_unref(handler_);
  close_all();
  close(fifo_);
}

void MockUsbDevice::attach(Attachment* attachment) {
  const std::lock_guard lock(mutex_);
  attachment_ = attachment;
}

void MockUsbDevice::release(const Urb& urb) {
  g_object_unref(urb.urb);
  if (urb.buffer != nullptr) g_object_unref(urb.buffer);
  if (urb.client != nullptr) g_object_unref(urb.client);
}

/// Drops the transfers of clients that closed the device or were killed, as usbfs does. Called under the lock.
void MockUsbDevice::forget_the_closed() {
  const auto forget_in = [](std::deque<Urb>& queue) {
    std::erase_if(queue, [](const Urb& urb) {
      if (umockdev_ioctl_client_get_connected(urb.client)) return false;
      release(urb);
      return true;
    });
  };
  for (auto& [endpoint, queue] : endpoints_) forget_in(queue);
  forget_in(controls_);
  forget_in(done_);
  if (unserved_ != nullptr && !umockdev_ioctl_client_get_connected(unserved_)) set_unserved(nullptr);
  show_whether_ready();
}

void MockUsbDevice::set_unserved(UMockdevIoctlClient* client) {
  if (client == unserved_) return;
  if (client != nullptr) g_object_ref(client);
  if (unserved_ != nullptr) g_object_unref(unserved_);
  unserved_ = client;
  served_.notify_all();
}

bool MockUsbDevice::is_served() {
  const std::lock_guard lock(mutex_);
  forget_the_closed();
  return is_gone_ || unserved_ == nullptr;
}

bool MockUsbDevice::wait_until_served() {
  constexpr int most_looks = 300;
  std::unique_lock lock(mutex_);
  for (int look = 0; look < most_looks; ++look) {
    forget_the_closed();
    constexpr std::chrono::milliseconds between_looks(100);
    if (served_.wait_for(lock, between_looks, [&] { return is_gone_ || unserved_ == nullptr; })) return true;
  }
  return false;
}

/// A client is ready when it has a transfer to reap.
void MockUsbDevice::show_whether_ready() {
  const bool is_ready = !done_.empty();
  if (is_ready == is_shown_ready_) return;
  is_shown_ready_ = is_ready;
  char byte = 0;
  const ssize_t moved = is_ready ? read(fifo_, &byte, 1) : write(fifo_, &byte, 1);
  if (moved != 1) std::perror("usb_mock: fifo");
}

void MockUsbDevice::end(const Urb& urb, int status, int length) {
  urb_of(urb.urb).status = status;
  urb_of(urb.urb).actual_length = length;
  done_.push_back(urb);
  set_unserved(urb.client);
}

void MockUsbDevice::frame() {
  const std::lock_guard lock(mutex_);
  if (is_gone_) return;
  ++frame_;
  model_->step();
  for (auto& [endpoint, queue] : endpoints_) {
    if (queue.empty()) continue;
    const Urb urb = queue.front();
    const auto wanted = static_cast<std::size_t>(urb_of(urb.urb).buffer_length);
    if ((endpoint & in_bit) == 0) {
      if (!model_->listens(endpoint)) continue;
      queue.pop_front();
      const bool is_taken = model_->take(endpoint, {urb.buffer->data, urb.buffer->data + wanted});
      end(urb, is_taken ? 0 : -EPIPE, is_taken ? static_cast<int>(wanted) : 0);
    } else if (const auto report = model_->give(endpoint)) {
      queue.pop_front();
      const std::size_t length = std::min(report->size(), wanted);
      std::copy_n(report->begin(), length, urb.buffer->data);
      end(urb, 0, static_cast<int>(length));
    }
  }
  while (!controls_.empty() && controls_.front().due >= 0 && controls_.front().due <= frame_) {
    const Urb urb = controls_.front();
    controls_.pop_front();
    control(urb);
  }
  if (attachment_ != nullptr) attachment_->frame(*model_);
  show_whether_ready();
}

void MockUsbDevice::unplug() {
  const std::lock_guard lock(mutex_);
  is_gone_ = true;
  if (attachment_ != nullptr) attachment_->unplug();
  const auto end_all = [&](std::deque<Urb>& queue) {
    for (const Urb& urb : queue) end(urb, -ESHUTDOWN, 0);
    queue.clear();
  };
  for (auto& [endpoint, queue] : endpoints_) end_all(queue);
  end_all(controls_);
  show_whether_ready();
}

void MockUsbDevice::close_all() {
  const std::lock_guard lock(mutex_);
  const auto forget_all = [](std::deque<Urb>& queue) {
    std::ranges::for_each(queue, release);
    queue.clear();
  };
  for (auto& [endpoint, queue] : endpoints_) forget_all(queue);
  forget_all(controls_);
  forget_all(done_);
  set_unserved(nullptr);
  show_whether_ready();
}

UsbModel::SetUp MockUsbDevice::set_up(const Urb& urb) {
  UsbModel::SetUp setup{};
  std::copy_n(urb.buffer->data, setup.size(), setup.begin());
  return setup;
}

void MockUsbDevice::control(const Urb& urb) {
  const UsbModel::SetUp setup = set_up(urb);
  const int length = setup[6] | setup[7] << 8;
  const bool is_in = (setup[0] & in_bit) != 0;
  const std::vector<std::uint8_t> out(urb.buffer->data + 8, urb.buffer->data + 8 + (is_in ? 0 : length));
  const auto answer = model_->control(setup, out);
  if (!answer) return end(urb, -EPIPE, 0);
  if (!is_in) return end(urb, 0, length);
  const auto given = std::min<std::size_t>(answer->size(), static_cast<std::size_t>(length));
  std::copy_n(answer->begin(), given, urb.buffer->data + 8);
  end(urb, 0, static_cast<int>(given));
}

int MockUsbDevice::submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  Urb urb;
  urb.urb = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
  if (urb.urb == nullptr) return EFAULT;  // the client was killed after its request
  const usbdevfs_urb& wanted = urb_of(urb.urb);
  if (wanted.buffer_length > 0) {
    urb.buffer = umockdev_ioctl_data_resolve(urb.urb, offsetof(usbdevfs_urb, buffer),
                                             static_cast<gsize>(wanted.buffer_length), nullptr);
    if (urb.buffer == nullptr) {
      g_object_unref(urb.urb);
      return EFAULT;
    }
  }
  urb.client = UMOCKDEV_IOCTL_CLIENT(g_object_ref(client));
  if (wanted.type == USBDEVFS_URB_TYPE_CONTROL) {
    const auto frames = model_->control_frames(set_up(urb));
    if (frames == 0) {
      control(urb);
    } else {
      urb.due = frames ? frame_ + *frames : -1;
      controls_.push_back(urb);
    }
  } else {
    endpoints_[wanted.endpoint].push_back(urb);
  }
  return 0;
}

int MockUsbDevice::discard(UMockdevIoctlData* argument) {
  gulong address = 0;
  std::memcpy(&address, argument->data, sizeof address);
  const auto take_from = [&](std::deque<Urb>& queue) {
    const auto found =
        std::find_if(queue.begin(), queue.end(), [&](const Urb& urb) { return urb.urb->client_addr == address; });
    if (found == queue.end()) return false;
    const Urb urb = *found;
    queue.erase(found);
    end(urb, -ENOENT, 0);
    return true;
  };
  if (take_from(controls_)) return 0;
  for (auto& [endpoint, queue] : endpoints_) {
    if (take_from(queue)) return 0;
  }
  return EINVAL;
}

/// The transfers that usbfs makes while the caller waits, as a keeper's are. They take no frame here.
int MockUsbDevice::transfer_at_once(gulong request, UMockdevIoctlData* argument) {
  const bool is_control = request == USBDEVFS_CONTROL;
  UMockdevIoctlData* wanted = umockdev_ioctl_data_resolve(
      argument, 0, is_control ? sizeof(usbdevfs_ctrltransfer) : sizeof(usbdevfs_bulktransfer), nullptr);
  if (wanted == nullptr) return EFAULT;
  const auto& control = *reinterpret_cast<const usbdevfs_ctrltransfer*>(wanted->data);
  const auto& packet = *reinterpret_cast<const usbdevfs_bulktransfer*>(wanted->data);
  const std::size_t size = is_control ? control.wLength : packet.len;
  const std::size_t at = is_control ? offsetof(usbdevfs_ctrltransfer, data) : offsetof(usbdevfs_bulktransfer, data);
  UMockdevIoctlData* data = size > 0 ? umockdev_ioctl_data_resolve(wanted, at, size, nullptr) : nullptr;
  const UsbModel::Bytes out(data != nullptr ? data->data : nullptr, data != nullptr ? data->data + size : nullptr);
  bool is_taken = false;
  if (is_control) {
    const auto low = [](unsigned word) { return static_cast<std::uint8_t>(word & 0xff); };
    const auto high = [](unsigned word) { return static_cast<std::uint8_t>(word >> 8); };
    is_taken = model_
                   ->control({control.bRequestType, control.bRequest, low(control.wValue), high(control.wValue),
                              low(control.wIndex), high(control.wIndex), low(control.wLength), high(control.wLength)},
                             out)
                   .has_value();
  } else {
    is_taken = model_->listens(static_cast<std::uint8_t>(packet.ep)) &&
               model_->take(static_cast<std::uint8_t>(packet.ep), out);
  }
  if (data != nullptr) g_object_unref(data);
  g_object_unref(wanted);
  return is_taken ? 0 : EPIPE;
}

int MockUsbDevice::reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  if (done_.empty()) {
    set_unserved(nullptr);
    return is_gone_ ? ENODEV : EAGAIN;
  }
  const Urb urb = done_.front();
  done_.pop_front();
  UMockdevIoctlData* pointer = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
  if (pointer != nullptr) umockdev_ioctl_data_set_ptr(pointer, 0, urb.urb);
  show_whether_ready();
  umockdev_ioctl_client_complete(client, 0, 0);
  if (pointer != nullptr) g_object_unref(pointer);
  release(urb);
  return 0;
}

gboolean MockUsbDevice::when_asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  ++answering_;
  static_cast<MockUsbDevice*>(self)->answer(client);
  --answering_;
  return TRUE;
}

void MockUsbDevice::answer(UMockdevIoctlClient* client) {
  thread_local const bool is_before_all_others = go_before_all_others();
  static_cast<void>(is_before_all_others);
  const std::lock_guard lock(mutex_);
  const gulong request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  int error = 0;
  const bool is_reap = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
  if (is_gone_ && !is_reap) {
    error = ENODEV;
  } else if (is_reap) {
    error = reap(client, argument);
    if (error == 0) return;
  } else if (request == USBDEVFS_GET_CAPABILITIES) {
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(std::uint32_t), nullptr);
    const std::uint32_t capabilities = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                                       USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    if (data != nullptr) std::memcpy(data->data, &capabilities, sizeof capabilities);
    umockdev_ioctl_client_complete(client, 0, 0);
    if (data != nullptr) g_object_unref(data);
    return;
  } else if (request == disconnect_claim || request == USBDEVFS_CLAIMINTERFACE) {
    if (is_claimed_elsewhere) {
      error = EBUSY;
    } else {
      ++claims;
    }
  } else if (request == USBDEVFS_RELEASEINTERFACE) {
    ++releases;
  } else if (request == USBDEVFS_IOCTL) {
    ++drivers_back;  // the kernel's driver is connected again
  } else if (request == USBDEVFS_SUBMITURB) {
    error = submit(client, argument);
    show_whether_ready();
  } else if (request == USBDEVFS_DISCARDURB) {
    error = discard(argument);
    show_whether_ready();
  } else if (request == USBDEVFS_BULK || request == USBDEVFS_CONTROL) {
    error = transfer_at_once(request, argument);
  } else if (request == USBDEVFS_GETDRIVER) {
    error = ENODATA;
  } else if (request != USBDEVFS_CLEAR_HALT && request != USBDEVFS_RESET && request != USBDEVFS_SETINTERFACE) {
    ++unknown_ioctls;
    error = ENOTTY;
  }
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
}

std::int64_t mock_microseconds() noexcept { return microseconds_passed.load(std::memory_order_relaxed); }

UsbMock::UsbMock() : testbed_(umockdev_testbed_new()) {
  thread_ = std::thread([this] {
    go_before_all_others();
    auto next = std::chrono::steady_clock::now();
    while (!ends_) {
      next = std::max(next + frame_time, std::chrono::steady_clock::now());  // late frames are not caught up
      std::this_thread::sleep_until(next);
      const std::lock_guard lock(mutex_);
      if (in_step_ == 0 && (!waits_for_drivers || is_served())) frame();
    }
  });
}

/// Under the lock.
bool UsbMock::is_served() {
  return std::ranges::all_of(devices_, [](const auto& device) { return device->is_served(); });
}

/// Under the lock.
void UsbMock::frame() {
  microseconds_passed.fetch_add(1000, std::memory_order_relaxed);
  for (const auto& device : devices_) device->frame();
  ++frames_;
}

void UsbMock::pass_frame() {
  const auto wait_until_served = [&] {
    std::unique_lock lock(mutex_);
    const auto devices = devices_;
    lock.unlock();
    if (!std::ranges::all_of(devices, [](const auto& device) { return device->wait_until_served(); }))
      throw std::runtime_error("a transfer has ended, and the driver does not take it");
  };
  wait_until_served();
  {
    const std::lock_guard lock(mutex_);
    frame();
  }
  wait_until_served();
}

UsbMock::~UsbMock() {
  ends_ = true;
  thread_.join();
  devices_.clear();
  g_object_unref(testbed_);
}

void UsbMock::show(std::shared_ptr<MockUsbDevice> device) {
  const std::lock_guard lock(mutex_);
  umockdev_testbed_uevent(testbed_, device->syspath().c_str(), "add");
  devices_.push_back(std::move(device));
}

void UsbMock::unplug(const std::shared_ptr<MockUsbDevice>& device) {
  device->unplug();
  umockdev_testbed_uevent(testbed_, device->syspath().c_str(), "remove");
  umockdev_testbed_remove_device(testbed_, device->syspath().c_str());
  const std::lock_guard lock(mutex_);
  std::erase(devices_, device);
}

}  // namespace wale::test
