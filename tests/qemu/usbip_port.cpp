#include "tests/qemu/usbip_port.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace wale::test {
namespace {

constexpr char controller[] = "/sys/devices/platform/vhci_hcd.0/";
constexpr int full_speed = 2;

// Commands of USB/IP; a header is 48 bytes, big-endian, as twelve words.
constexpr std::uint32_t submit = 1, unlink_request = 2, submit_answer = 3, unlink_answer = 4;
using Header = std::array<std::uint32_t, 12>;
enum Word { command, number, device, direction, endpoint, first };  // the meaning of later words depends on the command
constexpr std::size_t length_at = first + 1, setup_at = 10;

bool read_all(int socket, void* to, std::size_t size) {
  auto* bytes = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t got = recv(socket, bytes, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

void write_all(int socket, const std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return;
    at += static_cast<std::size_t>(sent);
  }
}

std::vector<std::uint8_t> bytes_of(const Header& header) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint32_t word : header) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  }
  return bytes;
}

void tell_controller(const char* file, const std::string& text) {
  std::ofstream out(std::string(controller) + file);
  out << text << std::flush;
  if (!out) throw std::runtime_error(std::string(controller) + file + " takes no \"" + text + "\"");
}

}  // namespace

UsbipPort::UsbipPort(std::unique_ptr<UsbModel> model, int port) : model_(std::move(model)), port_(port) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no socketpair");
  socket_ = ends[0];
  reader_ = std::thread([this] { read_requests(); });
  clock_ = std::thread([this] { pass_frames(); });
  const int device_number = 0x10000 + port + 1;
  tell_controller("attach", std::to_string(port) + " " + std::to_string(ends[1]) + " " + std::to_string(device_number) +
                                " " + std::to_string(full_speed));
  close(ends[1]);
}

UsbipPort::~UsbipPort() {
  try {
    tell_controller("detach", std::to_string(port_));
  } catch (const std::runtime_error&) {  // the kernel has released it by itself
  }
  ends_ = true;
  shutdown(socket_, SHUT_RDWR);
  reader_.join();
  clock_.join();
  close(socket_);
}

void UsbipPort::read_requests() {
  Header header{};
  while (read_all(socket_, header.data(), sizeof header)) {
    std::array<std::uint8_t, sizeof header> raw{};
    std::copy_n(reinterpret_cast<const std::uint8_t*>(header.data()), raw.size(), raw.begin());
    for (std::uint32_t& word : header) word = ntohl(word);
    if (header[command] == unlink_request) {
      const std::lock_guard lock(mutex_);
      const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                      [&](const Request& each) { return each.number == header[first]; });
      const bool was_waiting = found != waiting_.end();
      if (was_waiting) waiting_.erase(found);
      ++unlinked;
      const int status = was_waiting ? -ECONNRESET : 0;  // 0: its answer is already under way
      write_all(socket_, bytes_of({unlink_answer, header[number], 0, 0, 0, static_cast<std::uint32_t>(status)}));
      continue;
    }
    if (header[command] != submit) return;
    Request request;
    request.number = header[number];
    request.endpoint = header[endpoint];
    request.length = header[length_at];
    request.is_in = header[direction] == 1;
    std::copy_n(raw.begin() + 4 * setup_at, request.setup.size(), request.setup.begin());
    if (!request.is_in) {
      request.out.resize(request.length);
      if (!read_all(socket_, request.out.data(), request.out.size())) return;
    }
    const std::lock_guard lock(mutex_);
    if (request.endpoint == 0) {
      control(request);
    } else {
      waiting_.push_back(std::move(request));
    }
  }
}

void UsbipPort::pass_frames() {
  auto next = std::chrono::steady_clock::now();
  while (!ends_) {
    next =
        std::max(next + std::chrono::milliseconds(1), std::chrono::steady_clock::now());  // late ones are not caught up
    std::this_thread::sleep_until(next);
    frame();
  }
}

/// One frame: at most one packet for each endpoint.
void UsbipPort::frame() {
  const std::lock_guard lock(mutex_);
  model_->step();
  ++frames;
  std::map<std::uint32_t, bool> is_served;
  for (auto each = waiting_.begin(); each != waiting_.end();) {
    const auto address = static_cast<std::uint8_t>(each->endpoint | (each->is_in ? 0x80u : 0u));
    if (std::exchange(is_served[address], true)) {
      ++each;
      continue;
    }
    if (!each->is_in) {
      if (!model_->listens(address)) {
        ++each;
        continue;
      }
      const bool is_taken = model_->take(address, each->out);
      ++packets_out;
      answer(*each, is_taken ? 0 : -EPIPE, {}, is_taken ? each->out.size() : 0);
    } else {
      auto packet = model_->give(address);
      if (!packet) {
        ++each;
        continue;
      }
      packet->resize(std::min<std::size_t>(packet->size(), each->length));
      ++packets_in;
      answer(*each, 0, *packet, packet->size());
    }
    each = waiting_.erase(each);
  }
}

/// The answer of every device to a standard request (USB 2.0, section 9.4). Empty for other requests and for a stall.
std::optional<UsbModel::Bytes> UsbipPort::standard(const UsbModel::SetUp& setup) const {
  constexpr std::uint8_t get_status = 0, clear_feature = 1, set_feature = 3, get_descriptor = 6, set_configuration = 9,
                         set_interface = 11;
  const bool is_standard = (setup[0] & 0x60) == 0, is_to_device = (setup[0] & 0x1f) == 0;
  if (!is_standard) return std::nullopt;
  switch (setup[1]) {
    case get_status: return UsbModel::Bytes{0, 0};
    case clear_feature:
    case set_feature:
    case set_configuration:
    case set_interface: return UsbModel::Bytes{};
    case get_descriptor:
      if (is_to_device && setup[3] == 1) return model_->device_descriptor();
      if (is_to_device && setup[3] == 2) return model_->configuration_descriptor();
      return std::nullopt;
    default: return std::nullopt;
  }
}

void UsbipPort::control(const Request& request) {
  auto in = standard(request.setup);
  if (!in) in = model_->control(request.setup, request.out);
  if (!in) return answer(request, -EPIPE, {}, 0);
  if (!request.is_in) return answer(request, 0, {}, request.out.size());
  in->resize(std::min<std::size_t>(in->size(), request.length));
  answer(request, 0, *in, in->size());
}

/// Under the lock.
void UsbipPort::answer(const Request& request, int status, const UsbModel::Bytes& in, std::size_t length) {
  auto bytes = bytes_of(
      {submit_answer, request.number, 0, 0, 0, static_cast<std::uint32_t>(status), static_cast<std::uint32_t>(length)});
  bytes.insert(bytes.end(), in.begin(), in.end());
  write_all(socket_, bytes);
}

}  // namespace wale::test
