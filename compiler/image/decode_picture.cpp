#include "compiler/image/decode_picture.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/image/decoder/sandbox.hpp"
#include "schema/companion.hpp"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

/// A file descriptor of this process, above the three standard ones, closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {
    if (number_ < 0 || number_ > STDERR_FILENO) return;
    number_ = fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    close(number);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

Error short_of(const char* what) {
  return {Code::short_of_resources, fmt::format("no {} to decode the picture: {}", what, std::strerror(errno))};
}

Error failed(std::string sentence) {
  return {Code::unreadable_image, std::move(sentence), "save it as PNG, TIFF, JPEG or EXR"};
}

/// The picture as a file without a name that nobody can change any more.
Result<Descriptor> sealed_copy(std::span<const std::byte> bytes) {
  Descriptor file(memfd_create("picture", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file) return short_of("descriptor");
  while (!bytes.empty()) {
    const ssize_t written = write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return short_of("memory");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  if (fcntl(file.number(), F_ADD_SEALS, F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0)
    return short_of("sealed file");
  return Result<Descriptor>(std::move(file));
}

struct Pipe {
  Descriptor out, in;
};

Result<Pipe> new_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return short_of("descriptors");
  Pipe pipe{Descriptor(ends[0]), Descriptor(ends[1])};
  if (!pipe.out || !pipe.in) return short_of("descriptors");
  return Result<Pipe>(std::move(pipe));
}

/// The settings of a new process: standard input and output as given, standard error nowhere, no other descriptor, no
/// blocked or ignored signal, and no terminal that could stop it.
class SpawnSettings {
 public:
  SpawnSettings(int input, int output) {
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    error_ = first_error(
        {posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO),
         posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO),
         posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0),
         posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1),
         posix_spawnattr_setsigmask(&attributes_, &none), posix_spawnattr_setsigdefault(&attributes_, &all),
         posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID)});
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  /// 0, or the number of an error. The process inherits nothing of the environment but where libraries are, so that a
  /// picture has the same heights for everybody.
  int start(const std::string& program, const std::vector<std::string>& arguments, pid_t& process) const {
    if (error_ != 0) return error_;
    std::vector<char*> words{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    const char* libraries = std::getenv("LD_LIBRARY_PATH");
    std::string setting = fmt::format("LD_LIBRARY_PATH={}", libraries ? libraries : "");
    char* environment[] = {libraries ? setting.data() : nullptr, nullptr};
    return posix_spawn(&process, program.c_str(), &actions_, &attributes_, words.data(), environment);
  }

 private:
  static int first_error(std::initializer_list<int> results) {
    for (const int result : results)
      if (result != 0) return result;
    return 0;
  }

  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
  int error_ = 0;
};

/// A running decoder; ended and gone once `end` returns.
struct DecoderProcess {
  pid_t id = -1;
  Descriptor handle;  ///< names this process even if somebody else has waited for it; none on Linux before 5.3
};

Result<DecoderProcess> start_decoder(int picture, int answer, const DecoderArguments& arguments,
                                     const std::vector<std::string>& programs) {
  const SpawnSettings settings(picture, answer);
  DecoderProcess process;
  int error = ENOENT;
  for (const std::string& program : programs) {
    error = settings.start(program, arguments.words(), process.id);
    if (error != ENOENT && error != ENOTDIR) break;
  }
  if (error == EAGAIN || error == ENOMEM) {
    errno = error;
    return short_of("process");
  }
  if (error != 0)
    return Error{Code::missing_library,
                 fmt::format("the program that decodes pictures does not start: {}", std::strerror(error)),
                 "put wale-decoder beside the program that uses it",
                 {"wale-decoder"}};
  process.handle = Descriptor(static_cast<int>(syscall(SYS_pidfd_open, process.id, 0)));
  return Result<DecoderProcess>(std::move(process));
}

/// Kills the process if it still runs, and returns its status, unless somebody else has taken it.
std::optional<int> end(const DecoderProcess& process) {
  if (process.handle)
    syscall(SYS_pidfd_send_signal, process.handle.number(), SIGKILL, nullptr, 0);
  else
    kill(process.id, SIGKILL);
  int status = 0;
  while (true) {
    const pid_t ended = waitpid(process.id, &status, 0);
    if (ended == process.id) return status;
    if (ended >= 0 || errno != EINTR) return std::nullopt;
  }
}

struct Received {
  std::vector<std::byte> bytes;
  bool late = false;  ///< the time was over before the decoder had answered
};

/// Reads until the decoder closes the pipe, has written more than an answer can have, or the time is over.
Received receive(int pipe) {
  const auto end = Clock::now() + std::chrono::seconds(most_seconds_per_picture);
  Received received;
  std::vector<std::byte> block(1 << 16);
  while (received.bytes.size() <= largest_answer) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd wanted{pipe, POLLIN, 0};
    const int ready = left > 0 ? poll(&wanted, 1, static_cast<int>(left)) : 0;
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return received.late = true, received;
    const ssize_t count = read(pipe, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    received.bytes.insert(received.bytes.end(), block.begin(), block.begin() + count);
  }
  return received;
}

/// Why there is no answer.
Error reason(const Received& received, const std::optional<int>& status) {
  if (received.late) return failed(fmt::format("the picture cannot be decoded within {} s", most_seconds_per_picture));
  if (status && WIFSIGNALED(*status) && WTERMSIG(*status) == SIGXCPU)
    return failed(
        fmt::format("the picture takes more than {} s of processor time to decode", decoder::most_processor_seconds));
  if (status && WIFEXITED(*status) && WEXITSTATUS(*status) == 127)
    return {Code::missing_library,
            "the program that decodes pictures cannot load its libraries",
            "install OpenImageIO and libseccomp; where memory is limited (`ulimit`), allow more",
            {"wale-decoder"}};
  const bool crashed = status && WIFSIGNALED(*status) && WTERMSIG(*status) != SIGKILL;
  return failed(crashed ? "the decoder crashed, on this picture or for want of memory or of threads"
                        : "the decoder gave no valid answer");
}

/// Runs the decoder, and reads its answer by `read`.
template <class Image, class Read>
Result<Image> answer_of_decoder(std::span<const std::byte> bytes, const DecoderArguments& arguments,
                                const std::vector<std::string>& programs, const Read& read) {
  const auto picture = sealed_copy(bytes);
  if (!picture) return picture.error();
  auto pipe = new_pipe();
  if (!pipe) return pipe.error();
  const auto process = start_decoder(picture->number(), pipe->in.number(), arguments, programs);
  if (!process) return process.error();
  pipe->in = Descriptor();  // the decoder has the only end to write to, so its end is the end of the answer
  const Received received = receive(pipe->out.number());
  const std::optional<int> status = end(*process);
  if (auto answer = read(received.bytes)) return *std::move(answer);
  return reason(received, status);
}

}  // namespace

std::vector<std::string> decoder_programs() { return companion_paths("wale-decoder"); }

Result<HeightImage> decode_picture(std::span<const std::byte> bytes, const DecoderArguments& arguments,
                                   const std::vector<std::string>& programs) {
  return answer_of_decoder<HeightImage>(bytes, arguments, programs,
                                        [](std::span<const std::byte> answer) { return read_answer(answer); });
}

Result<ColourImage> decode_colours(std::span<const std::byte> bytes, const DecoderArguments& arguments,
                                   const std::vector<std::string>& programs) {
  return answer_of_decoder<ColourImage>(bytes, arguments, programs,
                                        [](std::span<const std::byte> answer) { return read_colour_answer(answer); });
}

}  // namespace wale
